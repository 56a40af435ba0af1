//! A naive triangle soup: so simple that it is unlikely to be wrong.
//!
//! Nothing here is imported from the library, and nothing is stored that can be found by
//! looking at all faces. There are no links and no walks: which faces a vertex has, which
//! edges are torn and which faces hang together is worked out anew from the triangles
//! and the class of each vertex: two vertices are of one class if they were once the same.
//! Masses are integers.

pub(crate) mod aim;
pub(crate) mod by_place;
mod cut;
mod insert;
pub(crate) mod naive_cut;
pub(crate) mod rational;
pub(crate) mod spoil;
pub(crate) mod straight;
mod strict;

pub(crate) use insert::{Child, End, Place, Spot, Unfit};
pub(crate) use strict::{Fault, faults, is_strict};

/// Triangles whose vertices are split, and what belongs to the vertices.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Soup {
    /// The triangles.
    pub(crate) faces: Vec<[u32; 3]>,
    /// The triangles as they would be if no vertex had been split: of classes, not vertices.
    pub(crate) whole: Vec<[u32; 3]>,
    /// For each vertex its class.
    pub(crate) class: Vec<u32>,
    /// While seams are closed, the class that each vertex has once they are open again.
    open_class: Option<Vec<u32>>,
    /// The number of classes that there ever were.
    classes: u32,
    /// For each vertex its position.
    pub(crate) points: Vec<[f64; 3]>,
    /// For each corner its lumped mass, in units.
    pub(crate) corner_mass: Vec<[u64; 3]>,
    /// For each vertex the mass that its class has, in units, and its part of that, in parts of
    /// [`WHOLE`]. Nothing once a vertex was inserted.
    pub(crate) halved: Option<Vec<(u64, u128)>>,
    /// Whether two vertices at different places were ever merged. Until then, corners are where
    /// their vertices are.
    pub(crate) joined_apart: bool,
    /// The sides of faces that lie opposite each other in the whole: (face, side), (face, side).
    pub(crate) links: Vec<[(usize, usize); 2]>,
}

/// What a vertex has that was never split. It can be halved 120 times.
pub(crate) const WHOLE: u128 = 1 << 120;

/// Why a split was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Refused {
    Empty,
    Everything,
    Foreign(usize),
    Repeated(usize),
}

/// Why a merge was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unmerged {
    Same,
    Apart,
}

/// Why a slide was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unslid {
    Parameter,
    Apart,
}

impl Soup {
    /// The soup of these triangles. `corner_mass` has three units for each face.
    pub(crate) fn new(points: &[[f64; 3]], faces: &[[u32; 3]], corner_mass: &[[u64; 3]]) -> Soup {
        let mut soup = Soup {
            faces: faces.to_vec(),
            whole: faces.to_vec(),
            class: (0..points.len() as u32).collect(),
            open_class: None,
            classes: points.len() as u32,
            points: points.to_vec(),
            corner_mass: corner_mass.to_vec(),
            halved: None,
            joined_apart: false,
            links: links_of(faces),
        };
        let whole = (0..points.len()).map(|v| (soup.lumped_mass(v), WHOLE));
        soup.halved = Some(whole.collect());
        soup
    }

    /// The smallest vertex of the class of each vertex.
    pub(crate) fn roots(&self) -> Vec<u32> {
        let mut smallest = vec![u32::MAX; self.classes as usize];
        for (v, &class) in self.class.iter().enumerate().rev() {
            smallest[class as usize] = v as u32;
        }
        self.class
            .iter()
            .map(|&class| smallest[class as usize])
            .collect()
    }

    /// Whether the triangles with classes for vertices are the whole.
    pub(crate) fn is_whole_but_for_splits(&self) -> bool {
        let classes = self
            .faces
            .iter()
            .map(|face| face.map(|v| self.class[v as usize]));
        classes.eq(self.whole.iter().copied())
    }

    /// The faces of a vertex, ascending.
    pub(crate) fn faces_of(&self, v: usize) -> Vec<usize> {
        let mut faces = Vec::new();
        for (f, face) in self.faces.iter().enumerate() {
            if face.contains(&(v as u32)) {
                faces.push(f);
            }
        }
        faces
    }

    /// The corners of every vertex, three a face, ascending.
    pub(crate) fn corners_by_vertex(&self) -> Vec<Vec<usize>> {
        let mut corners = vec![Vec::new(); self.class.len()];
        for (f, face) in self.faces.iter().enumerate() {
            for i in 0..3 {
                corners[face[i] as usize].push(3 * f + i);
            }
        }
        corners
    }

