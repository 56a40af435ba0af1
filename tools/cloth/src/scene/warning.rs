//! A reason to doubt a run, in words.

use std::fmt;

/// A reason to doubt what a run shows of its cloth. Its text is one sentence.
///
/// ```
/// use tearmesh_cloth::Method;
/// use tearmesh_cloth::scene::{Axis, Frame, Run, Scene, Warning, Wording};
/// use tearmesh::shapes;
///
/// let (mesh, positions) = shapes::grid(6, 6);
/// let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
/// let scene = Scene { solver: Method::pbd(), ..Scene::hang(&frame) };
/// let run = Run::new(mesh, &positions, scene, &frame)?;
/// let warnings = Warning::before(&run, &frame, &Wording::default());
/// let rigid = warnings.iter().find(|warning| warning.code() == "W-SIM-RIGID").unwrap();
/// assert!(rigid.to_string().starts_with("pbd treats edges as rigid"));
/// assert!(rigid.help().starts_with("solver verlet"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    code: &'static str,
    sentence: String,
    help: String,
    is_note: bool,
}

/// The names that a front end has for vertices and settings, as warnings use them. By default vertices
/// have their indices, and settings the names of fields of [`Scene`](super::Scene).
#[derive(Clone, Copy)]
pub struct Wording<'a> {
    /// The number of the vertex with this index.
    pub vertex: &'a dyn Fn(usize) -> usize,
    /// The setting of the duration, such as `--seconds`.
    pub duration: &'a str,
    /// The setting of the time step, such as `--dt`.
    pub step: &'a str,
    /// The setting of the method, such as `--solver`.
    pub solver: &'a str,
}

impl Default for Wording<'_> {
    fn default() -> Self {
        Wording {
            vertex: &|vertex| vertex,
            duration: "duration_s",
            step: "step_s",
            solver: "solver",
        }
    }
}

impl fmt::Debug for Wording<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let settings = [self.duration, self.step, self.solver];
        f.debug_tuple("Wording").field(&settings).finish()
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}

impl Warning {
    pub(super) fn new(code: &'static str, sentence: String, help: impl Into<String>) -> Warning {
        Warning {
            code,
            sentence,
            help: help.into(),
            is_note: false,
        }
    }

    pub(super) fn note(code: &'static str, sentence: String, help: impl Into<String>) -> Warning {
        Warning {
            is_note: true,
            ..Warning::new(code, sentence, help)
        }
    }

    /// Returns the code of this warning, such as `W-SIM-SOFT`.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.code
    }

    /// Returns what would help: other settings, or another mesh.
    #[must_use]
    pub fn help(&self) -> &str {
        &self.help
    }

    /// Returns whether this is a mere note: it explains a result, and others put theirs in doubt.
    #[must_use]
    pub fn is_note(&self) -> bool {
        self.is_note
    }
}
