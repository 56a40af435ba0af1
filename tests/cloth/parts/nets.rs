//! Systems of springs alone, and what is known of them by statics.

use tearmesh::{Point, Vector, VertexId, shapes};
use tearmesh_cloth::{ConstraintId, Loads, System};

use super::{G, gravity};

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

/// The stretch constraint between two particles.
pub(crate) fn link(system: &System, a: usize, b: usize) -> Option<ConstraintId> {
    let (mut ids, all) = (system.stretches().iter(), system.stretches());
    ids.find(|&id| [a, b].iter().all(|end| all.get(id).ends.contains(end)))
}

/// R2: ten links of 0.1 m and 50 N/m between particles of 10 g, hanging by the first, with this drag
/// in 1/s.
pub(crate) fn chain(drag_per_s: f64) -> System {
    let mut chain = row(10, 0.01, 50.0, 0.1, Vector::new(0.0, 0.0, -0.1));
    chain.set_loads(gravity(drag_per_s)).expect("loads");
    chain
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
    let is_rim = |p: &Point| [0.0, 1.0].contains(&p.x) || [0.0, 1.0].contains(&p.y);
    let rim = (0..points.len()).filter(|&i| is_rim(&points[i]));
    rim.for_each(|i| net.hold(i));
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

/// Where particles rest under gravity, by statics with no dynamics and no code in common: particle by particle,
/// each goes the way of its force until none has any. Given are the force on one and its stiffness.
pub(crate) fn relaxed(
    system: &System,
    pull: impl Fn(&[Point], usize) -> (Vector, f64),
) -> Vec<Point> {
    let mut points = system.positions().to_vec();
    for _ in 0..6000 {
        for i in (0..points.len()).filter(|&i| !system.is_held(i)) {
            let (force, stiffness) = pull(&points, i);
            points[i] += (force - Vector::z() * (G * system.masses()[i])) / stiffness;
        }
    }
    points
}

/// Where a net of springs rests.
pub(crate) fn relaxed_net(net: &System) -> Vec<Point> {
    let springs = net.stretches();
    let springs: Vec<_> = springs.iter().map(|id| springs.get(id)).collect();
    relaxed(net, |points, i| {
        let own = springs.iter().filter(|spring| spring.ends.contains(&i));
        own.fold((Vector::zeros(), 0.0), |(force, stiffness), spring| {
            let d = points[spring.ends[0] + spring.ends[1] - i] - points[i];
            let k = spring.stiffness_n_per_m;
            let pull = d.normalize() * (k * (d.norm() - spring.rest_length_m));
            (force + pull, stiffness + k)
        })
    })
}
