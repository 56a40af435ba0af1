//! Cloths of meshes: made, moved, measured, torn.

use tearmesh::insert::Plan;
use tearmesh::{
    Edit, Edits, ExactSum, FaceId, HalfEdgeId, Masses, Mesh, Point, Positions, VertexId, mend,
    shapes, slide, split,
};
use tearmesh_cloth::{
    Bending, Cloth, Fabric, Loads, Stretch, Tear, TearReport, Tearing, TornStiffness,
};

use crate::random::Random;

/// A cloth of 0.2 kg/m² in the shape of a mesh.
pub(crate) fn cloth(mesh: &Mesh, positions: &Positions, fabric: Fabric) -> Cloth {
    let masses = Masses::area(mesh, positions, 0.2).expect("masses");
    Cloth::new(mesh, positions, masses, fabric).expect("a cloth")
}

/// A cloth of a square metre in n × n cells under these loads, and its mesh.
pub(crate) fn loaded(n: u32, fabric: Fabric, loads: Loads) -> (Mesh, Cloth) {
    let (mesh, positions) = shapes::grid(n, n);
    let mut cloth = cloth(&mesh, &positions, fabric);
    cloth.system_mut().set_loads(loads).expect("loads");
    (mesh, cloth)
}

/// Splits so many faces of a vertex off, and has the cloth follow; gives the copy.
pub(crate) fn split_off(mesh: &mut Mesh, cloth: &mut Cloth, v: VertexId, faces: usize) -> VertexId {
    let mut edits = Edits::starting_at(cloth.seen());
    let faces: Vec<FaceId> = mesh.faces_of(v).take(faces).collect();
    let split = split::vertex(mesh, v, &faces, &mut edits);
    let new = split.expect("a split").new;
    edits.replay(cloth);
    new
}

/// Springs of one stiffness, whose copies are as stiff as that.
pub(crate) fn of_edges(stiffness_n_per_m: f64, torn: TornStiffness) -> Fabric {
    let stretch = Stretch::Edges {
        stiffness_n_per_m,
        torn,
    };
    Fabric {
        stretch,
        ..Fabric::of_edges(stiffness_n_per_m)
    }
}

/// A fabric with springs across its edges, which are so stiff.
pub(crate) fn bent(fabric: Fabric, stiffness_n_per_m: f64) -> Fabric {
    let bend = Some(Bending::Spring { stiffness_n_per_m });
    Fabric { bend, ..fabric }
}

/// A flat sheet of cells of 0.1 m, whose inner vertices are off the grid, in generic position.
pub(crate) fn sheet(columns: u32, rows: u32, seed: u64) -> (Mesh, Positions) {
    let mut random = Random(seed);
    let (mesh, positions) = shapes::grid_with_diagonals(columns, rows, |i, j| (i + j) % 2 == 0);
    let (n, m) = (columns as usize, rows as usize);
    let points = positions.as_slice().iter().enumerate().map(|(v, p)| {
        let (i, j) = (v % (n + 1), v / (n + 1));
        let inner = i > 0 && j > 0 && i < n && j < m;
        let mut off = || {
            if inner {
                0.4 * (random.next() - 0.5)
            } else {
                0.0
            }
        };
        [p.x * n as f64 + off(), p.y * m as f64 + off(), 0.0].map(|x| 0.1 * x)
    });
    let positions = Positions::new(points).expect("finite");
    (mesh, positions)
}

/// Moves the particles of a cloth by a function of where they are.
pub(crate) fn deform(cloth: &mut Cloth, mut to: impl FnMut(Point) -> Point) {
    for x in cloth.system_mut().state_mut().0 {
        *x = to(*x);
    }
}

/// Σ m v of all that is free, exactly, in kg m/s.
pub(crate) fn momentum(cloth: &Cloth) -> [ExactSum; 3] {
    let mut sums = [ExactSum::new(), ExactSum::new(), ExactSum::new()];
    let system = cloth.system();
    for (m, v) in system.masses().iter().zip(system.velocities()) {
        for (sum, v) in sums.iter_mut().zip(v.iter()) {
            let product = m * v;
            sum.add(product);
            sum.add(m.mul_add(*v, -product));
        }
    }
    sums
}

