//! A picture of a mesh: shaded from both sides, its pieces coloured, its seams and its boundary drawn over.

use std::io::{self, Write};

use tearmesh::geometry::max_abs;
use tearmesh::{FaceId, Mesh, Place, Point, Scissor, Vector};

use crate::bounds::Bounds;
use crate::camera::Camera;
use crate::figure::{Figure, crease_cosine};
use crate::palette::{self, Color};
use crate::picture::{Picture, PictureSize};
use crate::shade::{Light, SHADOW};
use crate::sky::Sky;
use crate::strokes::{Kind, Stroke, Strokes};
use crate::surface::{Facing, Lattice, Surface};
use crate::trace::trace;

/// How a mesh is drawn, and what is drawn beside its faces, torn edges and boundary.
#[derive(Clone, Debug, Default)]
pub struct RenderOptions {
    /// The angle between two faces, in degrees, from which on their common edge is drawn as a crease. 0
    /// draws each face flat, and `None` draws every surface smooth, as cloth is.
    pub crease_deg: Option<f64>,
    /// Into how many parts each edge is divided for the picture. Each face becomes the square of that number,
    /// bent between the normals of its corners. 0 and 1 draw the faces as they are.
    pub finer: u32,
    /// Whether short threads hang out of tears that gape.
    pub fringe: bool,
    /// The upward direction, if the picture has a ground, with the shadow of the mesh on it. The ground is
    /// just below the mesh.
    pub ground: Option<Vector>,
    /// The texture coordinates of each corner, by the index of its half-edge, on which a weave is drawn; empty
    /// draws none.
    pub texture: Vec<[f64; 2]>,
    /// Whether the edges between two faces are drawn.
    pub edges: bool,
    /// Whether the box around all faces is drawn.
    pub bounding_box: bool,
    /// The planned cuts whose [`trace`] is drawn.
    pub cuts: Vec<Scissor>,
    /// The rays to draw, each from its origin to beyond the box around all faces. A ray is not drawn if the
    /// whole box is behind its origin.
    pub rays: Vec<tearmesh::Ray>,
}

/// Lines of sight across each pixel, and down.
const SIDE: u32 = 3;

/// About how many lines of sight are looked along at a time, which bounds the memory that is needed.
const BAND: usize = 1 << 21;

/// Draws a mesh as a camera sees it, into a picture of `size`, which should be the size of the camera.
///
/// The same mesh, camera and options give the same picture on every machine.
///
/// ```
/// use tearmesh::{shapes, Vector};
/// use tearmesh_view::{PictureSize, RenderOptions, fit, render};
///
/// let (mesh, positions) = shapes::torus(24, 12);
/// let size = PictureSize::new(64, 48).expect("a size");
/// let camera = fit(&mesh, &positions, Vector::y(), 35.0, size.as_f64())?;
/// let picture = render(&mesh, &positions, &camera, size, &RenderOptions::default());
/// assert_eq!((picture.width(), picture.height()), (64, 48));
/// assert_ne!(picture.at(10, 24), picture.at(0, 0)); // the torus, and nothing
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Panics
///
/// If a vertex of the mesh is unknown to `place`.
#[must_use]
pub fn render(
    mesh: &Mesh,
    place: &(impl Place + ?Sized),
    camera: &Camera,
    size: PictureSize,
    options: &RenderOptions,
) -> Picture {
    in_bands(mesh, place, camera, size, options, BAND)
}

fn figure(mesh: &Mesh, place: &(impl Place + ?Sized), options: &RenderOptions) -> Figure {
    let crease = crease_cosine(options.crease_deg);
    let mut figure = Figure::new(mesh, place, crease, &options.texture, options.edges);
    if options.fringe {
        figure.fringe(mesh, place);
    }
    match options.finer {
        0 | 1 => figure,
        n => figure.finer(n),
    }
}

