//! What a straight cut must have made of a mesh, judged from triangles alone.
//!
//! Nothing here is imported from the library: a surface is points and triangles, a cut is a
//! plane and the side planes that bound it, and [`judge`] compares the surface before with the
//! one after. How the cut was made, in which order, and how the crossed faces were
//! triangulated, it neither knows nor asks.
//!
//! It is valid for **generic** cuts, which [`is_generic`] tells, made without a snap: then no old
//! vertex lies on the seam, so that old vertices keep their numbers and positions, and every seam
//! vertex is new.
//!
//! The surface before may have been cut already. What hangs together is told by numbers of
//! vertices, never by positions, so a torn edge is boundary on both of its sides although
//! these coincide. After the cut such boundary is told from the seam by direction: an edge
//! belongs to the old boundary if it runs along an old boundary edge *the same way*. Two
//! layers of one orientation in one place are beyond this oracle, and so are torn edges whose
//! copies moved apart: the cutter subdivides both copies where either is crossed, which shows
//! as [`Check::Children`] and nothing else.
//!
//! Lengths are measured in edges: mean edge lengths of the surface before.

mod expected;
mod parents;
mod surface;

use std::collections::BTreeMap;
use std::fmt;

use super::joined_sets;
use expected::Expected;
pub(crate) use expected::{End, is_generic, segments};
pub(crate) use surface::{Cut, Surface, cross, dot, length, minus, on_the_way};
use surface::{bits, place};

/// How far a seam vertex may be off the plane or outside the strip, in edges.
const OFF_MAX: f64 = 1e-9;
/// How far a sum of lengths may be off, in edges.
const LENGTH_OFF_MAX: f64 = 1e-8;
/// How far the total area may be off, relative to it.
const AREA_OFF_MAX: f64 = 1e-12;

/// What is checked. A fault names its check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Check {
    /// Faces have three different vertices that exist, at finite places.
    Index,
    /// No directed edge is there twice.
    Twice,
    /// The faces that meet in a vertex form as many fans as before; round a new one, one.
    Fans,
    /// The total area stays.
    Area,
    /// Each face lies in a face of before, turned the same way.
    Parent,
    /// Each face of before is covered by its children, and they are as many as the points that
    /// were inserted make of it.
    Children,
    /// Old vertices keep their places, and the corners of a face their numbers.
    Old,
    /// What is boundary after the cut and not seam is as long as the boundary before it.
    Boundary,
    /// Boundary that is not of before has two sides with bit-equal ends.
    Crack,
    /// Seam vertices lie on the plane and between the side planes.
    Off,
    /// The seam is as long as plane, faces and strip have in common.
    Length,
    /// The seam hangs together, place by place, as plane, faces and strip do.
    Chains,
    /// The Euler characteristic changes by B − (T + B) / 2, with T tips and B slit ends on the
    /// boundary.
    Euler,
    /// The pieces are those of an ideal cut, not only as many.
    Pieces,
}

/// A check that failed, and the numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    pub(crate) check: Check,
    numbers: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {}", self.check, self.numbers)
    }
}

/// What was found in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Facts {
    pub(crate) pieces: usize,
    /// Ends of the slit inside a face.
    pub(crate) tips: usize,
    /// Ends of the slit on the boundary.
    pub(crate) boundary_ends: usize,
    /// Parts of the seam that do not touch each other.
    pub(crate) chains: usize,
    /// The length of the seam, one side.
    pub(crate) seam_length: f64,
    /// The largest distance of a seam vertex from the plane, in edges.
    pub(crate) deviation_max_edges: f64,
}

/// Judges a straight cut: `cut` made `after` of `before`.
pub(crate) fn judge(before: &Surface, cut: &Cut, after: &Surface) -> Result<Facts, Vec<Fault>> {
    let expected = Expected::new(before, cut);
    let mut bench = Bench::new(before, std::slice::from_ref(cut), after);
    if bench.check_indices() {
        bench.check_surface();
        let parents = bench.check_parents(Some(&expected.children));
        let tips = expected.tips.len();
        bench.check_seam(expected.length, &expected.segments);
        bench.check_euler(tips, expected.boundary_ends);
        bench.check_pieces(&expected, &parents);
    }
    bench.verdict()
}

