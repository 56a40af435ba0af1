//! A cloth that is split, subdivided, torn and sewn while it moves is the cloth that one would make anew.

use tearmesh::insert::Plan;
use tearmesh::{
    Edit, Edits, FaceId, HalfEdgeId, Masses, Mesh, PerVertex, Point, Positions, TornLink, Vector,
    VertexId, mend, shapes, split,
};
use tearmesh_cloth::{
    BendRemoval, Bending, Buckling, Cloth, Constraint, Fabric, Frequency, Stretch, Tear, Tearing,
    Threshold, TornStiffness, Unstable, Verlet, Xpbd, energy, frequency_bound, recommended_step_s,
};

use crate::parts::cloths::{Done, bent, cloth, edit, momentum, of_edges, split_off};
use crate::parts::vibration::rayleigh_quotient;
use crate::parts::woven::of_moduli;
use crate::parts::{gravity, method, near, shake, state, v};
use crate::random::Random;

/// The ends of a constraint with its rest length, but for the last bits, which depend on the end that
/// comes first.
type Ends = ([usize; 2], u64);

fn ends(mut ends: [usize; 2], rest_m: f64) -> Ends {
    ends.sort_unstable();
    (ends, (rest_m * 1e9).round() as u64)
}

/// Edges, and apexes across edges: what a cloth must have. The faces of an edge disagree on its length where
/// copies slid apart before they were sewn.
fn expected(mesh: &Mesh, cloth: &Cloth) -> [Vec<Ends>; 2] {
    let rest = |h: HalfEdgeId| cloth.rest_corners()[h.index()];
    let of = |vs: [VertexId; 2], rest_m| ends(vs.map(VertexId::index), rest_m);
    let edges = mesh.edges().map(|h| {
        let sides = [Some(h), mesh.pair(h)].into_iter().flatten();
        let sides = sides.map(|h| flat([h, h.next(), h.prev()].map(rest)));
        let lengths: Vec<f64> = sides.clone().map(|[length, ..]| length).collect();
        // Two springs side by side.
        let stiff = sides.map(|[length, _, height]| [height / length, height]);
        let [k, kl] = stiff.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
        let is_one = lengths.iter().all(|length| *length == lengths[0]);
        let length = if is_one { lengths[0] } else { kl / k };
        of([mesh.origin(h), mesh.target(h)], length)
    });
    let across = mesh.edges().filter_map(|h| Some([h, mesh.pair(h)?]));
    let across = across.map(|both| {
        let [one, other] = both.map(|h| [h, h.next(), h.prev()].map(rest));
        let apart = (one[0], one[1]) != (other[1], other[0]);
        let [[_, x, y], [_, u, v]] = [one, other].map(flat);
        let length = if apart {
            (x + u).hypot(y + v)
        } else {
            (other[2] - one[2]).norm()
        };
        of(both.map(|h| mesh.origin(h.prev())), length)
    });
    [edges.collect(), across.collect()]
}

/// Of a triangle at rest: the length of its first side, where its third corner lies along that, from the
/// middle on, and its height over it.
fn flat([a, b, c]: [Point; 3]) -> [f64; 3] {
    let (along, up) = (b - a, c - a);
    let length = along.norm();
    let ahead = along.dot(&up) / length - 0.5 * length;
    [length, ahead, along.cross(&up).norm() / length]
}

