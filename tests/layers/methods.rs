//! The first layers by the methods that insert nothing: chains that are found by brute force say where
//! each may tear, and sheets that are apart what it tears there.

use super::*;
use crate::cuts::ALONG_EDGES;
use tearmesh::HalfEdgeId;

/// What was seen of one method.
#[derive(Debug, Default)]
struct Seen {
    cuts: usize,
    torn: usize,
    /// Cuts where all layers would have torn more.
    chose: usize,
    nothing: usize,
}

/// What a method tears of a mesh, as half-edges: their faces keep their numbers.
fn torn_by(
    method: CutMethod,
    scissor: &Scissor,
    mesh: &Mesh,
    positions: &Positions,
) -> (Mesh, BTreeSet<usize>) {
    let (mut after, mut at, mut edits) = (mesh.clone(), positions.clone(), Edits::new());
    let made = scissor.cut_measured(method, &mut after, &mut at, &mut edits);
    made.expect("in step");
    assert_eq!(after.check(), []);
    assert_eq!(after.face_count(), mesh.face_count());
    let torn = after
        .half_edges()
        .filter(|&h| after.ghost_pair(h).is_some());
    let torn = torn.map(HalfEdgeId::index).collect();
    (after, torn)
}

/// The faces of the chains that are to be cut, and whether there are others; none if a cut comes too
/// near to a special case.
fn chosen(
    mesh: &Mesh,
    positions: &Positions,
    rays: &[Ray; 2],
    scissor: &Scissor,
) -> Option<(BTreeSet<usize>, Oracle)> {
    let points = positions.as_slice();
    let edge = mean_edge(mesh, points);
    let oracle = Oracle::new(mesh, points, scissor, edge).ok()?;
    let chains = oracle.first(mesh, points, rays, edge).ok()?;
    let faces = oracle.pieces.keys().copied();
    let kept = faces.filter(|f| chains.contains(&Some(oracle.chain[f])));
    Some((kept.collect(), oracle))
}

/// On any mesh a method tears nothing that is not at the chosen chains; and `partition` tears there all
/// that it tears when it goes through all layers, but where both meet.
#[test]
fn other_methods_stay_with_the_chosen_chains() {
    let mut random = Random(19);
    let mut meshes = vec![
        folded(14, 2.0, &mut random),
        folded(24, 4.0, &mut random),
        dented(shapes::tube(14, 7), &mut random),
        dented(shapes::torus(16, 10), &mut random),
    ];
    meshes.extend(garments().into_iter().map(|(_, garment)| garment));
    let mut seen: [Seen; 3] = Default::default();
    for (mesh, positions) in &meshes {
        for _ in 0..150 {
            let Some(rays) = random_rays(positions, &mut random) else {
                continue;
            };
            let Ok(all) = Scissor::new(rays[0], rays[1]) else {
                continue;
            };
            let Some((kept, oracle)) = chosen(mesh, positions, &rays, &all) else {
                continue;
            };
            let first = all.clone().layers(CutLayers::First);
            let other_chains = oracle.pieces.keys().filter(|f| !kept.contains(f));
            let other_chains: BTreeSet<usize> = other_chains.copied().collect();
            let corners = |faces: &BTreeSet<usize>| -> BTreeSet<u32> {
                let all = faces
                    .iter()
                    .flat_map(|&f| &mesh.indices()[3 * f..3 * f + 3]);
                all.copied().collect()
            };
            let (corners, of_others) = (corners(&kept), corners(&other_chains));
            for (method, seen) in ALONG_EDGES.into_iter().zip(&mut seen) {
                let (after, torn) = torn_by(method, &first, mesh, positions);
                let (_, of_all) = torn_by(method, &all, mesh, positions);
                // The last vertex between the rays may have the plane in none of the faces of the chain.
                for v in after.vertices().skip(mesh.vertex_count()) {
                    let root = u32::from(after.root(v));
                    let is_beside = of_others.contains(&root) && !corners.contains(&root);
                    assert!(
                        !is_beside,
                        "{method:?} split {root}, which is of another chain, {rays:?}"
                    );
                }
                if method == CutMethod::Partition {
                    let across = |h: usize| {
                        mesh.pair(HalfEdgeId::new(h).expect("known"))
                            .map(HalfEdgeId::index)
                    };
                    let is_at = |h: usize, faces: &BTreeSet<usize>| {
                        let sides = [Some(h), across(h)].into_iter().flatten();
                        sides.into_iter().any(|h| faces.contains(&(h / 3)))
                    };
                    let is_beside = |&&h: &&usize| is_at(h, &other_chains) && !is_at(h, &kept);
                    assert_eq!(
                        torn.iter().find(is_beside),
                        None,
                        "torn at another chain, {rays:?}"
                    );
                    assert!(torn.is_subset(&of_all), "{rays:?}");
                    // All that is torn at these chains through all layers, but where others come near.
                    let ends = |h: usize| [h, h / 3 * 3 + (h + 1) % 3].map(|h| mesh.indices()[h]);
                    let others = of_all
                        .iter()
                        .filter(|&&h| !is_at(h, &kept))
                        .flat_map(|&h| ends(h));
                    let others: BTreeSet<u32> = others.collect();
                    for &h in of_all.iter().filter(|&&h| is_at(h, &kept)) {
                        let is_alone = ends(h).iter().all(|v| !others.contains(v));
                        assert!(!is_alone || torn.contains(&h), "{h} is not torn, {rays:?}");
                    }
                }
                seen.cuts += 1;
                seen.torn += torn.len();
                seen.chose += usize::from(torn.len() < of_all.len());
                seen.nothing += usize::from(torn.is_empty());
            }
        }
    }
    println!("{seen:?}");
    for seen in seen {
        assert!(
            seen.cuts > 300 && seen.chose > 100 && seen.nothing < seen.cuts / 2,
            "{seen:?}"
        );
    }
}

