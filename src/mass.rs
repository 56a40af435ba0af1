//! Masses of vertices, conserved exactly.
//!
//! There are two rules. Both follow the log, and both keep a [`MassLedger`]:
//!
//! * **area** (the default choice): a vertex weighs a third of each of its faces, so after a split
//!   each half weighs what its faces weigh. In plain floats `m_old + m_new` would differ from the
//!   mass before in a quarter of all splits. So each corner's mass is rounded once, when masses are
//!   made, to a whole number of *units*: 2^-52 of the power of two above the total. Sums of units
//!   are exact in any order. An insertion divides the units of a face among its children by area.
//! * **half** (Souza et al. 2014 §IV-A): each half weighs half, however many faces it has. Halving
//!   a float is exact as long as it stays normal. A mass is stored as fractions ½, ¼, … of the
//!   masses of the original vertices, because merges that do not reverse the order of the splits
//!   may leave ½ + ¼, and that fraction of a mass need not be an `f64`. This rule cannot follow an
//!   insertion: there is no vertex to be halved.
//!
//! A follower cannot refuse a split that has already happened. So masses that could become too
//! small later are refused when they are made.

use std::fmt;

use crate::edit::{ChildFace, Cursor, Edit, Follower, Mix};
use crate::exact::{ExactSum, exponent_above, power_of_two};
use crate::geometry::area;
use crate::id::{FaceId, VertexId};
use crate::mesh::Mesh;
use crate::place::Place;

/// The masses of all vertices of a mesh, updated from its log.
///
/// ```
/// use tearmesh::{shapes, split, Edits, Masses};
///
/// let (mut mesh, positions) = shapes::grid(3, 3);
/// let mut masses = Masses::area(&mesh, &positions, 1.0)?;
/// let v = mesh.vertex(5);
/// let before = masses.at(v);
///
/// let mut edits = Edits::new();
/// let face = mesh.faces_of(v).next().unwrap();
/// let new = split::vertex(&mut mesh, v, &[face], &mut edits)?.new;
/// edits.replay(&mut masses);
/// assert_eq!(masses.at(v) + masses.at(new), before); // bit for bit
/// assert!(masses.ledger().is_balanced());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Masses {
    store: Store,
    unit: f64,
    opening: ExactSum,
    seen: Cursor,
}

#[derive(Clone, Debug)]
enum Store {
    /// Whole numbers of units, of corners and of vertices.
    Area {
        corners: Vec<u64>,
        vertices: Vec<u64>,
    },
    Half {
        vertices: Vec<Halves>,
    },
}

/// A vertex by the rule of halves: what it has of each vertex that it is a copy of. There are
/// several of those where copies are sewn that already were copies when masses were made.
#[derive(Clone, Debug)]
struct Halves {
    first: Part,
    /// All different, and ascending by root and exponent.
    more: Vec<Part>,
}

/// A part 2^-exponent of the mass of a root.
#[derive(Clone, Copy, Debug)]
struct Part {
    root: VertexId,
    exponent: u32,
    /// That of the whole root.
    mass: f64,
}

impl Halves {
    /// Halves this vertex's mass exactly; returns the record of the new vertex, which holds the other half.
    fn halve(&mut self) -> Halves {
        self.first.exponent += 1;
        self.more.iter_mut().for_each(|part| part.exponent += 1);
        self.clone()
    }

    fn parts(&self) -> impl Iterator<Item = Part> {
        std::iter::once(self.first).chain(self.more.iter().copied())
    }

    fn add(&mut self, other: &Halves) {
        let mut sum = added(self.parts().chain(other.parts()));
        self.first = sum.remove(0);
        self.more = sum;
    }

    fn mass(&self) -> f64 {
        self.parts().map(Part::mass).sum()
    }
}

impl Part {
    fn mass(self) -> f64 {
        halved(self.mass, self.exponent)
    }

    fn order(&self) -> (VertexId, u32) {
        (self.root, self.exponent)
    }
}

/// Adds up parts so that no two are equal; ascending by root and exponent.
fn added(parts: impl Iterator<Item = Part>) -> Vec<Part> {
    let mut sum: Vec<Part> = Vec::new();
    for mut part in parts {
        while let Ok(equal) = sum.binary_search_by_key(&part.order(), Part::order) {
            sum.remove(equal);
            part.exponent -= 1;
        }
        let place = sum.partition_point(|other| other.order() < part.order());
        sum.insert(place, part);
    }
    sum
}

