//! Planes, and rays through points of a mesh, from wherever they come.

use crate::oracle::aim::Line;
use crate::oracle::straight::{Surface, length, minus};
use crate::random::Random;
use crate::table::Levels;
use crate::verb::Along;

type Point = [f64; 3];

/// What a cut of a row goes along. Every fourth goes through vertices, where ties are frequent.
pub(crate) fn along(levels: &Levels, surface: &Surface, size: f64, random: &mut Random) -> Along {
    let on_vertices = random.below(4) == 0;
    let aim = levels.of("aim");
    if aim == "plane" {
        return plane(surface, on_vertices, random);
    }
    let count = match aim {
        "two-rays" => 2,
        "polyline" => 3 + random.below(2),
        _ => 3 + random.below(2),
    };
    let targets = targets(surface, count, aim, on_vertices, random);
    let view = View::of(surface, size, levels.of("rays"), random);
    let mut lines: Vec<Line> = targets.iter().map(|&at| view.ray(at, random)).collect();
    if aim == "closed-polyline" {
        lines.push(lines[0]);
    }
    Along::Rays(lines)
}

/// A plane and its normal, along an axis or not.
pub(crate) fn plane(surface: &Surface, on_vertices: bool, random: &mut Random) -> Along {
    let point = on(surface, on_vertices, random);
    let normal = match random.below(4) {
        axis if axis < 2 && on_vertices => [0, 1, 2].map(|i| f64::from(u8::from(i == axis))),
        _ => [(); 3].map(|()| random.next() - 0.5),
    };
    Along::Plane(point, normal)
}

/// A point on a face, or a vertex of one.
fn on(surface: &Surface, at_vertex: bool, random: &mut Random) -> Point {
    let face = surface.faces[random.below(surface.faces.len())];
    let [a, b, c] = face.map(|v| surface.points[v as usize]);
    if at_vertex {
        return a;
    }
    let weights = [(); 3].map(|()| 0.1 + random.next());
    let sum: f64 = weights.iter().sum();
    [0, 1, 2].map(|i| (weights[0] * a[i] + weights[1] * b[i] + weights[2] * c[i]) / sum)
}

/// The corners of a polyline, each a few edges from the one before; those of a closed one from all.
fn targets(
    surface: &Surface,
    count: usize,
    aim: &str,
    on_vertices: bool,
    random: &mut Random,
) -> Vec<Point> {
    let edge = surface.mean_edge();
    let mut targets = vec![on(surface, on_vertices, random)];
    let most = [3.0, 5.0, 9.0][random.below(3)];
    for _ in 0..400 {
        let next = on(surface, on_vertices, random);
        let far = |p: &Point| length(minus(next, *p)) / edge;
        let last = targets.last().expect("one at least");
        let is_near = far(last) <= most;
        let is_apart = match aim {
            "closed-polyline" => targets.iter().all(|p| far(p) > 1.0 && far(p) <= most),
            _ => far(last) > 1.0,
        };
        if is_near && is_apart {
            targets.push(next);
        }
        if targets.len() == count {
            break;
        }
    }
    while targets.len() < count {
        targets.push(on(surface, on_vertices, random));
    }
    targets
}

/// Where rays come from.
struct View {
    rays: &'static str,
    size: f64,
    middle: Point,
    /// The direction in which the mesh is seen.
    ahead: Point,
}

impl View {
    /// From above, tilted by chance.
    fn of(surface: &Surface, size: f64, rays: &'static str, random: &mut Random) -> View {
        let count = surface.points.len() as f64;
        let sum = |i: usize| surface.points.iter().map(|p| p[i] / count).sum::<f64>();
        let [x, y] = [(); 2].map(|()| 0.8 * (random.next() - 0.5));
        let ahead = [x, y, -1.0];
        View {
            rays,
            size,
            middle: [0, 1, 2].map(sum),
            ahead: ahead.map(|x| x / length(ahead)),
        }
    }

    /// A ray that passes through a point.
    fn ray(&self, at: Point, random: &mut Random) -> Line {
        let behind =
            |from: Point, far: f64| [0, 1, 2].map(|i| from[i] - far * self.size * self.ahead[i]);
        let eye = behind(self.middle, 3.0);
        let near =
            |by: f64, random: &mut Random| eye.map(|x| x + by * self.size * (random.next() - 0.5));
        // Rays that meet far beyond the mesh, or have crossed before it.
        let through = |far: f64, from: f64| {
            let crossing = behind(self.middle, far);
            [0, 1, 2].map(|i| at[i] + from * (crossing[i] - at[i]))
        };
        let origin = match self.rays {
            "parallel" => behind(at, 3.0),
            "one-eye" => eye,
            "nearly-one-eye" => near(1e-9, random),
            "converging" if self.ahead[0] > 0.0 => through(-10.0, -0.3),
            "converging" => through(1.5, 2.0),
            "skew" => near(1.0, random),
            _ => behind(self.middle, 1e3),
        };
        (origin, minus(at, origin))
    }
}

/// A slit inside a mesh between two of its points, seen along an axis by chance.
pub(crate) fn slit(surface: &Surface, size: f64, random: &mut Random) -> Along {
    let targets = targets(surface, 2, "two-rays", false, random);
    let view = View::of(surface, size, "parallel", random);
    Along::Rays(targets.iter().map(|&at| view.ray(at, random)).collect())
}

/// A mesh turned, mirrored or renumbered, and what is cut along moved with it.
pub(crate) fn moved(along: &Along, by: impl Fn(Point) -> Point) -> Along {
    match along {
        Along::Plane(point, normal) => Along::Plane(by(*point), by(*normal)),
        Along::Rays(lines) => {
            let lines = lines.iter().map(|&(origin, along)| (by(origin), by(along)));
            Along::Rays(lines.collect())
        }
    }
}
