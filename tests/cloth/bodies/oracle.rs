//! Distances from a mesh without a grid: every triangle is asked, and solid angles tell inside from outside.

type V = [f64; 3];

/// The triangles of an OBJ file.
pub(super) struct Solid {
    pub(super) points: Vec<V>,
    pub(super) faces: Vec<[u32; 3]>,
}

fn minus(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    let at = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [at(1, 2), at(2, 0), at(0, 1)]
}

/// The distance of the origin from a segment.
fn from_segment(a: V, b: V) -> f64 {
    let d = minus(b, a);
    let t = (-dot(a, d) / dot(d, d)).clamp(0.0, 1.0);
    let nearest = [0, 1, 2].map(|i| a[i] + d[i] * t);
    dot(nearest, nearest).sqrt()
}

impl Solid {
    /// Reads vertices and faces, in metres of which a unit of the file has so many.
    pub(super) fn read(text: &str, unit_m: f64) -> Solid {
        let (mut points, mut faces) = (Vec::new(), Vec::new());
        for line in text.lines() {
            let mut words = line.split_whitespace();
            match words.next() {
                Some("v") => {
                    let numbers = words.map(|word| word.parse::<f64>().expect("a number") * unit_m);
                    let numbers: Vec<f64> = numbers.collect();
                    points.push([numbers[0], numbers[1], numbers[2]]);
                }
                Some("f") => {
                    let number = |word: &str| word.split('/').next()?.parse::<u32>().ok();
                    let corners = words.map(|word| number(word).expect("a number") - 1);
                    let corners: Vec<u32> = corners.collect();
                    let fan = corners[1..]
                        .windows(2)
                        .map(|pair| [corners[0], pair[0], pair[1]]);
                    faces.extend(fan);
                }
                _ => {}
            }
        }
        Solid { points, faces }
    }

    /// The distance of a point from the nearest triangle, negative where the faces surround it.
    pub(super) fn distance(&self, p: V) -> f64 {
        let (mut least, mut angle) = (f64::INFINITY, 0.0);
        for face in &self.faces {
            let [a, b, c] = face.map(|v| minus(self.points[v as usize], p));
            let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
            let volume = dot(a, cross(b, c));
            let base = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
            angle += 2.0 * volume.atan2(base);
            let normal = cross(minus(b, a), minus(c, a));
            let parts = [cross(b, c), cross(c, a), cross(a, b)].map(|part| dot(part, normal));
            let edges = from_segment(a, b)
                .min(from_segment(b, c))
                .min(from_segment(c, a));
            least = least.min(edges);
            if parts.iter().all(|&part| part >= 0.0) {
                least = least.min(volume.abs() / dot(normal, normal).sqrt());
            }
        }
        if angle > 2.0 * std::f64::consts::PI {
            -least
        } else {
            least
        }
    }
}
