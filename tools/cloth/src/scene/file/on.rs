//! The scene that a scene file describes, for the frame of a mesh.

use std::fmt;
use std::sync::Arc;

use tearmesh::Scissor;
use tearmesh::geometry::{Plane, Point, Vector};

use super::number::{Finite, Gravity, Rows, Vertices, Whole};
use super::{
    ColliderTable, CutTable, HoldTable, SceneFile, SeamTable, SolverTable, StrengthTable, WindTable,
};
use crate::cloth::seam::Seam;
use crate::method::Method;
use crate::scene::frame::{Axis, Frame};
use crate::scene::{HeldVertices, Region, Scene, SwayingWind, TimedCut};
use crate::system::body::{Body, BodyError};
use crate::system::load::{Collider, ColliderShape, Wind};
use crate::system::path::{Path, RigidMotion};
use crate::text::two_digits;

/// The points of a body, and its triangles.
pub type BodyMesh = (Vec<Point>, Vec<[u32; 3]>);

/// A reader of the file of a body, from the number of its collider, from 0, and the name of the file; or why it cannot
/// be read.
type ReadBody<'r> = dyn FnMut(usize, &str) -> Result<BodyMesh, String> + 'r;

/// A fault of a scene file, and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneFault {
    /// The name of the table; empty for the top.
    pub table: &'static str,
    /// The number of the table among those of its name, from 0.
    pub number: usize,
    /// The key; empty for the table as a whole.
    pub key: &'static str,
    /// The code of the error, such as `E-SCENE-CLASH`.
    pub code: &'static str,
    /// What is wrong.
    pub message: String,
    /// What would help.
    pub help: Option<String>,
}

impl fmt::Display for SceneFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.table {
            "" => f.write_str(&self.message),
            table => write!(f, "[{table}] {}: {}", self.number + 1, self.message),
        }
    }
}

impl std::error::Error for SceneFault {}

impl SceneFault {
    pub(super) fn help(mut self, help: impl Into<String>) -> SceneFault {
        self.help = Some(help.into());
        self
    }
}

/// A table, by its name and its number among those of that name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    table: &'static str,
    number: usize,
}

impl Place {
    pub(super) const fn of(table: &'static str, number: usize) -> Place {
        Place { table, number }
    }

    pub(super) fn fault(
        self,
        key: &'static str,
        code: &'static str,
        message: impl Into<String>,
    ) -> SceneFault {
        SceneFault {
            table: self.table,
            number: self.number,
            key,
            code,
            message: message.into(),
            help: None,
        }
    }

    pub(super) fn missing(self, key: &str) -> SceneFault {
        let message = format!("[{}] lacks `{key}`", self.table);
        self.fault("", "E-SCENE-MISSING", message)
    }

    /// That a table has one key of a group, and lacks another.
    pub(super) fn lacks(self, group: &Group) -> SceneFault {
        let lacking = group.iter().find(|(_, is_given)| !is_given);
        self.missing(lacking.unwrap_or(&group[0]).0)
    }
}

/// Keys that go together, and whether each is given.
pub(super) type Group = Vec<(&'static str, bool)>;

/// Gives the group of keys of which a table has some; refuses keys of different groups, and none of any.
pub(super) fn one_of<'g>(
    place: Place,
    what: &str,
    groups: &'g [Group],
) -> Result<&'g Group, SceneFault> {
    let found = groups.iter().filter_map(|group| {
        let given = group.iter().find(|(_, is_given)| *is_given)?;
        Some((group, given.0))
    });
    let mut choices: Vec<&str> = groups.iter().map(|group| group[0].0).collect();
    choices.sort_unstable();
    let choices = choices.join(", ");
    match found.collect::<Vec<_>>()[..] {
        [(group, _)] => Ok(group),
        [(_, one), (_, other), ..] => {
            let message = format!("`{one}` and `{other}` cannot go together");
            let fault = place.fault(other, "E-SCENE-CLASH", message);
            Err(fault.help(format!("{what} takes one of {choices}")))
        }
        [] => {
            let message = format!("{what} must have one of {choices}");
            Err(place.fault("", "E-SCENE-MISSING", message))
        }
    }
}

impl SceneFile {
    /// Returns the direction that is up.
    #[must_use]
    pub fn up(&self) -> Axis {
        self.up.as_deref().copied().unwrap_or(Axis::Y)
    }