    /// Splits a vertex; the new one has the last number.
    pub(crate) fn split(&mut self, v: usize, moving: &[usize]) -> Result<(), Refused> {
        for (i, &f) in moving.iter().enumerate() {
            if !self.faces[f].contains(&(v as u32)) {
                return Err(Refused::Foreign(f));
            }
            if moving[..i].contains(&f) {
                return Err(Refused::Repeated(f));
            }
        }
        if moving.is_empty() {
            return Err(Refused::Empty);
        }
        if moving.len() == self.faces_of(v).len() {
            return Err(Refused::Everything);
        }
        let new = self.class.len() as u32;
        for &f in moving {
            for corner in &mut self.faces[f] {
                if *corner == v as u32 {
                    *corner = new;
                }
            }
        }
        self.class.push(self.class[v]);
        if let Some(open) = &mut self.open_class {
            open.push(open[v]);
        }
        self.points.push(self.points[v]);
        if let Some(halved) = &mut self.halved {
            assert!(halved[v].1 % 2 == 0, "the oracle halves no further");
            halved[v].1 /= 2;
            halved.push(halved[v]);
        }
        Ok(())
    }

    /// Merges two vertices: the lower number stays, with so large a share in where it is then, and
    /// the last vertex gets the other one. Returns both.
    pub(crate) fn merge(
        &mut self,
        one: usize,
        other: usize,
        share: f64,
    ) -> Result<[usize; 2], Unmerged> {
        if one == other {
            return Err(Unmerged::Same);
        }
        if self.class[one] != self.class[other] {
            return Err(Unmerged::Apart);
        }
        let (kept, gone) = (one.min(other), one.max(other));
        let last = self.class.len() - 1;
        for corner in self.faces.as_flattened_mut() {
            if *corner == gone as u32 {
                *corner = kept as u32;
            } else if *corner == last as u32 {
                *corner = gone as u32;
            }
        }
        self.class.swap_remove(gone);
        self.joined_apart |= self.points[kept] != self.points[gone];
        self.points[kept] = between(self.points[kept], self.points[gone], 1.0 - share);
        self.points.swap_remove(gone);
        if let Some(halved) = &mut self.halved {
            halved[kept].1 += halved[gone].1;
            halved.swap_remove(gone);
        }
        Ok([kept, gone])
    }

    /// Slides a vertex along a side of one of its faces.
    pub(crate) fn slide(&mut self, v: usize, toward: usize, t: f64) -> Result<(), Unslid> {
        if t.is_nan() || t <= 0.0 || t >= 1.0 {
            return Err(Unslid::Parameter);
        }
        let ends = [v as u32, toward as u32];
        let has_both = |face: &[u32; 3]| ends.iter().all(|end| face.contains(end));
        if v == toward || !self.faces.iter().any(has_both) {
            return Err(Unslid::Apart);
        }
        self.points[v] = between(self.points[v], self.points[toward], t);
        Ok(())
    }

    /// The faces of a vertex whose centres are strictly behind the plane through that vertex:
    /// n·(b − v) + n·(c − v) < 0.
    pub(crate) fn behind(&self, v: usize, normal: [f64; 3]) -> Vec<usize> {
        let origin = self.points[v];
        let mut behind = self.faces_of(v);
        behind.retain(|&f| {
            let mut sum = 0.0;
            for &corner in &self.faces[f] {
                if corner != v as u32 {
                    let [x, y, z] = self.points[corner as usize];
                    sum += normal[0] * (x - origin[0])
                        + normal[1] * (y - origin[1])
                        + normal[2] * (z - origin[2]);
                }
            }
            sum < 0.0
        });
        behind
    }

    /// The side on the other end of the link of a side.
    fn opposite(&self, side: (usize, usize)) -> Option<(usize, usize)> {
        let link = self.links.iter().find(|link| link.contains(&side))?;
        Some(if link[0] == side { link[1] } else { link[0] })
    }

    /// Whether the two ends of a link no longer agree.
    pub(crate) fn is_torn(&self, [(f, i), (g, j)]: [(usize, usize); 2]) -> bool {
        side(self.faces[f], i) != reversed(side(self.faces[g], j))
    }

