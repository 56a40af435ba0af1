//! A page that shows meshes in a browser: one HTML file that needs no network and nothing beside it.
//!
//! What is shown lies in the page as one stream, deflated, in base64: a JSON text ([`Page`] says what is in
//! it), and behind it the faces ([`codec`]) and the places of the vertices ([`motion`]) of every moment. No
//! text of a file stands anywhere else but in the title, so none can break out of the page; and the page
//! forbids itself all that would need a network. Its script finds the shade of each moment when it is shown
//! (`page/shade.js`): that of a film would be as long as the film again.

mod codec;
mod motion;

use std::io::{self, Write};

use base64::Engine as _;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::{Value, json};
use tearmesh::geometry::length;
use tearmesh::nalgebra::Matrix3x4;
use tearmesh::{HalfEdgeId, Mesh, Place, Point, Scissor, Vector};

use crate::bounds::Bounds;
use crate::camera::CameraError;
use crate::fit::{ANGLE_OF_VIEW, fit};
use crate::palette::{self, Color};
use crate::pieces::Pieces;
use crate::shade;

/// An HTML page that shows a mesh at one or more moments.
///
/// A page with one moment shows a mesh at rest. Several moments are played, and each may have other faces;
/// only changes of the faces are stored. A viewer who clicks two points sees where a cut between them would
/// go, and the command that makes it.
///
/// A mesh has the shade of its folds, and a shadow below it, as in a picture.
///
/// Positions of the first moment are kept to 24 bits. Those of later moments are rounded to 1/65,536 of the
/// longest side of the box around all moments.
///
/// ```
/// use tearmesh::{shapes, Vector};
/// use tearmesh_view::{Moment, Page};
///
/// let (mesh, positions) = shapes::torus(24, 12);
/// let mut page = Page::new("torus.obj", Vector::y());
/// page.add(&mesh, &positions, Moment::default())?;
/// let mut html = Vec::new();
/// page.write(&mut html)?;
/// assert!(html.starts_with(b"<!doctype html>"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Page {
    title: String,
    up: Vector,
    /// From the first mesh to whoever looks at it.
    look: Vector,
    facts: Vec<[String; 2]>,
    plots: Vec<Value>,
    pieces: Pieces,
    /// The points and the corners of the faces of each.
    solids: Vec<(Vec<Point>, Vec<u32>)>,
    states: Vec<State>,
    shots: Vec<Shot>,
}

/// The description of a moment that a page shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moment {
    /// The name of the moment, such as the name of a file; may be empty.
    pub label: String,
    /// The time of the moment, in seconds. If it is `None`, the time is the index of the moment divided by
    /// [`MOMENTS_PER_S`], or the index in seconds if the page has fewer than twelve moments.
    pub time_s: Option<f64>,
    /// The parts of the command that cuts this mesh; `None` if the mesh is not in a file.
    pub cut: Option<CutLine>,
    /// The length at rest of all torn edges, each counted once, in metres. If it is `None`, the page shows
    /// their length in this mesh.
    pub torn_at_rest_m: Option<f64>,
    /// Where each [solid](Page::add_solid) is: the first three columns turn its points, and the last is added.
    pub placings: Vec<Matrix3x4<f64>>,
}

/// The parts of the command `tearmesh cut` that a page suggests. The page shows them as given, so names
/// must already be quoted for a shell.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CutLine {
    /// The name of the file to cut.
    pub file: String,
    /// Further options, each preceded by a space; may be empty.
    pub options: String,
    /// The name of the file for the cut mesh.
    pub output: String,
}

/// The number of moments per second for moments without a [`Moment::time_s`], on a page with at least
/// twelve moments.
pub const MOMENTS_PER_S: f64 = 30.0;

/// From how many moments on they are a film, and fewer are meshes to be looked at one after another.
const FILM: usize = 12;

/// The faces of a mesh, and how they hang together.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct State {
    /// The vertex of each half-edge's origin: three a face.
    corners: Vec<u32>,
    /// Of each half-edge: 0 if the faces on both sides are joined, 1 if there never was another, 2 if they are torn.
    kinds: Vec<u32>,
    /// The number of the piece of each face.
    pieces: Vec<u32>,
}

/// A moment, as it is kept until the page is written.
#[derive(Clone, Debug)]
struct Shot {
    moment: Moment,
    /// The index of its faces among all states.
    state: usize,
    points: Vec<Point>,
    /// The lengths of all torn edges, each counted once: at rest where that is known.
    torn: f64,
    loops: usize,
}

impl Page {
    /// Creates a page without moments. `up` is the upward direction of the meshes on it.
    #[must_use]
    pub fn new(title: impl Into<String>, up: Vector) -> Page {
        Page {
            title: title.into(),
            up,
            look: up,
            ..Page::default()
        }
    }

    /// Adds a row with a name and a value to the table of facts beside the mesh.
    pub fn tell(&mut self, name: impl Into<String>, what: impl Into<String>) {
        self.facts.push([name.into(), what.into()]);
    }

