//! The scene that a scene file describes.

use std::io;
use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;
use tearmesh::{Plane, Point, Scissor, Vector, VertexId};
use tearmesh_cloth::scene::{
    Axis, Frame, HeldVertices, Preset, Region, Scene, SwayingWind, TimedCut,
};
use tearmesh_cloth::{
    Body, BodyError, Collider, ColliderShape, Method, RigidMotion, Seam, Tearing, Threshold,
};

use super::kinds::set;
use super::read::{SceneFile, Table, none_of};
use crate::exit::Stop;
use crate::input::Input;
use crate::say::{Fault, two_digits};

impl SceneFile {
    /// Which way is up.
    pub(crate) fn up(&self) -> Axis {
        let top = self.table("");
        top.and_then(|top| top.word("up")).unwrap_or(Axis::Y)
    }

    /// The metres for 1 of `vt`, if texture coordinates are the shape at rest.
    pub(crate) fn vt_m(&self) -> Option<f64> {
        self.table("fabric").and_then(|fabric| fabric.get("vt_m"))
    }

    /// The scene for a mesh with this frame, or all that is wrong; the method may be chosen on the command line.
    pub(crate) fn scene(&self, frame: &Frame, solver: Option<&Method>) -> Result<Scene, Stop> {
        let top = self.table("").expect("a file has a top");
        let base = top.word::<Preset>("base");
        let mut scene = base.map_or_else(|| Scene::fall(frame.up), |preset| preset(frame));
        let faults = &mut Vec::new();
        set(&mut scene.duration_s, top.get("seconds"));
        match top.get("gravity_m_per_s2") {
            Some(Gravity::Down(g)) => scene.gravity_m_per_s2 = frame.up.vector() * -g,
            Some(Gravity::Vector(g)) => scene.gravity_m_per_s2 = g.into(),
            None => {}
        }
        set(&mut scene.drag_per_s, top.get("drag_per_s"));
        self.solver(&mut scene, solver, faults);
        self.fabric(&mut scene, frame, faults);
        self.wind(&mut scene, faults);
        self.fill(&mut scene.colliders, "collider", faults, Self::collider);
        self.fill(&mut scene.holds, "hold", faults, Self::hold);
        self.fill(&mut scene.cuts, "cut", faults, Self::cut);
        self.fill(&mut scene.seams, "seam", faults, Self::seam);
        self.fill(&mut scene.strengths, "strength", faults, Self::strength);
        let unpicks = self.tables("seam");
        let unpicks =
            unpicks.filter_map(|seam| Some((seam.get("unpick_at_s")?, seam.get("name")?)));
        scene.unpicks = unpicks.collect();
        scene.cuts.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
        if let Some(table) = self.table("tear") {
            match self.tear(table, frame) {
                Ok(tearing) => scene.tearing = tearing,
                Err(fault) => faults.push(fault),
            }
        }
        none_of(std::mem::take(faults))?;
        Ok(scene)
    }

    /// Where a file has any tables of a name, they stand for those of the base.
    fn fill<T>(
        &self,
        list: &mut Vec<T>,
        name: &str,
        faults: &mut Vec<Fault>,
        read: impl Fn(&SceneFile, &Table) -> Result<T, Fault>,
    ) {
        if self.has(name) {
            list.clear();
        }
        for table in self.tables(name) {
            match read(self, table) {
                Ok(one) => list.push(one),
                Err(fault) => faults.push(fault),
            }
        }
    }

    fn wind(&self, scene: &mut Scene, faults: &mut Vec<Fault>) {
        let Some(table) = self.table("wind") else {
            return;
        };
        let period_s = table.get("period_s").unwrap_or(1.0);
        if !(scene.duration_s / period_s).is_finite() {
            let message = "`period_s` is too short: the wind would sway too often to be counted";
            faults.push(self.fault(table, "period_s", "E-SCENE-RANGE", message));
        }
        match vector(table, "velocity_m_per_s") {
            Some(velocity_m_per_s) => {
                scene.wind = Some(SwayingWind {
                    steady: tearmesh_cloth::Wind {
                        velocity_m_per_s,
                        coefficient: table.get("coefficient").unwrap_or(1.5),
                    },
                    sway_m_per_s: vector(table, "sway_m_per_s").unwrap_or_else(Vector::zeros),
                    period_s,
                });
            }
            None => faults.push(self.missing(table, "velocity_m_per_s")),
        }
    }

    fn collider(&self, table: &Table) -> Result<Collider, Fault> {
        let groups: [&[_]; 3] = [
            &["point", "normal"],
            &["centre", "radius_m"],
            &["body", "thickness_m", "cell_m", "moves", "turns", "about"],
        ];
        let group = self.one_of(table, "a collider", &groups)?;
        let lacks = || self.lacks(table, group);
        let collider = match group[0] {
            "body" => self.body(table, &table.get::<String>("body").ok_or_else(lacks)?)?,
            "point" => {
                let point = point(table, "point").ok_or_else(lacks)?;
                let normal = vector(table, "normal").ok_or_else(lacks)?;
                let plane = Plane::new(point, normal).map_err(|error| error.to_string());
                let wrong = |why| self.fault(table, "normal", "E-SCENE-RANGE", why);
                Collider::plane(plane.map_err(wrong)?)
            }
            _ => {
                let centre = point(table, "centre").ok_or_else(lacks)?;
                Collider::sphere(centre, table.get("radius_m").ok_or_else(lacks)?)
            }
        };
        Ok(collider.with_friction(table.get("friction").unwrap_or(0.0)))
    }

