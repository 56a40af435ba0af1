//! The verbs of a sequence: lines of the command, and what the library needs to do the same.

use tearmesh::{CutLayers, CutMethod, CutTips};

use crate::oracle::aim::Line;

type Point = [f64; 3];

/// What a cut goes along.
#[derive(Clone, Debug)]
pub(crate) enum Along {
    /// A point and a normal.
    Plane(Point, Point),
    /// The rays through the corners of a polyline; a closed one ends with its first.
    Rays(Vec<Line>),
}

/// A cut and its options.
#[derive(Clone, Debug)]
pub(crate) struct CutVerb {
    pub(crate) along: Along,
    pub(crate) method: CutMethod,
    pub(crate) snap: f64,
    pub(crate) moves: bool,
    pub(crate) layers: CutLayers,
    pub(crate) through: bool,
    pub(crate) tips: CutTips,
    pub(crate) halves: bool,
    pub(crate) gap: Option<f64>,
    pub(crate) welds: bool,
}

#[derive(Clone, Debug)]
pub(crate) enum Verb {
    Cut(CutVerb),
    /// What is typed behind `mend -`.
    Mend(String),
}

fn three([x, y, z]: Point) -> String {
    format!("{x},{y},{z}")
}

fn ray(&(origin, along): &Line) -> String {
    format!("{}:{}", three(origin), three(along))
}

impl CutVerb {
    /// The pairs of rays, one after the other.
    pub(crate) fn pairs(&self) -> Vec<[Line; 2]> {
        match &self.along {
            Along::Plane(..) => Vec::new(),
            Along::Rays(lines) => lines.windows(2).map(|two| [two[0], two[1]]).collect(),
        }
    }

    fn typed(&self) -> String {
        let mut words = match &self.along {
            Along::Plane(point, normal) => format!(" --plane {}:{}", three(*point), three(*normal)),
            Along::Rays(_) => {
                let pairs = self.pairs().into_iter();
                let pairs = pairs.map(|[a, b]| format!(" --rays {} {}", ray(&a), ray(&b)));
                pairs.collect()
            }
        };
        let method = match self.method {
            CutMethod::Partition => "partition",
            CutMethod::Uniform => "uniform",
            CutMethod::Alternating => "alternating",
            _ => "exact",
        };
        words += &format!(" --method {method} --snap {}", self.snap);
        words += if self.moves { " --snap-move" } else { "" };
        words += match self.layers {
            CutLayers::First => " --layers first",
            _ => "",
        };
        words += if self.through { " --through" } else { "" };
        words += match self.tips {
            CutTips::Midpoint => " --tips midpoint",
            _ => "",
        };
        words += if self.halves { " --mass half" } else { "" };
        words += if self.welds { " --weld" } else { "" };
        if let Some(gap) = self.gap {
            words += &format!(" --gap {gap}");
        }
        format!("cut -{words} --allow-miss")
    }
}

impl Verb {
    /// The line that is typed, without files.
    pub(crate) fn typed(&self) -> String {
        match self {
            Verb::Cut(cut) => cut.typed(),
            Verb::Mend(words) => format!("mend - {words}"),
        }
    }
}

/// A shell script that repeats verbs on a file.
pub(crate) fn script(file: &str, verbs: &[Verb]) -> String {
    let mut script = format!("cat > 0.obj <<'END'\n{file}END\n");
    for (i, verb) in verbs.iter().enumerate() {
        let typed = verb.typed().replacen(" - ", &format!(" {i}.obj "), 1);
        script += &format!("tearmesh {} -o {}.obj\n", typed.trim_end(), i + 1);
    }
    script
}
