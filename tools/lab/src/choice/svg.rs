//! The chart: what policies pay over the cheapest, sorted; a map of who is cheapest; and a table of regrets.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::policy::{POLICIES, Ranking, Standing};
use super::task::{MASS_RATIO, Motion, STIFFNESS_N_PER_M, Task};
use super::words::verdict;
use super::{Study, Trial};
use crate::draw::{Area, Drawn, drawn, round_numbers, wrapped};
use crate::pareto::{Family, Look, draw_mark};
use crate::parts;

const WIDTH: i32 = 1480;
const PLOT: (i32, i32) = (600, 400);
const TOP: i32 = 130;
const LEFT: [i32; 2] = [80, 840];
const TABLE: i32 = TOP + PLOT.1 + 90;
const ROW: i32 = 20;
const COLUMNS: [i32; 4] = [420, 680, 940, 1200];

const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);

/// The policies of the left plot, by their places, and their colours: those of their families, paler at
/// default settings.
const LINES: [(usize, RGBColor); 5] = [
    (0, RGBColor(0x00, 0x72, 0xb2)),
    (6, RGBColor(0x8f, 0xc4, 0xe4)),
    (1, RGBColor(0xd5, 0x5e, 0x00)),
    (7, RGBColor(0xf2, 0xb5, 0x86)),
    (4, RGBColor(0x00, 0x9e, 0x73)),
];

/// Draws a study as SVG. Returns `None` if the drawing library fails, which does not happen in memory.
#[must_use]
pub fn svg(study: &Study) -> Option<String> {
    let ranking = study.rankings.first()?;
    let foot = TABLE + ROW * (POLICIES.len() as i32 + 5);
    let footer = wrapped(&footer(study), 200);
    let height = foot + 16 * footer.len() as i32 + 14;
    drawn((WIDTH as u32, height as u32), |root| {
        head(root, ranking)?;
        costs(root, ranking)?;
        map(root, study, ranking)?;
        table(root, study)?;
        for (i, line) in footer.iter().enumerate() {
            words(root, line, (14, foot + 16 * i as i32), 12, &GREY)?;
        }
        Ok(())
    })
}

fn footer(study: &Study) -> String {
    let line = study.provenance.line();
    let (seed, seconds) = (study.seed, study.seconds);
    let count = study.trials.len();
    let missing = parts::told(&study.missing).map_or(String::new(), |told| format!(" · {told}"));
    format!("{line} · {count} tasks of seed {seed}, {seconds} s each{missing}")
}

fn head(root: &Area<'_>, ranking: &Ranking) -> Drawn {
    let title = format!("Choice: {}", verdict(ranking));
    words(root, &title, (14, 10), 21, &BLACK)?;
    let about = "Scenes drawn at random over stiffness, size, drag, mass of one particle, motion and mesh, \
                 each with a tolerance for its error: the largest of those of displacements, edge forces and \
                 reactions. Cost in visits of edges. Best step: the cheapest step that meets the tolerance, as \
                 if it were known. A policy that misses the tolerance costs ten times always-Verlet.";
    for (i, line) in wrapped(about, 190).iter().enumerate() {
        words(root, line, (14, 38 + 17 * i as i32), 13, &GREY)?;
    }
    Ok(())
}

/// Text with its upper left corner at a pixel.
fn words(root: &Area<'_>, text: &str, at: (i32, i32), size: i32, colour: &RGBColor) -> Drawn {
    let style = ("sans-serif", size).into_font().color(colour);
    root.draw(&Text::new(text.to_owned(), at, style))
}

/// Text at a number of an axis.
fn number(root: &Area<'_>, text: String, at: (i32, i32), pos: Pos) -> Drawn {
    let style = ("sans-serif", 12).into_font().color(&GREY).pos(pos);
    root.draw(&Text::new(text, at, style))
}

/// Where a number is between two others, by logarithms, as a part.
fn share(x: f64, from: f64, to: f64) -> f64 {
    (x / from).ln() / (to / from).ln()
}

fn frame(root: &Area<'_>, left: i32, title: &str) -> Drawn {
    let corners = [(left, TOP), (left + PLOT.0, TOP + PLOT.1)];
    root.draw(&Rectangle::new(corners, GREY.stroke_width(1)))?;
    words(root, title, (left - 60, TOP - 26), 15, &BLACK)
}

