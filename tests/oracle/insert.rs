//! Insertions, as the soup sees them.
//!
//! How a face is divided is for the library to say; the soup has no rule for it. It
//! works out by itself which vertices there are and where, and then judges what it is told: whether
//! the children of each face tile that face, whether the whole is still a manifold, and
//! whether exactly the parts of torn edges are torn. Only the sharing of masses is done again, in
//! integers.

use std::collections::BTreeMap;

use super::{Soup, between, joined_sets, links_of, reversed, side};

/// Where a vertex is to be inserted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Spot {
    /// On a side of a face, at the part `t` of the way from its first corner, or if not `forward`, from its
    /// second one.
    Side {
        side: (usize, usize),
        t: f64,
        forward: bool,
    },
    /// In a face.
    Inside { face: usize, weights: [f64; 3] },
}

/// An end of a chord: corner number so much of a face, or a spot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum End {
    Corner(usize, usize),
    Spot(usize),
}

/// What can be wrong with an insertion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unfit {
    Parameter,
    Weights,
    Repeated,
    Chord,
    Crowded,
}

/// Where a new vertex is: between vertices that were there before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Place {
    Edge {
        ends: [u32; 2],
        t: f64,
    },
    Face {
        vertices: [u32; 3],
        weights: [f64; 3],
    },
}

/// A child of a divided face, as the library tells it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Child {
    pub(crate) parent: usize,
    pub(crate) face: usize,
    pub(crate) vertices: [u32; 3],
    pub(crate) share: f64,
    /// The weights that the corners of the parent have in each corner.
    pub(crate) weights: [[f64; 3]; 3],
}

/// Rounding of areas and weights, as parts of a face.
const ROUNDING: f64 = 1e-12;

/// A vertex of a face that is divided, by the weights of the three corners.
#[derive(Clone, Copy, Debug)]
struct Node {
    vertex: u32,
    at: [f64; 3],
}

/// A face that is divided: what is on its outline, in order, and inside.
#[derive(Clone, Debug, Default)]
pub(super) struct Divided {
    ring: Vec<Node>,
    inside: Vec<Node>,
}

/// Where the new vertices are, those of each spot, and the families of children with what they divide.
pub(super) type Divisions<'c> = (
    Vec<(u32, Place)>,
    Vec<[u32; 2]>,
    Vec<(&'c [Child], Divided)>,
);

impl Soup {
    /// All that is wrong with an insertion of which each spot is forward. The parameters must be such that
    /// 1 - t is exact.
    pub(crate) fn unfit(&self, spots: &[Spot], chord: Option<(usize, [End; 2])>) -> Vec<Unfit> {
        let mut unfit = Vec::new();
        for (i, &spot) in spots.iter().enumerate() {
            match spot {
                Spot::Side { side, t, .. } => {
                    if !(0.0 < t && t < 1.0) {
                        unfit.push(Unfit::Parameter);
                    }
                    let here = |&other: &Spot| match other {
                        Spot::Side {
                            side: at, t: there, ..
                        } => {
                            at == side && there == t
                                || self.opposite(at) == Some(side) && 1.0 - there == t
                        }
                        Spot::Inside { .. } => false,
                    };
                    if spots[..i].iter().any(here) {
                        unfit.push(Unfit::Repeated);
                    }
                }
                Spot::Inside { face, weights } => {
                    if !weights.iter().all(|&w| w > 0.0) {
                        unfit.push(Unfit::Weights);
                    }
                    let here = |&other: &Spot| match other {
                        Spot::Side { .. } => false,
                        Spot::Inside {
                            face: at,
                            weights: [a, b, c],
                        } => {
                            let [x, y, z] = weights;
                            at == face && a * y == b * x && b * z == c * y && a * z == c * x
                        }
                    };
                    if spots[..i].iter().any(here) {
                        unfit.push(Unfit::Crowded);
                    }
                }
            }
        }
        if let Some((face, ends)) = chord {
            let filled = spots
                .iter()
                .any(|spot| matches!(spot, Spot::Inside { face: at, .. } if *at == face));
            // The sides of the face on which an end lies: none if it is somewhere else.
            let sides = ends.map(|end| match end {
                End::Corner(f, i) if f == face => vec![i, (i + 2) % 3],
                End::Corner(..) => vec![],
                End::Spot(i) => match spots[i] {
                    Spot::Side { side, .. } => [Some(side), self.opposite(side)]
                        .into_iter()
                        .flatten()
                        .filter_map(|(f, i)| (f == face).then_some(i))
                        .collect(),
                    Spot::Inside { .. } => vec![],
                },
            });
            let [one, other] = &sides;
            let along = one.iter().any(|side| other.contains(side));
            if filled || along || one.is_empty() || other.is_empty() {
                unfit.push(Unfit::Chord);
            }
        }
        unfit
    }