/// A mesh, its cloth, and what tears it.
pub(crate) struct Torn {
    pub(crate) mesh: Mesh,
    pub(crate) cloth: Cloth,
    pub(crate) edits: Edits,
    pub(crate) tear: Tear,
}

impl Torn {
    /// A cloth as of [`cloth`] that tears by this rule.
    pub(crate) fn new(
        (mesh, positions): (Mesh, Positions),
        fabric: Fabric,
        tearing: Tearing,
    ) -> Torn {
        let cloth = cloth(&mesh, &positions, fabric);
        let tear = Tear::new(&cloth, tearing).expect("usable numbers");
        let edits = Edits::new();
        Torn {
            mesh,
            cloth,
            edits,
            tear,
        }
    }

    /// Sets the strengths of vertices.
    pub(crate) fn strengthen(&mut self, strengths: Vec<f64>) {
        let tear = self.tear.clone().with_strengths(strengths);
        self.tear = tear.expect("strengths");
    }

    /// Tears what is due. The mesh is checked.
    pub(crate) fn apply(&mut self) -> TearReport {
        let report = self
            .tear
            .apply(&mut self.mesh, &mut self.cloth, &mut self.edits);
        assert_eq!(self.mesh.check(), []);
        report
    }

    /// The vertices that were split, in order.
    pub(crate) fn split(&self) -> Vec<VertexId> {
        let old = |edit: Edit<'_>| match edit {
            Edit::Split(split) => Some(split.old),
            _ => None,
        };
        self.edits.iter().filter_map(old).collect()
    }
}

/// What an edit did.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Done {
    Nothing,
    Split,
    Insert,
    Merge,
    Slide,
}

/// One random edit of a mesh that the cloth is in step with.
pub(crate) fn edit(mesh: &mut Mesh, cloth: &Cloth, edits: &mut Edits, random: &mut Random) -> Done {
    let done = |done, is_done| if is_done { done } else { Done::Nothing };
    let verb = random.below(6);
    let half_edge = |mesh: &Mesh, random: &mut Random| {
        HalfEdgeId::new(random.below(mesh.half_edge_count())).expect("a half-edge")
    };
    match verb {
        0 | 1 => {
            let v = VertexId::new(random.below(mesh.vertex_count())).expect("a vertex");
            let faces: Vec<FaceId> = mesh.faces_of(v).filter(|_| random.below(2) == 0).collect();
            done(Done::Split, split::vertex(mesh, v, &faces, edits).is_ok())
        }
        2 => {
            let mut plan = Plan::new();
            let h = half_edge(mesh, random);
            plan.on_edge(h, 0.2 + 0.6 * random.below(1000) as f64 / 1000.0);
            if random.below(2) == 0 {
                let f = FaceId::new(random.below(mesh.face_count())).expect("a face");
                plan.in_face(f, [0.2, 0.3, 0.5]);
            }
            done(Done::Insert, plan.apply(mesh, edits).is_ok())
        }
        3 => {
            let h = half_edge(mesh, random);
            let t = 0.01 + 0.2 * random.below(1000) as f64 / 1000.0;
            let [vertex, toward] = [mesh.origin(h), mesh.target(h)];
            slide::toward(mesh, vertex, toward, t, edits).expect("a slide");
            Done::Slide
        }
        _ => {
            let stitches = mend::stitches(mesh, |_| true);
            if stitches.is_empty() {
                return Done::Nothing;
            }
            let stitch = stitches[random.below(stitches.len())];
            let [kept, gone] = [stitch.kept(), stitch.gone()];
            let weights = [kept, gone].map(|v| cloth.masses().at(v));
            done(
                Done::Merge,
                mend::merge(mesh, kept, gone, weights, edits).is_ok(),
            )
        }
    }
}
