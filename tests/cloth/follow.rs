//! A cloth that is split, subdivided and sewn while it moves is the cloth that one would make anew.

use std::collections::BTreeMap;

use tearmesh::insert::Plan;
use tearmesh::{Edits, FaceId, Masses, Mesh, Place, Vector, VertexId, mend, shapes, slide, split};
use tearmesh_cloth::{
    Bending, Cloth, Constraint, Copies, Fabric, Stretch, Unbend, Unstable, Weave, Xpbd, energy,
    frequency_bound,
};

use crate::parts::cloths::{cloth, momentum, of_edges};
use crate::parts::vibration::rayleigh_quotient;
use crate::parts::{gravity, near};
use crate::random::Random;
use crate::rk4::Rk4;

/// Edges with their rest length, and apexes across edges, as sets: what a cloth must have.
fn expected(mesh: &Mesh, cloth: &Cloth) -> [BTreeMap<[usize; 2], Vec<u64>>; 2] {
    let rest = |[a, b]: [VertexId; 2]| {
        (cloth.rest_positions().at(b) - cloth.rest_positions().at(a)).norm()
    };
    let mut sets = [BTreeMap::new(), BTreeMap::new()];
    let mut add = |family: usize, ends: [VertexId; 2]| {
        let mut key = ends.map(VertexId::index);
        key.sort_unstable();
        let lengths: &mut Vec<u64> = sets[family].entry(key).or_default();
        lengths.push(rest(ends).to_bits());
    };
    for h in mesh.edges() {
        add(0, [mesh.origin(h), mesh.target(h)]);
        if let Some(pair) = mesh.pair(h) {
            add(1, [h, pair].map(|h| mesh.origin(h.prev())));
        }
    }
    sets
}

/// The ends of the constraints that the cloth has, with their numbers as bits.
fn found(cloth: &Cloth) -> [BTreeMap<[usize; 2], Vec<u64>>; 2] {
    [cloth.system().stretches(), cloth.system().bends()].map(|family| {
        let mut set: BTreeMap<_, Vec<u64>> = BTreeMap::new();
        for id in family.iter() {
            let constraint = family.get(id);
            let mut key = constraint.ends;
            key.sort_unstable();
            set.entry(key)
                .or_default()
                .push(constraint.rest_length_m.to_bits());
        }
        set
    })
}

/// Everything that holds of a cloth at all times.
fn check(mesh: &Mesh, cloth: &Cloth, bends: bool) {
    assert_eq!(cloth.indices(), mesh.indices());
    let system = cloth.system();
    assert_eq!(system.positions().len(), mesh.vertex_count());
    let [mut edges, mut across] = expected(mesh, cloth);
    let [mut have, mut have_across] = found(cloth);
    // The last bit of a length depends on which end comes first.
    let close = |set: &mut BTreeMap<[usize; 2], Vec<u64>>| {
        for lengths in set.values_mut() {
            for bits in lengths.iter_mut() {
                *bits = (f64::from_bits(*bits) * 1e9).round() as u64;
            }
            lengths.sort_unstable();
        }
    };
    [&mut edges, &mut across, &mut have, &mut have_across]
        .into_iter()
        .for_each(close);
    assert_eq!(have, edges, "stretch constraints");
    if bends {
        assert_eq!(have_across, across, "bend constraints");
    }
    for h in mesh.half_edges() {
        let constraint = system.stretches().get(cloth.stretch(h));
        let mut ends = [mesh.origin(h), mesh.target(h)].map(VertexId::index);
        let mut given = constraint.ends;
        ends.sort_unstable();
        given.sort_unstable();
        assert_eq!(given, ends, "the constraint of {h}");
        let edge = cloth.edge(cloth.stretch(h));
        assert!(
            edge == h || Some(edge) == mesh.pair(h),
            "the edge of the constraint of {h}"
        );
    }
    for v in mesh.vertices() {
        let mass = cloth.masses().at(v).max(cloth.masses().unit());
        assert_eq!(system.masses()[v.index()], mass);
        let inverse = if system.is_held(v.index()) {
            0.0
        } else {
            1.0 / mass
        };
        assert_eq!(system.inverse_masses()[v.index()], inverse);
    }
    assert!(cloth.masses().ledger().is_balanced());
}