/// Everything that holds of a cloth at all times.
pub(crate) fn check(mesh: &Mesh, cloth: &Cloth, bends: bool) {
    assert_eq!(cloth.indices(), mesh.indices());
    let system = cloth.system();
    assert_eq!(system.positions().len(), mesh.vertex_count());
    let families = [system.stretches(), system.bends()].into_iter();
    let compared = families.zip(expected(mesh, cloth));
    for (family, mut expected) in compared.take(1 + usize::from(bends)) {
        let of = |id| ends(family.get(id).ends, family.get(id).rest_length_m);
        let mut found: Vec<Ends> = family.iter().map(of).collect();
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected);
    }
    for h in mesh.half_edges() {
        let id = cloth.stretch(h);
        let vertices = [mesh.origin(h), mesh.target(h)].map(VertexId::index);
        let found = ends(system.stretches().get(id).ends, 0.0);
        assert_eq!(found, ends(vertices, 0.0), "{h}");
        assert!([Some(h), mesh.pair(h)].contains(&Some(cloth.edge(id))));
    }
    for v in mesh.vertices() {
        let mass = cloth.masses().at(v).max(cloth.masses().unit());
        let is_free = f64::from(u8::from(!system.is_held(v.index())));
        assert_eq!(system.masses()[v.index()], mass);
        assert_eq!(system.inverse_masses()[v.index()], is_free / mass);
    }
    assert!(cloth.masses().ledger().is_balanced());
}

/// What of a cloth is, bit for bit, that of one which is made anew of the mesh and the rest positions: its
/// triangles, the stretch constraints of a membrane, and bends if asked for. Returns how many there are.
pub(crate) fn check_anew(mesh: &Mesh, cloth: &Cloth, fabric: Fabric, bends: bool) -> [usize; 3] {
    let (corners, masses) = (cloth.rest_corners().to_vec(), cloth.masses().clone());
    let corner = |h: HalfEdgeId| cloth.rest_corners()[h.index()];
    let rest = |f: FaceId| f.half_edges().map(corner);
    let now = Positions::new(cloth.positions().to_vec()).expect("finite");
    let mut anew =
        Cloth::with_rest(mesh, &now, corners, masses, fabric).expect("a cloth made anew");
    let mut damped = cloth.clone();
    for cloth in [&mut damped, &mut anew] {
        frequency_bound(cloth.system_mut()); // Which has its triangles damped.
    }
    let [triangles, others] = [&damped, &anew].map(|cloth| cloth.system().triangles());
    assert_eq!(triangles, others);
    let woven = fabric.orthotropic.map_or(0, |_| mesh.face_count());
    assert_eq!(triangles.len(), woven);
    let counted = cloth.system().counters().features.triangle;
    assert!(fabric.orthotropic.is_some() || counted == 0);
    let double_area = |[p, q, r]: [Point; 3]| (q - p).cross(&(r - p));
    // By definition: at rest warp and weft are unit vectors in the face, warp along the projection of its
    // direction.
    for (f, triangle) in mesh.faces().zip(triangles) {
        let (corners, weave) = (mesh.face_vertices(f), fabric.orthotropic.expect("a weave"));
        assert_eq!(triangle.vertices, corners.map(|v| v.index() as u32));
        let normal = double_area(rest(f));
        near(triangle.area, 0.5 * normal.norm(), 1e-12);
        let normal = normal.normalize();
        let warp = (weave.warp - normal * weave.warp.dot(&normal)).normalize();
        let [w_u, w_v] = triangle.derivatives(rest(f));
        near((w_u - warp).norm(), 0.0, 1e-9);
        near((w_v - normal.cross(&warp)).norm(), 0.0, 1e-9);
    }
    let mut edges = 0;
    if let Stretch::Membrane { modulus_n_per_m } = fabric.stretch {
        // By definition: Σ k l² over all edges is three times modulus times area.
        let mut sum = 0.0;
        for h in mesh.edges() {
            let of = |cloth: &Cloth| cloth.system().stretches().get(cloth.stretch(h));
            let (one, other) = (of(cloth), of(&anew));
            assert_eq!(one.stiffness_n_per_m, other.stiffness_n_per_m, "{h}");
            let tension_n = one.stiffness_n_per_m * one.rest_length_m;
            let sides = [Some(h), mesh.pair(h)].into_iter().flatten();
            let sides = sides.map(|h| flat([h, h.next(), h.prev()].map(corner)));
            let sides: Vec<[f64; 3]> = sides.collect();
            if sides.iter().all(|side| side[0] == sides[0][0]) {
                sum += tension_n * one.rest_length_m;
            } else {
                let half_n = |side: &[f64; 3]| 0.5 * modulus_n_per_m * side[2];
                near(tension_n, sides.iter().map(half_n).sum(), 1e-9 * tension_n);
                sum += sides.iter().map(|side| half_n(side) * side[0]).sum::<f64>();
            }
            edges += 1;
        }
        let areas = mesh.faces().map(|f| 0.5 * double_area(rest(f)).norm());
        near(sum, 3.0 * modulus_n_per_m * areas.sum::<f64>(), 1e-11 * sum);
    }
    let mut count = 0;
    if bends {
        count = cloth.system().bends().len();
        assert_eq!(bends_of(cloth), bends_of(&anew));
    }
    [triangles.len(), edges, count]
}

