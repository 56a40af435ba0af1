//! Cuts a cloth that moves, and draws four moments of it into a PNG file, without a window or a graphics card.
//!
//! ```console
//! $ cargo run --release --example moving_cut -- moving_cut.png
//! ```
//!
//! A sheet hangs by two corners and swings, and is cut in the middle of it. Its texture coordinates follow, so
//! that the weave which is drawn on it goes on across the cut.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;

use tearmesh::{PerCorner, Plane, Point, Scissor, Vector, shapes};
use tearmesh_cloth::{Simulation, SimulationDef, Wind};
use tearmesh_view::{Camera, Picture, PictureSize, RenderOptions, fit, render};

const CELLS: u32 = 32;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1);
    let path = path.unwrap_or_else(|| "moving_cut.png".to_owned());

    // 1. The cloth, and values of our own that follow its edits.
    let (mesh, positions) = shapes::grid(CELLS, CELLS);
    let uv = mesh.half_edges().map(|h| positions.at(mesh.origin(h)));
    let mut uv = PerCorner::new(uv.map(|p| [p.x, p.y]).collect());
    let breeze = Wind {
        velocity_m_per_s: Vector::new(0.0, 0.0, 2.0),
        coefficient: 0.5,
    };
    let def = SimulationDef::default().with_wind(breeze);
    let mut sim = Simulation::new(mesh, &positions, def)?;
    let corners = [CELLS * (CELLS + 1), (CELLS + 1) * (CELLS + 1) - 1];
    sim.hold(corners.map(|v| sim.mesh().vertex(v as usize)))?;

    // 2. A camera that sees where it is, and where it will fall.
    let size = PictureSize::new(360, 480).expect("a size");
    let around = positions.as_slice().iter();
    let around = around.map(|p| Point::new(1.5 * p.x - 0.25, 1.9 * p.y - 0.8, p.z));
    let around: Vec<Point> = around.collect();
    let camera = fit(sim.mesh(), &around[..], Vector::y(), 35.0, size.as_f64())?;

    // 3. Time passes, the cut is made on the way, and everything follows it.
    let mut pictures = Vec::new();
    for moment in 0..4 {
        sim.advance(0.15, u64::MAX)?;
        sim.edits().replay(&mut uv);
        pictures.push(draw(&sim, &uv, &camera, size));
        if moment == 1 {
            let plane = Plane::new(Point::new(0.5, 0.45, 0.0), Vector::new(-0.4, 1.0, 0.0))?;
            sim.cut(&Scissor::by_plane(plane))?;
            sim.edits().replay(&mut uv);
        }
    }
    assert_eq!(sim.mesh().components().count(), 2);
    let file = BufWriter::new(File::create(path)?);
    Picture::beside(&pictures).write_png(file)?;
    Ok(())
}

fn draw(sim: &Simulation, uv: &PerCorner<[f64; 2]>, camera: &Camera, size: PictureSize) -> Picture {
    let options = RenderOptions {
        finer: 2,
        texture: uv.as_slice().to_vec(),
        ..RenderOptions::default()
    };
    render(sim.mesh(), sim.cloth().positions(), camera, size, &options)
}
