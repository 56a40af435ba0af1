//! The first layers by the methods that insert nothing: chains that are found by brute force say where
//! each may tear, and sheets that are apart what it tears there.

use super::*;
use crate::work::ALONG_EDGES;
use tearmesh::HalfEdgeId;

/// What was seen of one method.
#[derive(Debug, Default)]
struct Seen {
    cuts: usize,
    /// Cuts where all layers would have torn more.
    chose: usize,
    nothing: usize,
}

impl Seen {
    fn count(&mut self, torn: &BTreeSet<usize>, of_all: &BTreeSet<usize>) {
        self.cuts += 1;
        self.chose += usize::from(torn.len() < of_all.len());
        self.nothing += usize::from(torn.is_empty());
    }
}

/// What a method tears of a mesh, as half-edges: their faces keep their numbers.
fn torn_by(method: CutMethod, scissor: &Scissor, work: &Work) -> (Mesh, BTreeSet<usize>) {
    let mut after = work.clone();
    after.cut(method, scissor);
    let mesh = after.mesh;
    assert_eq!(mesh.face_count(), work.mesh.face_count());
    let torn = mesh.half_edges().filter(|&h| mesh.ghost_pair(h).is_some());
    let torn = torn.map(HalfEdgeId::index).collect();
    (mesh, torn)
}

/// On any mesh a method tears nothing that is not at the chosen chains; and `partition` tears there all
/// that it tears when it goes through all layers, but where both meet.
#[test]
fn methods_along_edges_stay_with_the_chosen_chains() {
    let mut seen: [Seen; 3] = Default::default();
    for_rays(19, 150, |work, rays| {
        let Some(choice) = Choice::of(work, rays) else {
            return;
        };
        let Choice { kept, scissor, .. } = &choice;
        let mesh = &work.mesh;
        let first = scissor.clone().with_layers(CutLayers::First);
        let others = choice.oracle.pieces.keys().filter(|f| !kept.contains(f));
        let others: BTreeSet<usize> = others.copied().collect();
        let corners = |faces: &BTreeSet<usize>| -> BTreeSet<u32> {
            let faces = faces.iter().flat_map(|&f| triangles(mesh)[f]);
            faces.collect()
        };
        let (corners, of_others) = (corners(kept), corners(&others));
        let is_at = |h: usize, faces: &BTreeSet<usize>| {
            let across = mesh.pair(mesh.half_edge(h));
            let sides = [Some(h / 3), across.map(|h| h.face().index())];
            sides.into_iter().flatten().any(|f| faces.contains(&f))
        };
        for (method, seen) in ALONG_EDGES.into_iter().zip(&mut seen) {
            let (after, torn) = torn_by(method, &first, work);
            let (_, of_all) = torn_by(method, scissor, work);
            seen.count(&torn, &of_all);
            // The last vertex between the rays may have the plane in none of the faces of the chain.
            for v in after.vertices().skip(mesh.vertex_count()) {
                let root = u32::from(after.root(v));
                let is_beside = of_others.contains(&root) && !corners.contains(&root);
                assert!(!is_beside, "{method:?} split {root}, {rays:?}");
            }
            if method != CutMethod::Partition {
                continue;
            }
            let is_beside = |h: &usize| is_at(*h, &others) && !is_at(*h, kept);
            assert!(!torn.iter().any(is_beside), "torn elsewhere, {rays:?}");
            assert!(torn.is_subset(&of_all), "{rays:?}");
            // All that is torn at these chains through all layers, but where others come near.
            let (here, beside): (Vec<usize>, Vec<usize>) =
                of_all.iter().partition(|h| is_at(**h, kept));
            let ends = |h: usize| [h, h / 3 * 3 + (h + 1) % 3].map(|h| mesh.indices()[h]);
            let beside: BTreeSet<u32> = beside.into_iter().flat_map(ends).collect();
            for h in here {
                let is_alone = ends(h).iter().all(|v| !beside.contains(v));
                assert!(!is_alone || torn.contains(&h), "{h} is whole, {rays:?}");
            }
        }
    });
    for seen in seen {
        let is_idle = seen.nothing >= seen.cuts / 2;
        assert!(seen.cuts > 300 && seen.chose > 100 && !is_idle, "{seen:?}");
    }
}