/// The ends of bends, and their numbers as bits.
fn bends_of(cloth: &Cloth) -> Vec<([usize; 2], [u64; 2])> {
    let bends = cloth.system().bends();
    let of = |id| {
        let mut bend = bends.get(id);
        bend.ends.sort_unstable();
        let numbers = [bend.rest_length_m, bend.stiffness_n_per_m];
        (bend.ends, numbers.map(f64::to_bits))
    };
    let mut all: Vec<_> = bends.iter().map(of).collect();
    all.sort_unstable();
    all
}

fn fabric(torn: TornStiffness, bend_removal: BendRemoval, bend: bool) -> Fabric {
    let edges = of_edges(50.0, torn);
    let fabric = if bend { bent(edges, 3.0) } else { edges };
    Fabric {
        bend_removal,
        ..fabric
    }
}

/// What a cloth tears by, one split at a time, with strengths of its vertices; and what these must be: values that
/// nothing but the log touches.
fn tearing(mesh: &Mesh, cloth: &Cloth, seed: u64) -> (Tear, PerVertex<f64>) {
    let tearing = Tearing {
        splits_per_step_max: Some(1),
        weakening: (!seed.is_multiple_of(3)).then_some(0.7),
        ..Tearing::new(match seed % 5 {
            0 => Threshold::Stretch(1.2),
            1 => Threshold::Toughness(0.15),
            2 => Threshold::Force(1.0),
            3 => Threshold::PrincipalStretch(1.2),
            _ => Threshold::WarpWeft {
                warp: 1.2,
                weft: 1.3,
                axis: Vector::x(),
            },
        })
    };
    let mut random = Random(1000 + seed);
    let strengths: Vec<f64> = mesh.vertices().map(|_| 0.7 + 0.6 * random.next()).collect();
    let tear = Tear::new(cloth, tearing).expect("a tear");
    let tear = tear.with_strengths(strengths.clone());
    (tear.expect("strengths"), PerVertex::new(strengths))
}

/// A cloth in motion, strained and shaken.
fn shaken(mesh: &Mesh, positions: &Positions, fabric: Fabric, random: &mut Random) -> Cloth {
    let mut cloth = cloth(mesh, positions, fabric);
    let system = cloth.system_mut();
    system.set_loads(gravity(0.0)).expect("loads");
    system.when_unstable(Unstable::Substep);
    shake(system, 0.02, 1.0, random);
    cloth
}

/// The energy of a stretch constraint, in joules.
fn stretch_j(cloth: &Cloth, h: HalfEdgeId) -> f64 {
    let (id, springs) = (cloth.stretch(h), cloth.system().stretches());
    let (link, ratio) = (springs.get(id), cloth.system().stretch_ratio(id));
    0.5 * link.stiffness_n_per_m * ((ratio - 1.0) * link.rest_length_m).powi(2)
}