/// Triangles, bit for bit those of a cloth that is made anew of the mesh and the rest positions;
/// and by definition: at rest warp and weft are unit vectors in the face, warp along the
/// projection of its direction. Returns how many there are.
fn check_triangles(mesh: &Mesh, cloth: &Cloth, fabric: Fabric) -> usize {
    let Some(weave) = fabric.weave else {
        assert!(cloth.system().triangles().is_empty());
        assert_eq!(cloth.system().counters().features.triangle, 0);
        return 0;
    };
    let (rest, masses) = (cloth.rest_positions(), cloth.masses().clone());
    let triangles = cloth.system().triangles();
    let anew = Cloth::new(mesh, rest, masses, fabric).expect("a cloth made anew");
    assert_eq!(triangles, anew.system().triangles());
    assert_eq!(triangles.len(), mesh.face_count());
    for (f, triangle) in mesh.faces().zip(triangles) {
        let corners = mesh.face_vertices(f);
        assert_eq!(triangle.vertices, corners.map(|v| v.index() as u32));
        let [p, q, r] = corners.map(|v| rest.at(v));
        let normal = (q - p).cross(&(r - p));
        near(triangle.area, 0.5 * normal.norm(), 1e-12);
        let normal = normal.normalize();
        let warp = (weave.warp - normal * weave.warp.dot(&normal)).normalize();
        let [w_u, w_v] = triangle.derivatives([p, q, r]);
        assert!((w_u - warp).norm() < 1e-9, "{w_u} {warp}");
        assert!((w_v - normal.cross(&warp)).norm() < 1e-9);
    }
    triangles.len()
}

/// Bends, bit for bit those of a cloth that is made anew of the mesh and the rest positions.
fn check_bends(mesh: &Mesh, cloth: &Cloth, fabric: Fabric) -> usize {
    let (rest, masses) = (cloth.rest_positions(), cloth.masses().clone());
    let anew = Cloth::new(mesh, rest, masses, fabric).expect("a cloth made anew");
    let all = |cloth: &Cloth| {
        let bends = cloth.system().bends();
        let of = |id| {
            let Constraint {
                mut ends,
                rest_length_m,
                stiffness_n_per_m,
            } = bends.get(id);
            ends.sort_unstable();
            (ends, rest_length_m.to_bits(), stiffness_n_per_m.to_bits())
        };
        let mut all: Vec<_> = bends.iter().map(of).collect();
        all.sort_unstable();
        all
    };
    assert_eq!(all(cloth), all(&anew));
    all(cloth).len()
}

/// Stretch constraints of a membrane, bit for bit those of a cloth that is made anew of the mesh and the
/// rest positions; and by definition: Σ k l² over all edges is three times modulus times area.
fn check_membrane(mesh: &Mesh, cloth: &Cloth, fabric: Fabric) -> usize {
    let Stretch::Membrane { modulus_n_per_m } = fabric.stretch else {
        return 0;
    };
    let (rest, masses) = (cloth.rest_positions(), cloth.masses().clone());
    let anew = Cloth::new(mesh, rest, masses, fabric).expect("a cloth made anew");
    let of = |cloth: &Cloth, h| cloth.system().stretches().get(cloth.stretch(h));
    let mut sum = 0.0;
    for h in mesh.edges() {
        let (one, other) = (of(cloth, h), of(&anew, h));
        let [k, anew] = [one, other].map(|one| one.stiffness_n_per_m.to_bits());
        assert_eq!(k, anew, "{h}: {one:?} {other:?}");
        sum += one.stiffness_n_per_m * one.rest_length_m * one.rest_length_m;
    }
    let area = |f| {
        let [p, q, r] = mesh.face_vertices(f).map(|v| rest.at(v));
        0.5 * (q - p).cross(&(r - p)).norm()
    };
    let area: f64 = mesh.faces().map(area).sum();
    near(sum, 3.0 * modulus_n_per_m * area, 1e-11 * sum);
    mesh.edges().count()
}

fn fabric(copies: Copies, unbend: Unbend, bend: bool) -> Fabric {
    Fabric {
        bend: bend.then_some(Bending::Spring {
            stiffness_n_per_m: 3.0,
        }),
        unbend,
        ..of_edges(50.0, copies)
    }
}

