//! A cloth drawn by wgpu while it is cut and swings, far from the origin of its coordinates. The GPU gets each frame
//! only what changed. `cargo run --release cloth.png` writes the last frame, as in the picture beside the manifest; no window is
//! needed.

mod screen;

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;

use nalgebra::{Isometry3, Matrix4, Orthographic3};
use tearmesh::{Mesh, Point, Positions, Ray, Scissor, Vector, shapes};
use tearmesh_cloth::{ClothBuffers, Simulation, SimulationDef, Wind};

use screen::{SIZE, Screen, Vertex};

/// The cells of the cloth along each of its sides, of a metre.
const CELLS: u32 = 32;
const FRAMES: u32 = 60;
const FRAME_S: f64 = 1.0 / 60.0;

/// The lower left corner of the cloth, in the metres of a map.
const CORNER: Vector = Vector::new(500_000.0, 4_649_776.0, 0.0);

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os()
        .nth(1)
        .ok_or("usage: tearmesh-engine PICTURE.png")?;
    let mut sim = cloth()?;
    let mut screen = Screen::new()?;
    let buffers = sim.draw_buffers();
    screen.vertices.set(&vertices(buffers));
    screen.indices.set(buffers.indices());
    let mut written = 0;
    for frame in 0..FRAMES {
        if frame == FRAMES / 3 {
            sim.cut(&Scissor::new(ray(0.7, -0.1)?, ray(0.4, 0.6)?)?)?;
        }
        sim.advance(FRAME_S, 10_000)?;
        let buffers = sim.draw_buffers();
        let changes = buffers.take_changes();
        written += screen.vertices.update(&vertices(buffers), &changes.slots);
        written += screen.indices.update(buffers.indices(), &changes.corners);
    }
    let pixels = screen.draw(
        camera(sim.draw_buffers().origin()),
        sim.draw_buffers().indices().len(),
    )?;
    println!(
        "{FRAMES} frames, {} kB written per frame",
        written / FRAMES as usize / 1000
    );
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), SIZE, SIZE);
    encoder.set_color(png::ColorType::Rgba);
    Ok(encoder.write_header()?.write_image_data(&pixels)?)
}

/// A cloth in the wind, which hangs by two corners. Its texture has a seam down its middle.
fn cloth() -> Result<Simulation, Box<dyn Error>> {
    let (mesh, positions) = shapes::grid(CELLS, CELLS);
    let points = positions.as_slice().iter().map(|p| p + CORNER);
    let wind = Wind {
        velocity_m_per_s: Vector::new(0.4, 0.0, 1.0),
        coefficient: 1.2,
    };
    let texture = texture(&mesh, &positions);
    let def = SimulationDef::default()
        .with_texture(texture)
        .with_wind(wind);
    let mut sim = Simulation::new(mesh, &Positions::new(points)?, def)?;
    let corners = [CELLS * (CELLS + 1), (CELLS + 1).pow(2) - 1];
    let corners = corners.map(|number| sim.mesh().vertex(number as usize));
    sim.hold(corners)?;
    Ok(sim)
}

/// The texture coordinates of all corners: faces to the right of the middle have another part of the texture.
fn texture(mesh: &Mesh, positions: &Positions) -> Vec<[f32; 2]> {
    let corners = mesh.faces().flat_map(|face| {
        let corners = mesh.face_vertices(face).map(|v| positions.at(v));
        let middle = corners.iter().map(|p| p.x).sum::<f64>() / 3.0;
        corners.map(|p| [(p.x + f64::from(middle > 0.5)) as f32, p.y as f32])
    });
    corners.collect()
}

fn vertices(buffers: &ClothBuffers) -> Vec<Vertex> {
    let slots = buffers
        .positions()
        .iter()
        .zip(buffers.normals())
        .zip(buffers.texture());
    let vertices = slots.map(|((&position, &normal), &texture)| Vertex {
        position,
        normal,
        texture,
    });
    vertices.collect()
}

/// A ray onto the cloth.
fn ray(x: f64, y: f64) -> Result<Ray, tearmesh::RayError> {
    Ray::new(Point::new(x, y, 5.0) + CORNER, -Vector::z())
}

/// From places relative to the origin of the buffers to the screen, whose depth is from 0 to 1.
fn camera(origin: Point) -> [[f32; 4]; 4] {
    let middle = Point::from(CORNER) + Vector::new(0.5, 0.45, 0.0) - origin;
    let middle = Point::from(middle);
    let eye = middle + Vector::new(0.8, 0.5, 3.0);
    let seen = Isometry3::look_at_rh(&eye, &middle, &Vector::y());
    let mut depth = Matrix4::identity();
    (depth[(2, 2)], depth[(2, 3)]) = (0.5, 0.5);
    let all = Orthographic3::new(-0.75, 0.75, -0.75, 0.75, 0.1, 10.0);
    (depth * all.to_homogeneous() * seen.to_homogeneous())
        .cast::<f32>()
        .into()
}