/// The energy of each link that the last record tears, in joules, by a cloth that has not followed it.
fn torn_j(cloth: &Cloth, edits: &Edits) -> Vec<f64> {
    let Some(Edit::Split(split)) = edits.iter().next_back() else {
        return Vec::new();
    };
    let of = |link: &TornLink| stretch_j(cloth, link.stayed);
    split.torn.iter().map(of).collect()
}

/// What the last record made, by a cloth that has followed it and what its links stored before. By halves that is
/// nothing, and by whole copies as much again. Sides that disagree on the length of an edge strained each other in
/// it, which shows once they part.
fn made_j(cloth: &Cloth, edits: &Edits, before: &[f64], torn: TornStiffness) -> f64 {
    let Some(Edit::Split(split)) = edits.iter().next_back() else {
        return 0.0;
    };
    let rest = |h: HalfEdgeId| cloth.rest_corners()[h.index()];
    let of = |(link, &before_j): (&TornLink, &f64)| {
        let sides = [link.stayed, link.moved];
        let [one, other] = sides.map(|h| (rest(h.next()) - rest(h)).norm());
        match torn {
            _ if one != other => sides.map(|h| stretch_j(cloth, h)).iter().sum::<f64>() - before_j,
            TornStiffness::Whole => before_j,
            TornStiffness::Halved => 0.0,
            _ => unreachable!("there is no other kind"),
        }
    };
    split.torn.iter().zip(before).map(of).sum()
}

/// A copy of a cloth that takes in all of its constraints anew before its next step.
fn taken_in_anew(cloth: &Cloth) -> Cloth {
    let mut anew = cloth.clone();
    let damping_s = anew.system().damping_s();
    anew.system_mut().set_damping(damping_s).expect("usable");
    anew
}

/// All that steps go by, as far as it shows: the bound of frequencies, and a step of velocity Verlet that is so long
/// that some particles are carried.
fn shown(mut cloth: Cloth) -> (Frequency, bool, (Vec<Point>, Vec<Vector>)) {
    let system = cloth.system_mut();
    let bound = frequency_bound(system);
    system.when_unstable(Unstable::Allow);
    let is_taken = system.step(&mut Verlet, 3.0 / bound.omega_rad_per_s);
    (bound, is_taken.is_ok(), state(system))
}

