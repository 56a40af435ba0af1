//! Meshes from the buffers of an engine, and buffers back: against sets of pairs, which are made anew
//! after every edit.

use std::collections::{BTreeMap, BTreeSet};

use tearmesh::engine::{DrawBuffers, DrawChanges, draw_origin, normals};
use tearmesh::script::{Step, World};
use tearmesh::unsewn::{self, WeldError};
use tearmesh::{
    CutMethod, FaceId, HalfEdgeId, Mesh, PerCorner, Plane, Point, Positions, Scissor, Vector,
    shapes,
};

use crate::cases::cases;
use crate::oracle::joined_sets;
use crate::plain::{Plain, fan};
use crate::random::Random;
use crate::scripts::scripts;
use crate::surfaces::corpus;
use crate::work::Work;

type Value = [f64; 2];

/// Any origin serves, if it is the same throughout.
const ORIGIN: Point = Point::new(0.25, -3.0, 1.0);

/// What a GPU has, which is told of changes alone.
#[derive(PartialEq)]
struct Gpu {
    vertices: Vec<([f32; 3], Value)>,
    indices: Vec<u32>,
}

impl Gpu {
    fn upload(
        &mut self,
        buffers: &DrawBuffers<Value>,
        changes: &DrawChanges,
        positions: &Positions,
    ) {
        assert!(changes.slots.is_sorted_by(|a, b| a < b));
        assert!(changes.corners.is_sorted_by(|a, b| a < b));
        self.vertices
            .resize(buffers.len(), ([f32::NAN; 3], [f64::NAN; 2]));
        self.indices.resize(buffers.indices().len(), u32::MAX);
        for &slot in &changes.slots {
            let place = buffers.place_f32(slot, positions, ORIGIN);
            self.vertices[slot as usize] = (place, *buffers.value(slot));
        }
        for &corner in &changes.corners {
            self.indices[corner as usize] = buffers.indices()[corner as usize];
        }
    }

    fn full(buffers: &DrawBuffers<Value>, positions: &Positions) -> Gpu {
        let places = buffers.places_f32(positions, ORIGIN);
        let values = buffers.iter().map(|(_, &value)| value);
        Gpu {
            vertices: places.into_iter().zip(values).collect(),
            indices: buffers.indices().to_vec(),
        }
    }
}

/// The buffers hold every pair of a vertex and a value that some corner has, once each; and each corner
/// names its own.
fn check(mesh: &Mesh, values: &[Value], buffers: &DrawBuffers<Value>) -> usize {
    let pair = |h: usize| (mesh.indices()[h], values[h].map(f64::to_bits));
    let pairs: BTreeSet<_> = (0..mesh.half_edge_count()).map(pair).collect();
    let slots = buffers
        .iter()
        .map(|(v, value)| (u32::from(v), value.map(f64::to_bits)));
    let slots: Vec<_> = slots.collect();
    assert_eq!(slots.len(), pairs.len(), "a slot for each pair");
    assert_eq!(
        slots.iter().copied().collect::<BTreeSet<_>>(),
        pairs,
        "each pair"
    );
    assert_eq!(buffers.indices().len(), mesh.half_edge_count());
    for (h, &slot) in buffers.indices().iter().enumerate() {
        assert_eq!(slots[slot as usize], pair(h), "corner {h}");
        assert_eq!(u32::from(buffers.vertex(slot)), mesh.indices()[h]);
    }
    let rebuilt = DrawBuffers::new(mesh, values.to_vec());
    assert_eq!(rebuilt.len(), buffers.len(), "as many as from nothing");
    slots.len() - slots.iter().map(|(v, _)| v).collect::<BTreeSet<_>>().len()
}

/// Values with seams: those of a vertex differ on two sides, as its faces happen to be numbered.
fn values_of(mesh: &Mesh) -> Vec<Value> {
    let value = |h: HalfEdgeId| {
        let v = f64::from(u32::from(mesh.origin(h)));
        match h.face().index() % 3 {
            0 => [v, 0.25],
            _ => [v / 2.0, -1.0],
        }
    };
    mesh.half_edges().map(value).collect()
}

