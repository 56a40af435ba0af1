//! A picture of a mesh: shaded from both sides, its pieces coloured, its seams and its boundary drawn over.

use tearmesh::geometry::max_abs;
use tearmesh::{FaceId, Mesh, Place, Point, Scissor, Vector};

use crate::bounds::Bounds;
use crate::camera::Camera;
use crate::palette::{self, Color};
use crate::picture::{Picture, PictureSize};
use crate::shade::{Light, corner_normals};
use crate::strokes::{Kind, Stroke, Strokes};
use crate::surface::{Facing, Lattice, Surface};
use crate::trace::trace;

/// The lines that a picture shows in addition to the faces, torn edges and the boundary.
#[derive(Clone, Debug, Default)]
pub struct RenderOptions {
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
/// let camera = fit(&mesh, &positions, Vector::y(), 35.0, size.as_f64())?.expect("it has faces");
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

/// Draws about so many lines of sight at a time.
fn in_bands(
    mesh: &Mesh,
    place: &(impl Place + ?Sized),
    camera: &Camera,
    size: PictureSize,
    options: &RenderOptions,
    band: usize,
) -> Picture {
    let view = View::new(mesh, place, camera, size, SIDE);
    let scene = Scene {
        view: &view,
        light: Light::of(camera),
        normals: corner_normals(mesh, place),
        colors: piece_colors(mesh),
        strokes: strokes(mesh, place, &view, options),
    };
    // Lines at the edge of a band look at the surface beside it.
    let margin = (SIDE * 4) as usize;
    let rows = view.lattice.rows;
    let step = (band / view.lattice.columns)
        .max(1)
        .next_multiple_of(SIDE as usize);
    let mut pixels = Vec::with_capacity(size.width() as usize * size.height() as usize);
    for from in (0..rows).step_by(step) {
        let to = (from + step).min(rows);
        let around = from.saturating_sub(margin)..(to + margin).min(rows);
        let surface = Surface::of(mesh, &view.seen, view.lattice, around);
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
    let view = View::new(mesh, place, camera, size, 1);
    let Lattice { columns, rows } = view.lattice;
    let surface = Surface::of(mesh, &view.seen, view.lattice, 0..rows);
    let places = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let faces = places.map(|(column, row)| surface.face(column, row));
    faces.map(|face| face.and_then(FaceId::new)).collect()
}

/// A mesh as its camera sees it.
struct View<'m> {
    mesh: &'m Mesh,
    camera: Camera,
    lattice: Lattice,
    /// Each vertex, as the camera sees it, times the scale.
    seen: Vec<Vector>,
    /// A power of two, so that products of what is seen neither vanish nor run over.
    scale: f64,
}

impl<'m> View<'m> {
    fn new(
        mesh: &'m Mesh,
        place: &(impl Place + ?Sized),
        camera: &Camera,
        size: PictureSize,
        side: u32,
    ) -> View<'m> {
        let mut seen: Vec<Vector> = mesh.vertices().map(|v| camera.seen(place.at(v))).collect();
        let shown = mesh.indices().iter().map(|&v| max_abs(seen[v as usize]));
        let largest = shown.fold(0.0, f64::max);
        let scale = match largest > 0.0 && largest.is_finite() {
            true => power_of_two_below(1.0 / largest),
            false => 1.0,
        };
        seen.iter_mut().for_each(|p| *p *= scale);
        View {
            mesh,
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
    view: &'v View<'v>,
    light: Light,
    normals: Vec<[Vector; 3]>,
    /// Of each face.
    colors: Vec<Color>,
    strokes: Vec<Stroke>,
}

impl Scene<'_> {
    /// Draws the pixels of some rows of the lattice, of which the surface has more.
    fn draw(&self, surface: &Surface, rows: std::ops::Range<usize>, pixels: &mut Vec<Color>) {
        let lattice = self.view.lattice;
        let mut strokes = Strokes::new(surface, lattice);
        for &stroke in &self.strokes {
            let width = look(stroke.kind).width * f64::from(SIDE);
            strokes.add(stroke, width, surface, lattice);
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
        let seen = surface.face(column, row).and_then(|face| {
            let corners = &self.view.mesh.indices()[3 * face..3 * face + 3];
            let corners = [0, 1, 2].map(|i| self.view.seen[corners[i] as usize]);
            Some((face, Facing::new(corners)?))
        });
        let Some((face, facing)) = seen else {
            return palette::LIGHT.background.map(f64::from);
        };
        let weights = facing.weights(self.view.lattice.sight(column, row));
        let sum: f64 = weights.iter().sum();
        let normals = self.normals[face].iter().zip(weights);
        let normal = normals.fold(Vector::zeros(), |normal, (corner, weight)| {
            normal + corner * (weight / sum)
        });
        self.light.shade(self.colors[face], normal, facing.is_front)
    }
}

/// How a line is drawn.
struct Look {
    color: Color,
    /// In pixels.
    width: f64,
    /// How much of what is below it hides.
    cover: f64,
}

fn look(kind: Kind) -> Look {
    let (color, width, cover) = match kind {
        Kind::Edge => (palette::LIGHT.edge, 0.7, 0.45),
        Kind::Box => (palette::LIGHT.bounding_box, 1.0, 1.0),
        Kind::Boundary => (palette::LIGHT.boundary, 1.7, 1.0),
        Kind::Seam => (palette::LIGHT.seam, 2.4, 1.0),
        Kind::Trace => (palette::LIGHT.trace, 2.4, 1.0),
    };
    Look {
        color,
        width,
        cover,
    }
}

fn drawn_over(below: [f64; 3], line: Option<Kind>) -> [f64; 3] {
    let Some(Look { color, cover, .. }) = line.map(look) else {
        return below;
    };
    [0, 1, 2].map(|i| below[i] + cover * (f64::from(color[i]) - below[i]))
}

/// The colour of each face: that of its piece. The largest piece has the first.
fn piece_colors(mesh: &Mesh) -> Vec<Color> {
    let components = mesh.components();
    let mut sizes = vec![0usize; components.count()];
    mesh.faces().for_each(|f| sizes[components.of(f)] += 1);
    let mut by_size: Vec<usize> = (0..sizes.len()).collect();
    by_size.sort_by_key(|&piece| std::cmp::Reverse(sizes[piece]));
    let mut rank = vec![0; sizes.len()];
    for (number, &piece) in by_size.iter().enumerate() {
        rank[piece] = number;
    }
    let color = |f| palette::piece(rank[components.of(f)]);
    mesh.faces().map(color).collect()
}

/// All lines of a picture, in the order in which they are drawn.
fn strokes(
    mesh: &Mesh,
    place: &(impl Place + ?Sized),
    view: &View<'_>,
    options: &RenderOptions,
) -> Vec<Stroke> {
    let mut strokes = Vec::new();
    for h in mesh.half_edges() {
        let kind = match (mesh.pair(h), mesh.ghost_pair(h)) {
            (Some(pair), _) if options.edges && h < pair => Kind::Edge,
            (Some(_), _) => continue,
            (None, Some(_)) => Kind::Seam,
            (None, None) => Kind::Boundary,
        };
        let ends = [mesh.origin(h), mesh.target(h)].map(|v| view.seen[v.index()]);
        strokes.push(Stroke { kind, ends });
    }
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
        let camera = camera.expect("a camera").expect("faces");
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
