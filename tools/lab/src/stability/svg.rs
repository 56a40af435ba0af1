//! The map: a panel for each method with its nets, and below the scenes, with what was said.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::limit::STIFFNESS_N_PER_M;
use super::net::NetKind;
use super::told::Class;
use super::trial::{METHODS, TRIALS};
use super::{Limit, Study, Verdict};
use crate::draw::{Area, Drawn, drawn, wrapped};
use crate::parts;

const WIDTH: i32 = 1480;
const HEAD: i32 = 96;

/// A panel, its bars, and where they begin in it.
const PANEL: (i32, i32) = (486, 206);
const BARS: (i32, i32) = (70, 24);
const BAR: i32 = 4;
const LONG: i32 = 390;

/// The steps that a panel shows, as multiples of 2/ω.
const FROM: f64 = 0.3;
const TO: f64 = 1500.0;

/// The table of scenes.
const NAME: i32 = 370;
const CELL: (i32, i32) = (218, 40);

/// What the watch stops.
const WATCH: RGBColor = RGBColor(0x4b, 0x2e, 0x83);

const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);

/// The colours of Okabe and Ito, paler where words stand on them.
fn colour(class: Class) -> RGBColor {
    match class {
        Class::Fine => RGBColor(0xa6, 0xd8, 0xf0),
        Class::Wrong => RGBColor(0xf5, 0xcf, 0x6b),
        Class::BlowsUp => RGBColor(0xe0, 0x7b, 0x39),
        Class::Refused => RGBColor(0xc9, 0xc9, 0xd6),
    }
}

/// Draws a study as SVG. Returns `None` if the drawing library fails, which does not happen in memory.
#[must_use]
pub fn svg(study: &Study) -> Option<String> {
    let mut methods: Vec<&str> = study.limits.iter().map(|limit| limit.method).collect();
    methods.dedup();
    let rows = methods.len().div_ceil(3) as i32;
    let table = HEAD + rows * PANEL.1 + 12;
    let foot = table + 56 + CELL.1 * TRIALS.len() as i32 + 14;
    let footer = wrapped(&footer(study), 200);
    let height = foot + 16 * footer.len() as i32 + 14;
    drawn((WIDTH as u32, height as u32), |root| {
        head(root)?;
        for (i, method) in methods.iter().enumerate() {
            let (column, row) = ((i % 3) as i32, (i / 3) as i32);
            let corner = (12 + column * PANEL.0, HEAD + row * PANEL.1);
            let of = study.limits.iter().filter(|limit| limit.method == *method);
            panel(root, corner, method, &of.collect::<Vec<_>>())?;
        }
        scenes(root, table, study)?;
        for (i, line) in footer.iter().enumerate() {
            grey(root, line, (14, foot + 16 * i as i32), 12)?;
        }
        Ok(())
    })
}

fn footer(study: &Study) -> String {
    let missing = parts::told(&study.missing).map_or(String::new(), |told| format!(" · {told}"));
    format!(
        "{} · {} limits, {} scenes by method · {} differ from what is expected, {} failed without a \
         word{missing}",
        study.provenance.line(),
        study.limits.len(),
        study.verdicts.len(),
        study.differing,
        study.silent
    )
}

fn head(root: &Area<'_>) -> Drawn {
    let title = "Stability: where methods fail, and what one is told";
    root.draw(&Text::new(title, (14, 10), ("sans-serif", 21)))?;
    let words = "Above: small motions of six nets, five bars each for stiffnesses of 1e2 to 1e6 N/m, with the \
                 watch over stability off. To the right steps get longer, in multiples of 2/ω by a dense \
                 matrix. Black: the limit by theory (of Verlet with its guards what it promises). Violet: \
                 the shortest of the steps tried that the watch refuses. Below: scenes in which some method \
                 fails.";
    for (i, line) in wrapped(words, 190).iter().enumerate() {
        grey(root, line, (14, 36 + 17 * i as i32), 13)?;
    }
    let mut x = 14;
    for class in [Class::Fine, Class::Wrong, Class::BlowsUp, Class::Refused] {
        let at = [(x, 76), (x + 22, 88)];
        root.draw(&Rectangle::new(at, colour(class).filled()))?;
        root.draw(&Text::new(class.name(), (x + 28, 74), ("sans-serif", 14)))?;
        x += 110;
    }
    Ok(())
}

fn grey(root: &Area<'_>, words: &str, at: (i32, i32), size: i32) -> Drawn {
    let style = ("sans-serif", size).into_font().color(&GREY);
    root.draw(&Text::new(words.to_owned(), at, style))
}

