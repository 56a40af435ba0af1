//! The scene that a scene file describes.

use std::collections::BTreeSet;

use tearmesh::{Plane, Point, Scissor, Vector, VertexId};
use tearmesh_cloth::scene::{Axis, Frame, HeldVertices, Region, Scene, SwayingWind, TimedCut};
use tearmesh_cloth::{Collider, Tearing, Threshold};

use super::kinds::{Gravity, Word, set};
use super::read::{Place, SceneFile, Table, sorted};
use super::schema::{ColliderKeys, Cut, Tear, Vertices};
use crate::choice::{Preset, Solver};
use crate::exit::Stop;
use crate::say::Fault;

impl SceneFile {
    /// Which way is up.
    pub(crate) fn up(&self) -> Axis {
        self.top.up.map_or(Axis::Y, |up| up.0)
    }

    /// The scene for a mesh with this frame, or all that is wrong; the method may be chosen on the command line.
    pub(crate) fn scene(&self, frame: &Frame, solver: Option<Solver>) -> Result<Scene, Stop> {
        let mut scene = match self.top.base {
            Some(Word(Preset(preset))) => preset(frame),
            None => Scene::fall(frame.up),
        };
        let mut faults = Vec::new();
        set(&mut scene.duration_s, self.top.seconds);
        match self.top.gravity_m_per_s2 {
            Some(Gravity::Down(g)) => scene.gravity_m_per_s2 = frame.up.vector() * -g,
            Some(Gravity::Vector(g)) => scene.gravity_m_per_s2 = g,
            None => {}
        }
        set(&mut scene.drag_per_s, self.top.drag_per_s);
        self.solver(&mut scene, solver, &mut faults);
        self.fabric(&mut scene, frame, &mut faults);
        let faults = &mut faults;
        self.wind(&mut scene, faults);
        fill(&mut scene.colliders, &self.colliders, faults, |table| {
            self.collider(table)
        });
        fill(&mut scene.holds, &self.holds, faults, |table| {
            self.hold(table)
        });
        fill(&mut scene.cuts, &self.cuts, faults, |table| self.cut(table));
        fill(&mut scene.strengths, &self.strengths, faults, |table| {
            self.strength(table)
        });
        scene.cuts.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
        if let Some(table) = &self.tear {
            match self.tear(table, frame) {
                Ok(tearing) => scene.tearing = tearing,
                Err(fault) => faults.push(*fault),
            }
        }
        match faults.is_empty() {
            true => Ok(scene),
            false => Err(sorted(std::mem::take(faults)).into()),
        }
    }

    fn wind(&self, scene: &mut Scene, faults: &mut Vec<Fault>) {
        let Some(table) = &self.wind else {
            return;
        };
        let period_s = table.period_s.map_or(1.0, f64::from);
        if !(scene.duration_s / period_s).is_finite() {
            let message = "`period_s` is too short: the wind would sway too often to be counted";
            let message = message.to_owned();
            faults.push(*self.fault(&table.place, "period_s", "E-SCENE-RANGE", message));
        }
        match table.velocity_m_per_s {
            Some(velocity) => {
                scene.wind = Some(SwayingWind {
                    steady: tearmesh_cloth::Wind {
                        velocity_m_per_s: velocity.into(),
                        coefficient: table.coefficient.map_or(1.5, f64::from),
                    },
                    sway_m_per_s: table.sway_m_per_s.map_or_else(Vector::zeros, Vector::from),
                    period_s,
                });
            }
            None => faults.push(*self.missing(&table.place, "velocity_m_per_s")),
        }
    }

