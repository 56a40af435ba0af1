//! Planes exactly through vertices, along edges and through whole faces: how many pieces there are
//! is foretold from a row of whole numbers, or from a line in a square.

use tearmesh::{CutMethod, CutReport, Edits, Mesh, Point, Positions, Ray, Scissor, Vector, shapes};

use crate::random::Random;

/// Every method, the exact one with every kind of snap.
fn cuts() -> Vec<(CutMethod, f64, bool)> {
    let mut cuts: Vec<_> = [0.0, 0.02, Scissor::SNAP, 0.2]
        .into_iter()
        .flat_map(|snap| {
            [
                (CutMethod::Exact, snap, false),
                (CutMethod::Exact, snap, true),
            ]
        })
        .collect();
    cuts.extend(
        [
            CutMethod::Partition,
            CutMethod::Uniform,
            CutMethod::Alternating,
        ]
        .map(|m| (m, 0.0, false)),
    );
    cuts
}

/// A sheet, and the pieces that a cut along a plane is to leave.
struct Foretold {
    mesh: Mesh,
    positions: Positions,
    rays: [Ray; 2],
    pieces: usize,
    is_folded: bool,
}

/// Cuts a copy of a sheet through everything in each way, and looks at what came of it.
fn check(foretold: &Foretold, what: &str) {
    let Foretold {
        mesh,
        positions,
        rays,
        pieces,
        is_folded,
    } = foretold;
    let (pieces, is_folded) = (*pieces, *is_folded);
    for (method, snap, snap_move) in cuts() {
        let (mut mesh, mut positions) = (mesh.clone(), positions.clone());
        let scissor = Scissor::new(rays[0], rays[1]).expect("a plane");
        let scissor = scissor.through(true).snap(snap).snap_move(snap_move);
        let (_, report): (_, CutReport) = scissor
            .cut_measured(method, &mut mesh, &mut positions, &mut Edits::new())
            .expect("positions are in step");
        assert_eq!(mesh.check(), []);
        let said = format!("{what}, {method:?} with snap {snap}, moved {snap_move}: {report:?}");
        assert_eq!(report.pieces, mesh.components().count(), "{said}");
        match method {
            CutMethod::Exact => {
                let counts = (report.pieces, report.pieces_expected, report.separated);
                assert_eq!(counts, (pieces, pieces, true), "{said}");
                assert_eq!((report.crumbs, report.lost), (0, 0), "{said}");
            }
            // Along edges, and with what lies on the plane in front. Triangles that bridge a fold may
            // come loose; they are counted.
            CutMethod::Partition => assert!(report.crumbs == 0 || is_folded, "{said}"),
            _ => {}
        }
    }
}

/// A sheet with these heights from left to right, the same all along, turned and sheared by whole
/// numbers so that every plane z = c stays exact.
fn folded(heights: &[i32], random: &mut Random) -> (Mesh, impl Fn([f64; 3]) -> Point + use<>) {
    let mut coin = || random.next() < 0.5;
    let rises: Vec<bool> = (0..2 * heights.len()).map(|_| coin()).collect();
    let (mesh, _) = shapes::grid_with_diagonals(heights.len() as u32 - 1, 2, |x, y| {
        rises[(2 * x + y) as usize]
    });
    let shear = [0; 2].map(|_: i32| f64::from(random.below(5) as i32 - 2));
    let turn = random.below(3);
    let place = move |[x, y, z]: [f64; 3]| {
        let mut sheared = [x + shear[0] * z, y + shear[1] * z, z];
        sheared.rotate_right(turn);
        Point::from(sheared)
    };
    (mesh, place)
}

/// How often a row of numbers changes its sign, zeros left out: touching is not cutting.
fn changes(row: impl Iterator<Item = f64>) -> usize {
    let signs: Vec<bool> = row.filter(|x| *x != 0.0).map(|x| x > 0.0).collect();
    signs.windows(2).filter(|two| two[0] != two[1]).count()
}