#[test]
fn buffers_that_follow_are_those_made_anew() {
    let (mut count, mut edits, mut seams, mut written, mut all) = (0, 0, 0, 0, 0);
    for script in scripts() {
        count += 1;
        let mut beside: Option<(PerCorner<Value>, DrawBuffers<Value>, Gpu)> = None;
        script.run(|world: &World, step: &Step<'_>| {
            let (values, buffers, gpu) = beside.get_or_insert_with(|| {
                let values = values_of(&world.mesh);
                let buffers = DrawBuffers::new(&world.mesh, values.clone());
                let gpu = Gpu::full(&buffers, &world.positions);
                (PerCorner::new(values), buffers, gpu)
            });
            world.edits.replay(&mut (&mut *values, &mut *buffers));
            seams += check(&world.mesh, values.as_slice(), buffers);
            let changes = buffers.take_changes();
            gpu.upload(buffers, &changes, &world.positions);
            let full = Gpu::full(buffers, &world.positions);
            assert!(*gpu == full, "after {step:?} of\n{script}");
            assert_eq!(buffers.take_changes(), DrawChanges::default());
            edits += 1;
            written += changes.slots.len();
            all += buffers.len();
        });
    }
    assert!(edits > 10 * count && seams > 100 * count && 10 * written < all);
}

/// Patches of all sizes, near zero and far from it.
#[test]
fn positions_relative_to_the_draw_origin_are_exact_to_a_millionth() {
    let mut random = Random(7);
    let (mut moved, mut stayed) = (0, 0);
    for _ in 0..10 * cases() {
        let extent = 10_f64.powf(24.0 * random.next() - 12.0);
        let away = extent * 10_f64.powf(9.0 * random.next() - 1.0);
        let corner = [0; 3].map(|_| away * (2.0 * random.next() - 1.0));
        let points: Vec<Point> = (0..4)
            .map(|_| Point::from(corner.map(|x| x + extent * random.next())))
            .collect();
        let origin = draw_origin(points.iter().copied());
        let along = |axis: usize| points.iter().map(move |p| p[axis]);
        let least = |axis| along(axis).fold(f64::INFINITY, f64::min);
        let most = |axis| along(axis).fold(f64::NEG_INFINITY, f64::max);
        let given = (0..3)
            .map(|axis| most(axis) - least(axis))
            .fold(0.0, f64::max);
        for axis in 0..3 {
            for x in along(axis) {
                let drawn = f64::from((x - origin[axis]) as f32) + origin[axis];
                assert!((drawn - x).abs() <= 1e-6 * given, "{points:?}: {origin}");
            }
        }
        let farthest = (0..3)
            .flat_map(along)
            .fold(0.0, |far: f64, x| far.max(x.abs()));
        if farthest <= 2.0 * given {
            assert_eq!(origin, Point::origin(), "{points:?}");
        }
        let is_moved = origin != Point::origin();
        (moved, stayed) = (
            moved + usize::from(is_moved),
            stayed + usize::from(!is_moved),
        );
    }
    assert!(
        moved > stayed && stayed > 100,
        "{moved} moved, {stayed} stayed"
    );
    // None, one, and those at both ends of the numbers.
    let one = Point::new(500_000.25, 0.1, 0.0);
    assert_eq!(draw_origin([]), Point::origin());
    assert_eq!(draw_origin([one, one]), one);
    let ends = [f64::MAX, -f64::MAX].map(|x| Point::new(x, 1.0, 0.0));
    assert_eq!(draw_origin(ends), Point::origin());
}

/// Twice the area of a face, along its normal.
fn spanned(mesh: &Mesh, positions: &Positions, f: FaceId) -> Vector {
    let [a, b, c] = mesh.face_vertices(f).map(|v| positions.at(v));
    (b - a).cross(&(c - a))
}

