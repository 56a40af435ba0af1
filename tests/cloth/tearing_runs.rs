//! Cloths that tear while they run: what it takes to tear one on a coarse and a fine mesh, and everything at
//! random.

use tearmesh::{Edits, PerVertex, Point, Vector};
use tearmesh_cloth::{Copies, Fabric, Path, Tear, Tearing, Threshold, Unbend, Unstable, Xpbd};

use crate::parts::cloths::{bent, cloth, edit, of_edges, sheet};
use crate::parts::scenes::{noted, staged};
use crate::parts::{gravity, order};
use crate::random::Random;
use tearmesh_cloth::scene::Scene;

#[test]
fn a_strain_tears_a_finer_mesh_more_easily_toughness_not() {
    let slope = |threshold| {
        let forces = [8, 16].map(|cells| {
            let played = noted(staged(cells, |frame| Scene {
                tearing: Some(Tearing::new(threshold)),
                ..Scene::trouser(frame)
            }));
            played.log.largest_force_n().expect("springs have forces")
        });
        order(forces)
    };
    let slopes = [Threshold::Stretch(1.3), Threshold::Toughness(4.0)].map(slope);
    assert!(slopes[0] > 0.5 && slopes[1].abs() < 0.3, "{slopes:?}");
}

/// Random grabs, cuts, insertions, slides, mends and tears, with all that holds checked after each.
fn everything_at_random(seed: u64, steps: usize) -> [usize; 8] {
    let mut random = Random(seed);
    let (mut mesh, positions) = sheet(7, 7, seed);
    let fabric = Fabric {
        unbend: [Unbend::Seam, Unbend::Vertex][(seed / 4) as usize % 2],
        damping_s: 2e-3,
        ..match seed / 2 % 3 {
            0 => Fabric::new(40.0),
            1 => of_edges(40.0, Copies::Halved),
            _ => of_edges(40.0, Copies::Whole),
        }
    };
    let fabric = [bent(fabric, 1.0), fabric][seed as usize % 2];
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
    let mut edits = Edits::new();
    edits.replay(&mut oracle);
    let mut counts = [0; 8];
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
                (grabbed, counts[5]) = (Some(v), counts[5] + 1);
            }
            2..=8 => counts[edit(&mut mesh, &cloth, &mut edits, &mut random) as usize] += 1,
            _ => {}
        }
        let is_edited = edits.cursor() != before;
        if is_edited && random.below(2) == 0 {
            edits.replay(&mut (&mut cloth, &mut tear));
        }
        let report = tear.apply(&mut mesh, &mut cloth, &mut edits);
        counts[6] += report.splits;
        let cap = tearing.splits_per_step_max.unwrap_or(usize::MAX);
        assert!(report.splits <= report.overstretched.min(cap));
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
            counts[7] += 1;
            assert_eq!(cloth.positions(), began);
            let rest = cloth.rest_positions();
            let (x, v) = cloth.system_mut().state_mut();
            x.copy_from_slice(&rest);
            v.fill(Vector::zeros());
        }
    }
    counts
}

#[test]
fn nothing_done_to_a_tearing_cloth_breaks_it() {
    let mut sums = [0; 8];
    for seed in 0..20 {
        let counts = everything_at_random(seed, 120);
        sums = std::array::from_fn(|i| sums[i] + counts[i]);
    }
    let [_, splits, insertions, merges, slides, grabs, tears, _] = sums;
    let done = [splits, insertions, merges, slides, grabs, tears];
    assert!(done.iter().all(|&count| count > 50), "{sums:?}");
}