    /// Inserts vertices; the faces are divided as told, after everything was checked that must
    /// hold of that. Returns where the new vertices are.
    pub(crate) fn insert(
        &mut self,
        spots: &[Spot],
        chord: Option<(usize, [End; 2])>,
        children: &[Child],
    ) -> Vec<(u32, Place)> {
        let before = self.clone();
        let (places, vertices, families) = self.divide(spots, children);
        for (family, face) in families {
            let chord = chord.filter(|&(f, _)| f == family[0].parent);
            let chord = chord.map(|(f, ends)| {
                ends.map(|end| match end {
                    End::Corner(_, i) => before.faces[f][i],
                    End::Spot(i) => {
                        let [one, other] = vertices[i];
                        let here = face.ring.iter().any(|node| node.vertex == one);
                        if here { one } else { other }
                    }
                })
            });
            check_shape(family, &face, chord);
        }
        places
    }

    /// Divides faces as told, and checks what must hold of any insertion. Returns where the new vertices are,
    /// those of each spot, and the families with what was divided.
    pub(super) fn divide<'c>(&mut self, spots: &[Spot], children: &'c [Child]) -> Divisions<'c> {
        let before = self.clone();
        let (places, vertices) = self.place(spots);
        let divided = self.divided(spots, &vertices);
        let families = children.chunk_by(|one, next| one.parent == next.parent);
        let families: Vec<&[Child]> = families.collect();
        let parents = families.iter().map(|family| family[0].parent);
        let is_right = parents.eq(divided.keys().copied());
        assert!(is_right, "each face with a point is divided, in order");
        for (family, face) in families.iter().zip(divided.values()) {
            self.check_family(family, face);
        }
        for &family in &families {
            self.share_mass(family);
            for child in family {
                let classes = child.vertices.map(|v| self.class[v as usize]);
                if child.face == child.parent {
                    self.faces[child.face] = child.vertices;
                    self.whole[child.face] = classes;
                } else {
                    assert_eq!(child.face, self.faces.len(), "new faces are the last ones");
                    self.faces.push(child.vertices);
                    self.whole.push(classes);
                }
            }
        }
        self.links = links_of(&self.whole);
        self.check_links(&before, children, spots);
        self.halved = None;
        let families = families.into_iter().zip(divided.into_values()).collect();
        (places, vertices, families)
    }

    /// Adds the new vertices: of each spot that on the side that was named, and that on
    /// the other, which is another one where the edge is torn.
    fn place(&mut self, spots: &[Spot]) -> (Vec<(u32, Place)>, Vec<[u32; 2]>) {
        let (mut places, mut vertices) = (Vec::new(), Vec::new());
        let old = self.points.clone();
        for &spot in spots {
            let class = self.classes;
            self.classes += 1;
            let mut add = |soup: &mut Soup, place: Place| {
                let v = soup.class.len() as u32;
                soup.class.push(class);
                if let Some(open) = &mut soup.open_class {
                    open.push(class);
                }
                soup.points.push(match place {
                    Place::Edge { ends: [a, b], t } => between(old[a as usize], old[b as usize], t),
                    Place::Face { vertices, weights } => {
                        let [a, b, c] = vertices.map(|v| old[v as usize]);
                        [0, 1, 2].map(|i| a[i] * weights[0] + b[i] * weights[1] + c[i] * weights[2])
                    }
                });
                places.push((v, place));
                v
            };
            vertices.push(match spot {
                Spot::Side {
                    side: (f, i),
                    t,
                    forward,
                } => {
                    let turned = |ends| if forward { ends } else { reversed(ends) };
                    let ends = turned(side(self.faces[f], i));
                    let one = add(self, Place::Edge { ends, t });
                    let across = self.opposite((f, i)).map(|(g, j)| side(self.faces[g], j));
                    let other = match across.map(|across| turned(reversed(across))) {
                        Some(across) if across != ends => {
                            let other = add(self, Place::Edge { ends: across, t });
                            self.open_twin(other, [ends, across]);
                            other
                        }
                        _ => one,
                    };
                    [one, other]
                }
                Spot::Inside { face, weights } => {
                    let sum = whole(weights);
                    let place = Place::Face {
                        vertices: self.faces[face],
                        weights: weights.map(|w| w / sum),
                    };
                    [add(self, place); 2]
                }
            });
        }
        (places, vertices)
    }

    /// The faces that get a vertex, and what there is on and in each.
    fn divided(&self, spots: &[Spot], vertices: &[[u32; 2]]) -> BTreeMap<usize, Divided> {
        // For each face and side the points on it, by how far along they are.
        let mut on = BTreeMap::<usize, [Vec<(f64, u32)>; 3]>::new();
        let mut divided = BTreeMap::<usize, Divided>::new();
        for (&spot, &[one, other]) in spots.iter().zip(vertices) {
            match spot {
                Spot::Side {
                    side: (f, i),
                    t,
                    forward,
                } => {
                    let t = if forward { t } else { 1.0 - t };
                    on.entry(f).or_default()[i].push((t, one));
                    if let Some((g, j)) = self.opposite((f, i)) {
                        on.entry(g).or_default()[j].push((1.0 - t, other));
                    }
                }
                Spot::Inside { face, weights } => {
                    let sum = whole(weights);
                    on.entry(face).or_default();
                    divided.entry(face).or_default().inside.push(Node {
                        vertex: one,
                        at: weights.map(|w| w / sum),
                    });
                }
            }
        }
        for (f, sides) in on {
            let ring = &mut divided.entry(f).or_default().ring;
            for (i, mut points) in sides.into_iter().enumerate() {
                points.push((0.0, self.faces[f][i]));
                points.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
                for (t, vertex) in points {
                    let mut at = [0.0; 3];
                    (at[i], at[(i + 1) % 3]) = (1.0 - t, t);
                    ring.push(Node { vertex, at });
                }
            }
        }
        divided
    }

    /// The children of a face tile it: each covers something, together they cover all, and their
    /// sides are those of the outline, besides sides that two of them have in common.
    fn check_family(&self, family: &[Child], face: &Divided) {
        let mut sides = Vec::new();
        let mut total = 0.0;
        for (i, child) in family.iter().enumerate() {
            let is_first = i == 0;
            assert_eq!(child.face == child.parent, is_first, "the first has the id");
            let nodes = child.vertices.map(|v| node(face, v).at);
            for (weights, at) in child.weights.iter().zip(nodes) {
                let is_there = weights
                    .iter()
                    .zip(at)
                    .all(|(a, b)| (a - b).abs() < ROUNDING);
                assert!(is_there, "{child:?}: a source is not at {at:?}");
            }
            let area = determinant(nodes);
            assert!(area > 0.0, "{child:?} has no area, or the wrong way round");
            let off = (child.share - area).abs();
            assert!(off < ROUNDING, "{child:?} covers {area}");
            total += area;
            sides.extend((0..3).map(|i| side(child.vertices, i)));
        }
        assert!((total - 1.0).abs() < ROUNDING, "{total} is covered");
        sides.sort();
        let is_once = sides.windows(2).all(|two| two[0] != two[1]);
        assert!(is_once, "a side occurs once");
        let n = face.ring.len();
        let outline: Vec<[u32; 2]> = (0..n)
            .map(|i| [face.ring[i].vertex, face.ring[(i + 1) % n].vertex])
            .collect();
        for ends in &outline {
            assert!(sides.contains(ends), "{ends:?} is part of the outline");
        }
        for &ends in &sides {
            let [is_inner, is_outer] = [sides.contains(&reversed(ends)), outline.contains(&ends)];
            assert!(is_inner != is_outer, "{ends:?} is outside or between two");
        }
    }

    /// The whole is a manifold still, and the parts of an edge are torn where it was.
    fn check_links(&self, before: &Soup, children: &[Child], spots: &[Spot]) {
        let joined: Vec<[usize; 2]> = self
            .links
            .iter()
            .flat_map(|&[(f, i), (g, j)]| {
                let next = |(f, i): (usize, usize)| 3 * f + (i + 1) % 3;
                [[3 * f + i, next((g, j))], [next((f, i)), 3 * g + j]]
            })
            .collect();
        let mut fans = joined_sets(3 * self.whole.len(), &joined);
        fans.sort();
        fans.dedup();
        let mut classes = self.whole.as_flattened().to_vec();
        classes.sort();
        classes.dedup();
        assert_eq!(fans.len(), classes.len(), "one fan for each vertex");

        let mut parent: Vec<usize> = (0..self.faces.len()).collect();
        for child in children {
            parent[child.face] = child.parent;
        }
        let between = |link: &[(usize, usize); 2]| {
            let [f, g] = link.map(|(f, _)| parent[f]);
            [f.min(g), f.max(g)]
        };
        let mut parts = BTreeMap::<[usize; 2], Vec<bool>>::new();
        for link in &self.links {
            let parts = parts.entry(between(link)).or_default();
            parts.push(self.is_torn(*link));
        }
        for link in &before.links {
            let torn = before.is_torn(*link);
            let on_it =
                |spot: &&Spot| matches!(spot, Spot::Side { side, .. } if link.contains(side));
            let count = 1 + spots.iter().filter(on_it).count();
            let parts = parts.remove(&between(link));
            assert_eq!(parts, Some(vec![torn; count]), "the parts of {link:?}");
        }
        for ([f, g], torn) in parts {
            let is_inner = f == g && !torn.contains(&true);
            assert!(is_inner, "{f} and {g} were never joined");
        }
    }

    /// Shares the units of a face among its children, which have got their shares.
    fn share_mass(&mut self, family: &[Child]) {
        let parent = family[0].parent;
        let units: u64 = self.corner_mass[parent].iter().sum();
        let count = family.len() as u64;
        let least = if units >= 3 * count { 3 } else { 0 };
        let shared = units - least * count;
        let (mut share, mut given) = (0.0, 0);
        for (i, child) in family.iter().enumerate() {
            share += child.share;
            let mut until = ((shared as f64 * share).round() as u64).clamp(given, shared);
            if i + 1 == family.len() {
                until = shared;
            }
            let own = least + until - given;
            given = until;
            let off = own as f64 - units as f64 * child.share;
            let most = 3.0 * count as f64 + 4.0;
            assert!(off.abs() <= most, "{child:?} weighs {own} of {units}");
            let mass = [own / 3, (own + 1) / 3, own.div_ceil(3)];
            if i == 0 {
                self.corner_mass[parent] = mass;
            } else {
                self.corner_mass.push(mass);
            }
        }
        assert_eq!(given, shared, "children weigh what their parent did");
    }
}

