//! Draw buffers of a cloth against the cloth, wherever it is and whatever is done to it, and copies of them that take
//! over changes alone.

use tearmesh::geometry::{cross, length};
use tearmesh::{Plane, Point, Positions, Scissor, Vector, shapes};
use tearmesh_cloth::{
    BufferChanges, ClothBuffers, Simulation, SimulationDef, SimulationError, Wind, Wounds,
};

use super::{check, pass};
use crate::parts::scenes::methods;
use crate::parts::v;

/// The cells of a sheet of one metre along each side.
const CELLS: u32 = 8;

/// A column of the sheet where its texture has a seam.
const SEAM: f64 = 0.5;

/// How much further the texture to the right of the seam is.
const APART: f32 = 8.0;

/// What a GPU has, which gets changes alone.
#[derive(Default)]
struct Gpu {
    vertices: Vec<([f32; 3], [f32; 3], [f32; 2])>,
    indices: Vec<u32>,
    pieces: Vec<u32>,
}

impl Gpu {
    fn all_of(buffers: &ClothBuffers) -> Gpu {
        let all = |count: usize| (0..count as u32).collect::<Vec<_>>();
        let mut gpu = Gpu::default();
        let changes = BufferChanges {
            slots: all(buffers.positions().len()),
            corners: all(buffers.indices().len()),
            faces: all(buffers.pieces().len()),
        };
        gpu.upload(buffers, &changes);
        gpu
    }

    fn upload(&mut self, buffers: &ClothBuffers, changes: &BufferChanges) {
        self.vertices
            .resize(buffers.positions().len(), Default::default());
        for slot in changes.slots.iter().map(|&slot| slot as usize) {
            let [position, normal] =
                [buffers.positions(), buffers.normals()].map(|values| values[slot]);
            self.vertices[slot] = (position, normal, buffers.texture()[slot]);
        }
        take_over(&mut self.indices, buffers.indices(), &changes.corners);
        take_over(&mut self.pieces, buffers.pieces(), &changes.faces);
    }
}

fn take_over(copied: &mut Vec<u32>, from: &[u32], changed: &[u32]) {
    copied.resize(from.len(), u32::MAX);
    for index in changed.iter().map(|&index| index as usize) {
        copied[index] = from[index];
    }
}

/// The texture coordinates of a corner whose face has its middle at `middle`: those of its place on the sheet.
fn texture_at(place: Vector, middle: f64) -> [f32; 2] {
    let apart = if middle > SEAM { APART } else { 0.0 };
    [place.x as f32 + apart, place.y as f32]
}

/// A sheet with its lower left corner at `corner`, which hangs by its upper edge, with texture coordinates.
fn hung(corner: Vector, def: SimulationDef) -> Simulation {
    let (mesh, positions) = shapes::grid(CELLS, CELLS);
    let texture = mesh.faces().flat_map(|face| {
        let corners = mesh.face_vertices(face).map(|v| positions.at(v).coords);
        let middle = corners.iter().map(|p| p.x).sum::<f64>() / 3.0;
        corners.map(|p| texture_at(p, middle))
    });
    let def = SimulationDef {
        texture: texture.collect(),
        ..def
    };
    let points = positions.as_slice().iter().map(|p| p + corner);
    let positions = Positions::new(points).expect("finite");
    let mut sim = Simulation::new(mesh, &positions, def).expect("a simulation");
    let row = CELLS as usize + 1;
    sim.hold((row * (row - 1)..row * row).map(v)).expect("held");
    sim
}

/// Compares the buffers with the cloth, corner by corner.
fn is_drawn(sim: &mut Simulation, corner: Vector) {
    let mesh = sim.mesh();
    let faces: Vec<_> = mesh.faces().map(|f| mesh.face_vertices(f)).collect();
    let points = sim.cloth().positions().to_vec();
    let rest = sim.cloth().rest_corners().to_vec();
    let mut sums = vec![Vector::zeros(); points.len()];
    for face in &faces {
        let [a, b, c] = face.map(|v| points[v.index()]);
        for v in face {
            sums[v.index()] += cross(b - a, c - a);
        }
    }
    let buffers = sim.draw_buffers();
    for (face, corners) in faces.iter().enumerate() {
        let slots = [0, 1, 2].map(|c| buffers.indices()[3 * face + c] as usize);
        let [position, normal] =
            [buffers.positions(), buffers.normals()].map(|values| slots.map(|slot| values[slot]));
        let texture = slots.map(|slot| buffers.texture()[slot]);
        let is_right = texture[0][0] > APART / 2.0;
        for (c, v) in corners.iter().enumerate() {
            let wide = |x: [f32; 3]| Vector::from(x.map(f64::from));
            let drawn = buffers.origin() + wide(position[c]);
            assert!(length(drawn - points[v.index()]) < 2e-6, "drawn elsewhere");
            let sum = sums[v.index()];
            assert!(length(wide(normal[c]) - sum / length(sum)) < 1e-6);
            let [x, y] = texture_at(
                rest[3 * face + c] - Point::from(corner),
                if is_right { 1.0 } else { 0.0 },
            );
            let [u, w] = texture[c];
            assert!((u - x).abs() + (w - y).abs() < 4e-6, "{u} {w}, at {x} {y}");
        }
    }
}