#[test]
fn planes_through_folds_and_flat_strips_leave_the_pieces_that_the_folds_foretell() {
    let mut random = Random(101);
    let (mut through_faces, mut through_folds) = (0, 0);
    for _ in 0..600 {
        let count = 3 + random.below(8);
        let heights: Vec<i32> = (0..count).map(|_| random.below(3) as i32).collect();
        let (mesh, place) = folded(&heights, &mut random);
        let points = (0..=2).flat_map(|j| {
            let row = heights.iter().enumerate();
            let at = |(i, &h): (usize, &i32)| place([i as f64, f64::from(j), f64::from(h)]);
            row.map(at).collect::<Vec<_>>()
        });
        let positions = Positions::new(points.collect::<Vec<_>>()).expect("whole numbers");
        let level = f64::from(random.below(5) as i32) / 2.0;
        let above = |&h: &i32| f64::from(h) - level;
        let pieces = 1 + changes(heights.iter().map(above));
        through_faces += usize::from(
            heights
                .windows(2)
                .any(|two| above(&two[0]) == 0.0 && two[0] == two[1]),
        );
        through_folds += usize::from(heights.iter().any(|h| above(h) == 0.0));
        let along = place([1.0, 0.0, 0.0]) - place([0.0, 0.0, 0.0]);
        let rays = [-3.0, 9.0].map(|y| Ray::new(place([-7.0, y, level]), along).expect("a ray"));
        let foretold = Foretold {
            mesh,
            positions,
            rays,
            pieces,
            is_folded: true,
        };
        check(&foretold, &format!("{heights:?} at {level}"));
    }
    println!("{through_faces} planes through whole faces, {through_folds} along edges");
    assert!(through_faces > 100 && through_folds > 200);
}

#[test]
fn lines_through_vertices_of_a_square_leave_two_pieces_or_touch_it() {
    let mut random = Random(103);
    let mut divided = 0;
    for _ in 0..600 {
        let n = 2 + random.below(5) as u32;
        let seed = random.next();
        let (mesh, positions) = shapes::grid_with_diagonals(n, n, |x, y| {
            (f64::from(7 * x + 3 * y) * seed).fract() < 0.5
        });
        // Whole numbers, so that lines through vertices are exact.
        let points = positions.as_slice().iter().map(|p| p * f64::from(n));
        let points = points.map(|p| Point::new(p.x.round(), p.y.round(), 0.0));
        let positions = Positions::new(points.collect::<Vec<_>>()).expect("whole numbers");
        let mut below = |most: u32| f64::from((f64::from(most) * random.next()) as u32);
        let [x, y] = [below(n + 1), below(n + 1)];
        // Slopes of which no crossing is nearer to a vertex than the snap: at 1/3 they are 1/4.
        let slopes = [(1.0, 0.0), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0)];
        let (mut dx, mut dy) = slopes[below(4) as usize];
        if below(2) == 0.0 {
            (dx, dy) = (dy, dx);
        }
        if below(2) == 0.0 {
            dx = -dx;
        }
        let side = |p: &Point| dx * (p.y - y) - dy * (p.x - x);
        let corners = positions.as_slice().iter().map(side);
        let [least, most] =
            corners.fold([0.0f64; 2], |[least, most], d| [least.min(d), most.max(d)]);
        let pieces = if least < 0.0 && most > 0.0 { 2 } else { 1 };
        divided += usize::from(pieces == 2);
        let down = Vector::new(0.0, 0.0, -1.0);
        let at = |t: f64| Ray::new(Point::new(x + t * dx, y + t * dy, 5.0), down).expect("a ray");
        let what = format!("{n} cells, through {x},{y} along {dx},{dy}");
        let foretold = Foretold {
            mesh,
            positions,
            rays: [at(-1.0), at(1.0)],
            pieces,
            is_folded: false,
        };
        check(&foretold, &what);
    }
    println!("{divided} of 600 lines divide the square");
    assert!(divided > 300 && divided < 590);
}