/// Judged by sets: the faces of a vertex are joined across the pairs that are no crease.
#[test]
fn normals_are_means_by_area_between_creases() {
    let (mut steps, mut corners, mut creases) = (0, 0, 0);
    for script in scripts() {
        script.run(|world: &World, step: &Step<'_>| {
            steps += 1;
            let (mesh, at) = (&world.mesh, &world.positions);
            let normal = |f| spanned(mesh, at, f);
            let unit = |f| normal(f).try_normalize(0.0).unwrap_or_default();
            let crease = [-2.0, 0.9, 0.99][steps % 3];
            let is_near = |h: HalfEdgeId, g: HalfEdgeId| {
                (unit(h.face()).dot(&unit(g.face())) - crease).abs() < 1e-12
            };
            let normals = normals(mesh, at, crease);
            for v in mesh.vertices() {
                let around: Vec<HalfEdgeId> = mesh.corners_of(v).collect();
                let mut joined = Vec::new();
                let mut is_vague = false;
                for (i, &h) in around.iter().enumerate() {
                    let Some(pair) = mesh.pair(h) else { continue };
                    let other = around.iter().position(|&g| g == pair.next());
                    let other = other.expect("a pair's next corner is of the same vertex");
                    is_vague |= is_near(h, pair);
                    match unit(h.face()).dot(&unit(pair.face())) >= crease {
                        true => joined.push([i, other]),
                        false => creases += 1,
                    }
                }
                if is_vague {
                    continue; // Rounding has a say.
                }
                let parts = joined_sets(around.len(), &joined);
                for (i, h) in around.iter().enumerate() {
                    let part = (0..around.len()).filter(|&j| parts[j] == parts[i]);
                    let sum: Vector = part.map(|j| normal(around[j].face())).sum();
                    let error = (normals[h.index()] * sum.norm() - sum).norm();
                    assert!(error < 1e-12, "{h} after {step:?} of\n{script}");
                    corners += 1;
                }
            }
        });
    }
    assert!(creases as u64 > 10 * cases(), "{creases} of {corners}");
}

/// The buffers that an engine would have of a mesh: a vertex for each pair of a vertex and a value, in
/// any order.
fn engine_buffers(work: &Work, random: &mut Random) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let values = values_of(&work.mesh);
    let corners = work.mesh.half_edges().zip(values);
    let pairs = corners.map(|(h, value)| (work.mesh.origin(h), value.map(f64::to_bits)));
    let pairs: Vec<_> = pairs.collect();
    let mut order: Vec<_> = pairs.clone();
    order.sort_unstable();
    order.dedup();
    random.shuffle(&mut order);
    let number: BTreeMap<_, u32> = order.iter().copied().zip(0..).collect();
    let places = order.iter().map(|(v, _)| {
        let place: [f64; 3] = work.positions.at(*v).into();
        // A zero has two signs, and is one place.
        place.map(|x| match x == 0.0 && random.next() < 0.5 {
            true => -0.0,
            false => x as f32,
        })
    });
    let places = places.collect();
    let faces = pairs.as_chunks::<3>().0.iter();
    (
        places,
        faces.map(|face| face.map(|pair| number[&pair])).collect(),
    )
}

#[test]
fn a_mesh_that_was_taken_apart_at_its_seams_is_welded() {
    let mut random = Random(3);
    for shape in [
        shapes::grid(5, 4),
        shapes::octahedron(),
        shapes::tube(7, 3),
        shapes::torus(9, 7),
        shapes::fan(6, false),
    ] {
        let work = Work::new(shape);
        for _ in 0..20 {
            let (places, faces) = engine_buffers(&work, &mut random);
            assert!(places.len() > work.mesh.vertex_count());
            let (own, positions) = unsewn::weld(&places, &faces).expect("usable buffers");
            assert_eq!(own.check(), []);
            assert_eq!(own.vertex_count(), work.mesh.vertex_count());
            // The same faces, by a map of vertices that is one to one, at the places of the buffer.
            let mut to: BTreeMap<u32, u32> = BTreeMap::new();
            let slots = faces.as_flattened();
            for ((&v, &own), &slot) in work.mesh.indices().iter().zip(own.indices()).zip(slots) {
                assert_eq!(*to.entry(v).or_insert(own), own, "{v}");
                let at: [f64; 3] = positions.as_slice()[own as usize].into();
                assert_eq!(at.map(|x| x as f32), places[slot as usize]);
            }
            assert_eq!(to.values().collect::<BTreeSet<_>>().len(), to.len());
        }
    }
}