/// What policies pay over the cheapest run, each sorted by itself.
fn costs(root: &Area<'_>, ranking: &Ranking) -> Drawn {
    let left = LEFT[0];
    frame(
        root,
        left,
        "Cost over that of the cheapest run, tasks sorted for each policy",
    )?;
    let paid = |standing: &Standing| LINES.map(|(place, _)| standing.ratios[place]);
    let all = || ranking.standings.iter().flat_map(paid);
    let most = all().fold(10.0, f64::max) * 1.2;
    let least = all().fold(1.0, f64::min) * 0.9;
    let y = |ratio: f64| TOP + PLOT.1 - (share(ratio, least, most) * f64::from(PLOT.1)) as i32;
    for tick in round_numbers(&(least..most)) {
        let line = [(left, y(tick)), (left + PLOT.0, y(tick))];
        root.draw(&PathElement::new(line, GREY.mix(0.25)))?;
        let pos = Pos::new(HPos::Right, VPos::Center);
        number(root, format!("{tick}×"), (left - 6, y(tick)), pos)?;
    }
    let count = ranking.standings.len();
    let x = |i: usize| left + ((i as f64 + 0.5) / count as f64 * f64::from(PLOT.0)) as i32;
    let pos = Pos::new(HPos::Center, VPos::Top);
    let said = format!("{count} tasks whose answer is known, the best of each policy at the left");
    number(root, said, (left + PLOT.0 / 2, TOP + PLOT.1 + 8), pos)?;
    for (place, colour) in LINES {
        let of = ranking.standings.iter();
        let mut sorted: Vec<(f64, bool)> =
            of.map(|s| (s.ratios[place], s.is_missed[place])).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let points = sorted.iter().enumerate().map(|(i, one)| (x(i), y(one.0)));
        root.draw(&PathElement::new(
            points.collect::<Vec<_>>(),
            colour.stroke_width(2),
        ))?;
        for (i, (ratio, is_missed)) in sorted.into_iter().enumerate() {
            let style = match is_missed {
                true => colour.stroke_width(1),
                false => colour.filled(),
            };
            root.draw(&Circle::new((x(i), y(ratio)), 4, style))?;
        }
    }
    legend(root, left)
}

fn legend(root: &Area<'_>, left: i32) -> Drawn {
    let top = TOP + PLOT.1 + 30;
    for (i, (place, colour)) in LINES.into_iter().enumerate() {
        let at = (left - 50 + 150 * i as i32, top);
        root.draw(&Circle::new((at.0, at.1 + 7), 4, colour.filled()))?;
        words(root, POLICIES[place].name, (at.0 + 9, at.1), 13, &BLACK)?;
    }
    let at = (left - 50, top + 20);
    root.draw(&Circle::new((at.0, at.1 + 7), 4, GREY.stroke_width(1)))?;
    words(root, "misses the tolerance", (at.0 + 9, at.1), 13, &BLACK)
}

/// The rows of the map for tasks without a light particle, one per motion, and the height of each.
const BANDS: [Motion; 3] = [Motion::Swing, Motion::Taut(0.0), Motion::Fall];
const BAND: i32 = 24;

/// Where a task is on the map.
fn place(task: &Task) -> (i32, i32) {
    let (from, to) = (*STIFFNESS_N_PER_M.start(), *STIFFNESS_N_PER_M.end());
    let right = share(task.stiffness_n_per_m, from, to) * f64::from(PLOT.0);
    let bands = BAND * BANDS.len() as i32;
    let down = match task.middle_mass_ratio {
        1.0 => {
            let is_it = |motion: &Motion| motion.name() == task.motion.name();
            let band = BANDS.iter().position(is_it).unwrap_or(0) as i32;
            BAND * band + BAND / 2
        }
        ratio => {
            let part = share(ratio, *MASS_RATIO.end(), *MASS_RATIO.start());
            bands + (part * f64::from(PLOT.1 - bands)) as i32
        }
    };
    (LEFT[1] + right as i32, TOP + down)
}