    /// Adds a diagram beside the mesh, of one or more quantities over time: its title, the unit of the
    /// values, which may be empty, and the name and the points of each line. A point is a time in seconds and
    /// the value at that time.
    pub fn plot(&mut self, name: &str, unit: &str, lines: &[(String, Vec<[f64; 2]>)]) {
        let lines = lines.iter();
        let lines = lines.map(|(name, points)| json!({"name": name, "points": points}));
        let lines: Vec<Value> = lines.collect();
        let plot = json!({"name": name, "unit": unit, "lines": lines});
        self.plots.push(plot);
    }

    /// Adds a solid that the mesh lies on, by the points and the faces of its skin. It is drawn grey, at each
    /// moment where that [places](Moment::placings) it.
    pub fn add_solid(&mut self, points: Vec<Point>, faces: &[[u32; 3]]) {
        self.solids.push((points, faces.as_flattened().to_vec()));
    }

    /// Returns the description of the last moment, or `None` if the page has no moment.
    pub fn last_mut(&mut self) -> Option<&mut Moment> {
        self.shots.last_mut().map(|shot| &mut shot.moment)
    }

    /// Adds a moment: a mesh, the positions of its vertices, and a description.
    ///
    /// # Errors
    ///
    /// [`CameraError`] if the mesh has no face, or if the upward direction of the page is not valid.
    ///
    /// # Panics
    ///
    /// If a vertex of the mesh is unknown to `place`, or the moment does not place every solid.
    pub fn add(
        &mut self,
        mesh: &Mesh,
        place: &(impl Place + ?Sized),
        moment: Moment,
    ) -> Result<(), CameraError> {
        if mesh.face_count() == 0 {
            return Err(CameraError::Empty);
        }
        let (placed, solids) = (moment.placings.len(), self.solids.len());
        assert_eq!(placed, solids, "a moment places every solid");
        if self.shots.is_empty() {
            let camera = fit(mesh, place, self.up, ANGLE_OF_VIEW, [4.0, 3.0])?;
            [self.look, ..] = camera.axes();
        }
        let kind = |h: HalfEdgeId| {
            u32::from(mesh.pair(h).is_none()) + u32::from(mesh.ghost_pair(h).is_some())
        };
        let kinds: Vec<u32> = mesh.half_edges().map(kind).collect();
        let is_known = |last: &State| last.corners == mesh.indices() && last.kinds == kinds;
        if !self.states.last().is_some_and(is_known) {
            self.states.push(State {
                corners: mesh.indices().to_vec(),
                kinds,
                pieces: self.pieces.next(mesh),
            });
        }
        let torn = mesh.half_edges().filter(|&h| mesh.ghost_pair(h).is_some());
        let torn = torn.map(|h| length(place.at(mesh.target(h)) - place.at(mesh.origin(h))));
        let at_rest = moment.torn_at_rest_m;
        self.shots.push(Shot {
            moment,
            state: self.states.len() - 1,
            points: mesh.vertices().map(|v| place.at(v)).collect(),
            torn: at_rest.unwrap_or(torn.sum::<f64>() / 2.0),
            loops: mesh.boundary_loops().len(),
        });
        Ok(())
    }

