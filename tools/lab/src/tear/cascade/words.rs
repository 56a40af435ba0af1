//! What ensembles say, in words.

use std::fmt::Write as _;

use super::{Cascade, TOLD};
use crate::ensemble::Verdict;

/// Returns a summary in words: for each scene and quantity the reference, if any, and a line per method.
///
/// A line has the medians with the 10 % and 90 % points at the step, half and a quarter of it, and whether
/// halving the step makes a difference.
#[must_use]
pub fn summary(cascades: &[Cascade]) -> String {
    let mut text = String::new();
    let mut scenes: Vec<&str> = cascades
        .iter()
        .map(|cascade| cascade.scene.as_str())
        .collect();
    scenes.dedup();
    for scene in scenes {
        let of = || cascades.iter().filter(|cascade| cascade.scene == scene);
        for (place, quantity) in TOLD.into_iter().enumerate() {
            let [name, unit] = quantity.name();
            let reference = of().next().map(|cascade| &cascade.numbers[place].reference);
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
            writeln!(text, "{scene}, {name}{unit}; {reference}").expect("a string grows");
            for cascade in of() {
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