/// The limits of a method.
fn panel(root: &Area<'_>, (left, top): (i32, i32), method: &str, limits: &[&Limit]) -> Drawn {
    root.draw(&Text::new(
        method.to_owned(),
        (left, top),
        ("sans-serif", 15),
    ))?;
    let (x0, y0) = (left + BARS.0, top + BARS.1);
    let at = |multiple: f64| {
        let part = (multiple / FROM).ln() / (TO / FROM).ln();
        x0 + (part.clamp(0.0, 1.0) * f64::from(LONG)).round() as i32
    };
    let nets = NetKind::ALL.len() as i32;
    let net_high = BAR * STIFFNESS_N_PER_M.len() as i32 + 3;
    let bottom = y0 + nets * net_high;
    for (i, net) in NetKind::ALL.into_iter().enumerate() {
        let top = y0 + i as i32 * net_high;
        let style = ("sans-serif", 12)
            .into_font()
            .color(&BLACK)
            .pos(Pos::new(HPos::Right, VPos::Center));
        root.draw(&Text::new(
            net.name(),
            (x0 - 6, top + net_high / 2 - 2),
            style,
        ))?;
        let of = limits.iter().filter(|limit| limit.net == net.name());
        for (j, limit) in of.enumerate() {
            bar(root, top + BAR * j as i32, limit, &at)?;
        }
    }
    grey(root, "Δt ω/2", (x0 + LONG - 190, bottom + 3), 11)?;
    for decade in [1.0, 10.0, 100.0, 1000.0] {
        let x = at(decade);
        let line = [(x, bottom), (x, bottom + 4)];
        root.draw(&PathElement::new(line, GREY))?;
        let style = ("sans-serif", 11)
            .into_font()
            .color(&GREY)
            .pos(Pos::new(HPos::Center, VPos::Top));
        root.draw(&Text::new(format!("{decade}"), (x, bottom + 5), style))?;
    }
    Ok(())
}

/// What is fine up to where it blows up, and the rest as far as it was tried.
fn bar(root: &Area<'_>, top: i32, limit: &Limit, at: &dyn Fn(f64) -> i32) -> Drawn {
    let multiple = |dt_s: f64| dt_s * limit.omega_rad_per_s / 2.0;
    let low = top + BAR - 1;
    let longest = at(multiple(limit.longest_s));
    let turn = limit.measured_s.map_or(longest, |dt_s| at(multiple(dt_s)));
    for (from, to, class) in [
        (at(FROM), turn, Class::Fine),
        (turn, longest, Class::BlowsUp),
    ] {
        if to > from {
            root.draw(&Rectangle::new(
                [(from, top), (to, low)],
                colour(class).filled(),
            ))?;
        }
    }
    if let Some(theory_s) = limit.theory_s {
        let x = at(multiple(theory_s));
        root.draw(&Rectangle::new(
            [(x - 1, top), (x, low + 1)],
            BLACK.filled(),
        ))?;
    }
    let refused = limit
        .cells
        .iter()
        .find(|cell| cell.watched == Class::Refused);
    if let Some(cell) = refused {
        let x = at(multiple(cell.dt_s));
        root.draw(&Rectangle::new(
            [(x + 2, top), (x + 5, low + 1)],
            WATCH.filled(),
        ))?;
    }
    Ok(())
}

/// The table of scenes.
fn scenes(root: &Area<'_>, top: i32, study: &Study) -> Drawn {
    let title = "Scenes, as a user plays them: what came of each method, by how much, and the codes of what was said";
    root.draw(&Text::new(title, (14, top), ("sans-serif", 15)))?;
    for (i, method) in METHODS.into_iter().enumerate() {
        let at = (14 + NAME + CELL.0 * i as i32 + 6, top + 30);
        root.draw(&Text::new(method, at, ("sans-serif", 14)))?;
    }
    for (row, trial) in TRIALS.iter().enumerate() {
        let y = top + 50 + CELL.1 * row as i32;
        root.draw(&Text::new(trial.name, (14, y + 2), ("sans-serif", 14)))?;
        for (i, line) in wrapped(trial.about, 66).iter().take(2).enumerate() {
            grey(root, line, (14, y + 15 + 11 * i as i32), 11)?;
        }
        for (column, method) in METHODS.into_iter().enumerate() {
            let mut of = study.verdicts.iter();
            let found = of.find(|one| one.trial == trial.name && one.method == method);
            if let Some(verdict) = found {
                scene(root, (14 + NAME + CELL.0 * column as i32, y), verdict)?;
            }
        }
    }
    Ok(())
}

fn scene(root: &Area<'_>, (x, y): (i32, i32), verdict: &Verdict) -> Drawn {
    let corners = [(x, y), (x + CELL.0 - 3, y + CELL.1 - 3)];
    root.draw(&Rectangle::new(corners, colour(verdict.measured).filled()))?;
    if verdict.measured != verdict.expected || verdict.is_silent() {
        root.draw(&Rectangle::new(corners, RED.stroke_width(3)))?;
    }
    let mut words = verdict.measured.name().to_owned();
    if let Some(measure) = verdict.measure {
        words += &format!(" · {}", short(measure));
    }
    if verdict.measured != verdict.expected {
        words += &format!(" (should be {})", verdict.expected.name());
    }
    root.draw(&Text::new(words, (x + 6, y + 3), ("sans-serif", 13)))?;
    let codes: Vec<&str> = verdict.told.iter().map(|told| told.code.as_str()).collect();
    let codes = match verdict.is_silent() {
        true => "NOTHING SAID".to_owned(),
        false => codes.join(" "),
    };
    root.draw(&Text::new(codes, (x + 6, y + 20), ("sans-serif", 11)))
}

/// Two digits, as short as they can be written.
fn short(x: f64) -> String {
    match x {
        0.0 => "0".to_owned(),
        x if (0.01..1000.0).contains(&x) => format!("{}", (x * 100.0).round() / 100.0),
        x => format!("{x:.0e}"),
    }
}