/// How many lines the plane has in common with some faces.
fn lines_of(
    mesh: &Mesh,
    positions: &Positions,
    plane: &Plane,
    faces: std::ops::Range<usize>,
) -> usize {
    let is_front = |v: u32| plane.distance(positions.as_slice()[v as usize]) >= 0.0;
    let edges = |f: usize| {
        let face = &mesh.indices()[3 * f..3 * f + 3];
        let edges = [[face[0], face[1]], [face[1], face[2]], [face[2], face[0]]];
        let crossed = edges
            .into_iter()
            .filter(|edge| is_front(edge[0]) != is_front(edge[1]));
        crossed
            .map(|edge| [edge[0].min(edge[1]), edge[0].max(edge[1])])
            .collect::<Vec<_>>()
    };
    let mut line: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
    let mut changed = true;
    while changed {
        changed = false;
        for f in faces.clone() {
            if let [a, b] = edges(f)[..] {
                let [one, other] = [a, b].map(|edge| *line.get(&edge).unwrap_or(&edge));
                let least = one.min(other);
                changed |=
                    line.insert(a, least) != Some(least) || line.insert(b, least) != Some(least);
            }
        }
    }
    line.values().collect::<BTreeSet<_>>().len()
}

/// Of sheets that are apart, those that are chosen are torn as if the others were not there.
#[test]
fn a_chosen_sheet_of_a_stack_is_torn_as_if_it_were_alone() {
    let mut random = Random(29);
    let mut seen: [Seen; 3] = Default::default();
    for _ in 0..400 {
        let n = 5 + random.below(6) as u32;
        let count = 2 + random.below(3) as u32;
        let (sheet, flat) = shapes::grid_with_diagonals(n, n, |x, y| (x * y) % 3 == 1);
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for layer in 0..count {
            let first = points.len() as u32;
            let shift = [random.next() - 0.5, random.next() - 0.5].map(|x| 0.6 * x);
            let mut jitter = || 0.3 / f64::from(n) * (random.next() - 0.5);
            for p in flat.as_slice() {
                points.push([
                    p.x + shift[0] + jitter(),
                    p.y + shift[1] + jitter(),
                    0.2 * f64::from(layer) + jitter(),
                ]);
            }
            let faces = sheet.indices().as_chunks::<3>().0.iter();
            triangles.extend(faces.map(|face| face.map(|v| v + first)));
        }
        let positions = Positions::new(points).expect("finite");
        let mesh = Mesh::build(positions.len(), &triangles).expect("sheets");
        let down = Vector::new(0.1 * random.next(), 0.0, -1.0);
        let mut somewhere =
            || Point::new(1.4 * random.next() - 0.2, 1.4 * random.next() - 0.2, 3.0);
        let [a, b] =
            [somewhere(), somewhere()].map(|origin| Ray::new(origin, down).expect("a ray"));
        let Ok(all) = Scissor::new(a, b) else {
            continue;
        };
        let Some((kept, oracle)) = chosen(&mesh, &positions, &[a, b], &all) else {
            continue;
        };
        let sheet_of = |f: usize| f / sheet.face_count();
        let sheets: BTreeSet<usize> = kept.iter().map(|&f| sheet_of(f)).collect();
        // A sheet that is cut is cut wherever the rays pass over it.
        let is_whole = |f: &usize| kept.contains(f) || !sheets.contains(&sheet_of(*f));
        if !oracle.pieces.keys().all(is_whole) {
            continue;
        }
        // The plane may meet a sheet in several lines, and where there is a vertex between the rays beside
        // one that passes outside, through all layers it would be split too.
        if !sheets.iter().all(|&number| {
            let own = number * sheet.face_count()..(number + 1) * sheet.face_count();
            lines_of(&mesh, &positions, &all.plane(), own) == 1
        }) {
            continue;
        }
        let alone = mesh.pieces(&mesh.components());
        for (method, seen) in ALONG_EDGES.into_iter().zip(&mut seen) {
            let first = all.clone().layers(CutLayers::First);
            let (_, torn) = torn_by(method, &first, &mesh, &positions);
            let (_, of_all) = torn_by(method, &all, &mesh, &positions);
            let mut expected = BTreeSet::new();
            for &number in &sheets {
                let own = &alone[number];
                let at = Positions::new(own.vertices().iter().map(|&v| positions.at(v)));
                let at = at.expect("usable");
                let (_, torn) = torn_by(method, &all, own.mesh(), &at);
                expected.extend(torn.into_iter().map(|h| own.corners()[h].index()));
            }
            assert_eq!(
                torn, expected,
                "{method:?} through {sheets:?} of {count} sheets"
            );
            seen.cuts += 1;
            seen.torn += torn.len();
            seen.chose += usize::from(torn.len() < of_all.len());
            seen.nothing += usize::from(torn.is_empty());
        }
    }
    println!("{seen:?}");
    for seen in seen {
        assert!(
            seen.cuts > 150 && seen.chose > 100 && seen.nothing < seen.cuts / 2,
            "{seen:?}"
        );
    }
}
