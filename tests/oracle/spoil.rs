//! Bugs that a straight cut could have, put into its output.
//!
//! Of the cut they know only what a generic one leaves: every vertex of the seam is new, and the
//! two sides of the seam lie at the same places.

use super::straight::{Cut, Surface, length, minus, on_the_way};

/// A bug. The first nine are those that every oracle of the exact cut has to find.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Bug {
    /// An edge of the slit is not split.
    EdgeMissing,
    /// An edge outside the slit is split.
    EdgeTooMany,
    /// A vertex of the seam is not split, although its edges are.
    VertexNotSplit,
    /// One copy of a seam vertex is moved by 1e-10 edges.
    CopyMoved,
    /// A tip is moved along the slit by 1e-3 edges.
    TipOff,
    /// Both copies of a seam vertex are moved off the plane by 1e-6 edges.
    SeamOff,
    /// An edge is bisected for one of its faces only.
    NeighbourNotBisected,
    FaceLost,
    FaceFlipped,
    /// An edge outside the slit is bisected, for both of its faces.
    EdgeBisected,
    /// An old vertex is moved by 1e-10 edges.
    OldMoved,
    /// A face has a vertex twice.
    FaceCollapsed,
    /// A face is there twice.
    FaceTwice,
    /// Nothing was cut.
    NothingDone,
}

pub(crate) const BUGS: [Bug; 14] = [
    Bug::EdgeMissing,
    Bug::EdgeTooMany,
    Bug::VertexNotSplit,
    Bug::CopyMoved,
    Bug::TipOff,
    Bug::SeamOff,
    Bug::NeighbourNotBisected,
    Bug::FaceLost,
    Bug::FaceFlipped,
    Bug::EdgeBisected,
    Bug::OldMoved,
    Bug::FaceCollapsed,
    Bug::FaceTwice,
    Bug::NothingDone,
];