    fn collider(&self, table: &Table<ColliderKeys>) -> Result<Collider, Box<Fault>> {
        let place = &table.place;
        let groups: [&[_]; 2] = [&["point", "normal"], &["centre", "radius_m"]];
        self.one_of(place, "a collider", &groups)?;
        if let (Some(point), Some(normal)) = (table.point, table.normal) {
            let plane = Plane::new(point.into(), normal.into());
            return plane
                .map(Collider::Plane)
                .map_err(|error| self.fault(place, "normal", "E-SCENE-RANGE", error.to_string()));
        }
        match (table.centre, table.radius_m) {
            (Some(centre), Some(radius_m)) => Ok(Collider::Sphere {
                centre: centre.into(),
                radius_m: radius_m.into(),
            }),
            _ => Err(self.missing(place, other_half(place))),
        }
    }

    fn hold(&self, table: &Table<Vertices>) -> Result<HeldVertices, Box<Fault>> {
        let from_s = table.from_s.map_or(0.0, f64::from);
        let until_s = table.until_s.map(f64::from);
        if until_s.is_some_and(|until_s| until_s <= from_s) {
            let message = "`until_s` is not later than `from_s`".to_owned();
            return Err(self.fault(&table.place, "until_s", "E-SCENE-RANGE", message));
        }
        Ok(HeldVertices {
            region: self.region(table, "a hold")?,
            from_s,
            until_s,
            moves: table.moves.clone().map_or_else(Vec::new, |moves| moves.0),
        })
    }

    fn strength(&self, table: &Table<Vertices>) -> Result<(Region, f64), Box<Fault>> {
        match table.factor {
            Some(factor) => Ok((self.region(table, "a strength")?, factor.into())),
            None => Err(self.missing(&table.place, "factor")),
        }
    }

    fn region(&self, table: &Table<Vertices>, what: &str) -> Result<Region, Box<Fault>> {
        let groups: [&[_]; 5] = [
            &["near", "radius"],
            &["across", "along"],
            &["from", "to"],
            &["centre", "radius_m"],
            &["vertices"],
        ];
        self.one_of(&table.place, what, &groups)?;
        if let Some(at) = table.near {
            return Ok(Region::Near {
                at: at.into(),
                radius: table.radius.map_or(0.0, f64::from),
            });
        }
        if table.across.or(table.along).is_some() {
            return Ok(Region::Patch {
                across: table.across.map_or([0.0, 1.0], |across| across.0),
                along: table.along.map_or([0.0, 1.0], |along| along.0),
            });
        }
        if let Some(numbers) = &table.vertices {
            let id = |&number: &u32| VertexId::new(number as usize - 1);
            return Ok(Region::Vertices(numbers.0.iter().filter_map(id).collect()));
        }
        if let (Some(centre), Some(radius_m)) = (table.centre, table.radius_m) {
            return Ok(Region::Ball {
                centre: centre.into(),
                radius_m: radius_m.into(),
            });
        }
        match (table.from.map(Point::from), table.to.map(Point::from)) {
            (Some(from), Some(to)) => Ok(Region::Box { from, to }),
            _ => Err(self.missing(&table.place, other_half(&table.place))),
        }
    }

    fn cut(&self, table: &Table<Cut>) -> Result<TimedCut, Box<Fault>> {
        let rays = self.rays(table)?;
        Scissor::new(rays[0], rays[1]).map_err(|error| {
            self.fault(&table.place, "rays", "E-SCENE-RANGE", error.to_string())
        })?;
        Ok(TimedCut {
            at_s: table.at_s.map_or(0.0, f64::from),
            rays,
            through: table.through.unwrap_or(false),
            method: table.method.map(|word| word.0).unwrap_or_default(),
        })
    }

