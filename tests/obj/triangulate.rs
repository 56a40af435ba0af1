//! Polygons to triangles, against an oracle that only adds areas.

use proptest::prelude::*;

use super::read;

/// Reads a polygon as one face.
pub(crate) fn triangles(polygon: &[[f64; 3]]) -> Vec<[u32; 3]> {
    let vertices = polygon
        .iter()
        .map(|[x, y, z]| format!("v {x:?} {y:?} {z:?}\n"));
    let corners = (1..=polygon.len()).map(|i| format!(" {i}"));
    let file = vertices.collect::<String>() + "f" + &corners.collect::<String>();
    read(file.as_bytes()).triangles().to_vec()
}

/// A polygon in the plane, as `x y, x y, …`.
pub(crate) fn polygon(points: &str) -> Vec<[f64; 2]> {
    let point = |point: &str| {
        let (x, y) = point.trim().split_once(' ').expect("two numbers");
        [x, y].map(|number| number.parse().expect("a number"))
    };
    points.split(',').map(point).collect()
}

fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn doubled_area(polygon: &[[f64; 2]]) -> f64 {
    (1..polygon.len() - 1)
        .map(|i| cross(polygon[0], polygon[i], polygon[i + 1]))
        .sum()
}

/// Whether triangles cover a simple polygon of positive area without overlap: none
/// faces away, and the areas add up. Every vertex is used, and an edge twice at most.
fn cover(polygon: &[[f64; 2]], triangles: &[[u32; 3]]) -> Result<(), String> {
    assert_eq!(triangles.len(), polygon.len() - 2);
    let areas = triangles.iter().map(|t| {
        let [a, b, c] = t.map(|i| polygon[i as usize]);
        cross(a, b, c)
    });
    if let Some(area) = areas.clone().find(|&area| area < 0.0) {
        return Err(format!("a triangle faces away: {area}"));
    }
    let (sum, whole) = (areas.sum::<f64>(), doubled_area(polygon));
    if (sum - whole).abs() > 1e-9 * whole.abs() {
        return Err(format!("the areas add up to {sum}, not {whole}"));
    }
    Ok(())
}

/// The planes in which a polygon is tried: its view is along each axis, from both sides, and
/// aslant.
fn in_every_plane(polygon: &[[f64; 2]]) {
    type Place = fn([f64; 2]) -> [f64; 3];
    let places: [Place; 5] = [
        |[u, v]| [u, v, 3.0],
        |[u, v]| [v, u, -7.0],
        |[u, v]| [0.5, u, v],
        |[u, v]| [v, 0.0, u],
        |[u, v]| [u, v, 0.25 * u - 0.5 * v],
    ];
    for place in places {
        let placed: Vec<[f64; 3]> = polygon.iter().copied().map(place).collect();
        if let Err(reason) = cover(polygon, &triangles(&placed)) {
            panic!("{reason}: {polygon:?}");
        }
    }
}

#[test]
fn concave_shapes_are_covered_without_overlap() {
    let shapes = [
        "0 0, 4 2, 0 4, 1 2",
        "0 0, 3 0, 3 1, 1 1, 1 3, 0 3",
        "0 0, 9 0, 9 9, 0 9, 0 3, 6 3, 6 6, 3 6, 3 5, 5 5, 5 4, 1 4, 1 8, 8 8, 8 1, 0 1",
        // A square with a square hole, joined by a slit: corners that lie at the same place.
        "0 0, 6 0, 6 6, 0 6, 0 0, 2 2, 2 4, 4 4, 4 2, 2 2",
        "0 0, 1 0, 2 0, 2 2, 1 2, 0 2",
        // A corner that was no ear is tested against all others again once its triangle has grown; one
        // polygon in ten thousand shows the difference.
        "759 404, 883 576, 606 417, 485 170, 378 291, 288 539, 102 887, 2 935, 69 355, 1 239, 1 171, \
         92 152, 2 20, 291 32, 331 160, 484 0, 712 31, 840 91, 877 174, 815 142, 754 215, 740 271",
    ];
    for shape in shapes.map(polygon) {
        for turn in 0..shape.len() {
            let mut turned = shape.to_vec();
            turned.rotate_left(turn);
            in_every_plane(&turned);
        }
    }
}

