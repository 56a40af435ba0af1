//! What ensembles say, in words.

use std::fmt::Write as _;

use tearmesh_cloth::statistics::Verdict;

use super::{Cascade, Move, Number, TOLD, finer};

/// Returns a summary in words: for each scene and quantity the reference, if any, and a line per method.
///
/// A method's line has the medians with the 10 % and 90 % points at the step, half and a quarter of it, and whether
/// halving the step makes a difference. A line counts the halvings that are undecided, if any. If a scene was played on several meshes, a line per method and quantity
/// says whether a shorter step or the next finer mesh is the better buy.
#[must_use]
pub fn summary(cascades: &[Cascade]) -> String {
    let mut text = String::new();
    for of in cascades.chunk_by(|one, next| one.mesh() == next.mesh()) {
        let (scene, cells) = of[0].mesh();
        for (place, quantity) in TOLD.into_iter().enumerate() {
            let [name, unit] = quantity.name();
            let reference = of.first().map(|cascade| &cascade.numbers[place].reference);
            let reference = match reference {
                Some(names) if !names.is_empty() => {
                    format!("reference: the finest of {}", names.join(" and "))
                }
                _ => "no two methods that converged agree: there is no reference".to_owned(),
            };
            let unit = match unit {
                "" => String::new(),
                unit => format!(" in {unit}"),
            };
            writeln!(text, "{scene} of {cells} cells, {name}{unit}; {reference}")
                .expect("a string grows");
            for cascade in of {
                let number = &cascade.numbers[place];
                let spreads = number.spreads.iter().map(|spread| match spread {
                    Some([low, middle, high]) => {
                        format!("{} ({} to {})", short(*middle), short(*low), short(*high))
                    }
                    None => "not said".to_owned(),
                });
                let spreads: Vec<String> = spreads.collect();
                let halved = number.verdict().map_or("–", Verdict::name);
                let against = number
                    .against_reference
                    .map(|found| format!("; against the reference: {}", found.verdict.name()));
                writeln!(
                    text,
                    "  {:<9} {:<26} {:<26} {:<26} halved: {halved}{}",
                    cascade.method,
                    spreads[0],
                    spreads[1],
                    spreads[2],
                    against.unwrap_or_default()
                )
                .expect("a string grows");
            }
        }
    }
    text + &open(cascades) + &refined(cascades)
}

/// A line on comparisons that are undecided, if there are any.
fn open(cascades: &[Cascade]) -> String {
    let numbers = cascades.iter().flat_map(|cascade| &cascade.numbers);
    let verdicts: Vec<Verdict> = numbers.filter_map(Number::verdict).collect();
    let is_open = |verdict: &&Verdict| **verdict == Verdict::CannotTell;
    match verdicts.iter().filter(is_open).count() {
        0 => String::new(),
        undecided => format!(
            "{undecided} of {} halvings cannot tell; four times the `--seeds` halve their intervals\n",
            verdicts.len()
        ),
    }
}

/// A line for each cascade of which there is a finer one, and quantity: what halving the step changes, what the
/// finer mesh changes, and which is the better buy.
fn refined(cascades: &[Cascade]) -> String {
    let mut text = String::new();
    for found in finer(cascades) {
        let way = |way: Option<Move>| match way {
            Some(Move { change, cost_ratio }) => format!(
                "×{} ({}) for ×{:.1} the cost",
                short(change.ratio),
                change.verdict.name(),
                cost_ratio
            ),
            None => "not said".to_owned(),
        };
        let better = match found.better {
            Some(way) => format!("the {way} is the better buy"),
            None => "neither is known to change it".to_owned(),
        };
        writeln!(
            text,
            "{} of {} cells by {}, {}: half the step {}, {} cells {}: {better}",
            found.scene,
            found.cells,
            found.method,
            found.quantity,
            way(found.by_step),
            found.finer_cells,
            way(found.by_mesh),
        )
        .expect("a string grows");
    }
    text
}

/// Three digits.
pub(super) fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let scale = 10.0_f64.powi(2 - x.abs().log10().floor() as i32);
    ((x * scale).round() / scale).to_string()
}
