//! What a study says, in words.

use std::fmt::Write as _;

use super::{Better, Buy, Error, Floor, Row, SceneStudy, Study};
use crate::pareto::{AMPLIFICATION_MAX, Status};

/// Returns a summary in words: by scene, measure and method, the better buy from each point of the front.
#[must_use]
pub fn summary(study: &Study) -> String {
    let mut text = format!(
        "the better buy from each point of a method's front, against {} cells: halving the step, or halving \
         the edge\n",
        study.finest
    );
    for scene in &study.scenes {
        writeln!(text, "{} ({})", scene.scene, scene.about).expect("a string grows");
        if scene.is_barred {
            let grown = match scene.amplification {
                Some(a) => format!("{a:.0}-fold, above {AMPLIFICATION_MAX}"),
                None => "without measure".to_owned(),
            };
            writeln!(text, "  displacement: barred, as noise grows {grown}")
                .expect("a string grows");
        }
        for known in &scene.floors {
            measure(&mut text, scene, known);
        }
        let failed = failed(scene);
        if !failed.is_empty() {
            writeln!(text, "  failed: {failed}").expect("a string grows");
        }
    }
    text
}

fn measure(text: &mut String, scene: &SceneStudy, known: &Floor) {
    let name = known.measure.name();
    let Some(floor) = known.floor else {
        writeln!(
            text,
            "  {name}: no reference, as a run on the finest mesh has no answer"
        )
        .expect("a string grows");
        return;
    };
    writeln!(
        text,
        "  {name}: known to {} on the finest mesh",
        percent(floor)
    )
    .expect("a string grows");
    for method in scene.methods() {
        let rows = scene.rows.iter().filter(|row| row.method == method);
        let rows: Vec<&Row> = rows.collect();
        let errors = rows.iter().filter_map(|row| row.error(known.measure));
        let on_front = errors.filter(|error| error.is_on_front);
        let buys: Vec<Buy> = on_front.filter_map(|error| error.buy).collect();
        let trend = trend(&rows, known);
        writeln!(text, "    {method}: {}; {trend}", verdict(&buys)).expect("a string grows");
    }
}

/// Which is better, from how many points, and by how much each lowers the error.
fn verdict(buys: &[Buy]) -> String {
    if buys.is_empty() {
        return "no point from which both were tried".to_owned();
    }
    let kinds = [
        (Better::Mesh, "a finer mesh"),
        (Better::Step, "a shorter step"),
        (Better::Neither, "neither"),
    ];
    let counts = kinds.into_iter().filter_map(|(better, words)| {
        let count = buys.iter().filter(|buy| buy.better == better).count();
        (count > 0).then(|| format!("{words} from {count} of {}", buys.len()))
    });
    let counts: Vec<String> = counts.collect();
    let step = range(buys.iter().map(|buy| buy.by_step));
    let mesh = range(buys.iter().map(|buy| buy.by_mesh));
    format!(
        "{}; the error falls by {step} with half the step, by {mesh} with half the edge",
        counts.join(", ")
    )
}

/// From the least to the most.
fn range(falls: impl Iterator<Item = Option<f64>>) -> String {
    let mut falls: Vec<f64> = falls.flatten().collect();
    falls.sort_by(f64::total_cmp);
    let all: Vec<String> = falls
        .iter()
        .map(|fall| format!("{:.0}", 100.0 * fall))
        .collect();
    match (all.first(), all.last()) {
        (Some(least), Some(most)) if least != most => format!("{least} to {most} %"),
        (Some(only), _) => format!("{only} %"),
        _ => "nothing known".to_owned(),
    }
}

/// What is left of the mesh at the shortest steps, from the coarsest mesh to the finest.
fn trend(rows: &[&Row], known: &Floor) -> String {
    let mut left: Vec<(u32, f64)> = Vec::new();
    for row in rows {
        let of_mesh = row
            .error(known.measure)
            .and_then(|error: &Error| error.of_mesh);
        if let Some(error) = of_mesh.filter(|_| left.last().is_none_or(|last| last.0 != row.cells))
        {
            left.push((row.cells, error));
        }
    }
    let all: Vec<String> = left
        .iter()
        .map(|(cells, error)| format!("{cells}: {}", percent(*error)))
        .collect();
    match all.is_empty() {
        true => "the shortest steps failed".to_owned(),
        false => format!("errors of meshes {}", all.join(", ")),
    }
}

fn percent(part: f64) -> String {
    match 100.0 * part {
        x if x >= 10.0 => format!("{x:.0} %"),
        x if x >= 0.1 => format!("{x:.1} %"),
        x => format!("{x:.0e} %"),
    }
}

/// How many rows failed, by method and status.
fn failed(scene: &SceneStudy) -> String {
    let mut told: Vec<(&str, Status, usize)> = Vec::new();
    for row in scene.rows.iter().filter(|row| row.status != Status::Ok) {
        let same = |(method, status, _): &&mut (&str, Status, usize)| {
            *method == row.method && *status == row.status
        };
        match told.iter_mut().find(same) {
            Some((_, _, count)) => *count += 1,
            None => told.push((&row.method, row.status, 1)),
        }
    }
    let all = told.iter();
    let all = all.map(|(method, status, count)| format!("{count} {method} {}", status.name()));
    all.collect::<Vec<_>>().join(", ")
}