/// Writes the surface that [`render`] draws as OBJ, for another renderer: with the normals of its points, drawn
/// finer if that was wanted, and with the threads of the fringe as lines of the group `fringe`. A vertex stands
/// there once for each normal and each texture coordinate that it has, and nothing says what is torn.
///
/// # Errors
///
/// Any I/O error of `out`.
///
/// # Panics
///
/// If a vertex of the mesh is unknown to `place`.
pub fn write_drawn(
    mesh: &Mesh,
    place: &(impl Place + ?Sized),
    options: &RenderOptions,
    mut out: impl Write,
) -> io::Result<()> {
    let figure = figure(mesh, place, options);
    let corner = |at| match (at + 1, figure.texture.is_empty()) {
        (at, true) => format!("{at}//{at}"),
        (at, false) => format!("{at}/{at}/{at}"),
    };
    for p in &figure.points {
        writeln!(out, "v {} {} {}", p.x, p.y, p.z)?;
    }
    for [u, v] in &figure.texture {
        writeln!(out, "vt {u} {v}")?;
    }
    for n in &figure.normals {
        writeln!(out, "vn {} {} {}", n.x, n.y, n.z)?;
    }
    for corners in &figure.faces {
        writeln!(out, "f {}", corners.map(corner).join(" "))?;
    }
    writeln!(out, "g fringe")?;
    for (_, [from, to]) in figure.lines.iter().filter(|line| line.0 == Kind::Thread) {
        writeln!(out, "l {} {}", from + 1, to + 1)?;
    }
    Ok(())
}

/// Draws about so many lines of sight at a time.
fn in_bands(
    mesh: &Mesh,
    place: &(impl Place + ?Sized),
    camera: &Camera,
    size: PictureSize,
    options: &RenderOptions,
    band: usize,
) -> Picture {
    let figure = figure(mesh, place, options);
    let view = View::new(figure.points.iter().copied(), camera, size, SIDE);
    let scene = Scene {
        view: &view,
        light: Light::of(camera),
        sky: Sky::new(&figure, options.ground),
        weave: Weave::new(&figure.texture),
        strokes: strokes(mesh, place, &figure, &view, options),
        figure: &figure,
    };
    // Lines at the edge of a band look at the surface beside it.
    let margin = (SIDE * 4) as usize;
    let rows = view.lattice.rows;
    let step = (band / view.lattice.columns).max(1);
    let step = step.next_multiple_of(SIDE as usize);
    let mut pixels = Vec::with_capacity(size.width() as usize * size.height() as usize);
    for from in (0..rows).step_by(step) {
        let to = (from + step).min(rows);
        let around = from.saturating_sub(margin)..(to + margin).min(rows);
        let surface = Surface::of(&figure.faces, &view.seen, view.lattice, around);
        scene.draw(&surface, from..to, &mut pixels);
    }
    Picture::new(size, pixels)
}

/// Returns the face that is visible at the centre of each pixel, row by row from the top left, or `None`
/// where no face is visible. Of several equally near faces, the one with the lowest id is visible.
///
/// # Panics
///
/// If a vertex of the mesh is unknown to `place`.
#[must_use]
pub fn faces_seen(
    mesh: &Mesh,
    place: &(impl Place + ?Sized),
    camera: &Camera,
    size: PictureSize,
) -> Vec<Option<FaceId>> {
    let points = mesh.vertices().map(|v| place.at(v));
    let view = View::new(points, camera, size, 1);
    let Lattice { columns, rows } = view.lattice;
    let (faces, _) = mesh.indices().as_chunks();
    let surface = Surface::of(faces, &view.seen, view.lattice, 0..rows);
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let faces = places.map(|(column, row)| surface.face(column, row));
    faces.map(|face| face.and_then(FaceId::new)).collect()
}

/// Points as a camera sees them.
struct View {
    camera: Camera,
    lattice: Lattice,
    /// Each point, as the camera sees it, times the scale.
    seen: Vec<Vector>,
    /// A power of two, so that products of what is seen neither vanish nor run over.
    scale: f64,
}

impl View {
    fn new(
        points: impl Iterator<Item = Point>,
        camera: &Camera,
        size: PictureSize,
        side: u32,
    ) -> View {
        let mut seen: Vec<Vector> = points.map(|p| camera.seen(p)).collect();
        let largest = seen.iter().map(|&p| max_abs(p)).fold(0.0, f64::max);
        let scale = match largest > 0.0 && largest.is_finite() {
            true => power_of_two_below(1.0 / largest),
            false => 1.0,
        };
        seen.iter_mut().for_each(|p| *p *= scale);
        View {
            camera: *camera,
            lattice: Lattice::new(size.width(), size.height(), side),
            seen,
            scale,
        }
    }