/// A cloth in motion, strained and shaken.
fn shaken(
    mesh: &Mesh,
    positions: &tearmesh::Positions,
    fabric: Fabric,
    random: &mut Random,
) -> Cloth {
    let mut cloth = cloth(mesh, positions, fabric);
    let system = cloth.system_mut();
    system.set_loads(gravity(0.0)).expect("loads");
    system.when_unstable(Unstable::Substep);
    let (points, velocities) = system.state_mut();
    for (p, v) in points.iter_mut().zip(velocities) {
        let mut next = || random.next() - 0.5;
        *p += 0.02 * Vector::new(next(), next(), next());
        *v = Vector::new(next(), next(), next());
    }
    cloth
}

enum Done {
    Nothing,
    Split,
    Insert,
    Merge,
    Slide,
}

/// One random edit.
fn edit(mesh: &mut Mesh, cloth: &Cloth, edits: &mut Edits, random: &mut Random) -> Done {
    match random.below(6) {
        0 | 1 => {
            let v = VertexId::new(random.below(mesh.vertex_count())).expect("a vertex");
            let faces: Vec<FaceId> = mesh.faces_of(v).filter(|_| random.below(2) == 0).collect();
            match split::vertex(mesh, v, &faces, edits) {
                Ok(_) => Done::Split,
                Err(_) => Done::Nothing,
            }
        }
        2 => {
            let mut plan = Plan::new();
            let h = mesh
                .half_edges()
                .nth(random.below(mesh.half_edge_count()))
                .expect("a half-edge");
            plan.on_edge(h, 0.2 + 0.6 * random.below(1000) as f64 / 1000.0);
            if random.below(2) == 0 {
                let f = mesh
                    .faces()
                    .nth(random.below(mesh.face_count()))
                    .expect("a face");
                plan.in_face(f, [0.2, 0.3, 0.5]);
            }
            match plan.apply(mesh, edits) {
                Ok(_) => Done::Insert,
                Err(_) => Done::Nothing,
            }
        }
        3 => {
            let h = mesh
                .half_edges()
                .nth(random.below(mesh.half_edge_count()))
                .expect("a half-edge");
            let t = 0.01 + 0.2 * random.below(1000) as f64 / 1000.0;
            slide::toward(mesh, mesh.origin(h), mesh.target(h), t, edits).expect("a slide");
            Done::Slide
        }
        _ => {
            let stitches = mend::stitches(mesh, |_| true);
            if stitches.is_empty() {
                return Done::Nothing;
            }
            let stitch = stitches[random.below(stitches.len())];
            let weights = [stitch.kept(), stitch.gone()].map(|v| cloth.masses().at(v));
            match mend::merge(mesh, stitch.kept(), stitch.gone(), weights, edits) {
                Ok(_) => Done::Merge,
                Err(_) => Done::Nothing,
            }
        }
    }
}