impl Masses {
    /// Computes masses by area: each face distributes its mass equally to its three corners.
    ///
    /// `density` is the mass per unit of area, in the units of the model. A corner has a mass of at
    /// least one unit ([`Masses::unit`]), so that a face of zero area leaves no vertex without
    /// mass. A vertex without faces has zero mass. Linear.
    ///
    /// # Errors
    ///
    /// [`MassError`] if the density, the area or a mass is out of range.
    ///
    /// # Panics
    ///
    /// If `place` does not store the position of a vertex.
    pub fn area(
        mesh: &Mesh,
        place: &(impl Place + ?Sized),
        density: f64,
    ) -> Result<Masses, MassError> {
        Masses::by_areas(mesh, areas(mesh, place), density)
    }

    /// Computes masses like [`Masses::area`], with areas that are not those of the faces where they are. Linear.
    ///
    /// # Errors
    ///
    /// [`MassError`] if the density, the area or a mass is out of range.
    pub fn by_areas(
        mesh: &Mesh,
        area: impl Fn(FaceId) -> f64,
        density: f64,
    ) -> Result<Masses, MassError> {
        let (unit, corners, vertices) = lattice(mesh, area, density)?;
        Ok(Masses::opened(Store::Area { corners, vertices }, unit))
    }

    /// Computes masses that are halved at each split. The initial masses are those of
    /// [`Masses::area`]. They can follow splits and merges, and panic at an insertion.
    ///
    /// # Errors
    ///
    /// [`MassError`] if the density, the area or a mass is out of range.
    ///
    /// # Panics
    ///
    /// If `place` does not store the position of a vertex.
    pub fn half(
        mesh: &Mesh,
        place: &(impl Place + ?Sized),
        density: f64,
    ) -> Result<Masses, MassError> {
        let (unit, corners, units) = lattice(mesh, areas(mesh, place), density)?;
        let mut faces = vec![0u32; units.len()];
        for (h, _) in mesh.half_edges().zip(&corners) {
            faces[mesh.origin(h).index()] += 1;
        }
        // With n faces a vertex can be halved n - 1 times before nothing is left to split.
        let mass = |v: VertexId| units[v.index()] as f64 * unit;
        let is_too_light = |&v: &VertexId| {
            let halvings = faces[v.index()].saturating_sub(1) as i32;
            mass(v) > 0.0 && exponent_above(mass(v)) - 1 - halvings < f64::MIN_EXP - 1
        };
        let vertices: Vec<VertexId> = mesh.vertices().filter(is_too_light).collect();
        if !vertices.is_empty() {
            return Err(MassError::TooLight { vertices });
        }
        let whole = |v: VertexId| Halves {
            first: Part {
                root: v,
                exponent: 0,
                mass: mass(v),
            },
            more: Vec::new(),
        };
        let vertices = mesh.vertices().map(whole).collect();
        Ok(Masses::opened(Store::Half { vertices }, unit))
    }

    fn opened(store: Store, unit: f64) -> Masses {
        let mut masses = Masses {
            store,
            unit,
            opening: ExactSum::new(),
            seen: Cursor::START,
        };
        masses.opening = masses.total();
        masses
    }

    /// Reserves memory for `vertices` more vertices, so that replaying this many splits allocates
    /// nothing.
    pub fn reserve(&mut self, vertices: usize) {
        match &mut self.store {
            Store::Area {
                vertices: units, ..
            } => units.reserve(vertices),
            Store::Half { vertices: halves } => halves.reserve(vertices),
        }
    }

    /// Returns the mass of the vertex `v`.
    ///
    /// The mass is zero for a vertex without faces. It may become zero for a vertex with faces:
    /// when a face of only a few units is divided, some corners get no unit, and a split may leave
    /// a vertex with only such corners. Before dividing by a mass, replace it by [`Masses::unit`]
    /// if it is smaller.
    ///
    /// # Panics
    ///
    /// If `v` is not a vertex of the mesh.
    #[must_use]
    pub fn at(&self, v: VertexId) -> f64 {
        match &self.store {
            Store::Area { vertices, .. } => *v.of(vertices) as f64 * self.unit,
            Store::Half { vertices } => v.of(vertices).mass(),
        }
    }

    /// Returns the unit to which the initial masses were rounded, and which was the smallest
    /// initial mass of a corner: 2^-52 of the power of two above the total.
    #[must_use]
    pub fn unit(&self) -> f64 {
        self.unit
    }

