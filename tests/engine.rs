//! Meshes from the buffers of an engine, and buffers back: against sets of pairs, which are made anew
//! after every edit.

use std::collections::{BTreeMap, BTreeSet};

use tearmesh::script::{Step, World};
use tearmesh::weld::{self, WeldError};
use tearmesh::{
    CutMethod, DrawBuffers, DrawChanges, Edits, HalfEdgeId, Mesh, PerCorner, Plane, Point,
    Positions, Scissor, Vector, shapes, split,
};

use crate::cases::scripts;
use crate::random::Random;

type Value = [f64; 2];

/// What a GPU has, which is told of changes alone.
#[derive(Default)]
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
        assert!(
            changes.slots.is_sorted_by(|a, b| a < b) && changes.corners.is_sorted_by(|a, b| a < b)
        );
        self.vertices
            .resize(buffers.len(), ([f32::NAN; 3], [f64::NAN; 2]));
        self.indices.resize(buffers.indices().len(), u32::MAX);
        for &slot in &changes.slots {
            let place = buffers.place_f32(slot, positions);
            self.vertices[slot as usize] = (place, *buffers.value(slot));
        }
        for &corner in &changes.corners {
            self.indices[corner as usize] = buffers.indices()[corner as usize];
        }
    }

    fn full(buffers: &DrawBuffers<Value>, positions: &Positions) -> Gpu {
        let places = buffers.places_f32(positions);
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
fn buffers_that_follow_are_those_made_anew_and_a_gpu_is_told_of_all_that_changed() {
    struct Beside {
        values: PerCorner<Value>,
        buffers: DrawBuffers<Value>,
        gpu: Gpu,
    }
    let (mut count, mut edits, mut seams, mut written, mut all) = (0, 0, 0, 0, 0);
    for script in scripts(3_000) {
        count += 1;
        let mut beside: Option<Beside> = None;
        script.run(|world: &World, step: &Step<'_>| {
            let beside = beside.get_or_insert_with(|| {
                let values = values_of(&world.mesh);
                let buffers = DrawBuffers::new(&world.mesh, values.clone());
                let gpu = Gpu::full(&buffers, &world.positions);
                let values = PerCorner::new(values);
                Beside {
                    values,
                    buffers,
                    gpu,
                }
            });
            let Beside {
                values,
                buffers,
                gpu,
            } = beside;
            world.edits.replay(&mut (&mut *values, &mut *buffers));
            seams += check(&world.mesh, values.as_slice(), buffers);
            let changes = buffers.take_changes();
            gpu.upload(buffers, &changes, &world.positions);
            let full = Gpu::full(buffers, &world.positions);
            assert_eq!(
                gpu.vertices, full.vertices,
                "the vertex buffer after {step:?} of\n{script}"
            );
            assert_eq!(
                gpu.indices, full.indices,
                "the index buffer after {step:?} of\n{script}"
            );
            assert_eq!(buffers.take_changes(), DrawChanges::default());
            edits += 1;
            written += changes.slots.len();
            all += buffers.len();
        });
    }
    println!("{edits} steps, {seams} slots beyond vertices, {written} of {all} slots written");
    assert!(edits > 10 * count && seams > 100 * count && 10 * written < all);
}

/// What an edit writes does not grow with the mesh.
#[test]
fn an_edit_writes_what_it_touches() {
    let (mut mesh, mut positions) = shapes::grid(100, 100);
    let values = values_of(&mesh);
    let mut buffers = DrawBuffers::new(&mesh, values);
    let mut edits = Edits::new();
    let v = mesh.vertices().nth(5100).expect("10,201");
    let faces: Vec<_> = mesh.faces_of(v).take(3).collect();
    split::vertex(&mut mesh, v, &faces, &mut edits).expect("three stay");
    edits.replay(&mut (&mut positions, &mut buffers));
    let changes = buffers.take_changes();
    assert!(
        changes.slots.len() <= 4 && changes.corners.len() <= 6,
        "{changes:?}"
    );
}

/// The buffers that an engine would have of a mesh: a vertex for each pair of a vertex and a value, in
/// any order.
fn engine_buffers(
    mesh: &Mesh,
    positions: &Positions,
    random: &mut Random,
) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let values = values_of(mesh);
    let pairs = mesh
        .half_edges()
        .map(|h| (mesh.origin(h), values[h.index()].map(f64::to_bits)));
    let pairs: Vec<_> = pairs.collect();
    let mut order: Vec<_> = pairs
        .iter()
        .copied()
        .collect::<BTreeSet<_>>()
        .into_iter()
        .collect();
    random.shuffle(&mut order);
    let number: BTreeMap<_, u32> = order.iter().copied().zip(0..).collect();
    let places = order.iter().map(|(v, _)| {
        let p = positions.at(*v);
        // A zero has two signs, and is one place.
        [p.x, p.y, p.z].map(|x| {
            if x == 0.0 && random.next() < 0.5 {
                -0.0
            } else {
                x as f32
            }
        })
    });
    let faces = pairs
        .as_chunks::<3>()
        .0
        .iter()
        .map(|face| face.map(|pair| number[&pair]));
    (places.collect(), faces.collect())
}