    /// Returns the scene for a mesh with this frame. A method that is `typed` stands for that of the file; the
    /// file's keys for either are read. `bodies` reads the file of a body, from the number of its collider, from 0,
    /// and its name, or says why it cannot.
    ///
    /// Vertices have the ids that their numbers in the file say, counted from 1. The rest shape that
    /// [`FabricTable::vt_m`](super::FabricTable::vt_m) asks for is not set: it needs texture coordinates, of
    /// which [`rest_from_texture`](crate::scene::rest_from_texture) makes it.
    ///
    /// # Errors
    ///
    /// Every [`SceneFault`].
    pub fn on(
        &self,
        frame: &Frame,
        typed: Option<&Method>,
        bodies: &mut ReadBody<'_>,
    ) -> Result<Scene, Vec<SceneFault>> {
        let base = self.base.as_deref();
        let mut scene = base.map_or_else(|| Scene::fall(frame.up), |preset| preset(frame));
        let mut faults = Vec::new();
        put(&mut scene.duration_s, self.seconds.as_deref());
        put(&mut scene.drag_per_s, self.drag_per_s.as_deref());
        scene.ripple_m = self.ripple_m.as_deref().copied();
        match &self.gravity_m_per_s2 {
            Some(Gravity::Down(g)) => scene.gravity_m_per_s2 = frame.up.vector() * -**g,
            Some(Gravity::Vector(g)) => scene.gravity_m_per_s2 = g.vector(),
            None => {}
        }
        let solver = self.solver.clone().unwrap_or_default();
        solver.apply(&mut scene, typed, &mut faults);
        if let Some(fabric) = &self.fabric {
            fabric.apply(&mut scene, frame, &mut faults);
        }
        if let Some(wind) = &self.wind {
            scene.wind = wind.wind(scene.duration_s, &mut faults);
        }
        self.replace_lists(&mut scene, bodies, &mut faults);
        if let Some(tear) = &self.tear {
            let tearing = tear.tearing(frame);
            scene.tearing = tearing.unwrap_or_else(|fault| {
                faults.push(fault);
                None
            });
        }
        match faults.is_empty() {
            true => Ok(scene),
            false => Err(faults),
        }
    }

    /// Puts what the tables of lists describe in the place of what the base has.
    fn replace_lists(
        &self,
        scene: &mut Scene,
        bodies: &mut ReadBody<'_>,
        faults: &mut Vec<SceneFault>,
    ) {
        let collider = |one: &ColliderTable, number| one.collider(number, bodies);
        replace(&mut scene.colliders, &self.collider, faults, collider);
        replace(&mut scene.holds, &self.hold, faults, HoldTable::hold);
        replace(&mut scene.cuts, &self.cut, faults, CutTable::cut);
        replace(&mut scene.seams, &self.seam, faults, SeamTable::seam);
        replace(
            &mut scene.strengths,
            &self.strength,
            faults,
            StrengthTable::strength,
        );
        let unpicks = self.seam.iter().filter_map(|seam| {
            let name = seam.name.as_deref()?.clone();
            Some((*seam.unpick_at_s.as_deref()?, name))
        });
        scene.unpicks = unpicks.collect();
        scene.cuts.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    }
}

/// Puts a value in the place of another, if a file has it.
pub(super) fn put<T: Copy>(place: &mut T, value: Option<&T>) {
    if let Some(value) = value {
        *place = *value;
    }
}

/// Puts what tables describe in the place of a list, if there are any.
fn replace<T, U>(
    list: &mut Vec<T>,
    tables: &[U],
    faults: &mut Vec<SceneFault>,
    mut read: impl FnMut(&U, usize) -> Result<T, SceneFault>,
) {
    if tables.is_empty() {
        return;
    }
    list.clear();
    for (number, table) in tables.iter().enumerate() {
        match read(table, number) {
            Ok(one) => list.push(one),
            Err(fault) => faults.push(fault),
        }
    }
}

/// The keys of `[solver]` that not all methods read, and which do.
const OF_METHODS: [(&str, &[&str]); 7] = [
    ("sweeps", &["xpbd", "pbd"]),
    ("stiffness", &["pbd"]),
    ("bend_stiffness", &["pbd"]),
    ("limit_ratio", &["provot"]),
    ("limit_passes", &["provot"]),
    ("order", &["implicit"]),
    ("tolerance", &["implicit"]),
];

