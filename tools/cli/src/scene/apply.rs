//! From what a scene file says to the scene.

use std::collections::BTreeSet;

use clap::ValueEnum as _;
use tearmesh::{Plane, Scissor, Vector, VertexId};
use tearmesh_cloth::scene::{Axis, Frame, HeldVertices, Region, Scene, SwayingWind, TimedCut};
use tearmesh_cloth::{Collider, Tearing, Threshold, Wind};

use super::axes::axis;
use super::file::{Content, SceneFile, Table};
use super::method::SolverName;
use super::ready::base;
use crate::args::Method as CutMethod;
use crate::say::Fault;

impl SceneFile {
    pub(super) fn up(&self) -> Axis {
        let up = self.first("").and_then(|top| top.word("up"));
        up.and_then(|up| axis(up).ok()).unwrap_or(Axis::Y)
    }

    /// The scene for a mesh with this frame, or all that is wrong.
    pub(super) fn scene(
        &self,
        frame: &Frame,
        solver: Option<SolverName>,
    ) -> Result<Scene, Vec<Fault>> {
        let top = self.first("").and_then(|top| top.word("base"));
        let mut scene = base(top.unwrap_or("fall"), frame);
        let mut faults = Vec::new();
        self.world(&mut scene, frame);
        self.solver(&mut scene, solver, &mut faults);
        self.fabric(&mut scene, frame, &mut faults);
        self.wind(&mut scene, &mut faults);
        self.fill(&mut scene.colliders, "collider", &mut faults, |table| {
            self.collider(table)
        });
        self.fill(&mut scene.holds, "hold", &mut faults, |table| {
            self.hold(table)
        });
        self.fill(&mut scene.cuts, "cut", &mut faults, |table| self.cut(table));
        self.fill(&mut scene.strengths, "strength", &mut faults, |table| {
            self.strength(table)
        });
        scene.cuts.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
        if let Some(table) = self.first("tear") {
            match self.tear(table, frame) {
                Ok(tearing) => scene.tearing = tearing,
                Err(fault) => faults.push(*fault),
            }
        }
        if faults.is_empty() {
            return Ok(scene);
        }
        super::read::sort(&mut faults);
        Err(faults)
    }

    /// Where a file has any tables of a kind, they stand for those of the base.
    fn fill<T>(
        &self,
        list: &mut Vec<T>,
        name: &str,
        faults: &mut Vec<Fault>,
        read: impl Fn(&Table) -> Result<T, Box<Fault>>,
    ) {
        let tables = self.all(name);
        if tables.is_empty() {
            return;
        }
        list.clear();
        for table in tables {
            match read(table) {
                Ok(one) => list.push(one),
                Err(fault) => faults.push(*fault),
            }
        }
    }

    fn world(&self, scene: &mut Scene, frame: &Frame) {
        if let Some(top) = self.first("") {
            if let Some(seconds) = top.number("seconds") {
                scene.duration_s = seconds;
            }
            if let Some(gravity) = top.number("gravity_m_per_s2") {
                scene.gravity_m_per_s2 = frame.up.vector() * -gravity;
            }
            if let Some(gravity) = top.vector("gravity_m_per_s2") {
                scene.gravity_m_per_s2 = gravity;
            }
            if let Some(drag) = top.number("drag_per_s") {
                scene.drag_per_s = drag;
            }
        }
    }

    fn wind(&self, scene: &mut Scene, faults: &mut Vec<Fault>) {
        let Some(table) = self.first("wind") else {
            return;
        };
        let period_s = table.number("period_s").unwrap_or(1.0);
        if !(scene.duration_s / period_s).is_finite() {
            let message = "`period_s` is too short: the wind would sway too often to be counted";
            let message = message.to_owned();
            faults.push(*self.fault(table, "period_s", "E-SCENE-RANGE", message));
        }
        match table.vector("velocity_m_per_s") {
            Some(velocity_m_per_s) => {
                scene.wind = Some(SwayingWind {
                    steady: Wind {
                        velocity_m_per_s,
                        coefficient: table.number("coefficient").unwrap_or(1.5),
                    },
                    sway_m_per_s: table.vector("sway_m_per_s").unwrap_or_else(Vector::zeros),
                    period_s,
                });
            }
            None => faults.push(*self.missing(table, "wind", "velocity_m_per_s")),
        }
    }