/// Who is cheapest, over stiffness and mass ratio.
fn map(root: &Area<'_>, study: &Study, ranking: &Ranking) -> Drawn {
    let left = LEFT[1];
    let title = "The family of the cheapest run, by stiffness (across) and mass ratio (down)";
    frame(root, left, title)?;
    for power in 2..=6 {
        let x = left + (share(10_f64.powi(power), 1e2, 1e6) * f64::from(PLOT.0)) as i32;
        let pos = Pos::new(HPos::Center, VPos::Top);
        number(root, format!("1e{power} N/m"), (x, TOP + PLOT.1 + 8), pos)?;
    }
    let pos = || Pos::new(HPos::Right, VPos::Center);
    for (i, motion) in BANDS.iter().enumerate() {
        let y = TOP + BAND * i as i32;
        let said = format!("1, {}", motion.name());
        number(root, said, (left - 6, y + BAND / 2), pos())?;
        let line = [(left, y + BAND), (left + PLOT.0, y + BAND)];
        root.draw(&PathElement::new(line, GREY.mix(0.4)))?;
    }
    let bands = BAND * BANDS.len() as i32;
    for power in 1..=4 {
        let part = f64::from(power) / 4.0;
        let y = TOP + bands + (part * f64::from(PLOT.1 - bands)) as i32;
        number(root, format!("1e-{power}"), (left - 6, y), pos())?;
    }
    for trial in &study.trials {
        mark(root, trial, ranking)?;
    }
    families(root, left)
}

fn mark(root: &Area<'_>, trial: &Trial, ranking: &Ranking) -> Drawn {
    let at = place(&trial.task);
    let mut standings = ranking.standings.iter();
    let standing = standings.find(|standing| standing.number == trial.task.number);
    match standing.and_then(Standing::family) {
        Some(family) => draw_mark(root, family, at, 6.0, Look::Filled),
        None => words(root, "?", (at.0 - 4, at.1 - 8), 15, &GREY),
    }
}

fn families(root: &Area<'_>, left: i32) -> Drawn {
    let all = [
        Family::Verlet,
        Family::Plain,
        Family::Euler,
        Family::Xpbd,
        Family::BackwardEuler,
        Family::Bdf2,
    ];
    let top = TOP + PLOT.1 + 30;
    for (i, family) in all.into_iter().enumerate() {
        let x = left - 50 + 135 * (i as i32 % 5);
        let y = top + 20 * (i as i32 / 5);
        draw_mark(root, family, (x, y + 7), 5.0, Look::Filled)?;
        words(root, family.name(), (x + 11, y), 13, &BLACK)?;
    }
    let at = (left - 50 + 135, top + 20);
    words(root, "?  answer not known", (at.0 - 4, at.1), 13, &GREY)
}

/// The regret of each policy by demand, and how often it misses.
fn table(root: &Area<'_>, study: &Study) -> Drawn {
    let title =
        "Regret by the errors that have to meet the tolerance, and tasks in which it is missed";
    words(root, title, (20, TABLE), 15, &BLACK)?;
    for (ranking, x) in study.rankings.iter().zip(COLUMNS) {
        let known = format!(
            "{}, {} known",
            ranking.demand.name(),
            ranking.standings.len()
        );
        words(root, &known, (x, TABLE + ROW), 13, &GREY)?;
        for (i, regret) in ranking.regrets.iter().enumerate() {
            let y = TABLE + ROW * (2 + i as i32);
            let said = format!("{:.2}, misses {}", regret.regret, regret.missed);
            words(root, &said, (x, y), 14, &BLACK)?;
        }
        if let Some(most) = ranking.planner_max {
            let y = TABLE + ROW * (2 + POLICIES.len() as i32);
            words(root, &format!("at most {most:.2}"), (x, y), 14, &BLACK)?;
        }
    }
    for (i, policy) in POLICIES.iter().enumerate() {
        let y = TABLE + ROW * (2 + i as i32);
        words(root, policy.name, (20, y), 14, &BLACK)?;
    }
    let y = TABLE + ROW * (2 + POLICIES.len() as i32);
    let needed = "a planner worth having: 0.8 of the better of the first two";
    words(root, needed, (20, y), 14, &BLACK)
}