    /// Returns the number of vertices.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        match &self.store {
            Store::Area { vertices, .. } => vertices.len(),
            Store::Half { vertices } => vertices.len(),
        }
    }

    /// Returns the exact sum of all masses.
    #[must_use]
    pub fn total(&self) -> ExactSum {
        match &self.store {
            Store::Area { vertices, .. } => {
                let mass = |&units: &u64| units as f64 * self.unit;
                vertices.iter().map(mass).collect()
            }
            Store::Half { vertices } => sum_of_halves(vertices),
        }
    }

    /// Returns the initial total mass and the current one.
    #[must_use]
    pub fn ledger(&self) -> MassLedger {
        MassLedger {
            before: self.opening.clone(),
            after: self.total(),
        }
    }
}

/// The parts of each root add up before its mass is taken: after many splits and merges a part
/// may be smaller than any `f64`, but not their sum.
fn sum_of_halves(vertices: &[Halves]) -> ExactSum {
    let mut sum = ExactSum::new();
    let mut parts: Vec<Part> = Vec::new();
    for halves in vertices {
        for part in halves.parts() {
            if part.exponent == 0 {
                sum.add(part.mass);
            } else {
                parts.push(part);
            }
        }
    }
    parts.sort_unstable_by_key(Part::order);
    for of_root in parts.chunk_by(|a, b| a.root == b.root) {
        sum.extend(added(of_root.iter().copied()).into_iter().map(Part::mass));
    }
    sum
}

/// m / 2^halvings, in steps that an `f64` has powers of two for.
fn halved(mut mass: f64, mut halvings: u32) -> f64 {
    while halvings > 1000 {
        mass *= power_of_two(-1000);
        halvings -= 1000;
    }
    mass * power_of_two(-(halvings as i32))
}

/// The area from which on that of all faces together is one. The area of a face comes from squares of
/// products of edges: those below about 1e-162 are zero, and each is off by as much, of which a
/// mesh of ten million faces must lose no more than a billionth.
const AREA_MIN: f64 = 1e-140;

/// The areas of faces where they are.
fn areas(mesh: &Mesh, place: &(impl Place + ?Sized)) -> impl Fn(FaceId) -> f64 {
    |f| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| place.at(v));
        area(a, b, c)
    }
}

/// The unit, and the masses of corners and vertices in units.
fn lattice(
    mesh: &Mesh,
    area: impl Fn(FaceId) -> f64,
    density: f64,
) -> Result<(f64, Vec<u64>, Vec<u64>), MassError> {
    if !(density > 0.0 && density.is_finite()) {
        return Err(MassError::Density { given: density });
    }
    let mass = |f: FaceId| area(f) * density;
    let total: f64 = mesh.faces().map(mass).sum();
    if total.is_nan() || total <= AREA_MIN * density {
        return Err(MassError::NoArea);
    }
    if total >= f64::MAX / 2.0 || exponent_above(total) - 52 < f64::MIN_EXP - 1 {
        return Err(MassError::OutOfRange { total });
    }
    let unit = power_of_two(exponent_above(total) - 52);
    let mut corners = vec![0; mesh.half_edge_count()];
    let mut vertices = vec![0; mesh.vertex_count()];
    for f in mesh.faces() {
        // Rounded once a face; the three corners share what there is, to the unit.
        let units = ((mass(f) / unit).round() as u64).max(3);
        for (corner, h) in f.half_edges().into_iter().enumerate() {
            let share = (units + corner as u64) / 3;
            corners[h.index()] = share;
            vertices[mesh.origin(h).index()] += share;
        }
    }
    Ok((unit, corners, vertices))
}

impl Follower for Masses {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        let count = self.vertex_count();
        let in_step = |new: VertexId| {
            assert_eq!(new.index(), count, "masses are in step with the mesh");
        };
        match (edit, &mut self.store) {
            (Edit::Split(split), Store::Area { corners, vertices }) => {
                in_step(split.new);
                let moved = split.corners.iter().map(|h| corners[h.index()]).sum();
                vertices[split.old.index()] -= moved;
                vertices.push(moved);
            }
            (Edit::Split(split), Store::Half { vertices }) => {
                in_step(split.new);
                let half = vertices[split.old.index()].halve();
                vertices.push(half);
            }
            (Edit::Insert(insert), Store::Area { corners, vertices }) => {
                if let Some(first) = insert.points.first() {
                    in_step(first.vertex);
                }
                vertices.resize(count + insert.points.len(), 0);
                for family in insert.families() {
                    divide(family, corners, vertices);
                }
            }
            (Edit::Insert(_), Store::Half { .. }) => {
                panic!("masses by halves cannot follow an insertion: use masses by area")
            }
            (Edit::Merge(merge), Store::Area { vertices, .. }) => {
                vertices[merge.kept.index()] += vertices[merge.gone.index()];
                vertices.swap_remove(merge.gone.index());
            }
            (Edit::Merge(merge), Store::Half { vertices }) => {
                // `gone` is the higher id, so `kept` stays where it is.
                let gone = vertices.swap_remove(merge.gone.index());
                vertices[merge.kept.index()].add(&gone);
            }
            (Edit::Slide(_), _) => {}
        }
    }
}