    fn collider(&self, table: &Table) -> Result<Collider, Box<Fault>> {
        self.one_of(
            table,
            "a collider",
            &[&["point", "normal"], &["centre", "radius_m"]],
        )?;
        if let (Some(point), Some(normal)) = (table.point("point"), table.vector("normal")) {
            let plane = Plane::new(point, normal);
            return plane
                .map(Collider::Plane)
                .map_err(|error| self.fault(table, "normal", "E-SCENE-RANGE", error.to_string()));
        }
        match (table.point("centre"), table.number("radius_m")) {
            (Some(centre), Some(radius_m)) => Ok(Collider::Sphere { centre, radius_m }),
            _ => Err(self.missing(table, "collider", other_half(table))),
        }
    }

    fn hold(&self, table: &Table) -> Result<HeldVertices, Box<Fault>> {
        let row = |row: &Vec<f64>| (row[0], Vector::new(row[1], row[2], row[3]));
        let from_s = table.number("from_s").unwrap_or(0.0);
        if table.number("until_s").is_some_and(|until| until <= from_s) {
            let message = "`until_s` is not later than `from_s`".to_owned();
            return Err(self.fault(table, "until_s", "E-SCENE-RANGE", message));
        }
        Ok(HeldVertices {
            region: self.region(table, "hold")?,
            from_s,
            until_s: table.number("until_s"),
            moves: table
                .rows("moves")
                .map(|rows| rows.iter().map(row).collect())
                .unwrap_or_default(),
        })
    }

    fn strength(&self, table: &Table) -> Result<(Region, f64), Box<Fault>> {
        match table.number("factor") {
            Some(factor) => Ok((self.region(table, "strength")?, factor)),
            None => Err(self.missing(table, "strength", "factor")),
        }
    }

    fn region(&self, table: &Table, name: &str) -> Result<Region, Box<Fault>> {
        self.one_of(
            table,
            &format!("a {name}"),
            &[
                &["near", "radius"],
                &["across", "along"],
                &["from", "to"],
                &["centre", "radius_m"],
                &["vertices"],
            ],
        )?;
        if let Some(at) = table.pair("near") {
            let radius = table.number("radius").unwrap_or(0.0);
            return Ok(Region::Near { at, radius });
        }
        let (across, along) = (table.pair("across"), table.pair("along"));
        if across.or(along).is_some() {
            return Ok(Region::Patch {
                across: across.unwrap_or([0.0, 1.0]),
                along: along.unwrap_or([0.0, 1.0]),
            });
        }
        if let Some(row) = table.row("vertices") {
            let id = |&number: &f64| VertexId::new(number as usize - 1);
            return Ok(Region::Vertices(row.iter().filter_map(id).collect()));
        }
        if let (Some(centre), Some(radius_m)) = (table.point("centre"), table.number("radius_m")) {
            return Ok(Region::Ball { centre, radius_m });
        }
        match (table.point("from"), table.point("to")) {
            (Some(from), Some(to)) => Ok(Region::Box { from, to }),
            _ => Err(self.missing(table, name, other_half(table))),
        }
    }

    fn cut(&self, table: &Table) -> Result<TimedCut, Box<Fault>> {
        let Some(Content::Rays(rays)) = table.values.get("rays").map(|value| &value.content) else {
            return Err(self.missing(table, "cut", "rays"));
        };
        Scissor::new(rays[0], rays[1])
            .map_err(|error| self.fault(table, "rays", "E-SCENE-RANGE", error.to_string()))?;
        let method = table.word("method");
        let method = method.and_then(|word| CutMethod::from_str(word, false).ok());
        Ok(TimedCut {
            at_s: table.number("at_s").unwrap_or(0.0),
            rays: **rays,
            through: table.bool("through").unwrap_or(false),
            method: method.unwrap_or_default().of_library(),
        })
    }