#[test]
fn the_largest_polygon_takes_no_time_even_at_its_worst() {
    // A saw whose every other corner is reflex, and every triangle of three neighbours
    // full of others: the teeth lean over each other.
    let count = 2047;
    let mut saw = vec![[0.0, -1.0, 0.0], [f64::from(count), -1.0, 0.0]];
    for i in (0..count).rev() {
        let x = f64::from(i);
        saw.push([x + 0.9, 1e-4 * x, 0.0]);
        saw.push([x + 1000.0, 1000.0, 0.0]);
    }
    let start = std::time::Instant::now();
    assert_eq!(triangles(&saw).len(), saw.len() - 2);

    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}

/// Shortens the way until no two sides cross.
fn untangle(polygon: &mut [[f64; 2]]) {
    let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let count = polygon.len();
    let mut shorter = true;
    while shorter {
        shorter = false;
        for i in 0..count - 1 {
            for j in i + 2..count {
                let [a, b, c, d] = [i, i + 1, j, (j + 1) % count].map(|at| polygon[at]);
                if distance(a, c) + distance(b, d) < distance(a, b) + distance(c, d) - 1e-9 {
                    polygon[i + 1..=j].reverse();
                    shorter = true;
                }
            }
        }
    }
}

/// Quads on the same three vertices in a row, and one whose usual diagonal is an edge of two triangles, wherever in a file they stand.
#[test]
fn every_colliding_diagonal_is_found_under_any_numbers() {
    let groups = 200;
    let count = 11 * groups;
    // With many fins a large part of all sides meets a diagonal.
    for (stride, fins) in [1, 7, 331, 1009]
        .into_iter()
        .flat_map(|s| [(s, 2), (s, 12)])
    {
        let number = |group: usize, vertex: usize| (11 * group + vertex) * stride % count;
        let places =
            "0 0 0,1 0 0,1 1 0,0 1 0,0.5 0.5 1,0.5 0.5 2,0 0 0,2 -2 0,4 0 0,2 0.5 -0.5,2 2 3";
        let mut vertices = vec![""; count];
        let (mut quads, mut others) = (String::new(), String::new());
        for group in 0..groups {
            for (vertex, place) in places.split(',').enumerate() {
                vertices[number(group, vertex)] = place;
            }
            let face = |corners: &[usize]| {
                let corners = corners.iter().map(|&v| number(group, v) + 1);
                let corners: Vec<String> = corners.map(|v| v.to_string()).collect();
                format!("f {}\n", corners.join(" "))
            };
            quads += &face(&[0, 1, 2, 3]);
            quads += &face(&[6, 7, 8, 9]);
            for fin in 0..fins {
                others += &face(&[2, 0, 4 + fin % 2]);
            }
            others += &face(&[6, 9, 8, 10]);
        }
        let vertices: String = vertices
            .iter()
            .map(|place| format!("v {place}\n"))
            .collect();
        let document = read(format!("{vertices}{quads}{others}").as_bytes());
        for (group, found) in document.triangles().chunks(4).take(groups).enumerate() {
            let expected = [[0, 1, 3], [1, 2, 3], [6, 7, 9], [7, 8, 9]];
            let expected = expected.map(|corners| corners.map(|v| number(group, v) as u32));
            assert_eq!(found, expected, "group {group}, {stride}, {fins}");
        }
    }
}

proptest! {
    #![proptest_config(super::properties())]

    /// Random points, untangled: wherever two sides cross, the way between them is turned round.
    #[test]
    fn untangled_polygons_are_covered_without_overlap(
        points in prop::collection::btree_set((0i32..1000, 0i32..1000), 5..40),
        order in any::<u64>(),
    ) {
        let mut polygon: Vec<[f64; 2]> =
            points.into_iter().map(|(x, y)| [f64::from(x), f64::from(y)]).collect();
        polygon.sort_by_key(|p| (p[0].to_bits() ^ order).wrapping_mul(p[1].to_bits() | 1));
        untangle(&mut polygon);
        if doubled_area(&polygon) < 0.0 {
            polygon.reverse();
        }
        in_every_plane(&polygon);
    }

    #[test]
    fn polygons_give_two_triangles_less_than_corners(
        points in prop::collection::vec((-3i8..3, -3i8..3, -1i8..1), 3..30),
    ) {
        let points = points.into_iter().map(|(x, y, z)| [x, y, z].map(f64::from));
        let points: Vec<[f64; 3]> = points.collect();
        prop_assert_eq!(triangles(&points).len(), points.len() - 2);
    }
}