/// By halves a split makes no energy, and by whole copies what the torn links store.
#[test]
fn a_running_cloth_follows_every_edit_as_if_made_anew() {
    let (mut counts, mut seen, mut tears) = ([0; 5], [0; 3], 0);
    for seed in 0..130 {
        let mut random = Random(seed);
        let (mut mesh, positions) = match seed % 4 {
            0 => shapes::grid(3, 3),
            1 => shapes::fan(7, true),
            2 => shapes::tube(4, 3),
            _ => shapes::octahedron(),
        };
        let copies = [
            TornStiffness::Whole,
            TornStiffness::Halved,
            TornStiffness::Halved,
        ][seed as usize % 3];
        let with_bends = seed % 5 < 3;
        let unbend = [BendRemoval::Seam, BendRemoval::Vertex][usize::from(seed % 5 == 2)];
        let bends = with_bends && unbend == BendRemoval::Seam;
        let mut fabric = fabric(copies, unbend, with_bends);
        // Thirty are of triangles, every second of them without springs along edges.
        if (60..90).contains(&seed) {
            let warp = Vector::new(1.0, 0.3, 0.15);
            fabric.orthotropic = Some(of_moduli([60.0, 35.0, 4.0], warp));
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
                law: Buckling::new(0.6 + 0.01 * (seed - 90) as f64).expect("a law"),
            });
        }
        fabric.damping_s = [0.0, 2e-3, 0.1][seed as usize % 3];
        let triangles_alone = fabric.stretch == Stretch::Slack && !with_bends;
        let mut cloth = shaken(&mesh, &positions, fabric, &mut random);
        let mut suited_s = recommended_step_s(cloth.system_mut());
        check(&mesh, &cloth, bends);
        let (mut tear, mut strengths) = tearing(&mesh, &cloth, seed);
        let mut edits = Edits::new();
        edits.replay(&mut strengths);
        for _ in 0..40 {
            let elastic = energy::elastic_j(cloth.system());
            let moving = momentum(&cloth);
            let done = edit(&mut mesh, &cloth, &mut edits, &mut random);
            let before = torn_j(&cloth, &edits);
            edits.replay(&mut cloth);
            check(&mesh, &cloth, bends);
            let checked = check_anew(&mesh, &cloth, fabric, bends);
            seen = [0, 1, 2].map(|i| seen[i] + checked[i]);
            counts[done as usize] += 1;
            let now_j = energy::elastic_j(cloth.system());
            let now = momentum(&cloth);
            // Some keep momentum bit for bit.
            let is_exact = matches!(done, Done::Split | Done::Slide);
            assert!(!is_exact || now == moving);
            if done == Done::Nothing {
                continue;
            }
            if done == Done::Split && !with_bends {
                let made = made_j(&cloth, &edits, &before, copies);
                near(now_j, elastic + made, 1e-12 * (1.0 + elastic));
                assert!(!triangles_alone || now_j == elastic);
            }
            if done == Done::Insert && triangles_alone {
                near(now_j, elastic, 1e-11 * elastic);
            }
            for (now, moving) in now.iter().zip(&moving) {
                near(now.to_f64(), moving.to_f64(), 1e-15);
            }

            // What follows edits is what is summed up anew, to the bit; but the step that suits gets no shorter.
            let mut anew = taken_in_anew(&cloth);
            assert_eq!(shown(cloth.clone()), shown(anew.clone()), "{seed}");
            let mut held = cloth.clone();
            frequency_bound(held.system_mut());
            held.system_mut().hold(seed as usize % mesh.vertex_count());
            assert_eq!(shown(held.clone()), shown(taken_in_anew(&held)), "{seed}");
            suited_s = suited_s.max(recommended_step_s(anew.system_mut()));
            assert_eq!(recommended_step_s(cloth.system_mut()), suited_s, "{seed}");

            // The bound holds for the cloth as it is now.
            let known = frequency_bound(cloth.system_mut()).omega_rad_per_s;
            let shape = |i: usize| Vector::new(1.0, -1.0, 0.3) * [1.0, -1.0, 0.5][i % 3];
            let shapes: Vec<Vector> = (0..mesh.vertex_count()).map(shape).collect();
            assert!(rayleigh_quotient(cloth.system(), &shapes) <= known * known);
            if random.next() < 0.3 {
                let takes_springs_alone = fabric.orthotropic.is_none()
                    && !matches!(fabric.bend, Some(Bending::Buckling { .. }));
                let name = if takes_springs_alone { "XPBD" } else { "RK4" };
                let taken = cloth.step(&mut *method(name, 1), 1e-3);
                taken.expect("a step");
                check(&mesh, &cloth, bends);
            }
            let torn = tear.apply(&mut mesh, &mut cloth, &mut edits);
            assert!(torn.splits <= torn.overstretched.min(1));
            tears += torn.splits;
            check(&mesh, &cloth, bends);
            edits.replay(&mut strengths);
            let is_kept = |v: VertexId| tear.strength(v) == *strengths.at(v);
            assert!(mesh.vertices().all(is_kept));
        }
        assert!(mesh.check().is_empty());
    }
    assert!(seen.iter().all(|&seen| seen > 10_000), "{seen:?}");
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
    assert!(tears > 100, "{tears}");
}

