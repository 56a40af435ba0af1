//! Seams: which edges of panels are to be sewn to each other.
//!
//! A garment is a torn mesh that is not yet mended. The panels of it are the components of a mesh; each seam
//! gives vertices of one side their counterparts on the other, and a vertex and its counterpart are two copies
//! of one vertex, as if a cut had parted them. So a seam is a torn link from the start, and sewing it is what
//! mends any tear. Both sides have equally many vertices; their lengths may differ, which is *ease*. Both may be
//! of one panel: a dart, or the seam that makes a sleeve a tube.

use std::fmt;

use tearmesh::{Defect, DisjointSets, HalfEdgeId, Mesh, TornError, VertexId};

/// A seam between two sides, each a chain of boundary edges.
///
/// ```
/// use tearmesh::{Mesh, Positions, VertexId};
/// use tearmesh_cloth::{Seam, Simulation, SimulationDef};
///
/// // Two squares side by side, a tenth of a metre apart.
/// let square = |x: f64| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0], [x + 1.0, 1.0, 0.0]];
/// let positions = Positions::new([square(0.0), square(1.1)].concat())?;
/// let mesh = Mesh::build(8, &[[0, 1, 2], [2, 1, 3], [4, 5, 6], [6, 5, 7]])?;
/// let side = |numbers: [usize; 2]| numbers.into_iter().filter_map(VertexId::new).collect();
/// let seam = Seam { name: "side".to_owned(), one: side([1, 3]), other: side([4, 6]) };
///
/// let def = SimulationDef { seams: vec![seam], ..SimulationDef::default() };
/// let mut sim = Simulation::new(mesh, &positions, def)?;
/// sim.advance(0.2, 1000)?;
/// assert_eq!((sim.open_pairs(), sim.mesh().components().count()), (0, 1));
/// assert_eq!(sim.unpick("side")?, 2);
/// assert_eq!(sim.mesh().components().count(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Seam {
    /// The name by which it is unpicked. Seams that share a name are unpicked together.
    pub name: String,
    /// The vertices of one side, along the boundary.
    pub one: Vec<VertexId>,
    /// The counterpart of each: the vertex with which it becomes one. The tip of a dart is its own.
    pub other: Vec<VertexId>,
}

/// The reason why seams were refused.
#[derive(Clone, Debug, PartialEq)]
pub struct SeamError {
    /// The number of the first seam concerned, from 0.
    pub seam: usize,
    /// The vertices concerned.
    pub vertices: Vec<VertexId>,
    /// What is wrong with them.
    pub fault: SeamFault,
}

/// What is wrong with a seam.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SeamFault {
    /// The sides have different numbers of vertices, or fewer than two.
    Counts([usize; 2]),
    /// A side names a vertex that the mesh does not have.
    NoVertex,
    /// A side names a vertex twice.
    Repeated,
    /// Two vertices that follow each other are not the ends of an edge at the boundary.
    NoBoundary,
    /// Both ends of a boundary edge are sewn to those of another, so that these edges become one although no seam
    /// has them.
    Unnamed,
    /// Sewn whole, the panels would be no oriented manifold: three of them share an edge, or two a vertex and no
    /// edge beside it. The defect names a vertex by the lowest that it would be one with.
    Sewn(Defect),
}

impl SeamError {
    fn new(seam: usize, vertices: impl Into<Vec<VertexId>>, fault: SeamFault) -> SeamError {
        let vertices = vertices.into();
        SeamError {
            seam,
            vertices,
            fault,
        }
    }

    /// Returns the reason in words, in which each vertex has a name such as its number in a file.
    #[must_use]
    pub fn text(&self, name: impl Fn(VertexId) -> String) -> String {
        let names: Vec<String> = self.vertices.iter().copied().map(name).collect();
        let edge = names.join("-");
        match &self.fault {
            SeamFault::Counts([0 | 1, _]) => "a side of a seam has two vertices or more".to_owned(),
            SeamFault::Counts([one, other]) => {
                format!("one side of the seam has {one} vertices, the other {other}")
            }
            SeamFault::NoVertex => format!("the mesh has no vertex {edge}"),
            SeamFault::Repeated => format!("a side of the seam names the vertex {edge} twice"),
            SeamFault::NoBoundary => format!("{edge} is no edge at the boundary of a panel"),
            SeamFault::Unnamed => format!(
                "{edge} would be sewn as well, since both its ends are, and no seam names it"
            ),
            SeamFault::Sewn(Defect::CrowdedEdge { faces, .. }) => {
                format!("{} faces would meet at the edge {edge}", faces.len())
            }
            SeamFault::Sewn(Defect::FlippedFace { .. }) => {
                format!("both panels run along {edge} the same way: one lies face down")
            }
            SeamFault::Sewn(Defect::BowTie { .. }) => {
                format!("panels would meet in the vertex {edge} and in no edge beside it")
            }
            SeamFault::Sewn(Defect::RepeatedVertex { .. }) => {
                format!("a face would have the vertex {edge} twice")
            }
            SeamFault::Sewn(_) => format!("two faces would have the same vertices {edge}"),
        }
    }
}

