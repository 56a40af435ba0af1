//! The straight cut.

use tearmesh::{Edits, Masses, Mesh, Method, Point, Positions, Ray, Scissor, Vector, shapes};

use crate::random::Random;

fn meshes() -> Vec<(&'static str, Mesh, Positions)> {
    let named = |name, (mesh, positions)| (name, mesh, positions);
    vec![
        named("grid", shapes::grid(9, 7)),
        named("open fan", shapes::fan(5, false)),
        named("closed fan", shapes::fan(7, true)),
        named("tube", shapes::tube(7, 5)),
        named("torus", shapes::torus(9, 8)),
        named("octahedron", shapes::octahedron()),
    ]
}

#[test]
fn random_cuts_do_what_they_should() {
    let mut tally = [0; 8];
    for seed in 0..200 {
        for (name, mesh, positions) in meshes() {
            for snap in [0.0, 0.05] {
                let mut random = Random(seed);
                let mut point = |scale: f64| {
                    Point::new(
                        random.next() - 0.5,
                        random.next() - 0.5,
                        random.next() - 0.5,
                    ) * scale
                };
                let (eye, a, b) = (point(6.0), point(1.5), point(1.5));
                let shift = Vector::new(0.5, 0.5, 0.0) * f64::from(name == "grid");
                let (a, b) = (a + shift, b + shift);
                let (a, b) = (
                    Ray::new(eye, a - eye).unwrap(),
                    Ray::new(eye, b - eye).unwrap(),
                );
                let through = seed % 2 == 0;
                let scissor = Scissor::new(&a, &b).unwrap().through(through).snap(snap);
                let (mut mesh, mut positions) = (mesh.clone(), positions.clone());
                let mut masses = Masses::area(&mesh, &positions, 1.0).unwrap();
                let mut edits = Edits::new();
                let report = scissor
                    .cut(Method::Exact, &mut mesh, &mut positions, &mut edits)
                    .unwrap();
                edits.replay(&mut masses);
                let broken = mesh.check();
                assert!(broken.is_empty(), "{name} {seed}: {broken:?}");
                assert!(masses.ledger().is_balanced());
                tally[0] += 1;
                tally[1] += report.lost;
                tally[2] += report.crumbs;
                tally[3] += usize::from(!report.separated);
                if snap == 0.0 {
                    if report.seam_deviation_max > 1e-12 {
                        println!("{name} {seed} dev {}", report.seam_deviation_max);
                    }
                    if !report.missed && (report.seam_length_ratio - 1.0).abs() > 1e-9 {
                        println!(
                            "{name} {seed} ratio {} {:?}",
                            report.seam_length_ratio, report
                        );
                    }
                }
                if report.lost + report.crumbs > 0 || !report.separated {
                    println!(
                        "{name} {seed} snap {snap} through {through}: lost {} crumbs {} sep {} ends {:?} over {:?} labels",
                        report.lost,
                        report.crumbs,
                        report.separated,
                        report.ends_at_second_ray(),
                        report.tip_overshoots
                    );
                }
                for over in &report.tip_overshoots {
                    if snap == 0.0 && over.abs() > 1e-9 {
                        println!("{name} {seed} over {over}");
                    }
                }
                tally[4] += report.tip_overshoots.len();
            }
        }
    }
    println!("{tally:?}");
}
