//! Planes exactly through vertices, along edges and through whole faces: how many pieces there are
//! is foretold from a row of whole numbers, or from a line in a square.

use tearmesh::{CutMethod, Mesh, Point, Positions, Ray, Scissor, shapes};

use crate::random::Random;
use crate::work::{ALONG_EDGES, Work, between};

/// Every method, the exact one with every kind of snap.
fn cuts() -> impl Iterator<Item = (CutMethod, f64, bool)> {
    let snaps = [0.0, 0.02, Scissor::SNAP, 0.2].into_iter();
    let exact = snaps.flat_map(|snap| [false, true].map(|moves| (CutMethod::Exact, snap, moves)));
    exact.chain(ALONG_EDGES.map(|method| (method, 0.0, false)))
}

/// Cuts a copy of a sheet through everything in each way, and looks at what came of it.
fn is_cut_into(pieces: usize, sheet: (Mesh, Positions), scissor: &Scissor, what: &str) {
    let sheet = Work::new(sheet);
    let is_folded = sheet.positions.as_slice().iter().any(|p| p.z != 0.0);
    for (method, snap, moves) in cuts() {
        let scissor = scissor
            .clone()
            .with_through(true)
            .with_snap(snap)
            .with_snap_move(moves);
        let (_, report) = sheet.clone().cut(method, &scissor);
        let said = format!("{what}, {method:?} with snap {snap}, moved {moves}: {report:?}");
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

/// Sheared and turned by whole numbers, so that every plane z = c stays exact.
fn place(random: &mut Random) -> impl Fn([f64; 3]) -> Point + use<> {
    let shear = [0; 2].map(|_: i32| f64::from(random.below(5) as i32 - 2));
    let turn = random.below(3);
    move |[x, y, z]: [f64; 3]| {
        let mut sheared = [x + shear[0] * z, y + shear[1] * z, z];
        sheared.rotate_right(turn);
        Point::from(sheared)
    }
}

/// How often a row of numbers changes its sign, zeros left out: touching is not cutting.
fn changes(row: impl Iterator<Item = f64>) -> usize {
    let signs: Vec<bool> = row.filter(|x| *x != 0.0).map(|x| x > 0.0).collect();
    signs.windows(2).filter(|two| two[0] != two[1]).count()
}

/// Sheets with these heights from left to right, the same all along.
#[test]
fn planes_through_folds_cut_at_each_change_of_sign() {
    let mut random = Random(101);
    let (mut through_faces, mut through_folds) = (0, 0);
    for _ in 0..600 {
        let count = 3 + random.below(8);
        let heights: Vec<f64> = (0..count).map(|_| random.below(3) as f64).collect();
        let rises: Vec<bool> = (0..2 * count).map(|_| random.next() < 0.5).collect();
        let (mesh, _) =
            shapes::grid_with_diagonals(count as u32 - 1, 2, |x, y| rises[(2 * x + y) as usize]);
        let place = place(&mut random);
        let at = |i: usize| place([(i % count) as f64, (i / count) as f64, heights[i % count]]);
        let positions = Positions::new((0..3 * count).map(at)).expect("whole numbers");
        let level = random.below(5) as f64 / 2.0;
        let above: Vec<f64> = heights.iter().map(|height| height - level).collect();
        through_faces += usize::from(above.windows(2).any(|two| two == [0.0; 2]));
        through_folds += usize::from(above.contains(&0.0));
        let along = place([1.0, 0.0, 0.0]) - place([0.0, 0.0, 0.0]);
        let rays = [-3.0, 9.0].map(|y| Ray::new(place([-7.0, y, level]), along).expect("a ray"));
        let scissor = Scissor::new(rays[0], rays[1]).expect("a plane");
        let pieces = 1 + changes(above.into_iter());
        let what = format!("{heights:?} at {level}");
        is_cut_into(pieces, (mesh, positions), &scissor, &what);
    }
    assert!(through_faces > 100 && through_folds > 200);
}

#[test]
fn lines_through_vertices_of_a_square_divide_or_touch_it() {
    let mut random = Random(103);
    let mut divided = 0;
    for _ in 0..600 {
        let n = 2 + random.below(5);
        let seed = random.next();
        let (mesh, _) = shapes::grid_with_diagonals(n as u32, n as u32, |x, y| {
            (f64::from(7 * x + 3 * y) * seed).fract() < 0.5
        });
        // Whole numbers, so that lines through vertices are exact.
        let at = |i: usize| [(i % (n + 1)) as f64, (i / (n + 1)) as f64, 0.0];
        let positions = Positions::new((0..mesh.vertex_count()).map(at)).expect("small");
        let [x, y] = [(); 2].map(|()| random.below(n + 1) as f64);
        // Slopes of which no crossing is nearer to a vertex than the snap: at 1/3 they are 1/4.
        let slopes = [(1.0, 0.0), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0)];
        let (mut dx, mut dy) = slopes[random.below(4)];
        if random.below(2) == 0 {
            (dx, dy) = (dy, dx);
        }
        if random.below(2) == 0 {
            dx = -dx;
        }
        let side = |p: &Point| dx * (p.y - y) - dy * (p.x - x);
        let has = |sign: f64| positions.as_slice().iter().any(|p| side(p) * sign > 0.0);
        let pieces = 1 + usize::from(has(1.0) && has(-1.0));
        divided += pieces - 1;
        let scissor = between([x - dx, y - dy], [x + dx, y + dy]);
        let what = format!("{n} cells, through {x},{y} along {dx},{dy}");
        is_cut_into(pieces, (mesh, positions), &scissor, &what);
    }
    assert!(divided > 300 && divided < 590, "{divided}");
}