#[test]
fn a_running_cloth_follows_every_edit_as_if_made_anew() {
    let mut counts = [0; 4];
    let (mut triangles, mut bends, mut edges) = (0, 0, 0);
    for seed in 0..130 {
        let mut random = Random(seed);
        let (mut mesh, positions) = match seed % 4 {
            0 => shapes::grid(3, 3),
            1 => shapes::fan(7, true),
            2 => shapes::tube(4, 3),
            _ => shapes::octahedron(),
        };
        let copies = if seed % 3 == 0 {
            Copies::Whole
        } else {
            Copies::Halved
        };
        let with_bends = seed % 5 < 3;
        let unbend = if seed % 5 == 2 {
            Unbend::Vertex
        } else {
            Unbend::Seam
        };
        let mut fabric = fabric(copies, unbend, with_bends);
        // Thirty are of triangles, every second of them without springs along edges.
        if (60..90).contains(&seed) {
            fabric.weave = Some(Weave {
                warp_n_per_m: 60.0,
                weft_n_per_m: 35.0,
                shear_n_per_m: 4.0,
                warp: Vector::new(1.0, 0.3, 0.15),
            });
            if seed % 2 == 1 {
                fabric.stretch = Stretch::Slack;
            }
        }
        // Every third is a membrane.
        if seed % 3 == 1 && fabric.stretch != Stretch::Slack {
            fabric.stretch = Fabric::new(50.0).stretch;
        }
        // The last forty buckle where they bend.
        if seed >= 90 && with_bends {
            fabric.bend = Some(Bending::Buckling {
                rigidity_n_m: 1e-2,
                law: tearmesh_cloth::Buckling::new(0.6 + 0.01 * (seed - 90) as f64).expect("a law"),
            });
        }
        let triangles_alone = fabric.stretch == Stretch::Slack && !with_bends;
        let mut cloth = shaken(&mesh, &positions, fabric, &mut random);
        let check =
            |mesh: &Mesh, cloth: &Cloth| check(mesh, cloth, with_bends && unbend == Unbend::Seam);
        check(&mesh, &cloth);
        let mut edits = Edits::new();
        for _ in 0..40 {
            let elastic = energy::elastic_j(cloth.system());
            let moving = momentum(&cloth);
            let done = edit(&mut mesh, &cloth, &mut edits, &mut random);
            edits.replay(&mut cloth);
            check(&mesh, &cloth);
            triangles += check_triangles(&mesh, &cloth, fabric);
            edges += check_membrane(&mesh, &cloth, fabric);
            if with_bends && unbend == Unbend::Seam {
                bends += check_bends(&mesh, &cloth, fabric);
            }
            let now = momentum(&cloth);
            match done {
                Done::Nothing => continue,
                Done::Split => {
                    counts[0] += 1;
                    assert_eq!(now, moving, "a split keeps momentum bit for bit");
                    if copies == Copies::Halved && !with_bends {
                        let now = energy::elastic_j(cloth.system());
                        near(now, elastic, 1e-12 * (1.0 + elastic));
                    }
                    if triangles_alone {
                        assert_eq!(energy::elastic_j(cloth.system()), elastic);
                    }
                }
                Done::Insert => {
                    counts[1] += 1;
                    if triangles_alone {
                        near(energy::elastic_j(cloth.system()), elastic, 1e-11 * elastic);
                    }
                }
                Done::Merge => counts[2] += 1,
                Done::Slide => {
                    counts[3] += 1;
                    assert_eq!(now, moving, "a slide keeps momentum bit for bit");
                }
            }
            for (now, moving) in now.iter().zip(&moving) {
                near(now.to_f64(), moving.to_f64(), 1e-15);
            }

            // The bound holds for the cloth as it is now.
            let known = frequency_bound(cloth.system_mut()).omega_rad_per_s;
            let shape = |i: usize| Vector::new(1.0, -1.0, 0.3) * [1.0, -1.0, 0.5][i % 3];
            let shapes: Vec<Vector> = (0..mesh.vertex_count()).map(shape).collect();
            assert!(rayleigh_quotient(cloth.system(), &shapes) <= known * known);
            if random.next() < 0.3 {
                if fabric.weave.is_some() || matches!(fabric.bend, Some(Bending::Buckling { .. })) {
                    cloth.step(&mut Rk4::new(), 1e-3).expect("a step");
                } else {
                    cloth.step(&mut Xpbd::new(1, 1), 1e-3).expect("a step");
                }
                check(&mesh, &cloth);
            }
        }
        cloth.system_mut().when_unstable(Unstable::Substep);
        assert!(mesh.check().is_empty());
    }
    println!(
        "{counts:?} splits, insertions, merges and slides; {triangles} triangles, {bends} bends and {edges} \
         edges of membranes seen"
    );
    assert!(edges > 10_000, "{edges}");
    assert!(triangles > 10_000 && bends > 10_000, "{triangles} {bends}");
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
}

