//! Systems of springs alone, and what is known of them by statics.

use tearmesh::{Point, Vector, VertexId, shapes};
use tearmesh_cloth::{Loads, System};

use super::{G, gravity};
use crate::parts::vibration::stiffness_times;

/// A number of springs in a row, whose particles are `apart` from each other; held at the first.
/// Units: kg a particle, N/m and metres a spring.
pub(crate) fn row(springs: usize, mass: f64, stiffness: f64, rest: f64, apart: Vector) -> System {
    let points = (0..=springs).map(|i| Point::origin() + apart * i as f64);
    let mut row = System::new(points, vec![mass; springs + 1]).expect("particles with mass");
    for i in 0..springs {
        row.stretch([i, i + 1], rest, stiffness).expect("a spring");
    }
    row.hold(0);
    row
}

/// R2: ten links of 0.1 m and 50 N/m between particles of 10 g, hanging by the first, with this drag
/// in 1/s.
pub(crate) fn chain(drag_per_s: f64) -> System {
    let mut chain = row(10, 0.01, 50.0, 0.1, Vector::new(0.0, 0.0, -0.1));
    chain.set_loads(gravity(drag_per_s)).expect("loads");
    chain
}

/// A chain of n springs between two nails one metre apart, sagging as a parabola at first.
pub(crate) fn catenary(n: usize, mass: f64, stiffness: f64, rest: f64, drag: f64) -> System {
    let points = (0..=n).map(|i| {
        let x = i as f64 / n as f64;
        Point::new(x, 0.0, -2.0 * x * (1.0 - x))
    });
    let mut net = System::new(points, vec![mass; n + 1]).expect("particles");
    for i in 0..n {
        net.stretch([i, i + 1], rest, stiffness).expect("a spring");
    }
    net.hold(0);
    net.hold(n);
    net.set_loads(gravity(drag)).expect("loads");
    net
}

/// A square net of n × n cells with a diagonal each, in a frame of one metre with 2 % pretension,
/// under gravity across it.
pub(crate) fn framed(n: u32, stiffness: f64, drag: f64) -> System {
    let (mesh, positions) = shapes::grid(n, n);
    let points = positions.as_slice();
    let masses = vec![0.01; points.len()];
    let mut net = System::new(points.iter().copied(), masses).expect("particles");
    for h in mesh.edges() {
        let ends = [mesh.origin(h), mesh.target(h)].map(VertexId::index);
        let rest = (points[ends[1]] - points[ends[0]]).norm() / 1.02;
        net.stretch(ends, rest, stiffness).expect("an edge");
    }
    let border = |&i: &usize| {
        [points[i].x, points[i].y]
            .iter()
            .any(|x| [0.0, 1.0].contains(x))
    };
    (0..points.len()).filter(border).for_each(|i| net.hold(i));
    net.set_loads(gravity(drag)).expect("loads");
    net
}

/// A net without loads at rest, but for a push at one particle: a "chain" of sixteen links, a
/// "string" that is taut between two nails, or else a net in a frame.
pub(crate) fn pushed(name: &str, stiffness: f64) -> System {
    let apart = Vector::new(0.1, 0.0, 0.0);
    match name {
        "chain" => push(row(16, 0.01, stiffness, 0.1, apart), 5),
        "string" => {
            let mut string = row(16, 0.01, stiffness, 0.095, apart);
            string.hold(16);
            push(string, 5)
        }
        _ => push(framed(4, stiffness, 0.0), 7),
    }
}

/// A system without its loads, and with a push of about a micrometre per second at one particle.
pub(crate) fn push(mut system: System, particle: usize) -> System {
    system.set_loads(Loads::default()).expect("loads");
    system.state_mut().1[particle] = Vector::new(1e-6, 0.3e-6, 0.2e-6);
    system
}

/// The stiffness of a net in the plane, in N/m: xx, yy, xy, shear, and x with shear, from uᵀ K u
/// of the affine displacements of a cell's springs.
pub(crate) fn modulus(cell_area: f64, springs: &[[f64; 2]], k: f64) -> [f64; 5] {
    let energy = |f: &dyn Fn([f64; 2]) -> [f64; 2]| -> f64 {
        let of = |&spring: &[f64; 2]| {
            let d = Vector::new(spring[0], spring[1], 0.0);
            let pair = row(1, 1.0, k, d.norm(), d);
            let [x, y] = f(spring);
            let u = [Vector::zeros(), Vector::new(x, y, 0.0)];
            stiffness_times(&pair, &u)[1].dot(&u[1])
        };
        springs.iter().map(of).sum::<f64>() / cell_area
    };
    let xx = energy(&|[x, _]| [x, 0.0]);
    let yy = energy(&|[_, y]| [0.0, y]);
    let shear = energy(&|[_, y]| [y, 0.0]);
    let both = energy(&|[x, y]| [x, y]);
    let x_and_shear = energy(&|[x, y]| [x + y, 0.0]);
    [
        xx,
        yy,
        (both - xx - yy) / 2.0,
        shear,
        (x_and_shear - xx - shear) / 2.0,
    ]
}

/// Where the particles of a net rest under gravity, by statics with no dynamics and no code in common:
/// particle by particle, each goes the way of its force until none has any.
pub(crate) fn relaxed(net: &System) -> Vec<Point> {
    let springs = net.stretches();
    let springs: Vec<_> = springs.iter().map(|id| springs.get(id)).collect();
    let mut points = net.positions().to_vec();
    for _ in 0..4000 {
        for i in 0..points.len() {
            if net.is_held(i) {
                continue;
            }
            let mut force = Vector::new(0.0, 0.0, -G * net.masses()[i]);
            let mut stiffness = 0.0;
            for spring in springs.iter().filter(|spring| spring.ends.contains(&i)) {
                let other = spring.ends[0] + spring.ends[1] - i;
                let d = points[other] - points[i];
                let tension = spring.stiffness_n_per_m * (d.norm() - spring.rest_length_m);
                force += d.normalize() * tension;
                stiffness += spring.stiffness_n_per_m;
            }
            points[i] += force / stiffness;
        }
    }
    points
}