/// Judges a polyline: cuts one after the other, each of which starts on the side plane where
/// the one before it ends, and which do not meet elsewhere.
///
/// Where the tips of two consecutive cuts coincide is a joint: one vertex, from which both
/// slits go on. A joint is no tip, and it joins their chains. What an ideal polyline leaves of
/// pieces is not foreseen here; [`Facts::pieces`] tells what there is. Later cuts find
/// faces that earlier ones made, so the number of children of a face is free.
pub(crate) fn judge_polyline(
    before: &Surface,
    cuts: &[Cut],
    after: &Surface,
) -> Result<Facts, Vec<Fault>> {
    let expected: Vec<_> = cuts.iter().map(|cut| Expected::new(before, cut)).collect();
    let near = OFF_MAX * before.mean_edge();
    let mut joints = 0;
    for two in expected.windows(2) {
        for tip in &two[0].tips {
            joints += two[1]
                .tips
                .iter()
                .filter(|&other| length(minus(*tip, *other)) < near)
                .count();
        }
    }
    let tips = expected.iter().map(|one| one.tips.len()).sum::<usize>() - 2 * joints;
    let boundary_ends = expected.iter().map(|one| one.boundary_ends).sum();
    let segments: Vec<_> = expected.iter().flat_map(|one| &one.segments).collect();
    let segments: Vec<_> = segments.into_iter().copied().collect();
    let mut bench = Bench::new(before, cuts, after);
    if bench.check_indices() {
        bench.check_surface();
        bench.check_parents(None);
        bench.check_seam(expected.iter().map(|one| one.length).sum(), &segments);
        bench.check_euler(tips, boundary_ends);
        bench.facts.pieces = after.pieces().1;
    }
    bench.verdict()
}

/// Both surfaces on one bench, with the faults found so far.
struct Bench<'a> {
    before: &'a Surface,
    cuts: &'a [Cut],
    after: &'a Surface,
    edge: f64,
    facts: Facts,
    faults: Vec<Fault>,
}