#[test]
fn pieces_of_a_face_without_area_fall_and_meet_again() {
    // The second face is on a line, and weighs three units; its three pieces have nine corners.
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [2.0, -1.0, 0.0],
    ];
    let mut mesh = Mesh::build(4, &[[0, 1, 2], [2, 1, 3]]).expect("a strip");
    let positions = tearmesh::Positions::new(points).expect("numbers");
    let mut cloth = cloth(&mesh, &positions, Fabric::new(50.0));
    let mut edits = Edits::new();
    let [a, b] = [2, 3].map(|v| VertexId::new(v).expect("a vertex"));
    let long = mesh.half_edges().find(|&h| {
        let ends = [mesh.origin(h), mesh.target(h)];
        ends == [a, b] || ends == [b, a]
    });
    let mut plan = Plan::new();
    plan.on_edge(long.expect("the long edge"), 0.4);
    plan.on_edge(long.expect("the long edge"), 0.7);
    plan.apply(&mut mesh, &mut edits).expect("an insertion");
    edits.replay(&mut cloth);
    loop {
        let fan = |v: &VertexId| mesh.faces_of(*v).count() > 1;
        let Some(v) = mesh.vertices().find(fan) else {
            break;
        };
        let face = mesh.faces_of(v).next().expect("a face");
        split::vertex(&mut mesh, v, &[face], &mut edits).expect("a split");
        edits.replay(&mut cloth);
    }
    let light = mesh.vertices().filter(|&v| cloth.masses().at(v) == 0.0);
    assert!(light.count() > 1, "the pieces have nothing to weigh");
    assert!(cloth.masses().ledger().is_balanced());
    let unit = cloth.masses().unit();
    let mut particles = cloth.system().masses().iter();
    assert!(particles.all(|&mass| mass >= unit));

    cloth.system_mut().set_loads(gravity(0.0)).expect("loads");
    cloth.step(&mut Xpbd::new(1, 1), 0.01).expect("a step");
    for x in cloth.positions() {
        near(x.z, -9.81e-4, 1e-9);
    }
    // Two that weigh nothing have no velocity in common, if theirs are weighed by masses.
    let (_, velocities) = cloth.system_mut().state_mut();
    for (speed, v) in (0..).zip(velocities) {
        v.z = f64::from(speed);
    }
    let stitches = mend::stitches(&mesh, |_| true);
    let masses = cloth.masses().clone();
    let weight = |v| masses.at(v);
    mend::sew(&mut mesh, &cloth, &stitches, weight, 1.0, &mut edits).expect("copies");
    edits.replay(&mut cloth);
    assert_eq!(mesh.vertex_count(), 6);
    assert!(cloth.system().velocities().iter().all(|v| v.norm() < 10.0));
}

#[test]
fn a_split_by_halves_makes_no_energy_and_the_papers_says_how_much_it_makes() {
    let (mesh, positions) = shapes::grid(6, 6);
    for (copies, unbend) in [
        (Copies::Halved, Unbend::Seam),
        (Copies::Whole, Unbend::Vertex),
    ] {
        let mut mesh = mesh.clone();
        let mut cloth = shaken(
            &mesh,
            &positions,
            fabric(copies, unbend, false),
            &mut Random(1),
        );
        let v = VertexId::new(24).expect("the centre");
        let faces: Vec<FaceId> = mesh.faces_of(v).take(3).collect();
        let mut edits = Edits::new();
        let before = energy::elastic_j(cloth.system());
        let bound = frequency_bound(cloth.system_mut()).omega_rad_per_s;
        let torn: Vec<_> = {
            let split = split::vertex(&mut mesh, v, &faces, &mut edits).expect("a split");
            split.torn.to_vec()
        };
        let extension = |cloth: &Cloth, h| {
            let constraint = cloth.system().stretches().get(cloth.stretch(h));
            cloth.system().stretch_ratio(cloth.stretch(h)) * constraint.rest_length_m
                - constraint.rest_length_m
        };
        let made: f64 = torn
            .iter()
            .map(|link| 25.0 * extension(&cloth, link.stayed).powi(2))
            .sum();
        edits.replay(&mut cloth);
        assert_eq!(torn.len(), 2);
        assert!(made > 1e-6);
        let stiffness = |h| {
            cloth
                .system()
                .stretches()
                .get(cloth.stretch(h))
                .stiffness_n_per_m
        };
        for link in torn {
            let each = if copies == Copies::Halved { 25.0 } else { 50.0 };
            assert_eq!(
                (stiffness(link.stayed), stiffness(link.moved)),
                (each, each)
            );
        }
        let answer = if copies == Copies::Halved { 0.0 } else { made };
        near(energy::elastic_j(cloth.system()) - before, answer, 1e-13);
        // Particles are lighter, and the bound of frequencies knows.
        assert!(frequency_bound(cloth.system_mut()).omega_rad_per_s >= bound);
    }
}