impl SolverTable {
    /// The method: the keys are those of the file's or of the one that was typed in its place.
    fn apply(&self, scene: &mut Scene, typed: Option<&Method>, faults: &mut Vec<SceneFault>) {
        if let Some(method) = self.method.as_deref() {
            scene.solver = method();
        }
        let method = scene.solver.name();
        if let Some(typed) = typed {
            scene.solver = typed.clone();
        }
        scene.step_s = self.dt_s.as_deref().copied().or(scene.step_s);
        let given = present!(
            self,
            sweeps,
            stiffness,
            bend_stiffness,
            limit_ratio,
            limit_passes,
            order,
            tolerance
        );
        for ((key, readers), (_, is_given)) in OF_METHODS.into_iter().zip(given) {
            let is_read = |reader: &&str| [method, scene.solver.name()].contains(reader);
            if is_given && !readers.iter().any(is_read) {
                let readers = readers.join(" or ");
                let message = format!("`{key}` goes with {readers}, and the method is {method}");
                faults.push(Place::of("solver", 0).fault(key, "E-SCENE-CLASH", message));
            }
        }
        self.set(&mut scene.solver);
    }

    /// Puts what the table says in the place of a method's settings.
    fn set(&self, method: &mut Method) {
        let count = |number: &Option<Whole>| number.as_ref().map(Whole::get);
        let sweeps = count(&self.sweeps);
        match method {
            Method::Provot(limiter) => {
                put(&mut limiter.stretch_ratio_max, self.limit_ratio.as_deref());
                put(&mut limiter.passes_max, count(&self.limit_passes).as_ref());
            }
            Method::Pbd(pbd) => {
                put(&mut pbd.sweeps, sweeps.as_ref());
                put(&mut pbd.stiffness, self.stiffness.as_deref());
                put(&mut pbd.bend_stiffness, self.bend_stiffness.as_deref());
            }
            Method::Verlet => {}
            Method::Xpbd(xpbd) => {
                put(&mut xpbd.sweeps, sweeps.as_ref());
            }
            Method::Implicit(settings) => {
                put(&mut settings.tolerance, self.tolerance.as_deref());
                put(&mut settings.method, self.order.as_deref());
            }
        }
    }
}

impl WindTable {
    /// None without a velocity, which is a fault.
    fn wind(&self, duration_s: f64, faults: &mut Vec<SceneFault>) -> Option<SwayingWind> {
        let place = Place::of("wind", 0);
        let period_s = self.period_s.as_deref().copied().unwrap_or(1.0);
        if !(duration_s / period_s).is_finite() {
            let message = "`period_s` is too short: the wind would sway too often to be counted";
            faults.push(place.fault("period_s", "E-SCENE-RANGE", message));
        }
        let Some(velocity) = &self.velocity_m_per_s else {
            faults.push(place.missing("velocity_m_per_s"));
            return None;
        };
        let mut wind = SwayingWind::steady(Wind {
            velocity_m_per_s: velocity.vector(),
            coefficient: self.coefficient.as_deref().copied().unwrap_or(1.5),
        });
        if let Some(sway) = &self.sway_m_per_s {
            wind.sway_m_per_s = sway.vector();
        }
        put(&mut wind.from_s, self.from_s.as_deref());
        wind.period_s = period_s;
        Some(wind)
    }
}

impl ColliderTable {
    fn collider(&self, number: usize, bodies: &mut ReadBody<'_>) -> Result<Collider, SceneFault> {
        let place = Place::of("collider", number);
        let groups = [
            present!(self, point, normal),
            present!(self, centre, radius_m),
            present!(self, body, thickness_m, cell_m, moves, turns, about),
        ];
        let group = one_of(place, "a collider", &groups)?;
        let lacks = || place.lacks(group);
        let collider = match group[0].0 {
            "body" => {
                let name = self.body.as_ref().ok_or_else(lacks)?;
                self.of_body(place, name, bodies)?
            }
            "point" => {
                let given = self.point.as_ref().zip(self.normal.as_ref());
                let (point, normal) = given.ok_or_else(lacks)?;
                let plane = Plane::new(point.point(), normal.vector());
                let wrong = |why: tearmesh::PlaneError| {
                    place.fault("normal", "E-SCENE-RANGE", why.to_string())
                };
                Collider::plane(plane.map_err(wrong)?)
            }
            _ => {
                let given = self.centre.as_ref().zip(self.radius_m.as_ref());
                let (centre, radius_m) = given.ok_or_else(lacks)?;
                Collider::sphere(centre.point(), **radius_m)
            }
        };
        let friction = self.friction.as_deref().copied();
        Ok(collider.with_friction(friction.unwrap_or(Scene::FRICTION)))
    }

