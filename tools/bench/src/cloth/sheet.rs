//! A sheet that hangs by its upper edge.

use tearmesh::{Masses, Mesh, Point, Vector, shapes};
use tearmesh_cloth::{Cloth, Fabric, Loads, Method, Orthotropic, System, Xpbd};

use crate::options::Options;

pub(super) const GRAVITY_M_PER_S2: f64 = -9.81;
pub(super) const STEP_S: f64 = 1.0 / 60.0;

/// So stiff that no length of it shows, with the masses here: an extended constraint is as good as
/// rigid, as Bullet's links and those of PBD are.
const STIFFNESS_N_PER_M: f64 = 1e5;

/// n × n vertices over a square metre of 0.2 kg, upright and at rest; an edge of the mesh is a
/// constraint, of grid and one diagonal a cell. The upper row is held. No drag, no bending.
pub(super) fn hanging(n: u32) -> (Mesh, Cloth) {
    hung(n, Fabric::new(STIFFNESS_N_PER_M))
}

/// The same mesh, masses and held row, of triangles in place of constraints: as stiff along warp and
/// weft, and a tenth of that in shear.
pub(super) fn woven(n: u32) -> (Mesh, Cloth) {
    let moduli = Orthotropic {
        warp_n_per_m: STIFFNESS_N_PER_M,
        weft_n_per_m: STIFFNESS_N_PER_M,
        shear_n_per_m: 0.1 * STIFFNESS_N_PER_M,
        warp: Vector::x(),
    };
    hung(n, Fabric::orthotropic(moduli))
}

fn hung(n: u32, fabric: Fabric) -> (Mesh, Cloth) {
    let (mesh, positions) = shapes::grid(n - 1, n - 1);
    let masses = Masses::area(&mesh, &positions, 0.2).expect("a sheet has an area");
    let mut cloth = Cloth::new(&mesh, &positions, masses, fabric).expect("edges have a length");
    let system = cloth.system_mut();
    let loads = Loads {
        gravity_m_per_s2: Some(Vector::new(0.0, GRAVITY_M_PER_S2, 0.0)),
        ..Loads::default()
    };
    system.set_loads(loads).expect("finite");
    let upper = (n * (n - 1)..n * n).map(|top| top as usize);
    upper.for_each(|top| system.hold(top));
    // What stretches a hundredfold is a result here.
    system.set_stretch_ratio_max(f64::INFINITY);
    (mesh, cloth)
}

/// The methods that are measured alone, as far as they are picked: each with ten sweeps, or by forces.
pub(super) fn methods(options: &Options) -> Vec<Method> {
    let methods = [Method::Verlet, Method::Xpbd(Xpbd::default()), Method::pbd()];
    let names = methods.each_ref().map(Method::name);
    let methods = methods.into_iter();
    methods
        .filter(|method| options.picks(method.name(), &names))
        .collect()
}

/// Steps of a sheet from rest.
pub(super) struct Run {
    /// CPU time of all steps.
    pub(super) seconds: f64,
    /// Projections of single constraints, in all steps.
    pub(super) projections: u64,
    /// Where the particles are in the end.
    pub(super) positions: Vec<Point>,
}

/// The constraints: ends and rest lengths.
pub(super) struct Net(Vec<([usize; 2], f64)>);

impl Net {
    pub(super) fn new(system: &System) -> Net {
        let constraints = system.stretches();
        let of = |id| {
            let constraint = constraints.get(id);
            (constraint.ends, constraint.rest_length_m)
        };
        Net(constraints.iter().map(of).collect())
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// The root mean square of the strains, and the largest length as a multiple of the rest
    /// length.
    pub(super) fn strain(&self, positions: &[Point]) -> (f64, f64) {
        let ratio =
            |&([a, b], rest): &([usize; 2], f64)| (positions[b] - positions[a]).norm() / rest;
        let squares = self.0.iter().map(|edge| (ratio(edge) - 1.0).powi(2));
        let rms = (squares.sum::<f64>() / self.len() as f64).sqrt();
        (rms, self.0.iter().map(ratio).fold(0.0, f64::max))
    }
}