#[test]
fn a_mesh_that_was_taken_apart_at_its_seams_is_welded() {
    let mut random = Random(3);
    for (mesh, positions) in [
        shapes::grid(5, 4),
        shapes::octahedron(),
        shapes::tube(7, 3),
        shapes::torus(9, 7),
        shapes::fan(6, false),
    ] {
        for _ in 0..20 {
            let (places, triangles) = engine_buffers(&mesh, &positions, &mut random);
            assert!(places.len() > mesh.vertex_count());
            let welded = weld::by_place(&places, &triangles).expect("a manifold");
            assert_eq!(welded.mesh.check(), []);
            assert_eq!(welded.mesh.vertex_count(), mesh.vertex_count());
            assert_eq!(welded.vertices.len(), places.len());
            // The same faces, by a map of vertices that is one to one.
            let mut to: BTreeMap<u32, u32> = BTreeMap::new();
            let mut highest = None;
            for (h, &v) in mesh.indices().iter().enumerate() {
                let own = welded.mesh.indices()[h];
                assert_eq!(*to.entry(v).or_insert(own), own, "corner {h}");
                let slot = triangles[h / 3][h % 3] as usize;
                assert_eq!(u32::from(welded.vertices[slot]), own, "the map");
            }
            assert_eq!(to.values().collect::<BTreeSet<_>>().len(), to.len());
            for (v, place) in welded.vertices.iter().zip(&places) {
                assert_eq!(welded.positions.tail_f32(v.index())[0], *place);
                let is_new = highest.is_none_or(|highest| *v > highest);
                assert!(
                    !is_new || v.index() == highest.map_or(0, |v| v.index() + 1),
                    "in order"
                );
                highest = highest.max(Some(*v));
            }
        }
    }
}

#[test]
fn buffers_that_make_no_mesh_are_refused() {
    let places = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-0.0, 0.0, 0.0]];
    let refused = |places: &[[f32; 3]], triangles: &[[u32; 3]]| {
        weld::by_place(places, triangles).expect_err("no mesh")
    };
    let error = refused(&places, &[[0, 1, 4]]);
    assert_eq!(error, WeldError::Index { index: 4, known: 4 });
    assert_eq!(
        error.to_string(),
        "a triangle names vertex 4, but there are 4 vertices"
    );
    let mut spoilt = places;
    spoilt[3][1] = f32::NAN;
    let WeldError::Place(error) = refused(&spoilt, &[[0, 1, 2]]) else {
        panic!("no place")
    };
    assert_eq!(error.unusable()[0].0.index(), 3, "a vertex of the buffer");
    let error = refused(&places, &[[0, 1, 3]]);
    assert!(
        matches!(error, WeldError::Build(_)),
        "0 and 3 are at one place: {error}"
    );
}

/// The t-shirt of the corpus, if there is one.
#[test]
fn a_garment_has_a_vertex_for_a_gpu_for_each_place_and_texture_coordinate() {
    let Some(folder) = std::env::var_os("TEARMESH_CORPUS") else {
        return;
    };
    let path = std::path::Path::new(&folder).join("snug_tshirt.obj");
    let text = std::fs::read_to_string(path).expect("the t-shirt of the corpus");
    let (mut places, mut texture) = (Vec::new(), Vec::new());
    let mut corners: Vec<[u32; 2]> = Vec::new();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let number = |word: &str| word.parse::<f32>().expect("a number");
        match words.next() {
            Some("v") => places.push([(); 3].map(|()| number(words.next().expect("three")))),
            Some("vt") => {
                texture.push([(); 2].map(|()| f64::from(number(words.next().expect("two")))));
            }
            Some("f") => corners.extend(words.map(|word| {
                let mut indices = word
                    .split('/')
                    .map(|index| index.parse::<u32>().expect("an index") - 1);
                [(); 2].map(|()| indices.next().expect("two indices"))
            })),
            _ => {}
        }
    }
    // As an engine has it: a vertex for each pair that some corner names.
    let pairs: BTreeSet<[u32; 2]> = corners.iter().copied().collect();
    let number: BTreeMap<[u32; 2], u32> = pairs.iter().copied().zip(0..).collect();
    let on_gpu: Vec<[f32; 3]> = pairs.iter().map(|&[v, _]| places[v as usize]).collect();
    let triangles = corners
        .as_chunks::<3>()
        .0
        .iter()
        .map(|face| face.map(|pair| number[&pair]));
    let triangles: Vec<[u32; 3]> = triangles.collect();
    let welded = weld::by_place(&on_gpu, &triangles).expect("a manifold");
    let (mut mesh, mut positions) = (welded.mesh, welded.positions);
    let values: Vec<Value> = corners
        .iter()
        .map(|&[_, vt]| texture[vt as usize])
        .collect();
    let mut buffers = DrawBuffers::new(&mesh, values.clone());
    println!(
        "{} vertices, {} for a GPU",
        mesh.vertex_count(),
        buffers.len()
    );
    assert_eq!(
        (mesh.vertex_count(), buffers.len(), on_gpu.len()),
        (4424, 4649, 4649)
    );
    // And after a cut from side to side.
    let middle = positions
        .as_slice()
        .iter()
        .map(|p| p.coords)
        .sum::<Vector>()
        / 4424.0;
    let plane = Plane::new(Point::from(middle), Vector::new(0.1, 1.0, 0.05)).expect("a plane");
    let mut values = PerCorner::new(values);
    let mut edits = Edits::new();
    let scissor = Scissor::by_plane(plane);
    scissor
        .cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)
        .expect("in step");
    edits.replay(&mut (&mut values, &mut buffers));
    check(&mesh, values.as_slice(), &buffers);
    let changes = buffers.take_changes();
    println!(
        "after a cut {} and {}, {} of these written",
        mesh.vertex_count(),
        buffers.len(),
        changes.slots.len()
    );
    assert!(mesh.vertex_count() > 4500 && changes.slots.len() < buffers.len() / 4);
}
