//! Cloths that tear while they run: what it takes to tear a strip, what a weak tip does, what the
//! time step changes, what must not tear, and everything at random.

use tearmesh::insert::Plan;
use tearmesh::{
    Edits, HalfEdgeId, Mesh, PerVertex, Plane, Point, Positions, Vector, VertexId, mend, shapes,
    slide, split,
};
use tearmesh_cloth::{
    Bending, Copies, Fabric, Loads, Path, Tear, Tearing, Threshold, Unbend, Unstable, Verlet, Xpbd,
    force, frequency_bound, stable_step_s,
};

use crate::parts::cloths::{cloth, of_edges, sheet};
use crate::parts::{gravity, gravity_along_y, near};
use crate::random::Random;

/// A strip of 0.2 × 0.1 m with a slit from its left side to a quarter of its length; `rows` cells
/// across.
fn trousers(rows: usize) -> (Mesh, Positions, [Vec<usize>; 2]) {
    let (columns, h) = (2 * rows, 0.1 / rows as f64);
    let (middle, slit) = (rows / 2, rows / 2);
    let mut random = Random(1);
    let mut points = Vec::new();
    for j in 0..=rows {
        for i in 0..=columns {
            let inner = i > 0 && j > 0 && i < columns && j < rows && j != middle;
            let mut off = || {
                if inner {
                    0.3 * (random.next() - 0.5)
                } else {
                    0.0
                }
            };
            points.push([(i as f64 + off()) * h, (j as f64 + off()) * h, 0.0]);
        }
    }
    let row = |j: usize| j * (columns + 1);
    let copies = points.len();
    (0..slit).for_each(|i| points.push(points[row(middle) + i]));
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let vertex = |i: usize, k: usize| {
                let copied = k == middle && i < slit && j >= middle;
                (if copied { copies + i } else { row(k) + i }) as u32
            };
            let [a, b] = [vertex(i, j), vertex(i + 1, j)];
            let [c, d] = [vertex(i + 1, j + 1), vertex(i, j + 1)];
            if (i + j) % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    let lower = (0..=middle).map(row).collect();
    let upper = std::iter::once(copies).chain((middle + 1..=rows).map(row));
    let legs = [lower, upper.collect()];
    let mesh = Mesh::build(points.len(), &triangles).expect("a strip");
    (mesh, Positions::new(points).expect("finite"), legs)
}

/// What it took to pull the legs apart.
#[derive(Debug)]
struct Pulled {
    /// The largest force on a leg, over two milliseconds.
    force_max_n: f64,
    /// The mean force from the first tear until the legs were apart.
    force_mean_n: f64,
    first_tear_s: f64,
    tear_length_m: f64,
    edge_energy_j: f64,
    pieces: usize,
}

/// Pulls the legs of the strip apart, one up and one down.
fn pull(rows: usize, tearing: Tearing, speed_m_per_s: f64, finer: f64) -> Pulled {
    let (mut mesh, positions, legs) = trousers(rows);
    let mut cloth = cloth(&mesh, &positions, Fabric::new(1000.0));
    let end_s = 0.25 / speed_m_per_s;
    let system = cloth.system_mut();
    let drag_per_s = Some(20.0);
    let loads = Loads {
        drag_per_s,
        ..Loads::default()
    };
    system.set_loads(loads).expect("loads");
    for (leg, up) in legs.iter().zip([-0.25, 0.25]) {
        for &v in leg {
            let x = system.positions()[v];
            let path = [(0.0, x), (end_s, x + Vector::new(0.0, 0.0, up))];
            system.grab(v, Path::new(path).expect("a path"));
        }
    }
    let mut tear = Tear::new(&cloth, tearing).expect("a tear");
    let mut edits = Edits::new();
    let dt = 1.0 / (finer * frequency_bound(cloth.system_mut()).omega_rad_per_s);
    let (mut smooth, mut sum, mut count, mut apart) = (0.0, 0.0, 0.0, false);
    let mut pulled = Pulled {
        force_max_n: 0.0,
        force_mean_n: 0.0,
        first_tear_s: 0.0,
        tear_length_m: 0.0,
        edge_energy_j: 0.0,
        pieces: 0,
    };
    for step in 0..(end_s / dt) as usize {
        cloth.step(&mut Verlet::new(), dt).expect("a step");
        let force: f64 = legs[1]
            .iter()
            .map(|&v| force::reaction_n(cloth.system(), v).z)
            .sum();
        smooth += (force - smooth) * dt / 0.002;
        pulled.force_max_n = pulled.force_max_n.max(smooth);
        let report = tear.apply(&mut mesh, &mut cloth, &mut edits);
        edits.clear();
        pulled.tear_length_m += report.tear_length_m;
        pulled.edge_energy_j += report.edge_energy_j;
        if report.splits > 0 && pulled.first_tear_s == 0.0 {
            pulled.first_tear_s = cloth.system().elapsed_s();
        }
        if pulled.first_tear_s > 0.0 {
            (sum, count) = (sum + force, count + 1.0);
            if step % 64 == 0 {
                let pieces = mesh.components();
                let of = |v: usize| {
                    let v = VertexId::new(v).expect("a vertex");
                    pieces.of(mesh.faces_of(v).next().expect("a face"))
                };
                apart = of(legs[0][0]) != of(legs[1][1]);
            }
        }
        if apart {
            break;
        }
    }
    pulled.force_mean_n = sum / count;
    pulled.pieces = mesh.components().count();
    assert_eq!(mesh.check(), []);
    assert!(apart && cloth.masses().ledger().is_balanced());
    pulled
}