    fn tear(&self, table: &Table<Tear>, frame: &Frame) -> Result<Option<Tearing>, Box<Fault>> {
        let place = &table.place;
        if table.never == Some(true) {
            let others = place.values.iter().filter(|(key, _)| *key != "never");
            let Some((key, _)) = others.min_by_key(|(_, span)| span.start) else {
                return Ok(None);
            };
            let message = format!("`never` and `{key}` cannot go together");
            return Err(self.fault(place, key, "E-SCENE-CLASH", message));
        }
        let groups: [&[_]; 5] = [
            &["threshold"],
            &["toughness_j_per_m"],
            &["threshold_n"],
            &["principal_stretch"],
            &["threshold_warp", "threshold_weft", "warp"],
        ];
        match self.one_of(place, "a threshold", &groups) {
            Err(fault) if fault.code != "E-SCENE-MISSING" => return Err(fault),
            _ => {}
        }
        let woven = match (table.threshold_warp, table.threshold_weft) {
            (Some(warp), Some(weft)) => Some(Threshold::WarpWeft {
                warp: warp.into(),
                weft: weft.into(),
                axis: table
                    .warp
                    .map_or_else(|| frame.along.vector(), Vector::from),
            }),
            (None, None) if table.warp.is_none() => None,
            (Some(_), None) => return Err(self.missing(place, "threshold_weft")),
            (None, _) => return Err(self.missing(place, "threshold_warp")),
        };
        let stretch = table.threshold.map(|x| Threshold::Stretch(x.into()));
        let toughness = table.toughness_j_per_m;
        let threshold = stretch
            .or(toughness.map(|x| Threshold::Toughness(x.into())))
            .or(table.threshold_n.map(|x| Threshold::Force(x.into())))
            .or(table
                .principal_stretch
                .map(|x| Threshold::PrincipalStretch(x.into())))
            .or(woven)
            .unwrap_or(Threshold::Stretch(Scene::STRETCH_RATIO));
        let mut tearing = Tearing::new(threshold);
        tearing.splits_per_step_max = table.splits_per_step.map(|n| n.0 as usize);
        if let Some(weakening) = table.weakening.map(f64::from) {
            if weakening == 0.0 {
                let message = "`weakening` is above 0".to_owned();
                return Err(self.fault(place, "weakening", "E-SCENE-RANGE", message));
            }
            tearing.weakening = (weakening < 1.0).then_some(weakening);
        }
        Ok(Some(tearing))
    }

    /// Refuses keys of different groups in one table, and none of any.
    fn one_of(
        &self,
        place: &Place,
        what: &str,
        groups: &[&[&'static str]],
    ) -> Result<(), Box<Fault>> {
        let found: Vec<Vec<&str>> = groups
            .iter()
            .map(|group| place.those_of(group))
            .filter(|found| !found.is_empty())
            .collect();
        let choices: BTreeSet<&str> = groups.iter().map(|group| group[0]).collect();
        let choices = choices.into_iter().collect::<Vec<_>>().join(", ");
        match &found[..] {
            [_] => Ok(()),
            [one, other, ..] => {
                let message = format!("`{}` and `{}` cannot go together", one[0], other[0]);
                let fault = self.fault(place, other[0], "E-SCENE-CLASH", message);
                Err(Box::new(
                    fault.help(format!("{what} takes one of {choices}")),
                ))
            }
            [] => {
                let message = format!("{what} must have one of {choices}");
                Err(self.fault(place, "", "E-SCENE-MISSING", message))
            }
        }
    }
}

/// Where a file has any tables of a kind, they stand for those of the base.
fn fill<T, K>(
    list: &mut Vec<T>,
    tables: &[Table<K>],
    faults: &mut Vec<Fault>,
    read: impl Fn(&Table<K>) -> Result<T, Box<Fault>>,
) {
    if !tables.is_empty() {
        list.clear();
    }
    for table in tables {
        match read(table) {
            Ok(one) => list.push(one),
            Err(fault) => faults.push(*fault),
        }
    }
}

/// What a region begun with one key lacks.
fn other_half(place: &Place) -> &'static str {
    for (one, other) in [
        ("radius", "near"),
        ("from", "to"),
        ("to", "from"),
        ("centre", "radius_m"),
        ("point", "normal"),
        ("normal", "point"),
    ] {
        if place.values.contains_key(one) {
            return other;
        }
    }
    "centre"
}
