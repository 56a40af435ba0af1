//! From what a scene file says to the scene.

use std::collections::BTreeSet;

use tearmesh::cloth::implicit::{self, Buckling, Settings, Tolerance};
use tearmesh::cloth::{
    Axis, Bending, Breeze, Collider, Copies, Frame, Hold, Limiter, Method, Pbd, Region, Scene,
    Tearing, Threshold, TimedCut, Unbend, Weave, Wind, Xpbd,
};
use tearmesh::{Plane, Point, Scissor, Vector, VertexId};

use super::read::{Content, SceneFile, Table, Value};
use crate::args::SolverName;
use crate::say::Fault;

impl Table {
    fn number(&self, name: &str) -> Option<f64> {
        match self.values.get(name)?.content {
            Content::Number(x) => Some(x),
            _ => None,
        }
    }

    fn count(&self, name: &str) -> Option<u32> {
        self.number(name).map(|x| x as u32)
    }

    fn bool(&self, name: &str) -> Option<bool> {
        match self.values.get(name)?.content {
            Content::Bool(x) => Some(x),
            _ => None,
        }
    }

    fn word(&self, name: &str) -> Option<&str> {
        match &self.values.get(name)?.content {
            Content::Text(word) => Some(word),
            _ => None,
        }
    }

    fn rows(&self, name: &str) -> Option<&[Vec<f64>]> {
        match &self.values.get(name)?.content {
            Content::Rows(rows) => Some(rows),
            _ => None,
        }
    }

    fn row(&self, name: &str) -> Option<&[f64]> {
        self.rows(name)?.first().map(Vec::as_slice)
    }

    fn pair(&self, name: &str) -> Option<[f64; 2]> {
        self.row(name)?.try_into().ok()
    }

    fn vector(&self, name: &str) -> Option<Vector> {
        let [x, y, z] = self.row(name)?.try_into().ok()?;
        Some(Vector::new(x, y, z))
    }

    fn point(&self, name: &str) -> Option<Point> {
        self.vector(name).map(Point::from)
    }

    /// Which of these keys stand in the table.
    fn those_of<'n>(&self, names: &[&'n str]) -> Vec<&'n str> {
        let mut found = names.to_vec();
        found.retain(|name| self.values.contains_key(name));
        found
    }
}

impl SceneFile {
    fn first(&self, table: &str) -> Option<&Table> {
        self.tables.get(table)?.first()
    }

    fn all(&self, table: &str) -> &[Table] {
        self.tables.get(table).map_or(&[], Vec::as_slice)
    }

    pub(super) fn has(&self, table: &str, key: &str) -> bool {
        let has = |table: &Table| key.is_empty() || table.values.contains_key(key);
        self.all(table).iter().any(has)
    }

    pub(super) fn blame(
        &self,
        (table, number, key): (&str, usize, &str),
        code: &'static str,
        message: String,
    ) -> Fault {
        match self.all(table).get(number) {
            Some(table) => *self.fault(table, key, code, message),
            None => Fault::error(code, message),
        }
    }

    pub(super) fn up(&self) -> Axis {
        let up = self.first("").and_then(|top| top.word("up"));
        up.and_then(|up| super::axis(up).ok()).unwrap_or(Axis::Y)
    }

    /// The scene for a mesh with this frame, or all that is wrong.
    pub(super) fn scene(
        &self,
        frame: &Frame,
        solver: Option<SolverName>,
    ) -> Result<Scene, Vec<Fault>> {
        let top = self.first("").and_then(|top| top.word("base"));
        let mut scene = super::base(top.unwrap_or("fall"), frame);
        let mut faults = Vec::new();
        self.world(&mut scene, frame);
        self.solver(&mut scene, solver, &mut faults);
        if let Err(fault) = self.bend(&mut scene) {
            faults.push(*fault);
        }
        if let Err(fault) = self.weave(&mut scene, frame) {
            faults.push(*fault);
        }
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
        let Some(table) = self.first("fabric") else {
            return;
        };
        let fabric = &mut scene.fabric;
        if let Some(density) = table.number("density_kg_per_m2") {
            scene.areal_density_kg_per_m2 = density;
        }
        if let Some(stretch) = table.number("stretch_n_per_m") {
            fabric.stretch_n_per_m = stretch;
        }
        match table.word("copies") {
            Some("whole") => fabric.copies = Copies::Whole,
            Some(_) => fabric.copies = Copies::Halved,
            None => {}
        }
        match table.word("unbend") {
            Some("vertex") => fabric.unbend = Unbend::Vertex,
            Some(_) => fabric.unbend = Unbend::Seam,
            None => {}
        }
    }