/// What is in the log is seen first by the cloth, and by what knows how strong it is.
#[test]
fn a_cloth_that_is_behind_the_log_catches_up_before_it_tears() {
    let mut tears = 0;
    for seed in 0..20 {
        let mut random = Random(seed);
        let (mut mesh, positions) = shapes::grid(5, 5);
        let mut cloth = shaken(&mesh, &positions, Fabric::new(40.0), &mut random);
        let (x, _) = cloth.system_mut().state_mut();
        x.iter_mut().for_each(|p| p.x *= 1.5);
        let (mut tear, mut strengths) = tearing(&mesh, &cloth, seed);
        let mut edits = Edits::new();
        edits.replay(&mut strengths);
        for _ in 0..40 {
            edit(&mut mesh, &cloth, &mut edits, &mut random);
            tears += tear.apply(&mut mesh, &mut cloth, &mut edits).splits;
            check(&mesh, &cloth, false);
            edits.replay(&mut strengths);
            let is_kept = |v: VertexId| tear.strength(v) == *strengths.at(v);
            assert!(mesh.vertices().all(is_kept));
            edits.clear();
        }
    }
    assert!(tears > 100, "{tears}");
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
    let positions = Positions::new(points).expect("numbers");
    let mut cloth = cloth(&mesh, &positions, Fabric::new(50.0));
    let mut edits = Edits::new();
    let [a, b] = [2, 3].map(v);
    let is_long = |h: &HalfEdgeId| [mesh.origin(*h), mesh.target(*h)] == [b, a];
    let long = mesh.half_edges().find(is_long).expect("the long edge");
    let mut plan = Plan::new();
    plan.on_edge(long, 0.4);
    plan.on_edge(long, 0.7);
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
    let at = cloth.positions();
    mend::sew(&mut mesh, at, &stitches, weight, 1.0, &mut edits).expect("copies");
    edits.replay(&mut cloth);
    assert_eq!(mesh.vertex_count(), 6);
    assert!(cloth.system().velocities().iter().all(|v| v.norm() < 10.0));
}

#[test]
fn a_merge_undoes_a_split_and_pins_are_inherited() {
    let (mut mesh, positions) = shapes::grid(4, 4);
    for copies in [TornStiffness::Halved, TornStiffness::Whole] {
        let fabric = fabric(copies, BendRemoval::Seam, true);
        let mut cloth = cloth(&mesh, &positions, fabric);
        cloth.system_mut().hold(12);
        let sets = |cloth: &Cloth| {
            let springs = cloth.system().stretches();
            let springs = springs.iter().map(|id| springs.get(id));
            let of = |one: Constraint| (ends(one.ends, 0.0), one.stiffness_n_per_m.to_bits());
            let mut edges: Vec<_> = springs.map(of).collect();
            edges.sort_unstable();
            (edges, bends_of(cloth))
        };
        let before = sets(&cloth);
        let new = split_off(&mut mesh, &mut cloth, v(12), 2);
        assert!(cloth.system().is_held(new.index()) && !cloth.system().is_held(0));
        assert_ne!(sets(&cloth), before);
        let mut edits = Edits::starting_at(cloth.seen());
        mend::merge(&mut mesh, v(12), new, [1.0, 1.0], &mut edits).expect("a merge");
        edits.replay(&mut cloth);
        assert_eq!(sets(&cloth), before);
    }
}

#[test]
#[should_panic(expected = "the constraints of a cloth follow its mesh")]
fn a_cloth_takes_no_constraint_from_elsewhere() {
    let (mesh, positions) = shapes::grid(2, 2);
    let mut cloth = cloth(&mesh, &positions, Fabric::new(5.0));
    let _ = cloth.system_mut().bend([0, 2], 0.5, 1.0);
}

#[test]
#[should_panic(expected = "masses and positions are those of the mesh")]
fn a_cloth_with_positions_of_another_mesh_panics() {
    let (mesh, positions) = shapes::grid(1, 1);
    let masses = Masses::area(&mesh, &positions, 1.0).expect("masses");
    let few = Positions::new([[0.0; 3]]).expect("positions");
    let _ = Cloth::new(&mesh, &few, masses, Fabric::new(1.0));
}