/// What weights are parts of. Those of a record are parts of one, up to rounding, and stay as they are.
fn whole([a, b, c]: [f64; 3]) -> f64 {
    let sum = a + b + c;
    if (sum - 1.0).abs() < ROUNDING {
        1.0
    } else {
        sum
    }
}

fn node(face: &Divided, vertex: u32) -> Node {
    let mut nodes = face.ring.iter().chain(&face.inside);
    *nodes
        .find(|node| node.vertex == vertex)
        .unwrap_or_else(|| panic!("{vertex} is no vertex of this face"))
}

/// The part of a face that a triangle covers.
fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// A chord is an edge. A single point inside is joined to everything; without one, the
/// smallest child is as large as it can be.
fn check_shape(family: &[Child], face: &Divided, chord: Option<[u32; 2]>) {
    match face.inside[..] {
        [] => {
            let ring: Vec<[f64; 3]> = face.ring.iter().map(|node| node.at).collect();
            let mut largest = largest_minimum(&ring);
            if let Some(ends) = chord {
                let has_it = |child: &Child| (0..3).any(|i| side(child.vertices, i) == ends);
                assert!(family.iter().any(has_it), "{ends:?} is an edge");
                let place = |v| face.ring.iter().position(|node| node.vertex == v);
                let [one, other] = ends.map(|v| place(v).expect("on the outline"));
                let (one, other) = (one.min(other), one.max(other));
                let far: Vec<_> = ring[other..].iter().chain(&ring[..=one]).copied().collect();
                largest = largest_minimum(&ring[one..=other]).min(largest_minimum(&far));
            }
            let smallest = family.iter().map(|child| child.share).fold(1.0, f64::min);
            let is_largest = smallest >= largest - ROUNDING;
            assert!(is_largest, "{smallest} could be {largest}: {family:?}");
        }
        [centre] => {
            let has_it = |child: &Child| child.vertices.contains(&centre.vertex);
            assert!(family.iter().all(has_it), "not joined: {family:?}");
        }
        _ => {}
    }
}

/// The largest that the smallest triangle of a triangulation can be, found by trying all.
fn largest_minimum(polygon: &[[f64; 3]]) -> f64 {
    let last = polygon.len() - 1;
    if last < 2 {
        return f64::INFINITY;
    }
    let with = |k: usize| {
        determinant([polygon[0], polygon[k], polygon[last]])
            .min(largest_minimum(&polygon[..=k]))
            .min(largest_minimum(&polygon[k..]))
    };
    (1..last).map(with).fold(f64::NEG_INFINITY, f64::max)
}