#[test]
fn a_merge_undoes_a_split_and_pins_are_inherited() {
    let (mut mesh, positions) = shapes::grid(4, 4);
    for copies in [Copies::Halved, Copies::Whole] {
        let fabric = fabric(copies, Unbend::Seam, true);
        let mut cloth = cloth(&mesh, &positions, fabric);
        cloth.system_mut().hold(12);
        let sets = |cloth: &Cloth| {
            [cloth.system().stretches(), cloth.system().bends()].map(|family| {
                let mut all: Vec<_> = family
                    .iter()
                    .map(|id| {
                        let constraint = family.get(id);
                        let mut ends = constraint.ends;
                        ends.sort_unstable();
                        (ends, constraint.stiffness_n_per_m.to_bits())
                    })
                    .collect();
                all.sort_unstable();
                all
            })
        };
        let before = sets(&cloth);
        let mut edits = Edits::new();
        let v = VertexId::new(12).expect("the centre");
        let faces: Vec<FaceId> = mesh.faces_of(v).take(2).collect();
        let new = split::vertex(&mut mesh, v, &faces, &mut edits)
            .expect("a split")
            .new;
        edits.replay(&mut cloth);
        assert!(cloth.system().is_held(new.index()));
        assert_eq!(
            (
                cloth.free_mass(new),
                cloth
                    .free_mass(VertexId::new(0).expect("a vertex"))
                    .is_some()
            ),
            (None, true)
        );
        assert_ne!(sets(&cloth), before);
        mend::merge(&mut mesh, v, new, [1.0, 1.0], &mut edits).expect("a merge");
        edits.replay(&mut cloth);
        assert_eq!(sets(&cloth), before);
    }
}

#[test]
fn a_pin_stays_where_it_is_when_a_free_copy_is_sewn_to_it() {
    let (mut mesh, positions) = shapes::grid(2, 2);
    let mut cloth = cloth(&mesh, &positions, Fabric::new(5.0));
    let v = VertexId::new(4).expect("the centre");
    let mut edits = Edits::new();
    let faces: Vec<FaceId> = mesh.faces_of(v).take(3).collect();
    let new = split::vertex(&mut mesh, v, &faces, &mut edits)
        .expect("a split")
        .new;
    edits.replay(&mut cloth);
    let pin = cloth.at(new);
    cloth.system_mut().hold(new.index());
    let (points, _) = cloth.system_mut().state_mut();
    points[v.index()] += Vector::new(0.0, 0.0, 2.0);
    mend::merge(&mut mesh, v, new, [1.0, 1.0], &mut edits).expect("a merge");
    edits.replay(&mut cloth);
    assert!(cloth.system().is_held(v.index()));
    assert_eq!(cloth.at(v), pin);
}

#[test]
#[should_panic(expected = "the constraints of a cloth follow its mesh")]
fn a_cloth_takes_no_constraint_from_elsewhere() {
    let (mesh, positions) = shapes::grid(2, 2);
    let mut cloth = cloth(&mesh, &positions, Fabric::new(5.0));
    let _ = cloth.system_mut().bend([0, 2], 0.5, 1.0);
}

#[test]
fn a_cloth_that_cannot_be_is_refused_with_ids() {
    let (mesh, positions) = shapes::grid(1, 1);
    let masses = Masses::area(&mesh, &positions, 1.0).expect("masses");
    let error =
        Cloth::new(&mesh, &positions, masses.clone(), Fabric::new(-1.0)).expect_err("no stiffness");
    assert_eq!(
        error.to_string(),
        "modulus_n_per_m is -1, which makes no positive finite stiffness"
    );
    let twice = [
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    let twice = tearmesh::Positions::new(twice).expect("positions");
    let error = Cloth::new(&mesh, &twice, masses.clone(), Fabric::new(1.0)).expect_err("one place");
    assert!(
        error.to_string().ends_with("has the rest length 0 m"),
        "{error}"
    );
    let few = tearmesh::Positions::new([[0.0; 3]]).expect("positions");
    let error = Cloth::new(&mesh, &few, masses, Fabric::new(1.0)).expect_err("too few");
    assert_eq!(
        error.to_string(),
        "there are 1 positions and 4 masses for 4 vertices"
    );
}