#[test]
fn what_changed_brings_a_copy_of_the_buffers_up_to_date() {
    let far = Vector::new(500_000.0, 4_649_776.0, 0.0);
    for (name, method) in methods() {
        for corner in [Vector::zeros(), far] {
            let mut def = SimulationDef {
                method: method.clone(),
                ..SimulationDef::default()
            };
            // It turns the normals of vertices that are held as well.
            def.loads.wind = Some(Wind {
                velocity_m_per_s: Vector::z() * 3.0,
                coefficient: 1.0,
            });
            let mut sim = hung(corner, def);
            let buffers = sim.draw_buffers();
            let mut gpu = Gpu::all_of(buffers);
            assert_eq!(gpu.vertices.len(), 81 + 9, "a slot more along the seam");
            assert_eq!(
                buffers.origin() == Point::origin(),
                corner == Vector::zeros()
            );
            assert_eq!(buffers.take_changes(), Default::default());
            let middle = Point::from(corner) + Vector::new(0.0, 0.43, 0.0);
            let plane = Plane::new(middle, Vector::y()).expect("a plane");
            let mut cut = None;
            for frame in 0..30 {
                pass(&mut sim, 1.0 / 60.0);
                match frame {
                    5 => cut = Some(sim.cut(&Scissor::by_plane(plane)).expect("cut")),
                    15 => drop(sim.heal(Wounds::Cut(cut.expect("cut")))),
                    _ => {}
                }
                let buffers = sim.draw_buffers();
                let changes = buffers.take_changes();
                gpu.upload(buffers, &changes);
                let all = Gpu::all_of(buffers);
                assert_eq!(gpu.vertices, all.vertices, "{name}, frame {frame}");
                assert_eq!(gpu.indices, all.indices, "{name}, frame {frame}");
                assert_eq!(gpu.pieces, all.pieces, "{name}, frame {frame}");
                check(&mut sim);
                is_drawn(&mut sim, corner);
            }
        }
    }
}

#[test]
fn only_what_moved_is_listed() {
    let flat = SimulationDef::default().with_ripple(0.0);
    let mut sim = hung(Vector::zeros(), flat);
    for frame in 0..10 {
        pass(&mut sim, 1.0 / 60.0);
        let changes = sim.draw_buffers().take_changes();
        // Held vertices and their normals stay, as the sheet does not bend.
        assert_eq!(changes.slots.len(), 90 - 10, "frame {frame}");
        assert_eq!((changes.corners, changes.faces), (vec![], vec![]));
    }
}

/// A sheet that does not move, whose corners all have texture coordinates of their own: the sides of a cut coincide, so
/// the texture alone tells their slots apart.
#[test]
fn slots_of_which_only_the_texture_changes_are_listed() {
    let mut texture_alone = 0;
    for along in [0.25, 0.5, 0.75] {
        let (mesh, positions) = shapes::grid(4, 4);
        let def = SimulationDef {
            texture: (0..mesh.half_edge_count())
                .map(|c| [c as f32, 0.0])
                .collect(),
            ..SimulationDef::default()
        };
        let mut sim = Simulation::new(mesh, &positions, def).expect("a simulation");
        sim.hold((0..25).map(v)).expect("held");
        let mut gpu = Gpu::all_of(sim.draw_buffers());
        let plane = Plane::new(Point::new(along, 0.0, 0.0), Vector::x());
        let cut = sim
            .cut(&Scissor::by_plane(plane.expect("a plane")))
            .expect("cut");
        for _ in 0..20 {
            let buffers = sim.draw_buffers();
            let changes = buffers.take_changes();
            let before = gpu.vertices.clone();
            gpu.upload(buffers, &changes);
            let all = Gpu::all_of(buffers);
            assert_eq!((&gpu.vertices, &gpu.indices), (&all.vertices, &all.indices));
            let pairs = before.iter().zip(&all.vertices);
            let is_texture = pairs.filter(|(was, is)| (was.0, was.1) == (is.0, is.1) && was != is);
            texture_alone += is_texture.count();
            drop(sim.heal(Wounds::Cut(cut)));
            pass(&mut sim, 1.0 / 60.0);
        }
    }
    assert!(texture_alone > 0);
}

#[test]
fn texture_coordinates_for_another_mesh_are_refused() {
    let (mesh, positions) = shapes::grid(2, 2);
    let def = SimulationDef {
        texture: vec![[0.0; 2]; 9],
        ..SimulationDef::default()
    };
    let error = Simulation::new(mesh, &positions, def).expect_err("a coordinate by vertex");
    assert_eq!(
        error,
        SimulationError::Texture {
            given: 9,
            corners: 24
        }
    );
    assert_eq!(
        error.to_string(),
        "there are 9 texture coordinates for 24 corners"
    );
}