    /// The corners of every vertex, in sets that are joined by edges which are not torn: each
    /// set ascending, the sets by their smallest corner.
    pub(crate) fn fans_by_vertex(&self) -> Vec<Vec<Vec<usize>>> {
        let mut joined = Vec::new();
        for &link in &self.links {
            if !self.is_torn(link) {
                // Where one side starts the other one ends, and the other way round.
                let [(f, i), (g, j)] = link;
                joined.push([3 * f + i, 3 * g + (j + 1) % 3]);
                joined.push([3 * f + (i + 1) % 3, 3 * g + j]);
            }
        }
        let fan_of = joined_sets(3 * self.faces.len(), &joined);
        let mut fans = vec![Vec::<Vec<usize>>::new(); self.class.len()];
        for (v, corners) in self.corners_by_vertex().iter().enumerate() {
            for &corner in corners {
                let known = fans[v]
                    .iter_mut()
                    .find(|fan| fan_of[fan[0]] == fan_of[corner]);
                match known {
                    Some(fan) => fan.push(corner),
                    None => fans[v].push(vec![corner]),
                }
            }
        }
        fans
    }

    /// The number of edges: each side of a face, but the two sides of a link that is not
    /// torn once.
    pub(crate) fn edge_count(&self) -> usize {
        let joined = self.links.iter().filter(|&&link| !self.is_torn(link));
        3 * self.faces.len() - joined.count()
    }

    /// The number of sets of faces that are joined by edges which are not torn.
    pub(crate) fn piece_count(&self) -> usize {
        let joined = self.links.iter().filter(|&&link| !self.is_torn(link));
        let joined: Vec<_> = joined.map(|link| link.map(|(f, _)| f)).collect();
        let piece_of = joined_sets(self.faces.len(), &joined);
        (0..self.faces.len()).filter(|&f| piece_of[f] == f).count()
    }

    /// The sum of the lumped masses of the corners of a vertex, in units.
    pub(crate) fn lumped_mass(&self, v: usize) -> u64 {
        let mut mass = 0;
        for (face, corner_mass) in self.faces.iter().zip(&self.corner_mass) {
            for i in 0..3 {
                if face[i] == v as u32 {
                    mass += corner_mass[i];
                }
            }
        }
        mass
    }
}

/// The sides of triangles that run between the same two vertices, in opposite directions.
pub(crate) fn links_of(faces: &[[u32; 3]]) -> Vec<[(usize, usize); 2]> {
    let mut sides = Vec::new();
    for (f, &face) in faces.iter().enumerate() {
        for i in 0..3 {
            sides.push((side(face, i), (f, i)));
        }
    }
    sides.sort();
    for two in sides.windows(2) {
        assert!(
            two[0].0 != two[1].0,
            "two faces on one side of an edge: {two:?}"
        );
    }
    let mut links = Vec::new();
    for &(ends, here) in &sides {
        if let Ok(i) = sides.binary_search_by_key(&reversed(ends), |&(ends, _)| ends) {
            let there = sides[i].1;
            if here < there {
                links.push([here, there]);
            }
        }
    }
    links.sort();
    links
}

/// Masses of corners by area, and what a unit of them is: 2^-52 of the power of two above the
/// total area. Each face is rounded to whole units, at least three; its corners share them, and
/// where there is a remainder the last corners get it.
pub(crate) fn lump(points: &[[f64; 3]], faces: &[[u32; 3]]) -> (f64, Vec<[u64; 3]>) {
    let area = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| points[v as usize]);
        let [ux, uy, uz] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
        let [vx, vy, vz] = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
        let [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
        (x * x + y * y + z * z).sqrt() / 2.0
    };
    let mut total = 0.0;
    for face in faces {
        total += area(face);
    }
    let mut above = 1.0;
    while above <= total {
        above *= 2.0;
    }
    while above / 2.0 > total {
        above /= 2.0;
    }
    let mut unit = above;
    for _ in 0..52 {
        unit /= 2.0;
    }
    let mut corner_mass = Vec::new();
    for face in faces {
        let units = ((area(face) / unit).round() as u64).max(3);
        corner_mass.push([units / 3, (units + 1) / 3, units.div_ceil(3)]);
    }
    (unit, corner_mass)
}

/// For each of `count` things the smallest one that it is joined with, directly or through others.
pub(crate) fn joined_sets(count: usize, joined: &[[usize; 2]]) -> Vec<usize> {
    let mut least: Vec<usize> = (0..count).collect();
    let mut changed = true;
    while changed {
        changed = false;
        for &[a, b] in joined {
            if least[a] != least[b] {
                let smaller = least[a].min(least[b]);
                (least[a], least[b]) = (smaller, smaller);
                changed = true;
            }
        }
    }
    least
}

/// At `a + t (b − a)`, and at `a` where both are that, whatever the sign of a zero.
pub(crate) fn between(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - (a[i] - b[i]) * t)
}

/// The side `i` of a face, from its corner `i` to the next.
fn side(face: [u32; 3], i: usize) -> [u32; 2] {
    [face[i], face[(i + 1) % 3]]
}

fn reversed([a, b]: [u32; 2]) -> [u32; 2] {
    [b, a]
}