    /// The body in a file.
    fn of_body(
        &self,
        place: Place,
        name: &str,
        bodies: &mut ReadBody<'_>,
    ) -> Result<Collider, SceneFault> {
        let (points, faces) =
            bodies(place.number, name).map_err(|why| place.fault("body", "E-SCENE-BODY", why))?;
        let cell_m = self.cell_m.as_deref().copied();
        let body = Body::new(&points, &faces, cell_m).map_err(|error| {
            let key = match error {
                BodyError::Cell { .. } => "cell_m",
                _ => "body",
            };
            let fault = place.fault(key, "E-SCENE-BODY", error.to_string());
            fault.help("a body is closed, but for one edge in forty, and is in metres")
        })?;
        let worst_m = body.error_worst_m();
        let thickness_m = self.thickness_m.as_deref().copied();
        let thickness_m = thickness_m.unwrap_or(2.0 * worst_m);
        if thickness_m < worst_m {
            let worst = two_digits(worst_m);
            let message = format!("`thickness_m` is below {worst}, the error of the body's grid");
            let fault = place.fault("thickness_m", "E-SCENE-BODY", message);
            return Err(fault.help("a larger thickness, or a smaller `cell_m`"));
        }
        let path = |given: &Option<Rows>, unit: f64| {
            let rows = rows(given, unit).into_iter();
            Path::new(rows.map(|(time_s, way)| (time_s, Point::from(way))))
        };
        Ok(Collider {
            shape: ColliderShape::Body {
                body: Arc::new(body.named(name)),
                thickness_m,
                motion: RigidMotion {
                    moves: path(&self.moves, 1.0),
                    turns: path(&self.turns, 1_f64.to_radians()),
                    about: point(&self.about),
                },
            },
            friction: 0.0,
        })
    }
}

/// Rows of a time and a vector in this unit; none if the key is not there.
fn rows(given: &Option<Rows>, unit: f64) -> Vec<(f64, Vector)> {
    let rows = given.as_ref().map_or_else(Vec::new, Rows::paths);
    rows.into_iter()
        .map(|(time_s, way)| (time_s, way * unit))
        .collect()
}

/// A point; the origin if the key is not there.
fn point(given: &Option<Finite<3>>) -> Point {
    given.as_ref().map_or(Point::origin(), Finite::point)
}

impl HoldTable {
    fn hold(&self, number: usize) -> Result<HeldVertices, SceneFault> {
        let place = Place::of("hold", number);
        let from_s = self.from_s.as_deref().copied().unwrap_or(0.0);
        let until_s = self.until_s.as_deref().copied();
        if until_s.is_some_and(|until_s| until_s <= from_s) {
            let message = "`until_s` is not later than `from_s`";
            return Err(place.fault("until_s", "E-SCENE-RANGE", message));
        }
        Ok(HeldVertices {
            region: self.region_keys().region(place, "a hold")?,
            from_s,
            until_s,
            moves: rows(&self.moves, 1.0),
            turns: rows(&self.turns, 1_f64.to_radians()),
            about: point(&self.about),
            grip_m: self.grip_m.as_deref().copied(),
        })
    }
}

impl StrengthTable {
    fn strength(&self, number: usize) -> Result<(Region, f64), SceneFault> {
        let place = Place::of("strength", number);
        let factor = self.factor.as_deref().copied();
        let factor = factor.ok_or_else(|| place.missing("factor"))?;
        let region = self.region_keys().region(place, "a strength")?;
        Ok((region, factor))
    }
}

impl SeamTable {
    fn seam(&self, number: usize) -> Result<Seam, SceneFault> {
        let place = Place::of("seam", number);
        let side = |key, side: &Option<Vertices>| {
            let side = side.as_ref().map(Vertices::ids);
            side.ok_or_else(|| place.missing(key))
        };
        let name = self.name.as_deref().ok_or_else(|| place.missing("name"))?;
        Ok(Seam {
            name: name.clone(),
            one: side("one", &self.one)?,
            other: side("other", &self.other)?,
        })
    }
}

impl CutTable {
    fn cut(&self, number: usize) -> Result<TimedCut, SceneFault> {
        let place = Place::of("cut", number);
        let rays = self.rays.as_deref().ok_or_else(|| place.missing("rays"))?;
        Scissor::new(rays[0], rays[1])
            .map_err(|error| place.fault("rays", "E-SCENE-RANGE", error.to_string()))?;
        Ok(TimedCut {
            at_s: self.at_s.as_deref().copied().unwrap_or(0.0),
            rays: *rays,
            through: self.through.unwrap_or(false),
            method: self.method.as_deref().copied().unwrap_or_default(),
        })
    }
}
