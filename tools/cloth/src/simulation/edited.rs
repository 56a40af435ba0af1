//! Tests of the parts of a step that take in an edit alone. They edit cloths, of which systems know nothing.

use tearmesh::geometry::{Point, Vector};
use tearmesh::{Edits, Masses, Mesh, Positions, VertexId, shapes, split};

use crate::cloth::Cloth;
use crate::cloth::fabric::{Bending, Fabric};
use crate::method::stability::{recommended_step_s, weigh_for};
use crate::method::verlet::Verlet;
use crate::system::counters::Counters;
use crate::system::force::{accelerate, accelerate_edited};
use crate::system::guard::REACH;
use crate::system::load::Loads;
use crate::system::net::Net;
use crate::system::{System, damping};

const STEP_S: f64 = 0.02;

/// All forces anew, at the velocities that the step before had in its middle.
fn anew(system: &System) -> Vec<Vector> {
    let mut anew = system.clone();
    let half_s = STEP_S / 2.0;
    let pulled = system.scratch.accelerations.iter();
    let pulled = pulled.zip(&system.model.inverse_masses);
    for (v, (a, &w)) in anew.velocities.iter_mut().zip(pulled) {
        if w > 0.0 {
            *v = (*v - a * half_s) / (1.0 - half_s * system.model.drag_per_s());
        }
    }
    assert!(accelerate(&mut anew, false, Some(STEP_S)));
    anew.scratch.accelerations
}

/// Crushed, damped, with drag and a particle that is held, some of them carried.
#[test]
fn forces_after_an_edit_are_those_of_a_pass_over_all() {
    let (mut mesh, positions) = shapes::grid(6, 6);
    let masses = Masses::by_areas(&mesh, |_| 0.5, 1.0).expect("masses");
    let fabric = Fabric {
        damping_s: 0.02,
        bend: Some(Bending::Spring {
            stiffness_n_per_m: 3.0,
        }),
        ..Fabric::new(1200.0)
    };
    let mut cloth = Cloth::new(&mesh, &positions, masses, fabric).expect("a cloth");
    let system = cloth.system_mut();
    system.hold(3);
    let loads = Loads {
        gravity_m_per_s2: Some(Vector::new(0.0, 0.0, -9.81)),
        drag_per_s: Some(2.0),
        ..Loads::default()
    };
    system.set_loads(loads).expect("loads");
    let (x, v) = system.state_mut();
    for (i, (x, v)) in x.iter_mut().zip(v).enumerate() {
        x.y *= 0.8;
        x.z = 0.1 * (i as f64).sin();
        *v = Vector::new((i as f64).cos(), 0.3, (2.0 * i as f64).sin());
    }
    let mut edits = Edits::new();
    for round in 0..30 {
        cloth.step(&mut Verlet, STEP_S).expect("a step");
        let v = VertexId::new(round * 11 % mesh.vertex_count()).expect("an id");
        let face = mesh.faces_of(v).next().expect("it has faces");
        let _ = split::vertex(&mut mesh, v, &[face], &mut edits);
        edits.replay(&mut cloth);
        let system = cloth.system_mut();
        weigh_for(system, STEP_S);
        assert!(system.scratch.is_fresh);
        let expected = anew(system);
        accelerate_edited(system, STEP_S);
        for (a, expected) in system.scratch.accelerations.iter().zip(&expected) {
            assert!((a - expected).norm() < 1e-10 * (1.0 + expected.norm()));
        }
    }
    assert!(cloth.system().guard.carry.len() > 0);
}

/// A sheet whose vertices are moved by up to a third of a cell.
fn uneven(seed: u64, damping_s: f64) -> (Mesh, Cloth) {
    let (mesh, positions) = shapes::grid(9, 9);
    let moved = |(i, p): (usize, &Point)| {
        let part = |k: u64| ((i as u64 * 7 + seed * 13 + k) * 2_654_435_761 % 997) as f64 / 997.0;
        Point::new(
            p.x + 0.6 * (part(1) - 0.5),
            p.y + 0.6 * (part(2) - 0.5),
            0.0,
        )
    };
    let points = positions.as_slice().iter().enumerate().map(moved);
    let positions = Positions::new(points).expect("finite");
    let masses = Masses::by_areas(&mesh, |_| 0.5, 1.0).expect("masses");
    let fabric = Fabric {
        damping_s,
        ..Fabric::new(50.0)
    };
    let cloth = Cloth::new(&mesh, &positions, masses, fabric).expect("a cloth");
    (mesh, cloth)
}

#[test]
fn no_mode_is_faster_than_those_before_and_those_near_an_edit() {
    let (mut new, mut beyond, mut compared) = (0, 0, 0);
    for seed in 0..12 {
        let damping_s = [0.0, 1.0, 1e-3, 0.1][seed as usize % 4];
        let (mut mesh, mut cloth) = uneven(seed, damping_s);
        let step_s = [1.0, 1.5, 2.0][seed as usize % 3] * recommended_step_s(cloth.system_mut());
        let mut edits = Edits::new();
        let mut before = 0.0;
        for i in 0..150 {
            let v = VertexId::new((i * 37 + seed as usize) % mesh.vertex_count()).expect("an id");
            let faces: Vec<_> = mesh.faces_of(v).collect();
            let given = &faces[..faces.len().div_ceil(3)];
            if split::vertex(&mut mesh, v, given, &mut edits).is_err() {
                continue;
            }
            edits.replay(&mut cloth);
            let system = cloth.system_mut();
            weigh_for(system, step_s);
            let (guard, model) = (&mut system.guard, &system.model);
            if guard.carry.is_proven {
                before = 0.0;
                continue;
            }
            let stiffness = (guard.reach.max(REACH), damping::stiffness_in(step_s));
            let mut all = 0.0_f64;
            for _ in 0..100 {
                let (net, carry) = (&mut guard.net, &guard.carry);
                all = all.max(net.whole(model, stiffness, carry, &mut Counters::default()));
            }
            let mut list = guard.unmeasured.clone();
            let near = guard.part.near(&mut list, model, stiffness, &guard.carry);
            if before > 0.0 {
                let bound = Net::unless_faster(before, near);
                assert!(all <= 1.1 * bound, "{all} {near} {before}");
                beyond += usize::from(all > bound);
                new += usize::from(all > 1.001 * before);
                compared += 1;
            }
            before = all;
            guard.unmeasured.clear();
        }
    }
    assert!(
        new > 100 && beyond < 3 && compared > 1000,
        "{new} {beyond} of {compared}"
    );
}
