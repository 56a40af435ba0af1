//! The camera of a page, read from the line that it shows, and an own projection: the matrix of gluLookAt.

use crate::vectors::{cross, dot, length, minus};

/// What `tearmesh render` is told of a view.
#[derive(Debug)]
pub(crate) struct Eye {
    /// The options as they stand there, without `--size`.
    pub(crate) options: Vec<String>,
    pub(crate) size: [f64; 2],
    eye: [f64; 3],
    /// Right, up and backward, each one long.
    axes: [[f64; 3]; 3],
    focal: f64,
}

impl Eye {
    /// Reads a line `tearmesh render FILE --camera EYE@AT --up X,Y,Z --fov DEG --size WxH -o F.png`.
    pub(crate) fn of(line: &str) -> Eye {
        let words = shlex::split(line).expect("words that a shell understands");
        let after = |option: &str| {
            let at = words.iter().position(|word| word == option);
            words[at.unwrap_or_else(|| panic!("no {option} in {line}")) + 1].clone()
        };
        let (eye, at) = (after("--camera"), after("--camera"));
        let (eye, _) = eye.split_once('@').expect("an eye");
        let (_, at) = at.split_once('@').expect("what it looks at");
        let (eye, at, up) = (triple(eye), triple(at), triple(&after("--up")));
        let backward = unit(minus(eye, at));
        let right = unit(cross(up, backward));
        let size = after("--size");
        let (width, height) = size.split_once('x').expect("a size");
        let degrees: f64 = after("--fov").parse().expect("an angle");
        let options = ["--camera", "--up", "--fov"].map(|name| [name.to_owned(), after(name)]);
        Eye {
            options: options.into_iter().flatten().collect(),
            size: [width, height].map(|pixels| pixels.parse().expect("pixels")),
            eye,
            axes: [right, cross(backward, right), backward],
            focal: 1.0 / (degrees.to_radians() / 2.0).tan(),
        }
    }

    /// Where a point is seen, in pixels right and down.
    pub(crate) fn pixel(&self, p: [f64; 3]) -> [f64; 2] {
        let [x, y, z] = self.axes.map(|axis| dot(axis, minus(p, self.eye)));
        let [width, height] = self.size;
        let scale = self.focal * height / 2.0 / -z;
        [width / 2.0 + x * scale, height / 2.0 - y * scale]
    }
}

fn triple(text: &str) -> [f64; 3] {
    let mut numbers = text.split(',').map(|x| x.parse().expect("a number"));
    [(); 3].map(|()| numbers.next().expect("three numbers"))
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    a.map(|x| x / length(a))
}
