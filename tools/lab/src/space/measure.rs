//! What is asked of a run on any mesh, and how far two runs are apart by it.

use serde::{Deserialize, Serialize};
use tearmesh::Point;

use crate::pareto::{Case, Observable, Records};

/// A measure by which runs on different meshes are compared. Errors are relative to the finest mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// The L2 norm of the position errors of the vertices that all meshes share, divided by that of their
    /// displacements from the start; the largest of all checkpoints.
    Displacement,
    /// The mean distance by which the lower edge of the sheet went down, in metres.
    Sag,
    /// The largest mean over 1/60 s of the force at the held particles, in newtons.
    ReactionLargest,
    /// The time in seconds at which an edge first reaches a toughness.
    ToughTime,
    /// The force in newtons at [`ToughTime`](Measure::ToughTime), as a mean over the last 1/60 s.
    ToughForce,
    /// The time in seconds at which an edge first reaches a stretch ratio.
    TearTime,
    /// The force in newtons at [`TearTime`](Measure::TearTime), as a mean over the last 1/60 s.
    TearForce,
}

impl Measure {
    /// Returns the name of the measure in tables and captions.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Measure::Displacement => "displacement",
            Measure::Sag => "sag",
            Measure::ReactionLargest => "reaction-largest",
            Measure::ToughTime => "toughness-time",
            Measure::ToughForce => "toughness-force",
            Measure::TearTime => "stretch-time",
            Measure::TearForce => "stretch-force",
        }
    }

    /// Returns the unit of the measure's number; empty if it has none.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Measure::Displacement => "",
            Measure::Sag => "m",
            Measure::ReactionLargest | Measure::ToughForce | Measure::TearForce => "N",
            Measure::ToughTime | Measure::TearTime => "s",
        }
    }
}

/// The places at which a mesh is read.
#[derive(Clone, Debug)]
pub(super) struct Places {
    /// The particles on the lattice of the coarsest mesh, row by row.
    shared: Vec<usize>,
    /// The particles of the lower edge, and the part of the edge that each stands for.
    lower: Vec<(usize, f64)>,
}

/// How far a vertex may lie from the lattice, as a part of the side: what a float rounds.
const ROUNDED: f64 = 1e-9;

impl Places {
    /// The places of a case whose grid refines a lattice of so many cells.
    ///
    /// # Panics
    ///
    /// If it does not.
    pub(super) fn new(case: &Case, lattice: u32) -> Places {
        let side_m = case.scene.side_m;
        let points = &case.sheet.points;
        let part = |i: u32| side_m * f64::from(i) / f64::from(lattice);
        let spots = (0..=lattice).flat_map(|j| (0..=lattice).map(move |i| [i, j]));
        let shared = spots.map(|[i, j]| {
            let spot = Point::new(part(i), part(j), 0.0);
            let is_there = |p: &Point| (p - spot).norm() <= ROUNDED * side_m;
            let found = points.iter().position(is_there);
            found.expect("grids nest: each has the vertices of the coarsest")
        });
        let is_low = |i: &usize| points[*i].y == 0.0;
        let mut low: Vec<usize> = (0..points.len()).filter(is_low).collect();
        low.sort_by(|&i, &j| points[i].x.total_cmp(&points[j].x));
        let mut lower: Vec<(usize, f64)> = low.iter().map(|&i| (i, 0.0)).collect();
        // Half of each edge counts for each of its ends.
        for k in 1..lower.len() {
            let half = 0.5 * (points[low[k]].x - points[low[k - 1]].x) / side_m;
            lower[k - 1].1 += half;
            lower[k].1 += half;
        }
        Places {
            shared: shared.collect(),
            lower,
        }
    }
}

/// What a run says, in terms that do not depend on its mesh.
#[derive(Clone, Debug)]
pub(super) struct Reading {
    /// The coordinates of the shared particles in metres, checkpoint by checkpoint.
    shared_m: Vec<f64>,
    /// Where they started.
    start_m: Vec<f64>,
    /// How far the lower edge went down at the end, in metres.
    sag_m: Option<f64>,
    reaction_n: Option<f64>,
    /// Seconds and newtons by toughness, then by stretch.
    tears: [Option<f64>; 4],
}

impl Reading {
    pub(super) fn of(case: &Case, places: &Places, records: &Records) -> Reading {
        Reading {
            reaction_n: records.number(Observable::ReactionLargest),
            tears: [
                Observable::ToughTime,
                Observable::ToughForce,
                Observable::TearTime,
                Observable::TearForce,
            ]
            .map(|observable| records.number(observable)),
            ..Reading::of_positions(case, places, records.coordinates_m())
        }
    }