    /// Writes the page as HTML. The same content gives the same bytes.
    ///
    /// # Errors
    ///
    /// Any I/O error of `out`.
    ///
    /// # Panics
    ///
    /// If the page has no moment.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        let (text, bytes) = self.content();
        let parts = [
            ("{title}", &*escaped(&self.title)),
            ("{style}", STYLE),
            ("{data}", &packed(&text, &bytes)?),
            ("{script}", &script(&SCRIPTS)),
        ];
        fill(FRAME, &parts, out)
    }

    /// All that is shown: the text, and the bytes behind it.
    fn content(&self) -> (String, Vec<u8>) {
        let shown = self.shots.iter().flat_map(|shot| {
            let corners = &self.states[shot.state].corners;
            corners.iter().map(|&v| shot.points[v as usize])
        });
        let at_rest = self.solids.iter().flat_map(|(points, _)| points);
        let all = shown.chain(at_rest.copied());
        let bounds = Bounds::around(all).expect("a page shows something");
        let lattice = motion::Lattice::round(&bounds);
        let mut faces = Vec::new();
        let nothing = State::default();
        let before = std::iter::once(&nothing).chain(&self.states);
        for (before, state) in before.zip(&self.states) {
            codec::write_change(&before.corners, &state.corners, &mut faces);
            codec::write_change(&before.kinds, &state.kinds, &mut faces);
            codec::write_change(&before.pieces, &state.pieces, &mut faces);
        }
        for (_, corners) in &self.solids {
            codec::write_change(&[], corners, &mut faces);
        }
        let moments = self.shots.iter().map(|shot| {
            let state = &self.states[shot.state];
            (&*shot.points, &*state.corners)
        });
        let solids = self.solids.iter();
        let solids = solids.map(|(points, corners)| (&**points, &**corners));
        let places = motion::write(moments.chain(solids), &lattice);
        let mut text = json!({
            "title": self.title,
            "up": self.up.as_slice(),
            "look": self.look.as_slice(),
            "angle": ANGLE_OF_VIEW,
            "origin": lattice.origin.coords.as_slice(),
            "side": lattice.side,
            "rate": MOMENTS_PER_S,
            "few": FILM,
            "states": self.states.len(),
            "faceBytes": faces.len(),
            "moments": self.moments(),
            "facts": self.facts,
            "plots": self.plots,
            "colors": colors(),
            "light": shade::LIGHT,
            "shadow": shade::SHADOW,
            "snap": Scissor::SNAP,
        });
        if !self.solids.is_empty() {
            // On a page, places are counted from the corner of the box.
            let corner = lattice.origin;
            let placing = |mut matrix: Matrix3x4<f64>| {
                let moved = matrix * corner.to_homogeneous() - corner.coords;
                matrix.set_column(3, &(moved / lattice.side));
                json!(matrix.as_slice())
            };
            let solids = self.solids.iter().enumerate();
            let solids = solids.map(|(number, (points, _))| {
                let matrices = self.shots.iter().map(|shot| shot.moment.placings[number]);
                let placings: Vec<Value> = matrices.map(placing).collect();
                json!({"vertices": points.len(), "placings": placings})
            });
            text["solids"] = solids.collect();
        }
        (text.to_string(), [faces, places].concat())
    }

    fn moments(&self) -> Vec<Value> {
        let told = |shot: &Shot| {
            let (moment, cut) = (&shot.moment, shot.moment.cut.as_ref());
            json!({
                "label": moment.label,
                "time": moment.time_s,
                "cut": cut.map(|cut| [&cut.file, &cut.options, &cut.output]),
                "state": shot.state,
                "vertices": shot.points.len(),
                "torn": shot.torn,
                "torn_at_rest": moment.torn_at_rest_m.is_some(),
                "loops": shot.loops,
            })
        };
        self.shots.iter().map(told).collect()
    }
}

/// The colours of both themes.
pub(crate) fn colors() -> Value {
    let theme = |theme: &palette::Theme| {
        json!({
            "background": theme.background,
            "seam": theme.seam,
            "boundary": theme.boundary,
            "edge": theme.edge,
            "trace": theme.trace,
            "box": theme.bounding_box,
        })
    };
    let pieces: &[Color] = &palette::PIECES;
    json!({"pieces": pieces, "light": theme(&palette::LIGHT), "dark": theme(&palette::DARK)})
}

/// A text and bytes behind it as one stream, deflated, in base64.
pub(crate) fn packed(text: &str, bytes: &[u8]) -> io::Result<String> {
    let mut zlib = ZlibEncoder::new(Vec::new(), Compression::best());
    zlib.write_all(&(text.len() as u32).to_le_bytes())?;
    zlib.write_all(text.as_bytes())?;
    zlib.write_all(bytes)?;
    Ok(base64::engine::general_purpose::STANDARD.encode(zlib.finish()?))
}

/// Writes a frame with its parts, each at its mark. They come in the order of the frame.
pub(crate) fn fill(frame: &str, parts: &[(&str, &str)], mut out: impl Write) -> io::Result<()> {
    let mut rest = frame;
    for (mark, part) in parts {
        let (before, after) = rest.split_once(mark).expect("the frame has all marks");
        out.write_all(before.as_bytes())?;
        out.write_all(part.as_bytes())?;
        rest = after;
    }
    out.write_all(rest.as_bytes())
}

/// A text as HTML.
pub(crate) fn escaped(text: &str) -> String {
    let html = text.replace('&', "&amp;").replace('<', "&lt;");
    let html = html.replace('>', "&gt;").replace('"', "&quot;");
    html.replace('\'', "&#39;")
}

/// The script of a page: what all have, and its own.
pub(crate) fn script(own: &[&str]) -> String {
    SHARED_SCRIPTS.concat() + &own.concat()
}

/// The page round its parts.
pub(crate) const FRAME: &str = include_str!("page/page.html");
pub(crate) const STYLE: &str = include_str!("page/page.css");
/// What every page begins its script with, file by file: each uses those before it.
const SHARED_SCRIPTS: [&str; 8] = [
    include_str!("page/vectors.js"),
    include_str!("page/packed.js"),
    include_str!("page/camera.js"),
    include_str!("page/cutter.js"),
    include_str!("page/finer.js"),
    include_str!("page/scene.js"),
    include_str!("page/overlay.js"),
    include_str!("page/stage.js"),
];
const SCRIPTS: [&str; 4] = [
    include_str!("page/data.js"),
    include_str!("page/shade.js"),
    include_str!("page/plots.js"),
    include_str!("page/page.js"),
];