    /// The body in a file, whose place is given as from the scene file.
    fn body(&self, table: &Table, file: &str) -> Result<Collider, Fault> {
        let path = Path::new(self.name()).with_file_name(file);
        let read = Input::find(&path, &mut io::empty()).and_then(|input| input.document());
        let document = read.map_err(|stop| {
            let found = stop.faults.into_iter().next().expect("a reason");
            match found.location {
                Some(_) => found,
                None => self.fault(table, "body", found.code, found.message.clone()),
            }
        })?;
        let (points, faces) = (document.positions(), document.triangles());
        let body = Body::new(points, faces, table.get("cell_m")).map_err(|error| {
            let key = match error {
                BodyError::Cell { .. } => "cell_m",
                _ => "body",
            };
            let fault = self.fault(table, key, "E-SCENE-BODY", error.to_string());
            fault.help("a body is closed, but for one edge in forty, and is in metres")
        })?;
        let worst_m = body.error_worst_m();
        let thickness_m = table.get("thickness_m").unwrap_or(2.0 * worst_m);
        if thickness_m < worst_m {
            let worst = two_digits(worst_m);
            let message = format!("`thickness_m` is below {worst}, the error of the body's grid");
            let fault = self.fault(table, "thickness_m", "E-SCENE-BODY", message);
            return Err(fault.help("a larger thickness, or a smaller `cell_m`"));
        }
        let path = |key, unit: f64| {
            let rows = rows(table, key).into_iter();
            tearmesh_cloth::Path::new(rows.map(|(time_s, way)| (time_s, Point::from(way * unit))))
        };
        Ok(Collider {
            shape: ColliderShape::Body {
                body: Arc::new(body),
                thickness_m,
                motion: RigidMotion {
                    moves: path("moves", 1.0),
                    turns: path("turns", 1_f64.to_radians()),
                    about: point(table, "about").unwrap_or_else(Point::origin),
                },
            },
            friction: 0.0,
        })
    }

    fn hold(&self, table: &Table) -> Result<HeldVertices, Fault> {
        let from_s = table.get("from_s").unwrap_or(0.0);
        let until_s = table.get("until_s");
        if until_s.is_some_and(|until_s| until_s <= from_s) {
            let message = "`until_s` is not later than `from_s`";
            return Err(self.fault(table, "until_s", "E-SCENE-RANGE", message));
        }
        Ok(HeldVertices {
            region: self.region(table, "a hold")?,
            from_s,
            until_s,
            moves: rows(table, "moves"),
        })
    }

    fn strength(&self, table: &Table) -> Result<(Region, f64), Fault> {
        match table.get("factor") {
            Some(factor) => Ok((self.region(table, "a strength")?, factor)),
            None => Err(self.missing(table, "factor")),
        }
    }

    fn region(&self, table: &Table, what: &str) -> Result<Region, Fault> {
        let places: [&[_]; 2] = [&["near", "radius"], &["across", "along"]];
        let bodies: [&[_]; 3] = [&["from", "to"], &["centre", "radius_m"], &["vertices"]];
        let group = self.one_of(table, what, &[&places[..], &bodies].concat())?;
        if let Some(at) = table.get("near") {
            let radius = table.get("radius").unwrap_or(0.0);
            return Ok(Region::Near { at, radius });
        }
        if table.has("across") || table.has("along") {
            let part = |key| table.get(key).unwrap_or([0.0, 1.0]);
            return Ok(Region::Patch {
                across: part("across"),
                along: part("along"),
            });
        }
        if let Some(named) = vertices(table, "vertices") {
            return Ok(Region::Vertices(named));
        }
        if let (Some(centre), Some(radius_m)) = (point(table, "centre"), table.get("radius_m")) {
            return Ok(Region::Ball { centre, radius_m });
        }
        match (point(table, "from"), point(table, "to")) {
            (Some(from), Some(to)) => Ok(Region::Box { from, to }),
            _ => Err(self.lacks(table, group)),
        }
    }

    fn seam(&self, table: &Table) -> Result<Seam, Fault> {
        let side = |key| vertices(table, key).ok_or_else(|| self.missing(table, key));
        let name = table
            .get("name")
            .ok_or_else(|| self.missing(table, "name"))?;
        Ok(Seam {
            name,
            one: side("one")?,
            other: side("other")?,
        })
    }