/// Shares the units of a divided face among its children, by area and without losing one.
///
/// Every corner gets at least one unit where there are enough for all.
fn divide(family: &[ChildFace], corners: &mut Vec<u64>, vertices: &mut [u64]) {
    let mut units = 0;
    for child in family {
        for (vertex, source) in child.vertices.iter().zip(child.sources) {
            if let Mix::Copy(h) = source {
                // Several children may have it; what is taken once is gone.
                let taken = std::mem::take(&mut corners[h.index()]);
                vertices[vertex.index()] -= taken;
                units += taken;
            }
        }
    }
    let least = if units >= 3 * family.len() as u64 {
        3
    } else {
        0
    };
    let shared = units - least * family.len() as u64;
    let (mut given, mut share) = (0, 0.0);
    for (i, child) in family.iter().enumerate() {
        share += child.share;
        let until = if i + 1 == family.len() {
            shared
        } else {
            ((shared as f64 * share).round() as u64).clamp(given, shared)
        };
        let own = least + until - given;
        given = until;
        let start = 3 * child.face.index();
        if start == corners.len() {
            corners.extend([0; 3]);
        }
        for (corner, vertex) in child.vertices.into_iter().enumerate() {
            let part = (own + corner as u64) / 3;
            corners[start + corner] = part;
            vertices[vertex.index()] += part;
        }
    }
}

/// The exact total mass before all edits and after those seen so far.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MassLedger {
    /// The total of the initial masses.
    pub before: ExactSum,
    /// The total of the current masses.
    pub after: ExactSum,
}

impl MassLedger {
    /// Returns whether the two totals are equal. The comparison is exact and has no tolerance.
    #[must_use]
    pub fn is_balanced(&self) -> bool {
        self.before == self.after
    }
}

/// The reason why masses were refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum MassError {
    /// The density is not a positive finite number.
    Density {
        /// The density given.
        given: f64,
    },
    /// The total area is below 1e-140, or a position is not a number. An area of 1e-140 corresponds
    /// to edges of about 1e-70.
    NoArea,
    /// The total mass is so large or so small that its parts are not normal floating-point numbers.
    OutOfRange {
        /// The total mass, rounded to an `f64`.
        total: f64,
    },
    /// A vertex could be split so often that its halved mass would no longer be a normal
    /// floating-point number, and halving would not be exact.
    TooLight {
        /// All vertices for which this is the case, in ascending order.
        vertices: Vec<VertexId>,
    },
}

impl fmt::Display for MassError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MassError::Density { given } => {
                write!(f, "the density {given} is not a positive finite number")
            }
            MassError::NoArea => write!(
                f,
                "no face has an area (all of them together less than {AREA_MIN:e}), so there is no \
                 mass to lump"
            ),
            MassError::OutOfRange { total } => {
                write!(
                    f,
                    "the total mass {total:e} is too large or too small to be divided exactly"
                )
            }
            MassError::TooLight { vertices } => {
                let count = vertices.len();
                let noun = if count == 1 {
                    "vertex is"
                } else {
                    "vertices are"
                };
                write!(
                    f,
                    "{count} {noun} too light to be halved exactly, {} first",
                    vertices[0]
                )
            }
        }
    }
}

impl std::error::Error for MassError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halving_takes_as_many_steps_as_powers_of_two_need() {
        assert_eq!(halved(3.0, 0), 3.0);
        assert_eq!(halved(3.0, 1), 1.5);
        assert_eq!(halved(1.0, 1000), power_of_two(-1000));
        assert_eq!(halved(1.0, 1001), power_of_two(-1001));
        assert_eq!(halved(power_of_two(900), 1900), power_of_two(-1000));
        assert_eq!(halved(power_of_two(1000), 2001), power_of_two(-1001));
    }
}
