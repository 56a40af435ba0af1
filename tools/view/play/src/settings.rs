//! What is chosen before a cloth is let go: the cloth itself, how it is held, and how it moves and tears.

use std::fmt::Display;
use std::str::FromStr;

use tearmesh::shapes;
use tearmesh_cloth::scene::file::{PackedScene, SceneFault, SceneFile};
use tearmesh_cloth::scene::{Axis, Frame, Preset, Scene};
use tearmesh_cloth::{Method, Tearing, Threshold};
use tearmesh_obj::Document;

/// The settings of a cloth that is played with. As text, each is a line: its name, and its value.
///
/// ```
/// let text = "cloth sheet 32\nscene flag\nup y\nmethod verlet\nthreshold 1.5\n";
/// let settings: tearmesh_play::Settings = text.parse()?;
/// assert_eq!(settings.cloth, tearmesh_play::ClothSource::Sheet(32));
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug)]
pub struct Settings {
    /// The cloth.
    pub cloth: ClothSource,
    /// `None` for that of a file.
    scene: Option<Preset>,
    /// The scene of the file, which is not in the text.
    pub plan: Option<Plan>,
    /// The upward direction.
    pub up: Axis,
    /// `None` for that of the scene.
    method: Option<Method>,
    /// The ratio of length to rest length at which an edge tears, infinite for never; `None` for the rules of the
    /// scene.
    pub threshold: Option<f64>,
    /// All of them, as they were read.
    pub(crate) text: String,
}

/// The scene of a file.
#[derive(Clone, Debug)]
pub struct Plan {
    packed: PackedScene,
    file: SceneFile,
}

impl Plan {
    /// Reads a packed scene, as JSON.
    ///
    /// # Errors
    ///
    /// Why it is none, in words.
    pub fn read(json: &[u8]) -> Result<Plan, String> {
        let packed: PackedScene = words(serde_json::from_slice(json))?;
        let file = words(serde_json::from_str(&packed.text))?;
        Ok(Plan { packed, file })
    }

    fn scene(&self, frame: &Frame) -> Result<Scene, String> {
        let made = self.packed.on(&self.file, frame);
        made.map_err(|faults| faults.first().map_or(String::new(), SceneFault::to_string))
    }
}

/// Where a cloth comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum ClothSource {
    /// A square of 1 m, in so many cells a side.
    Sheet(u32),
    /// An OBJ file of this name.
    File(String),
}

/// The largest number of vertices that a page plays with.
pub const VERTICES_MAX: usize = 20_000;

/// The largest number of cells a side of a sheet: its vertices are fewer than [`VERTICES_MAX`].
pub const CELLS_MAX: u32 = 128;

/// The largest coordinate that a page draws, in metres: cloths are drawn in `f32`, which ends at 3.4e38, and move.
const COORDINATE_MAX: f64 = 1e30;

impl Settings {
    /// Returns the scene for a cloth in this frame, with what was chosen. Where a scene that stands ready would
    /// strengthen the cloth for its own grip, hands grip where they grab.
    pub(crate) fn scene(&self, frame: &Frame) -> Result<Scene, String> {
        let ready = self.scene.map(|ready| Scene {
            strengths: Vec::new(),
            ..ready(frame)
        });
        let mut scene = match (ready, &self.plan) {
            (Some(ready), _) => ready,
            (None, Some(plan)) => plan.scene(frame)?,
            (None, None) => return Err("the scene is in a file that is not here".to_owned()),
        };
        if let Some(method) = &self.method {
            scene.solver = method.clone();
        }
        if let Some(ratio) = self.threshold {
            let tearing = Tearing::new(Threshold::Stretch(ratio));
            scene.tearing = ratio.is_finite().then_some(tearing);
        }
        Ok(scene)
    }

    /// Reads the cloth. `obj` is the content of its file, for one that has a file.
    ///
    /// # Errors
    ///
    /// What is wrong with the file, in words.
    pub fn document(&self, obj: &[u8]) -> Result<Document, String> {
        match self.cloth {
            ClothSource::Sheet(cells) => document(sheet(cells).as_bytes()),
            ClothSource::File(_) => document(obj),
        }
    }
}