    fn tear(&self, table: &Table, frame: &Frame) -> Result<Option<Tearing>, Box<Fault>> {
        if table.bool("never") == Some(true) {
            let others = table.values.iter().filter(|(key, _)| **key != "never");
            let Some((key, _)) = others.min_by_key(|(_, value)| value.span.start) else {
                return Ok(None);
            };
            let message = format!("`never` and `{key}` cannot go together");
            return Err(self.fault(table, key, "E-SCENE-CLASH", message));
        }
        self.one_of(
            table,
            "a threshold",
            &[
                &["threshold"],
                &["toughness_j_per_m"],
                &["threshold_n"],
                &["principal_stretch"],
                &["threshold_warp", "threshold_weft", "warp"],
            ],
        )
        .or_else(|fault| match fault.code {
            "E-SCENE-MISSING" => Ok(()),
            _ => Err(fault),
        })?;
        let one = |name: &str, make: fn(f64) -> Threshold| table.number(name).map(make);
        let axis = table.vector("warp").unwrap_or_else(|| frame.along.vector());
        let ratios = [
            table.number("threshold_warp"),
            table.number("threshold_weft"),
        ];
        let woven = match ratios {
            [Some(warp), Some(weft)] => Some(Threshold::WarpWeft { warp, weft, axis }),
            [None, None] if table.values.contains_key("warp") => {
                return Err(self.missing(table, "tear", "threshold_warp"));
            }
            [None, None] => None,
            [_, None] => return Err(self.missing(table, "tear", "threshold_weft")),
            [None, _] => return Err(self.missing(table, "tear", "threshold_warp")),
        };
        let threshold = one("threshold", Threshold::Stretch)
            .or(one("toughness_j_per_m", Threshold::Toughness))
            .or(one("threshold_n", Threshold::Force))
            .or(one("principal_stretch", Threshold::PrincipalStretch))
            .or(woven)
            .unwrap_or(Threshold::Stretch(Scene::STRETCH_RATIO));
        let mut tearing = Tearing::new(threshold);
        tearing.splits_per_step_max = table.count("splits_per_step").map(|n| n as usize);
        if let Some(weakening) = table.number("weakening") {
            if weakening == 0.0 {
                let message = "`weakening` is above 0".to_owned();
                return Err(self.fault(table, "weakening", "E-SCENE-RANGE", message));
            }
            tearing.weakening = (weakening < 1.0).then_some(weakening);
        }
        Ok(Some(tearing))
    }

    /// Refuses keys of different groups in one table, and none of any.
    fn one_of(
        &self,
        table: &Table,
        what: &str,
        groups: &[&[&'static str]],
    ) -> Result<(), Box<Fault>> {
        let found: Vec<Vec<&str>> = groups
            .iter()
            .map(|group| table.those_of(group))
            .filter(|found| !found.is_empty())
            .collect();
        let choices: BTreeSet<&str> = groups.iter().map(|group| group[0]).collect();
        let choices = choices.into_iter().collect::<Vec<_>>().join(", ");
        match &found[..] {
            [_] => Ok(()),
            [one, other, ..] => {
                let message = format!("`{}` and `{}` cannot go together", one[0], other[0]);
                let fault = self.fault(table, other[0], "E-SCENE-CLASH", message);
                Err(Box::new(
                    fault.help(format!("{what} takes one of {choices}")),
                ))
            }
            [] => {
                let message = format!("{what} must have one of {choices}");
                let fault = self
                    .source
                    .fault("E-SCENE-MISSING", message, &table.span, "");
                Err(Box::new(fault))
            }
        }
    }
}

/// What a region begun with one key lacks.
fn other_half(table: &Table) -> &'static str {
    for (one, other) in [
        ("radius", "near"),
        ("from", "to"),
        ("to", "from"),
        ("centre", "radius_m"),
        ("point", "normal"),
        ("normal", "point"),
    ] {
        if table.values.contains_key(one) {
            return other;
        }
    }
    "centre"
}