#[test]
fn a_threshold_of_strain_is_weaker_on_a_finer_mesh_and_toughness_is_not() {
    let strain = Tearing::new(Threshold::Stretch(1.3));
    let toughness = Tearing::new(Threshold::Toughness(0.5));
    let slopes = [strain, toughness].map(|tearing| {
        let [coarse, fine] = [8, 16].map(|rows| pull(rows, tearing, 0.25, 1.0));
        println!("{:?}\n  {coarse:?}\n  {fine:?}", tearing.threshold);
        let slope = |coarse: f64, fine: f64| (coarse / fine).log2();
        [
            slope(coarse.force_max_n, fine.force_max_n),
            slope(coarse.force_mean_n, fine.force_mean_n),
        ]
    });
    println!("slopes of the largest and the mean force: {slopes:.3?}");
    let [[strain_max, strain_mean], [tough_max, tough_mean]] = slopes;
    assert!(strain_max > 0.5 && strain_mean > 0.15);
    assert!(tough_max < 0.45 && tough_mean.abs() < 0.2);
}

#[test]
fn a_tear_with_weak_tips_runs_and_leaves_fewer_crumbs() {
    let toughness = Tearing::new(Threshold::Toughness(0.5));
    let weak = Tearing {
        weakening: Some(0.7),
        ..toughness
    };
    let [strong, weak] = [toughness, weak].map(|tearing| pull(16, tearing, 0.5, 1.0));
    println!("all tips strong {strong:?}\ntips weakened {weak:?}");
    assert!(weak.pieces <= strong.pieces);
    assert!(weak.force_mean_n < strong.force_mean_n);
    near(weak.first_tear_s, strong.first_tear_s, 1e-12);
}

#[test]
fn half_the_time_step_starts_the_same_tear() {
    let tearing = Tearing::new(Threshold::Toughness(0.5));
    let [whole, half] = [1.0, 2.0].map(|finer| pull(8, tearing, 0.5, finer));
    println!("at Δt {whole:?}\nat Δt/2 {half:?}");
    // How it starts converges. How it goes on is one of many ways, so of that only what
    // any way must have: the strip in two, by at least its length.
    near(whole.first_tear_s, half.first_tear_s, 1e-4);
    near(whole.force_max_n / half.force_max_n, 1.0, 0.05);
    for pulled in [whole, half] {
        assert!(pulled.pieces >= 2 && pulled.tear_length_m >= 0.15);
    }
}

/// A square metre that hangs by two corners, each held over the same length.
fn hangs(cells: u32, seconds: f64) -> f64 {
    let (mut mesh, positions) = shapes::grid(cells, cells);
    let mut cloth = cloth(&mesh, &positions, Fabric::new(200.0));
    let patch = 0.125;
    let held: Vec<usize> = positions
        .as_slice()
        .iter()
        .enumerate()
        .filter(|(_, p)| p.y > 1.0 - 1e-9 && (p.x < patch + 1e-9 || p.x > 1.0 - patch - 1e-9))
        .map(|(v, _)| v)
        .collect();
    let system = cloth.system_mut();
    held.into_iter().for_each(|v| system.hold(v));
    system.set_loads(gravity_along_y(2.0)).expect("loads");
    let mut tear = Tear::new(&cloth, Tearing::default()).expect("a tear");
    let mut edits = Edits::new();
    let dt = 0.95 * stable_step_s(cloth.system_mut(), 2.0);
    let mut worst = 0.0_f64;
    for _ in 0..(seconds / dt) as usize {
        cloth.step(&mut Verlet::new(), dt).expect("a step");
        let report = tear.apply(&mut mesh, &mut cloth, &mut edits);
        let loads = mesh.edges();
        let loads = loads.filter_map(|h| tear.tearing().threshold.edge_load(&mesh, &cloth, h));
        worst = loads.fold(worst, f64::max);
        assert_eq!(report.overstretched, 0, "{cells} cells");
    }
    worst
}

