//! The ways in which we cut, and how long one takes.

use tearmesh::{CutMethod, Edits, Scissor};
use tearmesh_lab::sheet::through;

use super::facts::Sheet;
use crate::measure::timed_on_cpu;

/// A way in which we cut.
pub(super) struct Way {
    pub(super) name: &'static str,
    pub(super) method: CutMethod,
    pub(super) snap: f64,
    pub(super) form: Form,
}

/// What is done beside the cut, in or out of the time.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// Nothing: the mesh is as it was built, so the cut has to move arrays that grow.
    First,
    /// There is room in the arrays, as after a cut before, or by `reserve`.
    Room,
    /// Another cut was made before, and its memory is lent.
    Second,
    /// As built, and a report is made.
    Report,
}

impl Form {
    pub(super) const fn note(self) -> &'static str {
        match self {
            Form::First => "in place; a first cut, so arrays move to grow",
            Form::Room => "in place; room made before",
            Form::Second => "in place; a second cut in the memory of one before",
            Form::Report => "as the first, and a report of the whole mesh",
        }
    }
}

const fn way(name: &'static str, method: CutMethod, snap: f64, form: Form) -> Way {
    Way {
        name,
        method,
        snap,
        form,
    }
}

pub(super) const WAYS: [Way; 11] = [
    way("exact, snap 0", CutMethod::Exact, 0.0, Form::First),
    way("exact, snap 0.05", CutMethod::Exact, 0.05, Form::First),
    way("partition", CutMethod::Partition, 0.0, Form::First),
    way("exact, snap 0, room", CutMethod::Exact, 0.0, Form::Room),
    way("exact, snap 0.05, room", CutMethod::Exact, 0.05, Form::Room),
    way("partition, room", CutMethod::Partition, 0.0, Form::Room),
    way(
        "exact, snap 0.05, second",
        CutMethod::Exact,
        0.05,
        Form::Second,
    ),
    way("partition, second", CutMethod::Partition, 0.0, Form::Second),
    way("exact, snap 0, report", CutMethod::Exact, 0.0, Form::Report),
    way(
        "exact, snap 0.05, report",
        CutMethod::Exact,
        0.05,
        Form::Report,
    ),
    way("partition, report", CutMethod::Partition, 0.0, Form::Report),
];

/// How many seconds a cut takes on a copy. The copy, and what becomes of it, are not part of it.
pub(super) fn time(
    scissor: &Scissor,
    method: CutMethod,
    form: Form,
    (mesh, positions): &Sheet,
) -> f64 {
    let (mut mesh, mut positions, mut edits) = (mesh.clone(), positions.clone(), Edits::new());
    if form == Form::Room {
        let room = mesh.face_count() / 8;
        mesh.reserve(room);
        mesh.reserve_faces(room);
        positions.reserve(room);
    }
    if form == Form::Second {
        let before = through([0.31, 0.62], 0.4).with_snap(Scissor::SNAP);
        let made = before.cut(method, &mut mesh, &mut positions, &mut edits);
        made.expect("positions are in step");
    }
    let (result, time) = timed_on_cpu(|| match form {
        Form::First | Form::Room | Form::Second => {
            let made = scissor.cut(method, &mut mesh, &mut positions, &mut edits);
            made.map(drop)
        }
        Form::Report => {
            let made = scissor.cut_measured(method, &mut mesh, &mut positions, &mut edits);
            made.map(|(_, report)| assert_eq!(report.pieces, 2, "the sheet is in two"))
        }
    });
    result.expect("positions are in step");
    time
}
