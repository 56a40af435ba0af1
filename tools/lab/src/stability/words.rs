//! What a study says, in words.

use std::fmt::Write as _;

use super::{Class, Study};

/// Returns a summary in words: the numbers of differing and silent results, the limits by method, and then
/// each scene in which a method failed, with the codes of its messages.
#[must_use]
pub fn summary(study: &Study) -> String {
    let mut text = format!(
        "{} limits and {} scenes by method: {} differ from what is expected, {} failed without a word\n",
        study.limits.len(),
        study.verdicts.len(),
        study.differing,
        study.silent,
    );
    let mut line = |words: String| writeln!(text, "{words}").expect("a string grows");
    let mut methods: Vec<&str> = study.limits.iter().map(|limit| limit.method).collect();
    methods.dedup();
    for method in methods {
        let of = || study.limits.iter().filter(|limit| limit.method == method);
        let ratios = of().filter_map(|limit| Some(limit.measured_s? / limit.theory_s?));
        let (least, most) = ratios.fold((f64::INFINITY, 0.0_f64), |(least, most), ratio| {
            (least.min(ratio), most.max(ratio))
        });
        let said = match of().next() {
            Some(limit) if limit.is_promise && most > 0.0 => format!(
                "promised up to twice the step that suits it; blew up from {least:.2} times that on"
            ),
            Some(limit) if limit.is_promise => {
                "promised up to twice the step that suits it; never blew up".to_owned()
            }
            Some(limit) if limit.theory_s.is_some() => {
                format!("blows up at {least:.4} to {most:.4} of its limit by theory")
            }
            _ => {
                let blown = of().filter(|limit| limit.measured_s.is_some()).count();
                format!("{blown} of {} nets blew up, at any step", of().count())
            }
        };
        line(format!("  {method}: {said}"));
    }
    for limit in study.limits.iter().filter(|limit| !limit.agrees) {
        line(format!(
            "  differs: {} by {} at {:e} N/m",
            limit.net, limit.method, limit.stiffness_n_per_m
        ));
    }
    for verdict in &study.verdicts {
        let differs = verdict.measured != verdict.expected;
        if verdict.measured == Class::Fine && !differs {
            continue;
        }
        let codes: Vec<&str> = verdict.told.iter().map(|told| told.code.as_str()).collect();
        let codes = match codes.len() {
            0 => "nothing said".to_owned(),
            _ => codes.join(", "),
        };
        let expected = match differs {
            true => format!(", and should be {}", verdict.expected.name()),
            false => String::new(),
        };
        line(format!(
            "  {}, {}: {}{expected}; {codes}",
            verdict.trial,
            verdict.method,
            verdict.measured.name()
        ));
    }
    text
}
