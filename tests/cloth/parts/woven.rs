//! Cloth of triangles.

use tearmesh::{Mesh, Point, Positions, Vector, shapes};
use tearmesh_cloth::{Cloth, Fabric, Orthotropic, System, Unstable};

use super::cloths::cloth;
use super::gravity;
use crate::parts::vibration::stiffness_times;

/// A strip two columns wide, whose rows are a chain with these numbers: particles 2 i and 2 i + 1 are
/// row i. `apart` leads from row to row; held at row 0.
pub(crate) fn strip(rows: usize, mass: f64, stiffness: f64, rest: f64, apart: Vector) -> System {
    let width = 0.25;
    // Across the strip, and across its length.
    let across = if apart.x.abs() > 0.0 {
        Vector::y()
    } else {
        Vector::x()
    };
    let points = (0..2 * (rows + 1))
        .map(|v| Point::origin() + apart * (v / 2) as f64 + across * (width * (v % 2) as f64));
    let mut strip = System::new(points, vec![mass / 2.0; 2 * (rows + 1)]).expect("particles");
    let modulus = stiffness * rest / width;
    let at = |v: usize| [width * (v % 2) as f64, rest * (v / 2) as f64];
    for row in 0..rows {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| 2 * row + i);
        for corners in [[a, b, d], [a, d, c]] {
            strip
                .triangle(
                    corners,
                    corners.map(at),
                    [0.1 * modulus, modulus, 0.05 * modulus],
                )
                .expect("a triangle");
        }
    }
    strip.hold(0);
    strip.hold(1);
    strip
}

/// A weave of these moduli, by warp, by weft and in shear.
pub(crate) fn of_moduli([warp, weft, shear]: [f64; 3], along: Vector) -> Orthotropic {
    Orthotropic {
        warp_n_per_m: warp,
        weft_n_per_m: weft,
        shear_n_per_m: shear,
        warp: along,
    }
}

/// A soft weave whose warp lies in no edge of a grid.
pub(crate) fn weave() -> Orthotropic {
    of_moduli([120.0, 80.0, 15.0], Vector::new(1.0, 0.4, 0.0))
}

/// A square metre in n × n cells, of this weave.
pub(crate) fn sheet(n: u32, weave: Orthotropic) -> (Mesh, Positions, Cloth) {
    let (mesh, positions) = shapes::grid(n, n);
    let cloth = cloth(&mesh, &positions, Fabric::orthotropic(weave));
    (mesh, positions, cloth)
}

/// A square metre in n × n cells, of this weave, held at its whole border and sagging, with so much
/// drag that it comes to rest.
pub(crate) fn framed(n: u32, weave: Orthotropic) -> Cloth {
    let (mesh, positions, mut cloth) = sheet(n, weave);
    for v in mesh.vertices() {
        let p = positions.at(v);
        if p.x == 0.0 || p.y == 0.0 || p.x == 1.0 || p.y == 1.0 {
            cloth.system_mut().hold(v.index());
        }
    }
    cloth.system_mut().set_loads(gravity(8.0)).expect("loads");
    cloth.system_mut().when_unstable(Unstable::Substep);
    cloth
}

/// The moduli of a plane system in homogeneous small strain, by (εx, εy, γ) along these axes, from uᵀ K u of
/// affine displacements.
pub(crate) fn moduli(system: &System, area: f64, [e, f]: [Vector; 2]) -> [[f64; 3]; 3] {
    let affine = |mode: usize| -> Vec<Vector> {
        let of = |p: &Point| match mode {
            0 => e * e.dot(&p.coords),
            1 => f * f.dot(&p.coords),
            _ => 0.5 * (e * f.dot(&p.coords) + f * e.dot(&p.coords)),
        };
        system.positions().iter().map(of).collect()
    };
    [0, 1, 2].map(|i| {
        let product = stiffness_times(system, &affine(i));
        let with = |j| {
            affine(j)
                .iter()
                .zip(&product)
                .map(|(u, p)| u.dot(p))
                .sum::<f64>()
        };
        [0, 1, 2].map(|j| with(j) / area)
    })
}