    fn point(&self, p: Point) -> Vector {
        self.camera.seen(p) * self.scale
    }
}

/// The largest power of two that is not above a positive number; the smallest of the normal range at
/// least.
fn power_of_two_below(x: f64) -> f64 {
    f64::from_bits(x.max(f64::MIN_POSITIVE).to_bits() & !((1 << 52) - 1))
}

/// All that is drawn.
struct Scene<'v> {
    figure: &'v Figure,
    view: &'v View,
    light: Light,
    sky: Sky,
    weave: Option<Weave>,
    strokes: Vec<Stroke>,
}

impl Scene<'_> {
    /// Draws the pixels of some rows of the lattice, of which the surface has more.
    fn draw(&self, surface: &Surface, rows: std::ops::Range<usize>, pixels: &mut Vec<Color>) {
        let lattice = self.view.lattice;
        let mut strokes = Strokes::new(surface, lattice);
        for &stroke in &self.strokes {
            let (_, width, _) = look(stroke.kind);
            strokes.add(stroke, width * f64::from(SIDE), surface, lattice);
        }
        let side = SIDE as usize;
        for top in rows.step_by(side) {
            for left in (0..lattice.columns).step_by(side) {
                let mut sum = [0.0; 3];
                for row in top..top + side {
                    let first = (row - surface.rows.start) * lattice.columns;
                    for column in left..left + side {
                        let below = self.color(surface, column, row);
                        let color = drawn_over(below, strokes.kind(first + column));
                        sum = [0, 1, 2].map(|i| sum[i] + color[i]);
                    }
                }
                // Every sum is below 255 times the count, so this is a colour.
                pixels.push(sum.map(|sum| (sum / f64::from(SIDE * SIDE) + 0.5) as u8));
            }
        }
    }

    /// What is seen along a line of sight, but for lines.
    fn color(&self, surface: &Surface, column: usize, row: usize) -> [f64; 3] {
        let sight = self.view.lattice.sight(column, row);
        let seen = surface.face(column, row).and_then(|face| {
            let corners = self.figure.faces[face].map(|at| at as usize);
            let facing = Facing::new(corners.map(|at| self.view.seen[at]))?;
            Some((face, corners, facing))
        });
        let Some((face, corners, facing)) = seen else {
            return self.ground(sight);
        };
        let weights = facing.weights(sight);
        let sum: f64 = weights.iter().sum();
        let (mut normal, mut sky, mut texture) = (Vector::zeros(), 0.0, [0.0; 2]);
        for (at, weight) in corners.into_iter().zip(weights.map(|weight| weight / sum)) {
            normal += self.figure.normals[at] * weight;
            sky += self.sky.seen[at][usize::from(!facing.is_front)] * weight;
            if let Some(at) = self.figure.texture.get(at) {
                texture = [0, 1].map(|i| texture[i] + at[i] * weight);
            }
        }
        let woven = self.weave.as_ref().map_or(1.0, |weave| weave.at(texture));
        let color = self.figure.colors[face].map(|part| f64::from(part) * woven);
        self.light.shade(color, normal, facing.is_front, sky)
    }

    /// What is seen where there is no face.
    fn ground(&self, sight: Vector) -> [f64; 3] {
        let background = palette::LIGHT.background.map(f64::from);
        let (eye, direction) = self.view.camera.sight(sight);
        let ground = self.sky.ground.as_ref();
        match ground.and_then(|ground| ground.seen(eye, direction)) {
            Some(sky) => background.map(|part| part * (1.0 - SHADOW * (1.0 - sky))),
            None => background,
        }
    }
}

/// Two threads that cross, over and under each other in turn, on a surface with texture coordinates.
struct Weave {
    origin: [f64; 2],
    /// The width of a thread.
    thread: f64,
}

/// How many threads lie beside each other, along the longer side of the texture.
const THREADS: f64 = 64.0;

/// How much of the light the lower thread keeps.
const UNDER: f64 = 0.93;

