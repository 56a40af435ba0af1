//! A tear must not depend on the order in which triangles, corners and vertices are stored.

use std::collections::BTreeSet;

use tearmesh::{Mesh, Point, Positions, Vector};
use tearmesh_cloth::{Fabric, TearReport, Tearing, Threshold};

use crate::parts::cloths::{Torn, sheet};
use crate::random::Random;

/// The mesh with its vertices and triangles in another order and its triangles turned.
struct Renamed {
    mesh: Mesh,
    positions: Positions,
    /// By corner of the first mesh, that of this.
    corners: Vec<usize>,
}

fn shuffled(count: usize, random: &mut Random) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    random.shuffle(&mut order);
    order
}

fn rename(mesh: &Mesh, positions: &Positions, random: &mut Random) -> Renamed {
    let vertices = shuffled(mesh.vertex_count(), random);
    let faces = shuffled(mesh.face_count(), random);
    let mut triangles = vec![[0_u32; 3]; faces.len()];
    let mut corners = vec![0; mesh.half_edge_count()];
    for (f, triangle) in mesh.indices().chunks_exact(3).enumerate() {
        let turn = random.below(3);
        for (corner, &v) in triangle.iter().enumerate() {
            let to = (corner + turn) % 3;
            triangles[faces[f]][to] = vertices[v as usize] as u32;
            corners[3 * f + corner] = 3 * faces[f] + to;
        }
    }
    let mut points = vec![Point::origin(); vertices.len()];
    let moved = vertices.iter().zip(positions.as_slice());
    moved.for_each(|(&to, &at)| points[to] = at);
    Renamed {
        mesh: Mesh::build(points.len(), &triangles).expect("a mesh"),
        positions: Positions::new(points).expect("finite"),
        corners,
    }
}

/// The vertex of the other mesh that has the same corners as each of this; panics unless
/// there is one.
fn same_vertices(mesh: &Mesh, other: &Mesh, corners: &[usize]) -> Vec<usize> {
    assert_eq!(mesh.vertex_count(), other.vertex_count());
    let there = corners
        .iter()
        .map(|&corner| other.indices()[corner] as usize);
    let pairs: BTreeSet<(u32, usize)> = mesh.indices().iter().copied().zip(there).collect();
    let to: Vec<usize> = pairs.iter().map(|&(_, to)| to).collect();
    let these = pairs.iter().map(|&(v, _)| v as usize);
    assert!(these.eq(0..mesh.vertex_count()), "one is two");
    let all: BTreeSet<usize> = to.iter().copied().collect();
    assert!(all.into_iter().eq(0..to.len()), "two are one");
    to
}

#[test]
fn a_tear_does_not_depend_on_the_order_of_storage() {
    let thresholds = [
        Threshold::Stretch(1.25),
        Threshold::Toughness(0.2),
        Threshold::Force(1.0),
        Threshold::PrincipalStretch(1.3),
        Threshold::WarpWeft {
            warp: 1.2,
            weft: 1.3,
            axis: Vector::new(1.0, 0.3, 0.2),
        },
    ];
    let mut splits = 0;
    for seed in 0..40 {
        let mut random = Random(1000 + seed);
        let (mesh, positions) = sheet(7, 6, seed);
        let renamed = rename(&mesh, &positions, &mut random);
        let corners = renamed.corners;
        let tearing = Tearing {
            splits_per_step_max: [None, Some(1), Some(5)][seed as usize % 3],
            weakening: (seed % 2 == 0).then_some(0.6),
            ..Tearing::new(thresholds[seed as usize % 5])
        };
        let fabric = Fabric::new(50.0);
        let mut one = Torn::new((mesh, positions), fabric, tearing);
        let mut other = Torn::new((renamed.mesh, renamed.positions), fabric, tearing);
        let to = same_vertices(&one.mesh, &other.mesh, &corners);
        let (mut strengths, mut others) = (Vec::new(), vec![0.0; to.len()]);
        for there in to {
            strengths.push(0.8 + 0.4 * random.next());
            others[there] = strengths[strengths.len() - 1];
        }
        one.strengthen(strengths);
        other.strengthen(others);
        for _ in 0..6 {
            let to = same_vertices(&one.mesh, &other.mesh, &corners);
            let pull = 1.0 + 0.4 * random.next();
            for (v, &there) in to.iter().enumerate() {
                let mut next = || 0.02 * (random.next() - 0.5);
                let x = one.cloth.positions()[v];
                let x = Point::new(x.x + next(), x.y * pull + next(), x.z + next());
                one.cloth.system_mut().state_mut().0[v] = x;
                other.cloth.system_mut().state_mut().0[there] = x;
            }
            let (report, same) = (one.apply(), other.apply());
            splits += report.splits;
            let counts = |r: TearReport| (r.splits, r.overstretched, r.cap_hit);
            assert_eq!(counts(report), counts(same), "seed {seed}");
        }
        same_vertices(&one.mesh, &other.mesh, &corners);
    }
    assert!(splits > 400, "{splits}");
}