#[test]
fn buffers_that_make_no_mesh_are_refused() {
    let places = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-0.0, 0.0, 0.0]];
    let refused = |places: &[[f32; 3]], face| unsewn::weld(places, &[face]).expect_err("no mesh");
    let error = refused(&places, [0, 1, 4]);
    assert_eq!(error, WeldError::Index { index: 4, known: 4 });
    let told = "a triangle names vertex 4, but there are 4 vertices";
    assert_eq!(error.to_string(), told);
    let mut spoilt = places;
    spoilt[3][1] = f32::NAN;
    let WeldError::Place(error) = refused(&spoilt, [0, 1, 2]) else {
        panic!("no place")
    };
    assert_eq!(error.unusable()[0].0.index(), 3, "a vertex of the buffer");
}

/// The t-shirt of the corpus, if there is one: on a GPU it has a vertex for each place and texture
/// coordinate, also after a cut from side to side.
#[test]
fn a_garment_is_welded_and_its_buffers_follow_a_cut() {
    for path in corpus(&["snug_tshirt"]) {
        let text = std::fs::read_to_string(&path).expect("a file");
        let file = Plain::read(&text);
        // As an engine has it: a vertex for each pair that some corner names.
        let corners = file.faces.iter().zip(&file.face_textures);
        let corners = corners.flat_map(|(vertices, textures)| {
            let pairs = vertices.iter().zip(textures);
            let pairs: Vec<[usize; 2]> = pairs.map(|(&v, vt)| [v, vt.unwrap_or(0)]).collect();
            fan(&pairs).collect::<Vec<_>>()
        });
        let corners: Vec<[[usize; 2]; 3]> = corners.collect();
        let pairs: BTreeSet<[usize; 2]> = corners.as_flattened().iter().copied().collect();
        let number: BTreeMap<[usize; 2], u32> = pairs.iter().copied().zip(0..).collect();
        let on_gpu = pairs.iter().map(|&[v, _]| file.at(v).map(|x| x as f32));
        let on_gpu: Vec<[f32; 3]> = on_gpu.collect();
        let faces = corners.iter().map(|face| face.map(|pair| number[&pair]));
        let faces: Vec<[u32; 3]> = faces.collect();
        let welded = unsewn::weld(&on_gpu, &faces).expect("usable buffers");
        let mut work = Work::new(welded);
        let value = |&[_, vt]: &[usize; 2]| [0, 1].map(|i| file.texture[vt][i]);
        let values = corners.as_flattened().iter().map(value);
        let mut values = PerCorner::new(values.collect::<Vec<Value>>());
        let mut buffers = DrawBuffers::new(&work.mesh, values.as_slice().to_vec());
        let counts = [work.mesh.vertex_count(), buffers.len(), on_gpu.len()];
        assert_eq!(counts, [4424, 4649, 4649]);
        let sum: Vector = work.positions.as_slice().iter().map(|p| p.coords).sum();
        let middle = Point::from(sum / 4424.0);
        let plane = Plane::new(middle, Vector::new(0.1, 1.0, 0.05)).expect("a plane");
        work.cut(CutMethod::Exact, &Scissor::by_plane(plane));
        work.edits.replay(&mut (&mut values, &mut buffers));
        check(&work.mesh, values.as_slice(), &buffers);
        let written = buffers.take_changes().slots.len();
        assert!(work.mesh.vertex_count() > 4500 && written < buffers.len() / 4);
    }
}