impl<'a> Bench<'a> {
    fn new(before: &'a Surface, cuts: &'a [Cut], after: &'a Surface) -> Bench<'a> {
        Bench {
            before,
            cuts,
            after,
            edge: before.mean_edge(),
            facts: Facts {
                pieces: 0,
                tips: 0,
                boundary_ends: 0,
                chains: 0,
                seam_length: 0.0,
                deviation_max_edges: 0.0,
            },
            faults: Vec::new(),
        }
    }

    fn verdict(self) -> Result<Facts, Vec<Fault>> {
        if self.faults.is_empty() {
            Ok(self.facts)
        } else {
            Err(self.faults)
        }
    }

    fn fault(&mut self, check: Check, numbers: String) {
        self.faults.push(Fault { check, numbers });
    }

    /// Whether the faces are worth looking at.
    fn check_indices(&mut self) -> bool {
        let after = self.after;
        for (f, &[a, b, c]) in after.faces.iter().enumerate() {
            let there = |v: u32| (v as usize) < after.points.len();
            let sound = [a, b, c].into_iter().all(there) && a != b && b != c && c != a;
            if !sound {
                self.fault(Check::Index, format!("face {f} is {:?}", [a, b, c]));
            }
        }
        for (v, p) in after.points.iter().enumerate() {
            if p.iter().any(|x| !x.is_finite()) {
                self.fault(Check::Index, format!("vertex {v} is at {p:?}"));
            }
        }
        self.faults.is_empty()
    }

    fn check_surface(&mut self) {
        let (before, after) = (self.before, self.after);
        for (side, count) in after.directed_edges() {
            if count > 1 {
                self.fault(Check::Twice, format!("{side:?} is there {count} times"));
            }
        }
        let fans = before.fans();
        for (v, fans_after) in after.fans().into_iter().enumerate() {
            let fans_before = fans.get(v).copied().unwrap_or(1);
            if fans_after != fans_before {
                let numbers = format!("{fans_after} round vertex {v} instead of {fans_before}");
                self.fault(Check::Fans, numbers);
            }
        }
        let (area_before, area_after) = (before.area(), after.area());
        if (area_after - area_before).abs() > AREA_OFF_MAX * area_before {
            self.fault(
                Check::Area,
                format!("{area_after} instead of {area_before}"),
            );
        }
        for (v, place) in before.points.iter().enumerate() {
            if after.points.get(v).map(bits) != Some(bits(place)) {
                let now = after.points.get(v);
                self.fault(
                    Check::Old,
                    format!("vertex {v} was at {place:?}, is at {now:?}"),
                );
            }
        }
    }

    /// Tells the seam from the old boundary, and checks both.
    fn check_seam(&mut self, length_expected: f64, segments: &[[[f64; 3]; 2]]) {
        let (before, after) = (self.before, self.after);
        let rim = before.boundary();
        let mut left_over = BTreeMap::<_, usize>::new();
        let mut total = 0.0;
        for (a, b) in after.boundary() {
            let [p, q] = [a, b].map(|v| after.points[v as usize]);
            total += length(minus(q, p));
            let old = |&(c, d): &(u32, u32)| {
                let [from, to] = [c, d].map(|v| before.points[v as usize]);
                runs_along([p, q], [from, to], OFF_MAX * self.edge)
            };
            if !rim.iter().any(old) {
                *left_over.entry([bits(&p), bits(&q)]).or_default() += 1;
            }
        }
        let mut seam = Vec::new();
        for (&[p, q], &count) in &left_over {
            let opposite = left_over.get(&[q, p]).copied().unwrap_or(0);
            if count > opposite {
                let [p, q] = [p, q].map(place);
                let numbers = format!("{p:?} to {q:?}: {count} times, back {opposite} times");
                self.fault(Check::Crack, numbers);
            }
            if p < q {
                seam.extend(vec![[place(p), place(q)]; count.min(opposite)]);
            }
        }

        let seam_length: f64 = seam.iter().map(|[p, q]| length(minus(*q, *p))).sum();
        if (seam_length - length_expected).abs() > LENGTH_OFF_MAX * self.edge {
            let numbers = format!("{seam_length} instead of {length_expected}");
            self.fault(Check::Length, numbers);
        }
        let rim_length: f64 = before.total_length(&rim);
        let apart = total - 2.0 * seam_length;
        if (apart - rim_length).abs() > LENGTH_OFF_MAX * self.edge {
            self.fault(Check::Boundary, format!("{apart} instead of {rim_length}"));
        }
        let mut deviation_max = 0.0f64;
        for &p in seam.iter().flatten() {
            // On a polyline every seam vertex lies on one of the cuts.
            let off = |cut: &Cut| cut.plane.distance(p).abs().max(-cut.depth(p));
            let off = self.cuts.iter().map(off).fold(f64::INFINITY, f64::min) / self.edge;
            deviation_max = deviation_max.max(off);
            if off > OFF_MAX {
                self.fault(Check::Off, format!("{p:?} by {off} edges"));
            }
        }
        let chains = chains(&seam, 0.0);
        let chains_expected = self::chains(segments, OFF_MAX * self.edge);
        if chains != chains_expected {
            self.fault(
                Check::Chains,
                format!("{chains} instead of {chains_expected}"),
            );
        }
        self.facts.chains = chains;
        self.facts.seam_length = seam_length;
        self.facts.deviation_max_edges = deviation_max;
    }

    fn check_euler(&mut self, tips: usize, boundary_ends: usize) {
        self.facts.tips = tips;
        self.facts.boundary_ends = boundary_ends;
        // A slit has two ends, so their number is even.
        let expected = boundary_ends as i64 - (tips + boundary_ends) as i64 / 2;
        let change = self.after.euler() - self.before.euler();
        if change != expected {
            let numbers = format!(
                "changes by {change} instead of {expected} ({tips} tips, {boundary_ends} ends on \
                 the boundary)"
            );
            self.fault(Check::Euler, numbers);
        }
    }

    /// Each piece has to be one piece of the ideal cut, and the other way round.
    fn check_pieces(&mut self, expected: &Expected, parents: &[Option<usize>]) {
        let (before, after) = (self.before, self.after);
        let (piece, count) = after.pieces();
        self.facts.pieces = count;
        if count != expected.pieces {
            let numbers = format!("{count} instead of {}", expected.pieces);
            self.fault(Check::Pieces, numbers);
        }
        // Each part of a face has an old vertex, which tells its side of the plane.
        let mut meant = BTreeMap::new();
        let mut made = BTreeMap::new();
        for (f, &parent) in parents.iter().enumerate() {
            let old = after.faces[f]
                .into_iter()
                .find(|&v| (v as usize) < before.points.len());
            let (Some(parent), Some(old)) = (parent, old) else {
                continue;
            };
            let ideal = expected.piece_of(parent, before.points[old as usize]);
            let (also_meant, also_made) = (
                *meant.entry(piece[f]).or_insert(ideal),
                *made.entry(ideal).or_insert(piece[f]),
            );
            if also_meant != ideal || also_made != piece[f] {
                let numbers = format!("face {f} of piece {} ought to be of another", piece[f]);
                self.fault(Check::Pieces, numbers);
                return;
            }
        }
    }
}

/// Whether the directed segment `pq` is a part of the directed segment `from to`.
fn runs_along([p, q]: [[f64; 3]; 2], [from, to]: [[f64; 3]; 2], near: f64) -> bool {
    let whole = minus(to, from);
    let size = length(whole);
    let along = |x: [f64; 3]| dot(minus(x, from), whole) / size;
    let across = |x: [f64; 3]| length(cross(minus(x, from), whole)) / size;
    across(p) <= near
        && across(q) <= near
        && along(p) >= -near
        && along(q) <= size + near
        && along(p) < along(q)
}

/// The number of sets of segments that are joined by ends in one place.
fn chains(segments: &[[[f64; 3]; 2]], near: f64) -> usize {
    let mut joined = Vec::new();
    for (i, one) in segments.iter().enumerate() {
        for (j, other) in segments.iter().enumerate().skip(i + 1) {
            let meet = |p: &[f64; 3], q: &[f64; 3]| length(minus(*p, *q)) <= near;
            if one.iter().any(|p| other.iter().any(|q| meet(p, q))) {
                joined.push([i, j]);
            }
        }
    }
    let chain = joined_sets(segments.len(), &joined);
    (0..chain.len()).filter(|&i| chain[i] == i).count()
}