impl fmt::Display for SeamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = self.text(|v| v.to_string());
        write!(f, "seam {}: {text}", self.seam + 1)
    }
}

impl std::error::Error for SeamError {}

/// The panels as one mesh that is torn along the seams; and by half-edge the number of its seam, from 1, or 0.
pub(crate) fn joined(panels: &Mesh, seams: &[Seam]) -> Result<(Mesh, Vec<u32>), SeamError> {
    let mut sets = DisjointSets::new(panels.vertex_count() as u32);
    (0..)
        .zip(panels.roots())
        .for_each(|(v, root)| sets.join(v, root));
    let mut labels = vec![0; panels.half_edge_count()];
    for (number, seam) in seams.iter().enumerate() {
        seam.check(number, panels)?;
        for side in [&seam.one, &seam.other] {
            for (&one, &other) in side.iter().zip(&side[1..]) {
                let ends = [one, other];
                let h = boundary(panels, ends);
                let h = h.ok_or_else(|| SeamError::new(number, ends, SeamFault::NoBoundary))?;
                labels[h.index()] = number as u32 + 1;
            }
        }
        for (&one, &other) in seam.one.iter().zip(&seam.other) {
            sets.join(one.into(), other.into());
        }
    }
    let roots = sets.representatives();
    // The seam that names one of these vertices, or a copy of it.
    let first = |of: &[VertexId]| {
        let root = |v: &VertexId| roots[v.index()];
        let is_of = |seam: &Seam| {
            seam.one
                .iter()
                .any(|v| of.iter().any(|w| root(v) == root(w)))
        };
        seams.iter().position(is_of).unwrap_or(0)
    };
    let faces = panels.indices().as_chunks().0;
    let built = Mesh::build_torn(faces, roots);
    let mesh = built.map_err(|error| {
        let TornError::Build(error) = error else {
            unreachable!(
                "a vertex with a counterpart has an edge, and the representative of a set is the lowest"
            );
        };
        let defect = error.defects()[0].clone();
        let vertices = vertices_of(&defect);
        SeamError::new(first(&vertices), vertices, SeamFault::Sewn(defect))
    })?;
    let is_unnamed = |h: &HalfEdgeId| {
        let [before, now] = [panels, &mesh].map(|mesh| mesh.pair_or_ghost(*h));
        before != now && labels[h.index()] == 0
    };
    if let Some(h) = mesh.half_edges().find(is_unnamed) {
        let ends = [mesh.origin(h), mesh.target(h)];
        return Err(SeamError::new(first(&ends), ends, SeamFault::Unnamed));
    }
    Ok((mesh, labels))
}

impl Seam {
    fn check(&self, seam: usize, panels: &Mesh) -> Result<(), SeamError> {
        let counts = [self.one.len(), self.other.len()];
        if counts[0] != counts[1] || counts[0] < 2 {
            return Err(SeamError::new(seam, [], SeamFault::Counts(counts)));
        }
        for side in [&self.one, &self.other] {
            let mut sorted = side.clone();
            sorted.sort_unstable();
            if let Some(&vertex) = sorted.last().filter(|v| v.index() >= panels.vertex_count()) {
                return Err(SeamError::new(seam, [vertex], SeamFault::NoVertex));
            }
            if let Some(two) = sorted.windows(2).find(|two| two[0] == two[1]) {
                return Err(SeamError::new(seam, [two[0]], SeamFault::Repeated));
            }
        }
        Ok(())
    }
}

/// The half-edge at the boundary between two vertices, either way.
fn boundary(mesh: &Mesh, [a, b]: [VertexId; 2]) -> Option<HalfEdgeId> {
    let joins = |&h: &HalfEdgeId| mesh.origin(h) == b || mesh.target(h) == b;
    let around = mesh.corners_of(a).flat_map(|h| [h, h.prev()]);
    around.filter(joins).find(|&h| mesh.pair(h).is_none())
}

fn vertices_of(defect: &Defect) -> Vec<VertexId> {
    match *defect {
        Defect::RepeatedVertex { vertex, .. } | Defect::BowTie { vertex, .. } => vec![vertex],
        Defect::CrowdedEdge { ends, .. } => ends.to_vec(),
        Defect::FlippedFace { from, to, .. } => vec![from, to],
        Defect::DuplicateFaces { vertices, .. } | Defect::Pillow { vertices, .. } => {
            vertices.to_vec()
        }
        _ => Vec::new(),
    }
}