    fn cut(&self, table: &Table) -> Result<TimedCut, Fault> {
        let rays = self.rays(table)?;
        Scissor::new(rays[0], rays[1])
            .map_err(|error| self.fault(table, "rays", "E-SCENE-RANGE", error.to_string()))?;
        Ok(TimedCut {
            at_s: table.get("at_s").unwrap_or(0.0),
            rays,
            through: table.get("through").unwrap_or(false),
            method: table.word("method").unwrap_or_default(),
        })
    }

    fn tear(&self, table: &Table, frame: &Frame) -> Result<Option<Tearing>, Fault> {
        if table.get("never") == Some(true) {
            let Some(key) = table.first_but("never") else {
                return Ok(None);
            };
            let message = format!("`never` and `{key}` cannot go together");
            return Err(self.fault(table, key, "E-SCENE-CLASH", message));
        }
        let groups: [&[_]; 5] = [
            &["threshold"],
            &["toughness_j_per_m"],
            &["threshold_n"],
            &["principal_stretch"],
            &["threshold_warp", "threshold_weft", "warp"],
        ];
        match self.one_of(table, "a threshold", &groups) {
            Err(fault) if fault.code != "E-SCENE-MISSING" => return Err(fault),
            _ => {}
        }
        let woven = match (table.get("threshold_warp"), table.get("threshold_weft")) {
            (Some(warp), Some(weft)) => Some(Threshold::WarpWeft {
                warp,
                weft,
                axis: vector(table, "warp").unwrap_or_else(|| frame.along.vector()),
            }),
            (None, None) if !table.has("warp") => None,
            (Some(_), None) => return Err(self.missing(table, "threshold_weft")),
            (None, _) => return Err(self.missing(table, "threshold_warp")),
        };
        let of = |key, threshold: fn(f64) -> Threshold| table.get(key).map(threshold);
        let stretch = of("threshold", Threshold::Stretch);
        let stretch = stretch.or(of("principal_stretch", Threshold::PrincipalStretch));
        let energy = of("toughness_j_per_m", Threshold::Toughness);
        let other = energy.or(of("threshold_n", Threshold::Force)).or(woven);
        let usual = Threshold::Stretch(Scene::STRETCH_RATIO);
        let mut tearing = Tearing::new(stretch.or(other).unwrap_or(usual));
        tearing.splits_per_step_max = table.get("splits_per_step");
        if let Some(weakening) = table.get("weakening") {
            if weakening == 0.0 {
                let message = "`weakening` is above 0";
                return Err(self.fault(table, "weakening", "E-SCENE-RANGE", message));
            }
            tearing.weakening = (weakening < 1.0).then_some(weakening);
        }
        Ok(Some(tearing))
    }

    /// Gives the group of keys of which a table has some; refuses keys of different groups, and none of any.
    fn one_of<'g>(
        &self,
        table: &Table,
        what: &str,
        groups: &[&'g [&'static str]],
    ) -> Result<&'g [&'static str], Fault> {
        let found = groups.iter().filter_map(|&group| {
            let found = table.those_of(group);
            Some((group, *found.first()?))
        });
        let mut choices: Vec<&str> = groups.iter().map(|group| group[0]).collect();
        choices.sort_unstable();
        let choices = choices.join(", ");
        match found.collect::<Vec<_>>()[..] {
            [(group, _)] => Ok(group),
            [(_, one), (_, other), ..] => {
                let message = format!("`{one}` and `{other}` cannot go together");
                let fault = self.fault(table, other, "E-SCENE-CLASH", message);
                Err(fault.help(format!("{what} takes one of {choices}")))
            }
            [] => {
                let message = format!("{what} must have one of {choices}");
                Err(self.fault(table, "", "E-SCENE-MISSING", message))
            }
        }
    }

    /// That a table has one key of a group, and lacks another.
    fn lacks(&self, table: &Table, group: &[&str]) -> Fault {
        let lacking = group.iter().find(|key| !table.has(key));
        self.missing(table, lacking.unwrap_or(&group[0]))
    }
}

/// A number, which means that much downward, or a vector.
#[derive(Deserialize)]
#[serde(untagged)]
enum Gravity {
    Down(f64),
    Vector([f64; 3]),
}

/// The vector of a key.
pub(super) fn vector(table: &Table, key: &str) -> Option<Vector> {
    table.get::<[f64; 3]>(key).map(Vector::from)
}

/// The times and vectors of the rows of a key.
fn rows(table: &Table, key: &str) -> Vec<(f64, Vector)> {
    let rows: Vec<[f64; 4]> = table.get(key).unwrap_or_default();
    let row = |[time_s, x, y, z]: [f64; 4]| (time_s, Vector::new(x, y, z));
    rows.into_iter().map(row).collect()
}

/// The vertices that the numbers of a key stand for.
fn vertices(table: &Table, key: &str) -> Option<Vec<VertexId>> {
    let numbers: Vec<usize> = table.get(key)?;
    let ids = numbers.into_iter().map(|number| VertexId::new(number - 1));
    Some(ids.flatten().collect())
}

fn point(table: &Table, key: &str) -> Option<Point> {
    table.get::<[f64; 3]>(key).map(Point::from)
}