    /// What resists bending: springs, or arcs that buckle.
    fn bend(&self, scene: &mut Scene) -> Result<(), Box<Fault>> {
        let Some(table) = self.first("fabric") else {
            return Ok(());
        };
        let is_arc = table.word("bend_law") == Some("buckling");
        let foreign: &[&'static str] = if is_arc {
            &["bend_n_per_m"]
        } else {
            &["flexural_n_m2", "buckles_below"]
        };
        if let Some(&key) = table.those_of(foreign).first() {
            let law = if is_arc { "spring" } else { "buckling" };
            let message = format!("`{key}` goes with bend_law = \"{law}\"");
            return Err(self.fault(table, key, "E-SCENE-CLASH", message));
        }
        if !is_arc {
            if let Some(stiffness_n_per_m) = table.number("bend_n_per_m") {
                let spring = Bending::Spring { stiffness_n_per_m };
                scene.fabric.bend = (stiffness_n_per_m > 0.0).then_some(spring);
            }
            return Ok(());
        }
        let flexural_n_m2 = table.number("flexural_n_m2");
        let flexural_n_m2 =
            flexural_n_m2.ok_or_else(|| self.missing(table, "fabric", "flexural_n_m2"))?;
        let law = Buckling::new(table.number("buckles_below").unwrap_or(0.95));
        let law = law.ok_or_else(|| {
            let message = "`buckles_below` is above 0.592 and under 1".to_owned();
            self.fault(table, "buckles_below", "E-SCENE-RANGE", message)
        })?;
        scene.fabric.bend = Some(Bending::Buckling { flexural_n_m2, law });
        self.has_forces(scene, table, "bend_law", "know no arcs")
    }

    /// Refuses methods that move springs, where a key asks for something else.
    fn has_forces(
        &self,
        scene: &Scene,
        table: &Table,
        key: &str,
        lack: &str,
    ) -> Result<(), Box<Fault>> {
        if matches!(scene.solver, Method::Pbd(_) | Method::Xpbd(_)) {
            let message = format!("pbd and xpbd move springs, and {lack}");
            let fault = self.fault(table, key, "E-SCENE-CLASH", message);
            let help = "add method = \"implicit\" to [solver]; verlet and provot do as well";
            return Err(Box::new(fault.help(help.to_owned())));
        }
        Ok(())
    }