/// Reads an OBJ file that a page can play with.
pub(crate) fn document(obj: &[u8]) -> Result<Document, String> {
    let document = words(Document::read(obj))?;
    let numbers = document.positions().iter().flat_map(|p| [p.x, p.y, p.z]);
    let farthest = numbers.map(f64::abs).fold(0.0, f64::max);
    if farthest > COORDINATE_MAX {
        return Err(format!(
            "a coordinate is {farthest:e}, and a page draws up to {COORDINATE_MAX:e}"
        ));
    }
    match document.positions().len() {
        0..=VERTICES_MAX => Ok(document),
        given => Err(format!(
            "the mesh has {given} vertices, and a page plays with at most {VERTICES_MAX}"
        )),
    }
}

/// A square of 1 m as an OBJ file. Diagonals alternate, so that it tears no more easily one way than the other.
fn sheet(cells: u32) -> String {
    let (mesh, positions) = shapes::grid_with_diagonals(cells, cells, |i, j| (i + j) % 2 == 0);
    let mut text = "o sheet\n".to_owned();
    let points = || positions.as_slice().iter();
    text.extend(points().map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)));
    text.extend(points().map(|p| format!("vt {} {}\n", p.x, p.y)));
    for face in mesh.faces() {
        let corners = mesh.face_vertices(face).map(|v| v.index() + 1);
        let [a, b, c] = corners.map(|v| format!("{v}/{v}"));
        text.push_str(&format!("f {a} {b} {c}\n"));
    }
    text
}

/// Why something failed, in words.
pub(crate) fn words<T>(done: Result<T, impl Display>) -> Result<T, String> {
    done.map_err(|error| error.to_string())
}

fn find<T: Copy>(table: &[(&str, T)], name: &str) -> Option<T> {
    let mut named = table.iter().filter(|(known, _)| *known == name);
    named.next().map(|(_, value)| *value)
}

impl FromStr for Settings {
    type Err = String;

    fn from_str(text: &str) -> Result<Settings, String> {
        let mut lines = text.lines();
        let mut value = |name: &str| {
            let line = lines.next().unwrap_or_default();
            let value = line.strip_prefix(name);
            let value = value.and_then(|rest| rest.strip_prefix(' '));
            value.ok_or_else(|| format!("expected `{name}` and its value, found `{line}`"))
        };
        let (cloth, scene) = (value("cloth")?, value("scene")?);
        let (up, method, threshold) = (value("up")?, value("method")?, value("threshold")?);
        let more = lines.next();
        more.map_or(Ok(()), |line| {
            Err(format!("expected nothing more, found `{line}`"))
        })?;
        let unknown = |what: &str, given: &str| format!("there is no {what} `{given}`");
        let file = cloth.strip_prefix("file ").map(str::to_owned);
        let cells = cloth.strip_prefix("sheet ");
        let cells = cells.and_then(|cells| cells.parse().ok());
        let sheet = cells.filter(|cells| (1..=CELLS_MAX).contains(cells));
        let source = file.map(ClothSource::File);
        let source = source.or(sheet.map(ClothSource::Sheet));
        let cloth = source.ok_or_else(|| unknown("cloth", cloth))?;
        let threshold = match threshold {
            "scene" => None,
            "never" => Some(f64::INFINITY),
            ratio => {
                let number = ratio.parse().ok();
                let number = number.filter(|number: &f64| number.is_finite() && *number > 1.0);
                Some(number.ok_or_else(|| unknown("threshold", ratio))?)
            }
        };
        Ok(Settings {
            cloth,
            scene: match scene.starts_with("file ") {
                true => None,
                false => Some(find(&Scene::PRESETS, scene).ok_or(unknown("scene", scene))?),
            },
            plan: None,
            up: find(&Axis::NAMED, up).ok_or(unknown("direction", up))?,
            method: match method {
                "scene" => None,
                name => Some(Method::named(name).ok_or(unknown("method", name))?),
            },
            threshold,
            // Each with the end of its line, since the inputs follow in a log.
            text: text.lines().flat_map(|line| [line, "\n"]).collect(),
        })
    }
}
