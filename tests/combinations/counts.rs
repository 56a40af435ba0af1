//! The oracles of a cut, the levels at which each holds, and how often each was applied.

use std::collections::BTreeMap;

/// An oracle and the levels at which it holds.
pub(crate) const ORACLES: [(&str, &str); 20] = [
    ("invariants", "always"),
    ("mass", "always"),
    (
        "file",
        "always: the command writes what the library does, or refuses what it refuses",
    ),
    (
        "record",
        "always: mended and simplified, it is the file that it was at first, to the byte",
    ),
    ("area", "unless a vertex slid on a mesh that is not flat"),
    (
        "border",
        "unless a vertex slid on a mesh that is not flat: sewn up, the border is as long",
    ),
    (
        "closed",
        "unless two layers are at one place: what is closed by place stays closed",
    ),
    (
        "values",
        "with values at corners, and no gap: they are those of the place",
    ),
    (
        "normals",
        "with normals at corners, and no gap: they are those of their side",
    ),
    (
        "exactly",
        "exact, generic, of the same rays at snap 0: plane, strip, length, chains, ends, pieces",
    ),
    (
        "plane",
        "exact, rays not skew, no polyline: no farther from the plane than the snap allows",
    ),
    (
        "strip",
        "exact, with rays, not through: nothing torn lies beyond a ray",
    ),
    (
        "aims",
        "exact, with rays, not through: where a ray meets the mesh, the seam ends",
    ),
    (
        "met",
        "exact, with rays, not through: of all aims at most one in twenty is missed and said to be",
    ),
    (
        "slides",
        "exact: what slid is an end of an edge that was torn",
    ),
    (
        "parts",
        "plane or through, exact or partition: what is before it and behind is apart",
    ),
    (
        "layers",
        "rays, flat, nothing torn apart: the first layer is all of them",
    ),
    (
        "undo",
        "no gap: `mend --last --simplify` leaves what was there, to the byte",
    ),
    (
        "turned",
        "exact, nothing torn before: turned and mirrored, it is the same up to rounding",
    ),
    (
        "renumbered",
        "exact, nothing torn before: it is the same, to the bit",
    ),
];

/// Of so many aims more than one in twenty may be missed by chance.
const FEW: usize = 200;

/// How often each oracle was applied, in how many sequences.
#[derive(Clone, Debug, Default)]
pub(crate) struct Counts {
    applied: BTreeMap<&'static str, usize>,
    sequences: BTreeMap<&'static str, usize>,
    of_this: Vec<&'static str>,
    /// The aims that were missed, as the report said.
    missed: usize,
}

impl Counts {
    pub(crate) fn add(&mut self, oracle: &'static str) {
        let is_known = ORACLES.iter().any(|(name, _)| *name == oracle);
        assert!(is_known, "{oracle} is no oracle");
        *self.applied.entry(oracle).or_default() += 1;
        if !self.of_this.contains(&oracle) {
            self.of_this.push(oracle);
        }
    }

    /// Counts an aim, which may be missed if that is said, but not often.
    pub(crate) fn aim(&mut self, is_missed: bool) {
        self.add("met");
        self.missed += usize::from(is_missed);
        let all = self.applied["met"];
        assert!(
            20 * self.missed <= all.max(FEW),
            "of {all} aims {} are missed",
            self.missed
        );
    }

    pub(crate) fn end_sequence(&mut self) {
        for oracle in self.of_this.drain(..) {
            *self.sequences.entry(oracle).or_default() += 1;
        }
    }

    /// A line for each oracle; and those that were applied in fewer than so many sequences.
    pub(crate) fn lines(&self, least: usize) -> (Vec<String>, Vec<&'static str>) {
        let count =
            |of: &BTreeMap<&'static str, usize>, name: &str| of.get(name).copied().unwrap_or(0);
        let line = |(name, levels): &(&'static str, &str)| {
            let [times, sequences] = [&self.applied, &self.sequences].map(|of| count(of, name));
            format!("{name:<10} {times:>5} times in {sequences:>4} sequences  {levels}")
        };
        let absent = ORACLES.iter().map(|(name, _)| *name);
        let absent = absent.filter(|name| count(&self.sequences, name) < least);
        (ORACLES.iter().map(line).collect(), absent.collect())
    }
}