    /// What the coordinates of all particles say, checkpoint by checkpoint.
    fn of_positions(case: &Case, places: &Places, coordinates_m: &[f64]) -> Reading {
        let start: Vec<f64> = case.start.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
        let checkpoints = || coordinates_m.chunks_exact(start.len());
        let shared = |x: &[f64]| -> Vec<f64> {
            let of = |&i: &usize| [x[3 * i], x[3 * i + 1], x[3 * i + 2]];
            places.shared.iter().flat_map(of).collect()
        };
        let sag = |x: &[f64]| -> f64 {
            let down = |i: usize| start[3 * i + 1] - x[3 * i + 1];
            let each = places.lower.iter();
            each.map(|&(i, part)| part * down(i)).sum()
        };
        Reading {
            shared_m: checkpoints().flat_map(shared).collect(),
            start_m: shared(&start),
            sag_m: checkpoints().next_back().map(sag),
            reaction_n: None,
            tears: [None; 4],
        }
    }

    /// The number of a measure; `None` for displacements, which have many, and where there is no answer.
    pub(super) fn number(&self, measure: Measure) -> Option<f64> {
        match measure {
            Measure::Displacement => None,
            Measure::Sag => self.sag_m,
            Measure::ReactionLargest => self.reaction_n,
            Measure::ToughTime => self.tears[0],
            Measure::ToughForce => self.tears[1],
            Measure::TearTime => self.tears[2],
            Measure::TearForce => self.tears[3],
        }
    }

    /// How far two runs are apart as a part of a reference; `None` where one has no answer.
    pub(super) fn apart(&self, other: &Reading, of: &Reading, measure: Measure) -> Option<f64> {
        let apart = match measure {
            Measure::Displacement => self.displaced(other, of)?,
            _ => {
                let number = |reading: &Reading| reading.number(measure);
                (number(self)? - number(other)?).abs() / number(of)?.abs()
            }
        };
        apart.is_finite().then_some(apart)
    }

    /// The largest of all checkpoints.
    fn displaced(&self, other: &Reading, of: &Reading) -> Option<f64> {
        let count = self.start_m.len();
        let [a, b, of_m] = [self, other, of].map(|reading| reading.shared_m.chunks(count));
        if a.len() == 0 || a.len() != b.len() || a.len() != of_m.len() {
            return None;
        }
        let norm = |a: &[f64], b: &[f64]| {
            let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
            squares.sum::<f64>().sqrt()
        };
        let each = a.zip(b).zip(of_m);
        let each = each.map(|((a, b), of_m)| norm(a, b) / norm(of_m, &of.start_m));
        each.max_by(f64::total_cmp)
    }
}

#[cfg(test)]
mod tests {
    use super::super::scene::SpaceScene;
    use super::*;

    /// Thirds, which floats round, too.
    const CELLS: [u32; 4] = [3, 6, 9, 24];

    /// A field over the sheet as it is read on a mesh.
    fn read(cells: u32, moved: impl Fn([f64; 3]) -> [f64; 3]) -> Reading {
        let case = SpaceScene::Hang.case(cells);
        let coordinates = case.start.iter().flat_map(|p| moved([p.x, p.y, p.z]));
        let coordinates: Vec<f64> = coordinates.collect();
        Reading::of_positions(&case, &Places::new(&case, CELLS[0]), &coordinates)
    }

    #[test]
    fn a_field_is_the_same_on_every_mesh_and_another_is_as_far_as_it_is_by_hand() {
        let bent = |[x, y, z]: [f64; 3]| [x + 0.1 * y * y, y - 0.2 * x, z + x * y];
        let off = |[x, y, z]: [f64; 3]| [x + 0.1 * y * y, y - 0.2 * x, z + x * y + 0.3 * y];
        let (mut apart, mut far) = (0.0, 0.0);
        for j in 0..=3 {
            for i in 0..=3 {
                let [x, y] = [i, j].map(|k| f64::from(k) / 3.0);
                apart += 0.09 * y * y;
                far += 0.01 * y.powi(4) + 0.04 * x * x + x * x * y * y;
            }
        }
        let by_hand = f64::sqrt(apart / far);
        for a in CELLS {
            for b in CELLS {
                let [first, second, third] = [read(a, bent), read(b, bent), read(b, off)];
                let measure = Measure::Displacement;
                let same = first.apart(&second, &second, measure).expect("a distance");
                assert!(same < 1e-14, "{a} {b}: {same}");
                let apart = third.apart(&first, &first, measure).expect("a distance");
                assert!(
                    (apart - by_hand).abs() < 1e-13,
                    "{a} {b}: {apart}, not {by_hand}"
                );
            }
        }
    }

    #[test]
    fn the_sag_of_a_parabola_is_its_mean_by_the_rule_of_trapezia() {
        for cells in CELLS {
            let reading = read(cells, |[x, y, z]| [x, y - x * x, z]);
            // ∫ x² = 1/3, and straight lines between its points lie above it by h²/6.
            let h = 1.0 / f64::from(cells);
            let mean = 1.0 / 3.0 + h * h / 6.0;
            let sag = reading.number(Measure::Sag).expect("a sag");
            assert!((sag - mean).abs() < 1e-14, "{cells}: {sag}, not {mean}");
        }
    }
}