#[test]
fn a_sheet_that_merely_hangs_does_not_tear() {
    for cells in [16, 32] {
        let load = hangs(cells, 0.5);
        println!("{cells} cells: at most {load:.3} of the threshold");
        assert!(load > 0.05);
    }
}

#[test]
#[ignore = "minutes; run it in release"]
fn a_fine_sheet_that_merely_hangs_does_not_tear() {
    for cells in [64, 128, 256] {
        println!(
            "{cells} cells: at most {:.3} of the threshold",
            hangs(cells, 0.5)
        );
    }
}

/// Random grabs, cuts, insertions, slides, mends and tears, with all that holds checked after each.
fn everything_at_random(seed: u64, steps: usize) -> [usize; 7] {
    let mut random = Random(seed);
    let (mut mesh, positions) = sheet(7, 7, seed);
    let fabric = Fabric {
        bend: seed.is_multiple_of(2).then_some(Bending::Spring {
            stiffness_n_per_m: 1.0,
        }),
        unbend: [Unbend::Seam, Unbend::Vertex][(seed / 4) as usize % 2],
        damping_s: 2e-3,
        ..match seed / 2 % 3 {
            0 => Fabric::new(40.0),
            1 => of_edges(40.0, Copies::Halved),
            _ => of_edges(40.0, Copies::Whole),
        }
    };
    let threshold = match seed % 5 {
        0 => Threshold::Stretch(1.4),
        1 => Threshold::Toughness(0.3),
        2 => Threshold::Force(1.5),
        3 => Threshold::PrincipalStretch(1.5),
        _ => Threshold::WarpWeft {
            warp: 1.3,
            weft: 1.5,
            axis: Vector::x(),
        },
    };
    let tearing = Tearing {
        splits_per_step_max: [None, Some(1), Some(4)][seed as usize % 3],
        weakening: (!seed.is_multiple_of(3)).then_some(0.7),
        ..Tearing::new(threshold)
    };
    let mut cloth = cloth(&mesh, &positions, fabric);
    let strengths: Vec<f64> = mesh.vertices().map(|_| 0.7 + 0.6 * random.next()).collect();
    // What strengths must be: values of vertices that nothing but the log has touched.
    let mut oracle = PerVertex::new(strengths.clone());
    let tear = Tear::new(&cloth, tearing).expect("a tear");
    let mut tear = tear.with_strengths(strengths).expect("strengths");
    let system = cloth.system_mut();
    system.when_unstable(Unstable::Substep);
    system.set_loads(gravity(3.0)).expect("loads");
    (0..8).for_each(|v| system.hold(v));
    let total = cloth.masses().total();
    let faces_max = 4 * mesh.face_count();
    let mut edits = Edits::new();
    let mut counts = [0; 7];
    let mut grabbed: Option<usize> = None;
    for step in 0..steps {
        let before = edits.cursor();
        match random.below(24) {
            0 | 1 => {
                if let Some(v) = grabbed.take() {
                    cloth.system_mut().release(v.min(mesh.vertex_count() - 1));
                }
                let v = random.below(mesh.vertex_count());
                let (x, now) = (cloth.positions()[v], cloth.system().elapsed_s());
                let mut by = || 0.5 * (random.below(1000) as f64 / 1000.0 - 0.5);
                let to = x + Vector::new(by(), by(), by());
                let path = Path::new([(now, x), (now + 0.2, to)]).expect("a path");
                cloth.system_mut().grab(v, path);
                (grabbed, counts[0]) = (Some(v), counts[0] + 1);
            }
            2 => {
                let v = VertexId::new(random.below(mesh.vertex_count())).expect("a vertex");
                let normal = Vector::new(
                    random.below(9) as f64 - 4.0,
                    random.below(9) as f64 - 4.0,
                    0.5,
                );
                let plane = Plane::new(cloth.positions()[v.index()], normal).expect("a plane");
                if split::by_plane(&mut mesh, v, &plane, &cloth, &mut edits).is_some() {
                    counts[1] += 1;
                }
            }
            3 if mesh.face_count() < faces_max => {
                let mut plan = Plan::new();
                let h = HalfEdgeId::new(random.below(mesh.half_edge_count())).expect("a half-edge");
                plan.on_edge(h, 0.3 + 0.4 * random.below(100) as f64 / 100.0);
                counts[2] += usize::from(plan.apply(&mut mesh, &mut edits).is_ok());
            }
            4 => {
                let h = HalfEdgeId::new(random.below(mesh.half_edge_count())).expect("a half-edge");
                let t = 0.01 + 0.1 * random.below(100) as f64 / 100.0;
                let [v, toward] = [mesh.origin(h), mesh.target(h)];
                counts[3] += usize::from(slide::toward(&mesh, v, toward, t, &mut edits).is_ok());
            }
            5..=8 => {
                let stitches = mend::stitches(&mesh, |_| true);
                for _ in 0..stitches.len().min(4) {
                    let stitches = mend::stitches(&mesh, |_| true);
                    let Some(stitch) = stitches.get(random.below(stitches.len().max(1))) else {
                        break;
                    };
                    let ends = [stitch.kept(), stitch.gone()];
                    edits.replay(&mut cloth);
                    let weights = ends.map(|v| cloth.masses().at(v));
                    let merged = mend::merge(&mut mesh, ends[0], ends[1], weights, &mut edits);
                    counts[4] += usize::from(merged.is_ok());
                }
            }
            _ => {}
        }
        let is_edited = edits.cursor() != before;
        if is_edited && random.below(2) == 0 {
            edits.replay(&mut (&mut cloth, &mut tear));
        }
        let report = tear.apply(&mut mesh, &mut cloth, &mut edits);
        counts[5] += report.splits;
        assert!(report.splits <= report.overstretched);
        assert!(
            tearing
                .splits_per_step_max
                .is_none_or(|cap| report.splits <= cap)
        );
        edits.replay(&mut oracle);
        edits.clear();
        assert_eq!(oracle.as_slice().len(), mesh.vertex_count());
        for v in mesh.vertices() {
            assert_eq!(tear.strength(v), *oracle.at(v));
        }
        assert!(mesh.vertex_count() <= 3 * mesh.face_count());
        assert_eq!(cloth.masses().total(), total, "seed {seed} step {step}");
        assert!(cloth.masses().ledger().is_balanced());
        assert_eq!(cloth.indices(), mesh.indices());
        let finite = |x: &Point| x.iter().all(|x| x.is_finite());
        assert!(cloth.positions().iter().all(finite));
        if step % 16 == 0 {
            assert_eq!(mesh.check(), [], "seed {seed} step {step}");
        }
        let began = cloth.positions().to_vec();
        if cloth.step(&mut Xpbd::new(2, 1), 0.005).is_err() {
            // Blown up, and said so: the last good state is kept, and the cloth laid out anew.
            counts[6] += 1;
            assert_eq!(cloth.positions(), began);
            let rest = cloth.rest_positions().as_slice().to_vec();
            let (x, v) = cloth.system_mut().state_mut();
            x.copy_from_slice(&rest);
            v.fill(Vector::zeros());
        }
    }
    counts
}

fn at_random(seeds: u64, steps: usize) {
    let mut sums = [0; 7];
    for seed in 0..seeds {
        let counts = everything_at_random(seed, steps);
        sums.iter_mut()
            .zip(counts)
            .for_each(|(sum, count)| *sum += count);
    }
    let [grabs, cuts, insertions, slides, merges, tears, blown] = sums;
    println!(
        "{grabs} grabs, {cuts} cuts, {insertions} insertions, {slides} slides, {merges} merges, \
         {tears} tears, {blown} blow-ups"
    );
    assert!(
        [grabs, cuts, insertions, slides, merges, tears]
            .iter()
            .all(|&count| count > 50)
    );
}

#[test]
fn nothing_that_is_done_to_a_tearing_cloth_breaks_it() {
    at_random(20, 120);
}

#[test]
#[ignore = "a hundred thousand steps; run it in release"]
fn nothing_that_is_done_to_a_tearing_cloth_for_long_breaks_it() {
    at_random(100, 1000);
}