impl Weave {
    /// None if there is no texture, or no part of it.
    fn new(texture: &[[f64; 2]]) -> Option<Weave> {
        let [u, v] = [0, 1].map(|axis| {
            let along = || texture.iter().map(|at| at[axis]);
            let least = along().fold(f64::INFINITY, f64::min);
            [least, along().fold(f64::NEG_INFINITY, f64::max)]
        });
        let thread = (u[1] - u[0]).max(v[1] - v[0]) / THREADS;
        (thread > 0.0 && thread.is_finite()).then_some(Weave {
            origin: [u[0], v[0]],
            thread,
        })
    }

    fn at(&self, texture: [f64; 2]) -> f64 {
        let [across, along] = [0, 1].map(|i| ((texture[i] - self.origin[i]) / self.thread).floor());
        match (across + along).rem_euclid(2.0) {
            0.0 => 1.0,
            _ => UNDER,
        }
    }
}

/// How a line is drawn: its colour, its width in pixels, and how much of what is below it hides.
fn look(kind: Kind) -> (Color, f64, f64) {
    match kind {
        Kind::Edge => (palette::LIGHT.edge, 0.7, 0.45),
        Kind::Box => (palette::LIGHT.bounding_box, 1.0, 1.0),
        Kind::Boundary => (palette::LIGHT.boundary, 1.0, 0.7),
        Kind::Thread => (palette::LIGHT.edge, 0.6, 0.55),
        Kind::Slit => (palette::LIGHT.seam, 1.5, 1.0),
        Kind::Seam => (palette::LIGHT.seam, 2.4, 1.0),
        Kind::Trace => (palette::LIGHT.trace, 2.4, 1.0),
    }
}

fn drawn_over(below: [f64; 3], line: Option<Kind>) -> [f64; 3] {
    let Some((color, _, cover)) = line.map(look) else {
        return below;
    };
    [0, 1, 2].map(|i| below[i] + cover * (f64::from(color[i]) - below[i]))
}

/// All lines of a picture, in the order in which they are drawn.
fn strokes(
    mesh: &Mesh,
    place: &(impl Place + ?Sized),
    figure: &Figure,
    view: &View,
    options: &RenderOptions,
) -> Vec<Stroke> {
    let line = |&(kind, ends): &(Kind, [u32; 2])| {
        let ends = ends.map(|at| view.seen[at as usize]);
        Stroke { kind, ends }
    };
    let mut strokes: Vec<Stroke> = figure.lines.iter().map(line).collect();
    let bounds = Bounds::of(mesh, place);
    let mut add = |kind, segment: [Point; 2]| {
        let ends = segment.map(|p| view.point(p));
        strokes.push(Stroke { kind, ends });
    };
    if let Some(bounds) = bounds.filter(|_| options.bounding_box) {
        bounds.edges().for_each(|edge| add(Kind::Box, edge));
    }
    for scissor in &options.cuts {
        let segments = trace(mesh, place, scissor).into_iter();
        segments.for_each(|segment| add(Kind::Trace, segment));
    }
    for ray in &options.rays {
        if let Some(far) = bounds.and_then(|bounds| bounds.beyond(ray)) {
            add(Kind::Trace, [ray.origin(), far]);
        }
    }
    strokes.sort_by_key(|stroke| stroke.kind);
    strokes
}

#[cfg(test)]
mod tests {
    use tearmesh::{CutMethod, Edits, Ray, shapes};

    use super::*;
    use crate::fit::fit;

    #[test]
    fn bands_are_not_seen() {
        let (mut mesh, mut positions) = shapes::torus(16, 8);
        let across = |y| Ray::new(Point::new(-5.0, y, 0.3), Vector::x()).expect("a ray");
        let scissor = Scissor::new(across(-3.0), across(3.0)).expect("a plane");
        let log = &mut Edits::new();
        let cut = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, log);
        assert!(cut.is_ok());
        let size = PictureSize::new(60, 50).expect("a size");
        let camera = fit(&mesh, &positions, Vector::y(), 35.0, size.as_f64());
        let camera = camera.expect("a camera");
        let options = RenderOptions {
            edges: true,
            bounding_box: true,
            ..RenderOptions::default()
        };
        let drawn = |band| in_bands(&mesh, &positions, &camera, size, &options, band);
        let whole = drawn(1 << 20);
        for band in [1, 1000, 5000] {
            assert!(drawn(band) == whole, "in bands of {band}");
        }
    }
}