/// Some sheets one above the other, which are alike but for small moves, and a mesh of one of them.
fn stack(random: &mut Random) -> (Work, usize) {
    let n = 5 + random.below(6) as u32;
    let (sheet, flat) = shapes::grid_with_diagonals(n, n, |x, y| (x * y) % 3 == 1);
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for layer in 0..2 + random.below(3) {
        let first = points.len() as u32;
        let shift = [random.next() - 0.5, random.next() - 0.5].map(|x| 0.6 * x);
        let mut jitter = || 0.3 / f64::from(n) * (random.next() - 0.5);
        points.extend(flat.as_slice().iter().map(|p| {
            let [x, y] = [p.x + shift[0] + jitter(), p.y + shift[1] + jitter()];
            [x, y, 0.2 * layer as f64 + jitter()]
        }));
        let own = triangles(&sheet).iter();
        faces.extend(own.map(|face| face.map(|v| v + first)));
    }
    let mesh = Mesh::build(points.len(), &faces).expect("sheets");
    let positions = Positions::new(points).expect("finite");
    (Work::new((mesh, positions)), sheet.face_count())
}

/// Of sheets that are apart, those that are chosen are torn as if the others were not there.
#[test]
fn a_chosen_sheet_of_a_stack_is_torn_as_if_it_were_alone() {
    let mut random = Random(29);
    let mut seen: [Seen; 3] = Default::default();
    for _ in 0..400 {
        let (work, faces) = stack(&mut random);
        let down = Vector::new(0.1 * random.next(), 0.0, -1.0);
        let rays = [(); 2].map(|()| {
            let [x, y] = [(); 2].map(|()| 1.4 * random.next() - 0.2);
            Ray::new(Point::new(x, y, 3.0), down).expect("a ray")
        });
        let Some(choice) = Choice::of(&work, rays) else {
            continue;
        };
        let Choice { kept, scissor, .. } = &choice;
        let sheets: BTreeSet<usize> = kept.iter().map(|f| f / faces).collect();
        // A sheet that is cut is cut wherever the rays pass over it.
        let is_whole = |f: &usize| kept.contains(f) || !sheets.contains(&(f / faces));
        // The plane may meet a sheet in several lines, and where there is a vertex between the rays beside
        // one that passes outside, through all layers it would be split too.
        let Ok(lines) = Oracle::new(&work, &cut_of(&rays).through()) else {
            continue;
        };
        let is_one_line = |sheet: &usize| {
            let own = lines.chain.range(sheet * faces..(sheet + 1) * faces);
            own.map(|(_, line)| line).collect::<BTreeSet<_>>().len() == 1
        };
        if !choice.oracle.pieces.keys().all(is_whole) || !sheets.iter().all(is_one_line) {
            continue;
        }
        let alone = work.mesh.pieces(&work.mesh.components());
        for (method, seen) in ALONG_EDGES.into_iter().zip(&mut seen) {
            let first = scissor.clone().with_layers(CutLayers::First);
            let (_, torn) = torn_by(method, &first, &work);
            let (_, of_all) = torn_by(method, scissor, &work);
            let mut expected = BTreeSet::new();
            for own in sheets.iter().map(|&number| &alone[number]) {
                let at = own.vertices.iter().map(|&v| work.positions.at(v));
                let at = Positions::new(at).expect("usable");
                let (_, torn) = torn_by(method, scissor, &Work::new((own.mesh.clone(), at)));
                expected.extend(torn.into_iter().map(|h| own.corners[h].index()));
            }
            assert_eq!(torn, expected, "{method:?} through {sheets:?}");
            seen.count(&torn, &of_all);
        }
    }
    for seen in seen {
        let is_idle = seen.nothing >= seen.cuts / 2;
        assert!(seen.cuts > 150 && seen.chose > 100 && !is_idle, "{seen:?}");
    }
}