/// The surface `after` with a bug somewhere; `None` if it has no place for it. `random` gives
/// numbers from 0 to 1.
pub(crate) fn spoil(
    before: &Surface,
    cut: &Cut,
    after: &Surface,
    bug: Bug,
    random: &mut impl FnMut() -> f64,
) -> Option<Surface> {
    let mut spoilt = after.clone();
    let edge = before.mean_edge();
    let is_new = |v: u32| v as usize >= before.points.len();
    let seam: Vec<_> = after.boundary();
    let seam: Vec<_> = seam
        .into_iter()
        .filter(|&(a, b)| is_new(a) && is_new(b))
        .collect();
    let place = |v: u32| after.points[v as usize];
    let copies = |v: u32| -> Vec<u32> {
        let all = 0..after.points.len() as u32;
        all.filter(|&w| place(w) == place(v)).collect()
    };
    let mut pick = |count: usize| (random() * count as f64) as usize % count.max(1);
    let face = pick(after.faces.len());
    match bug {
        Bug::EdgeMissing => {
            let &(a, b) = seam.get(pick(seam.len()))?;
            let back = |&&(c, d): &&(u32, u32)| [place(c), place(d)] == [place(b), place(a)];
            let &(c, d) = seam.iter().find(back).expect("a seam has two sides");
            relabel(&mut spoilt, c, b);
            relabel(&mut spoilt, d, a);
        }
        Bug::EdgeTooMany => {
            let directed = after.directed_edges();
            let rim: Vec<u32> = after.boundary().into_iter().map(|(a, _)| a).collect();
            let inner = |&&(a, b): &&(u32, u32)| directed.contains_key(&(b, a)) && rim.contains(&a);
            let inner: Vec<_> = directed.keys().filter(inner).collect();
            let &&(a, b) = inner.get(pick(inner.len()))?;
            tear(&mut spoilt, a, b);
        }
        Bug::VertexNotSplit | Bug::CopyMoved | Bug::SeamOff => {
            let split: Vec<_> = seam.iter().filter(|&&(v, _)| copies(v).len() > 1).collect();
            let &&(v, _) = split.get(pick(split.len()))?;
            let [x, y, z] = cut.plane.normal();
            match bug {
                Bug::VertexNotSplit => {
                    let other = copies(v).into_iter().find(|&w| w != v)?;
                    relabel(&mut spoilt, other, v);
                }
                Bug::CopyMoved => {
                    let way = [[x, y, z], [-y, x, z], [z, y, -x]][pick(3)];
                    spoilt.points[v as usize] = moved(place(v), way, 1e-10 * edge);
                }
                _ => {
                    for copy in copies(v) {
                        spoilt.points[copy as usize] = moved(place(v), [x, y, z], 1e-6 * edge);
                    }
                }
            }
        }
        Bug::TipOff => {
            let tips: Vec<_> = seam
                .iter()
                .filter(|&&(v, _)| copies(v).len() == 1)
                .collect();
            let &&(tip, next) = tips.get(pick(tips.len()))?;
            let way = minus(place(next), place(tip));
            let by = [1e-3, -1e-3][pick(2)] * edge / length(way);
            spoilt.points[tip as usize] = moved(place(tip), way, by);
        }
        Bug::NeighbourNotBisected | Bug::EdgeBisected => {
            let directed = after.directed_edges();
            let inner = |&&(a, b): &&(u32, u32)| directed.contains_key(&(b, a));
            let inner: Vec<_> = directed.keys().filter(inner).collect();
            let &&(a, b) = inner.get(pick(inner.len()))?;
            let middle = spoilt.points.len() as u32;
            spoilt
                .points
                .push(on_the_way(place(a), place(b), 0.2 + 0.1 * pick(7) as f64));
            bisect(&mut spoilt, a, b, middle);
            if bug == Bug::EdgeBisected {
                bisect(&mut spoilt, b, a, middle);
            }
        }
        Bug::FaceLost => {
            spoilt.faces.remove(face);
        }
        Bug::FaceFlipped => spoilt.faces[face].swap(0, 1),
        Bug::OldMoved => {
            let v = pick(before.points.len());
            spoilt.points[v] = moved(before.points[v], cut.plane.normal(), 1e-10 * edge);
        }
        Bug::FaceCollapsed => spoilt.faces[face][0] = spoilt.faces[face][1],
        Bug::FaceTwice => spoilt.faces.push(after.faces[face]),
        Bug::NothingDone => {
            if seam.is_empty() {
                return None;
            }
            spoilt = before.clone();
        }
    }
    Some(spoilt)
}

fn relabel(surface: &mut Surface, from: u32, to: u32) {
    for corner in surface.faces.iter_mut().flatten() {
        if *corner == from {
            *corner = to;
        }
    }
}

/// Gives the faces round `a` that lie left of its edge to `b`, up to the boundary, a vertex of
/// their own.
fn tear(surface: &mut Surface, a: u32, b: u32) {
    let new = surface.points.len() as u32;
    surface.points.push(surface.points[a as usize]);
    let mut next = Some(b);
    while let Some(rim) = next {
        next = None;
        for face in &mut surface.faces {
            for i in 0..3 {
                if face[i] == a && face[(i + 1) % 3] == rim {
                    next = Some(face[(i + 2) % 3]);
                    face[i] = new;
                }
            }
        }
    }
}

/// Inserts a vertex on the side from `a` to `b` of one face.
fn bisect(surface: &mut Surface, a: u32, b: u32, middle: u32) {
    for f in 0..surface.faces.len() {
        for i in 0..3 {
            let [from, to, apex] = [0, 1, 2].map(|k| surface.faces[f][(i + k) % 3]);
            if (from, to) == (a, b) {
                surface.faces[f] = [from, middle, apex];
                surface.faces.push([middle, to, apex]);
                return;
            }
        }
    }
}

/// A point moved by a multiple of a vector.
fn moved(p: [f64; 3], way: [f64; 3], by: f64) -> [f64; 3] {
    [p[0] + by * way[0], p[1] + by * way[1], p[2] + by * way[2]]
}