    /// A fabric of triangles, which stands for springs on edges unless these are named as well.
    fn weave(&self, scene: &mut Scene, frame: &Frame) -> Result<(), Box<Fault>> {
        let Some(table) = self.first("fabric") else {
            return Ok(());
        };
        let keys = ["warp_n_per_m", "weft_n_per_m", "shear_n_per_m", "warp"];
        let Some(&key) = table.those_of(&keys).first() else {
            return Ok(());
        };
        let required = |key: &'static str| {
            let modulus = table.number(key);
            modulus.ok_or_else(|| self.missing(table, "fabric", key))
        };
        scene.fabric.weave = Some(Weave {
            warp_n_per_m: required(keys[0])?,
            weft_n_per_m: required(keys[1])?,
            shear_n_per_m: table.number(keys[2]).unwrap_or(0.0),
            warp: table
                .vector(keys[3])
                .unwrap_or_else(|| frame.along.vector()),
        });
        scene.fabric.stretch_n_per_m = table.number("stretch_n_per_m").unwrap_or(0.0);
        self.has_forces(scene, table, key, "have no triangles")
    }

    /// The method: its keys are those of the file's or of the one that was typed in its place.
    fn solver(&self, scene: &mut Scene, typed: Option<SolverName>, faults: &mut Vec<Fault>) {
        let table = self.first("solver");
        let word = table.and_then(|table| table.word("method"));
        let named = word.and_then(SolverName::of);
        if let Some(name) = typed.or(named) {
            scene.solver = name.method();
        }
        let Some(table) = table else {
            return;
        };
        scene.step_s = table.number("dt_s").or(scene.step_s);
        let method = word.unwrap_or("xpbd");
        for (key, readers) in OF_METHODS {
            let is_read = |reader: &&str| *reader == method || SolverName::of(reader) == typed;
            if table.values.contains_key(key) && !readers.iter().any(is_read) {
                let readers = readers.join(" or ");
                let message = format!("`{key}` goes with {readers}, and the method is {method}");
                faults.push(*self.fault(table, key, "E-SCENE-CLASH", message));
            }
        }
        match &mut scene.solver {
            Method::Provot(limiter) => provot(table, limiter),
            Method::Pbd(pbd) => set_pbd(table, pbd),
            Method::Verlet => {}
            Method::Xpbd(xpbd) => {
                xpbd.substeps = table.count("substeps").unwrap_or(xpbd.substeps);
                xpbd.sweeps = table.count("sweeps").unwrap_or(xpbd.sweeps);
            }
            Method::Implicit(settings) => set_implicit(table, settings),
        }
    }

    fn wind(&self, scene: &mut Scene, faults: &mut Vec<Fault>) {
        let Some(table) = self.first("wind") else {
            return;
        };
        let period_s = table.number("period_s").unwrap_or(1.0);
        if !(scene.duration_s / period_s).is_finite() {
            let message = "`period_s` is too short: the sways of the scene are without number";
            let message = message.to_owned();
            faults.push(*self.fault(table, "period_s", "E-SCENE-RANGE", message));
        }
        match table.vector("velocity_m_per_s") {
            Some(velocity_m_per_s) => {
                scene.breeze = Some(Breeze {
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

    fn hold(&self, table: &Table) -> Result<Hold, Box<Fault>> {
        let row = |row: &Vec<f64>| (row[0], Vector::new(row[1], row[2], row[3]));
        let from_s = table.number("from_s").unwrap_or(0.0);
        if table.number("until_s").is_some_and(|until| until <= from_s) {
            let message = "`until_s` is not later than `from_s`".to_owned();
            return Err(self.fault(table, "until_s", "E-SCENE-RANGE", message));
        }
        Ok(Hold {
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
        Scissor::new(&rays[0], &rays[1])
            .map_err(|error| self.fault(table, "rays", "E-SCENE-RANGE", error.to_string()))?;
        Ok(TimedCut {
            at_s: table.number("at_s").unwrap_or(0.0),
            rays: **rays,
            through: table.bool("through").unwrap_or(false),
            method: match table.word("method") {
                Some("partition") => tearmesh::Method::Partition,
                Some("uniform") => tearmesh::Method::Uniform,
                Some("alternating") => tearmesh::Method::Alternating,
                _ => tearmesh::Method::Exact,
            },
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
        tearing.delay_s = table.number("delay_s").unwrap_or(0.0);
        tearing.tears_held = table.bool("tears_held").unwrap_or(false);
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
                Err(Box::new(fault.help(format!("{what} has one of {choices}"))))
            }
            [] => {
                let message = format!("{what} has to have one of {choices}");
                let fault = self
                    .source
                    .fault("E-SCENE-MISSING", message, &table.span, "");
                Err(Box::new(fault))
            }
        }
    }

    fn missing(&self, table: &Table, name: &str, key: &str) -> Box<Fault> {
        let message = format!("[{name}] lacks `{key}`");
        let code = "E-SCENE-MISSING";
        Box::new(self.source.fault(code, message, &table.span, ""))
    }

    fn fault(&self, table: &Table, key: &str, code: &'static str, message: String) -> Box<Fault> {
        let span = table.values.get(key).map(|Value { span, .. }| span.clone());
        let span = span.unwrap_or_else(|| table.span.clone());
        Box::new(self.source.fault(code, message, &span, ""))
    }
}

/// The keys of [solver] that not all methods read, and which do.
const OF_METHODS: [(&str, &[&str]); 9] = [
    ("substeps", &["xpbd"]),
    ("sweeps", &["xpbd", "pbd"]),
    ("stiffness", &["pbd"]),
    ("bend_stiffness", &["pbd"]),
    ("limit_ratio", &["provot"]),
    ("limit_passes", &["provot"]),
    ("order", &["implicit"]),
    ("newton_iterations", &["implicit"]),
    ("tolerance", &["implicit"]),
];

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

fn provot(table: &Table, limiter: &mut Limiter) {
    if let Some(ratio) = table.number("limit_ratio") {
        limiter.stretch_ratio_max = ratio;
    }
    if let Some(passes) = table.count("limit_passes") {
        limiter.passes_max = passes;
    }
}

fn set_pbd(table: &Table, pbd: &mut Pbd) {
    pbd.sweeps = table.count("sweeps").unwrap_or(pbd.sweeps);
    pbd.stiffness = table.number("stiffness").unwrap_or(pbd.stiffness);
    pbd.bend_stiffness = table.number("bend_stiffness").unwrap_or(pbd.bend_stiffness);
}

fn set_implicit(table: &Table, settings: &mut Settings) {
    if let Some(iterations) = table.count("newton_iterations") {
        settings.newton_iterations_max = iterations;
    }
    if let Some(tolerance) = table.number("tolerance") {
        settings.tolerance = Tolerance::Tied(tolerance);
    }
    match table.word("order") {
        Some("2") => settings.method = implicit::Method::Bdf2,
        Some(_) => settings.method = implicit::Method::BackwardEuler,
        None => {}
    }
}

impl SolverName {
    fn of(word: &str) -> Option<SolverName> {
        Some(match word {
            "provot" => SolverName::Provot,
            "pbd" => SolverName::Pbd,
            "verlet" => SolverName::Verlet,
            "xpbd" => SolverName::Xpbd,
            "implicit" => SolverName::Implicit,
            _ => return None,
        })
    }

    /// The method with its default settings. Of XPBD a step is one sweep, so that tears are looked
    /// for after each; the implicit method may err by 0.2 mm/s in a step of 1/240 s.
    pub(crate) fn method(self) -> Method {
        match self {
            SolverName::Provot => Method::Provot(Limiter::default()),
            SolverName::Pbd => Method::Pbd(Pbd::default()),
            SolverName::Verlet => Method::Verlet,
            SolverName::Xpbd => Method::Xpbd(Xpbd::new(1, 1)),
            SolverName::Implicit => Method::Implicit(Settings {
                tolerance: Tolerance::Tied(10.0),
                ..Settings::default()
            }),
        }
    }
}

/// The threshold that was typed, if any.
pub(crate) fn threshold(
    ratio: Option<f64>,
    toughness_j_per_m: Option<f64>,
    newtons: Option<f64>,
) -> Option<Threshold> {
    ratio
        .map(Threshold::Stretch)
        .or(toughness_j_per_m.map(Threshold::Toughness))
        .or(newtons.map(Threshold::Force))
}
