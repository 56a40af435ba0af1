//! Which face of before each face of after lies in.

use std::collections::{BTreeMap, BTreeSet};

use super::surface::{Surface, twice_area};
use super::{Bench, Check, OFF_MAX, cross, dot, length, minus};

impl Bench<'_> {
    /// The parent of each face. `children` is the number of faces that each face is cut into,
    /// if that is known.
    pub(super) fn check_parents(&mut self, children: Option<&[usize]>) -> Vec<Option<usize>> {
        let (before, after) = (self.before, self.after);
        let mut family = vec![Vec::new(); before.faces.len()];
        let parents = parents(before, after, self.edge);
        for (f, &parent) in parents.iter().enumerate() {
            let Some(parent) = parent else {
                self.fault(Check::Parent, format!("face {f} lies in no face of before"));
                continue;
            };
            family[parent].push(f);
            let normal = |s: &Surface, face| twice_area(s.corners(face));
            let (child, whole) = (&after.faces[f], &before.faces[parent]);
            // A sliver may have no area but that of rounding.
            let up = dot(normal(before, whole), normal(after, child)) / self.edge.powi(4);
            if up < -1e-12 {
                self.fault(Check::Parent, format!("face {f} is turned over ({up:e})"));
            }
        }
        for (parent, family) in family.iter().enumerate() {
            self.check_family(parent, family, children.map(|children| children[parent]));
        }
        parents
    }

    fn check_family(&mut self, parent: usize, family: &[usize], count: Option<usize>) {
        let (before, after) = (self.before, self.after);
        let whole = &before.faces[parent];
        let area = |s: &Surface, face| length(twice_area(s.corners(face))) / 2.0;
        let covered: f64 = family.iter().map(|&f| area(after, &after.faces[f])).sum();
        let area = area(before, whole);
        let there = family.len();
        if (covered - area).abs() > OFF_MAX * self.edge * self.edge {
            let numbers = format!("{there} of face {parent} cover {covered} of {area}");
            self.fault(Check::Children, numbers);
        }
        if let Some(count) = count.filter(|&count| count != there) {
            let numbers = format!("{there} of face {parent} instead of {count}");
            self.fault(Check::Children, numbers);
        }
        let old: BTreeSet<u32> = family
            .iter()
            .flat_map(|&f| after.faces[f])
            .filter(|&v| (v as usize) < before.points.len())
            .collect();
        if old != whole.iter().copied().collect() {
            let numbers = format!("face {parent} had {whole:?}, its children have {old:?}");
            self.fault(Check::Old, numbers);
        }
    }
}

/// For each face of `after` the face of `before` in whose plane and outline it lies: the one
/// with the same vertices, or the one whose edges are farthest from its centre.
pub(super) fn parents(before: &Surface, after: &Surface, edge: f64) -> Vec<Option<usize>> {
    let whole: BTreeMap<_, _> = before.faces.iter().map(smallest_first).zip(0..).collect();
    let kept: Vec<_> = after
        .faces
        .iter()
        .map(|face| whole.get(&smallest_first(face)).copied())
        .collect();
    let mut is_kept = vec![false; before.faces.len()];
    for parent in kept.iter().flatten() {
        is_kept[*parent] = true;
    }
    let search = |face: &[u32; 3]| {
        let mut best = None;
        for (f, parent) in before
            .faces
            .iter()
            .enumerate()
            .filter(|&(f, _)| !is_kept[f])
        {
            let depth = depth(before.corners(parent), after.corners(face), OFF_MAX * edge);
            if let Some(depth) = depth.filter(|&depth| best.is_none_or(|(_, most)| depth > most)) {
                best = Some((f, depth));
            }
        }
        best.map(|(f, _)| f)
    };
    let faces = after.faces.iter().zip(kept);
    faces
        .map(|(face, kept)| kept.or_else(|| search(face)))
        .collect()
}

/// How far the centre of the inner triangle is inside the outer one, if all its corners are.
fn depth(outer: [[f64; 3]; 3], inner: [[f64; 3]; 3], near: f64) -> Option<f64> {
    let normal = twice_area(outer);
    let size = length(normal);
    let centre = [0, 1, 2].map(|i| (inner[0][i] + inner[1][i] + inner[2][i]) / 3.0);
    let mut depth = f64::INFINITY;
    for i in 0..3 {
        let (a, b) = (outer[i], outer[(i + 1) % 3]);
        let inward = cross(normal, minus(b, a));
        let inside = |p: [f64; 3]| dot(inward, minus(p, a)) / length(inward);
        if inner.iter().any(|&p| inside(p) < -near) {
            return None;
        }
        depth = depth.min(inside(centre));
    }
    let off = |p: &[f64; 3]| dot(normal, minus(*p, outer[0])).abs() / size > near;
    (!inner.iter().any(off)).then_some(depth)
}

/// A face with its smallest vertex first, turned the same way.
fn smallest_first(&[a, b, c]: &[u32; 3]) -> [u32; 3] {
    let turns = [[a, b, c], [b, c, a], [c, a, b]];
    turns.into_iter().min().expect("three turns")
}
