//! The paper's tearing rule, against the rule written down once more for a list of triangles.

use tearmesh::{Edits, Positions, VertexId, shapes, tear};

use crate::random::Random;

/// The corners, of a list of triangles, that the rule moves; `None` if it does nothing.
///
/// Written from Souza et al. 2014 §III-A and §IV for plain lists, with the tie rules of the
/// library: a centre on the plane is in front, and of equal masses the lower id is split.
fn expected(
    triangles: &[[usize; 3]],
    points: &[[f64; 3]],
    masses: &[Option<f64>],
    [a, b]: [usize; 2],
) -> Option<(usize, Vec<usize>)> {
    let mut candidates = Vec::new();
    for (v, other) in [(a, b), (b, a)] {
        let Some(mass) = masses[v] else { continue };
        let sub = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
        let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        let normal = sub(points[other], points[v]);
        let of_v = triangles.iter().enumerate().filter(|(_, t)| t.contains(&v));
        let (mut behind, mut all) = (Vec::new(), 0);
        for (f, triangle) in of_v {
            all += 1;
            let mut corners = *triangle;
            corners.sort_unstable();
            let offsets = corners.map(|w| dot(normal, sub(points[w], points[v])));
            if offsets[0] + offsets[1] + offsets[2] < 0.0 {
                behind.push(f);
            }
        }
        if !behind.is_empty() && behind.len() < all {
            candidates.push((mass, v, behind));
        }
    }
    candidates.sort_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)));
    candidates
        .into_iter()
        .next()
        .map(|(_, v, behind)| (v, behind))
}

#[test]
fn overstretched_edges_tear_by_the_rule_of_the_paper() {
    let (mut torn, mut refused) = (0, 0);
    for seed in 0..160 {
        let mut random = Random(seed);
        let (mut mesh, positions) = match seed % 4 {
            0 => shapes::grid(4, 3),
            1 => shapes::fan(6, true),
            2 => shapes::torus(4, 4),
            _ => shapes::tube(5, 2),
        };
        // Numbers with few bits, so that ties are ties.
        let mut jitter = |x: f64| (x * 64.0).round() / 64.0 + random.below(16) as f64 / 64.0;
        let points = positions.as_slice().iter();
        let points: Vec<[f64; 3]> = points.map(|p| [p.x, p.y, p.z].map(&mut jitter)).collect();
        let mut positions = Positions::new(points).expect("finite");
        let mut mass = || [None, Some(0.25), Some(0.5), Some(0.5)][random.below(4)];
        let mut masses: Vec<Option<f64>> = mesh.vertices().map(|_| mass()).collect();
        let mut edits = Edits::new();
        for _ in 0..30 {
            let h = random.below(mesh.half_edge_count());
            let h = mesh.half_edge(h);
            let faces = mesh
                .faces()
                .map(|f| mesh.face_vertices(f).map(VertexId::index));
            let triangles: Vec<[usize; 3]> = faces.collect();
            let points: Vec<[f64; 3]> = positions.as_slice().iter().map(|&p| p.into()).collect();
            let ends = [mesh.origin(h), mesh.target(h)].map(VertexId::index);
            let truth = expected(&triangles, &points, &masses, ends);
            let mass = |v: VertexId| masses[v.index()];
            let named = |h| tear::candidate(&mesh, h, &positions, mass).map(|(v, _)| v);
            // Either half-edge names the edge.
            assert_eq!(named(mesh.pair(h).unwrap_or(h)), named(h));
            let split = tear::edge(&mut mesh, h, &positions, mass, &mut edits);
            let done = split.map(|split| {
                let mut faces: Vec<usize> =
                    split.corners.iter().map(|h| h.face().index()).collect();
                faces.sort_unstable();
                (split.old.index(), faces)
            });
            assert_eq!(done, truth, "seed {seed}");
            match done {
                Some((old, _)) => {
                    masses.push(masses[old]);
                    torn += 1;
                }
                None => refused += 1,
            }
            edits.replay(&mut positions);
            assert_eq!(mesh.check(), []);
        }
    }
    assert!(torn > 1000 && refused > 500, "{torn} {refused}");
}
