//! The map: for each tolerance a table of stiffness and mass ratio, each place in the colour of the cheapest
//! family, with the line along which XPBD and Verlet's method cost the same.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::line::OPPONENTS;
use super::words::question;
use super::{Answer, Asked, Crossing, FamilyCost, Line, Place, QUESTIONS, Study};
use crate::draw::{Area, Drawn, drawn, wrapped};
use crate::pareto::{Family, colour};
use crate::parts;

/// The room of a place, and what is left free above and beside a table.
const CELL: (i32, i32) = (164, 84);
const HEAD: i32 = 132;
const TABLE_HEAD: i32 = 40;
const LEFT: i32 = 66;
const BELOW: i32 = 46;

const GREY: RGBColor = RGBColor(0x66, 0x66, 0x66);

/// Where nothing is known.
const BLANK: RGBColor = RGBColor(0xe6, 0xe6, 0xe6);

/// Lines, which words on them can be read through.
const LINE: RGBColor = RGBColor(0x80, 0x80, 0x80);

/// How much of a family's colour shows behind words.
const PALE: f64 = 0.4;

/// Draws a study as SVG. Returns `None` if the drawing library fails, which does not happen in memory.
#[must_use]
pub fn svg(study: &Study) -> Option<String> {
    let axes = Axes::of(study);
    let table = (
        LEFT + CELL.0 * axes.stiffness.len() as i32 + 24,
        TABLE_HEAD + CELL.1 * axes.ratios.len() as i32 + BELOW,
    );
    let width = (QUESTIONS.len() as i32 * table.0 + 12).max(900);
    let foot = wrapped(&footer(study), width as usize / 6);
    let height = HEAD + table.1 + 16 * foot.len() as i32 + 18;
    drawn((width as u32, height as u32), |root| {
        head(root, width, study)?;
        for (i, asked) in QUESTIONS.into_iter().enumerate() {
            let corner = (12 + table.0 * i as i32, HEAD);
            axes.panel(root, corner, study, asked)?;
        }
        for (i, line) in foot.iter().enumerate() {
            let at = (14, HEAD + table.1 + 6 + 16 * i as i32);
            root.draw(&Text::new(line.clone(), at, style(12, &GREY)))?;
        }
        Ok(())
    })
}

fn style(size: i32, colour: &RGBColor) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(colour)
}

fn anchored(size: i32, colour: &RGBColor, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    style(size, colour).pos(Pos::new(horizontal, vertical))
}

fn footer(study: &Study) -> String {
    let runs = study
        .places
        .iter()
        .map(|place| place.runs.len())
        .sum::<usize>();
    let missing = parts::told(&study.missing).map_or(String::new(), |told| format!(" · {told}"));
    format!(
        "{} · the swing of 30° on a grid of {} cells a side, drag 10 /s, 1 s · {runs} runs at {} places · \
         runs end at {} times the cost of Verlet with its base step{missing}",
        study.provenance.line(),
        study.cells,
        study.places.len(),
        study.cost_max,
    )
}

/// The title, how to read it, and the colours.
fn head(root: &Area<'_>, width: i32, study: &Study) -> Drawn {
    let title = "The plane of stiffness and mass ratio: the cheapest method at a fixed error";
    root.draw(&Text::new(title, (14, 10), ("sans-serif", 21)))?;
    let words = "Each place has the colour of the cheapest family, with its cost in visits of edges, and the \
                 costs of XPBD and of plain Verlet as multiples of Verlet's (which has light particles carried \
                 by their neighbours). ≤: by the longest step tried; a longer one may cost less. >: runs were given up \
                 there. misses: no step tried meets the error. Grey line: where XPBD and Verlet cost the \
                 same, with the stiffness (between: one of the two misses on one side); dashed: XPBD and plain \
                 Verlet.";
    for (i, line) in wrapped(words, width as usize / 6).iter().enumerate() {
        root.draw(&Text::new(
            line.clone(),
            (14, 38 + 17 * i as i32),
            style(13, &GREY),
        ))?;
    }
    let mut x = 14;
    for family in families(study) {
        let at = [(x, HEAD - 26), (x + 22, HEAD - 12)];
        root.draw(&Rectangle::new(at, colour(family).mix(PALE).filled()))?;
        root.draw(&Text::new(
            family.name(),
            (x + 28, HEAD - 27),
            style(14, &BLACK),
        ))?;
        x += 52 + 8 * family.name().len() as i32;
    }
    root.draw(&Rectangle::new(
        [(x, HEAD - 26), (x + 22, HEAD - 12)],
        BLANK.filled(),
    ))?;
    root.draw(&Text::new(
        "no answer",
        (x + 28, HEAD - 27),
        style(14, &BLACK),
    ))
}

/// The families of which there are runs.
fn families(study: &Study) -> impl Iterator<Item = Family> + '_ {
    let has = |family: &Family| {
        let mut places = study.places.iter();
        places.any(|place| {
            place
                .answers
                .iter()
                .any(|answer| answer.cost(*family).is_some())
        })
    };
    Family::ALL.into_iter().filter(has)
}

/// A place with its answer and its upper left corner.
type Cell<'a> = ((i32, i32), &'a Place, &'a Answer);

/// What the tables have in common: the stiffness values from left to right, and the mass ratios downward.
struct Axes {
    stiffness: Vec<f64>,
    ratios: Vec<f64>,
}

impl Axes {
    fn of(study: &Study) -> Axes {
        let sorted = |of: fn(&Place) -> f64| {
            let mut all: Vec<f64> = study.places.iter().map(of).collect();
            all.sort_by(f64::total_cmp);
            all.dedup();
            all
        };
        let mut ratios = sorted(|place| place.mass_ratio);
        ratios.reverse();
        Axes {
            stiffness: sorted(|place| place.stiffness_n_per_m),
            ratios,
        }
    }

    /// The upper left corner of a column and a row, in a panel.
    fn corner((left, top): (i32, i32), column: usize, row: usize) -> (i32, i32) {
        (
            left + LEFT + CELL.0 * column as i32,
            top + TABLE_HEAD + CELL.1 * row as i32,
        )
    }

    /// Words stand above lines, and lines above colours.
    fn panel(&self, root: &Area<'_>, at: (i32, i32), study: &Study, asked: Asked) -> Drawn {
        let title = (at.0 + LEFT, at.1 + 4);
        root.draw(&Text::new(question(asked), title, style(16, &BLACK)))?;
        self.names(root, at)?;
        let cells = self.cells(at, study, asked);
        for &(corner, _, answer) in &cells {
            fill(root, corner, answer)?;
        }
        for opponent in OPPONENTS {
            self.line(root, at, study, asked, opponent)?;
        }
        for &(corner, place, answer) in &cells {
            words(root, corner, place, answer)?;
        }
        Ok(())
    }

    /// The numbers along both axes, and what they are.
    fn names(&self, root: &Area<'_>, at: (i32, i32)) -> Drawn {
        let below = |size, colour| anchored(size, colour, HPos::Center, VPos::Top);
        let beside = |size, colour| anchored(size, colour, HPos::Right, VPos::Center);
        for (column, k) in self.stiffness.iter().enumerate() {
            let (x, y) = Axes::corner(at, column, self.ratios.len());
            let middle = (x + CELL.0 / 2, y + 5);
            root.draw(&Text::new(format!("{k:e}"), middle, below(13, &BLACK)))?;
        }
        for (row, ratio) in self.ratios.iter().enumerate() {
            let (x, y) = Axes::corner(at, 0, row);
            let middle = (x - 6, y + CELL.1 / 2);
            root.draw(&Text::new(format!("{ratio:e}"), middle, beside(13, &BLACK)))?;
        }
        let (right, bottom) = Axes::corner(at, self.stiffness.len(), self.ratios.len());
        let middle = ((at.0 + LEFT + right) / 2, bottom + 23);
        let name = "stiffness k, N/m (logarithmic)";
        root.draw(&Text::new(name, middle, below(13, &GREY)))?;
        let middle = (at.0 + LEFT - 6, at.1 + TABLE_HEAD - 8);
        root.draw(&Text::new("mass ratio", middle, beside(12, &GREY)))
    }

    /// The corner of each place that has an answer.
    fn cells<'a>(&self, at: (i32, i32), study: &'a Study, asked: Asked) -> Vec<Cell<'a>> {
        let find = |all: &[f64], wanted: f64| all.iter().position(|one| *one == wanted);
        let cell = |place: &'a Place| {
            let column = find(&self.stiffness, place.stiffness_n_per_m)?;
            let row = find(&self.ratios, place.mass_ratio)?;
            let answer = place.answer(asked.observable)?;
            Some((Axes::corner(at, column, row), place, answer))
        };
        study.places.iter().filter_map(cell).collect()
    }

    /// The changes between XPBD and an opponent, row by row, joined where rows below each other have one.
    fn line(
        &self,
        root: &Area<'_>,
        at: (i32, i32),
        study: &Study,
        asked: Asked,
        opponent: Family,
    ) -> Drawn {
        let is_it = |line: &&Line| line.asked == asked && line.opponent == opponent;
        let lines: Vec<&Line> = study.lines.iter().filter(is_it).collect();
        let is_dashed = opponent == Family::Plain;
        let mut above: Option<i32> = None;
        for (row, ratio) in self.ratios.iter().enumerate() {
            let found = lines.iter().find(|line| line.mass_ratio == *ratio);
            let crossings = found.map_or(&[][..], |line| &line.crossings);
            let (_, y) = Axes::corner(at, 0, row);
            for crossing in crossings {
                let x = self.x(at, crossing);
                stroke(root, [(x, y), (x, y + CELL.1)], is_dashed)?;
                if !is_dashed {
                    label(root, (x, y + CELL.1 - 12), crossing)?;
                }
            }
            let own = match crossings {
                [only] => Some(self.x(at, only)),
                _ => None,
            };
            if let (Some(before), Some(x)) = (above, own) {
                stroke(root, [(before, y), (x, y)], is_dashed)?;
            }
            above = own;
        }
        Ok(())
    }

    /// Where a change is drawn between the middles of two columns; without a stiffness, half-way.
    fn x(&self, at: (i32, i32), crossing: &Crossing) -> i32 {
        let middle = |k: f64| {
            let column = self.stiffness.iter().position(|other| *other == k);
            f64::from(Axes::corner(at, column.unwrap_or(0), 0).0 + CELL.0 / 2)
        };
        let (from, to) = (crossing.from_n_per_m, crossing.to_n_per_m);
        let part = crossing
            .at_n_per_m
            .map_or(0.5, |k| (k / from).ln() / (to / from).ln());
        (middle(from) + part * (middle(to) - middle(from))).round() as i32
    }
}

/// A piece of a line, straight down or across.
fn stroke(root: &Area<'_>, [(x0, y0), (x1, y1)]: [(i32, i32); 2], is_dashed: bool) -> Drawn {
    if !is_dashed {
        let thick = LINE.stroke_width(4);
        return root.draw(&PathElement::new([(x0, y0), (x1, y1)], thick));
    }
    let long = (x1 - x0).abs().max((y1 - y0).abs());
    let at = |along: i32| {
        let part = |from: i32, to: i32| from + (to - from) * along.min(long) / long.max(1);
        (part(x0, x1), part(y0, y1))
    };
    (0..long).step_by(10).try_for_each(|along| {
        let dash = [at(along), at(along + 5)];
        root.draw(&PathElement::new(dash, LINE.stroke_width(2)))
    })
}

/// The stiffness of a change, on the line.
fn label(root: &Area<'_>, (x, y): (i32, i32), crossing: &Crossing) -> Drawn {
    let words = match crossing.at_n_per_m {
        Some(k) => format!("{k:.1e}"),
        None => "between".to_owned(),
    };
    let half = 4 * words.len() as i32;
    let around = [(x - half, y - 8), (x + half, y + 8)];
    root.draw(&Rectangle::new(around, WHITE.filled()))?;
    root.draw(&Rectangle::new(around, BLACK.stroke_width(1)))?;
    let words_style = anchored(12, &BLACK, HPos::Center, VPos::Center);
    root.draw(&Text::new(words, (x, y), words_style))
}

/// A place in the colour of its cheapest family.
fn fill(root: &Area<'_>, (x, y): (i32, i32), answer: &Answer) -> Drawn {
    let corners = [(x + 1, y + 1), (x + CELL.0 - 1, y + CELL.1 - 1)];
    let winner = answer.winner();
    let fill = winner.map_or(BLANK.to_rgba(), |winner| colour(winner.family).mix(PALE));
    root.draw(&Rectangle::new(corners, fill.filled()))
}

/// The cheapest family with its cost and two ratios, or why there is none.
fn words(root: &Area<'_>, (x, y): (i32, i32), place: &Place, answer: &Answer) -> Drawn {
    let winner = answer.winner();
    let lines = match winner {
        Some(winner) => vec![
            format!("{} {}", winner.family.name(), cost(winner)),
            format!("XPBD / Verlet {}", ratio(place, answer, Family::Xpbd)),
            format!("plain / Verlet {}", ratio(place, answer, Family::Plain)),
        ],
        None => unanswered(place, answer),
    };
    let colour = if winner.is_some() { BLACK } else { GREY };
    for (i, line) in lines.into_iter().enumerate() {
        let size = if i == 0 { 14 } else { 12 };
        let at = (x + 8, y + 7 + 19 * i as i32);
        root.draw(&Text::new(line, at, style(size, &colour)))?;
    }
    Ok(())
}

fn cost(of: &FamilyCost) -> String {
    let sign = if of.is_at_most { "≤ " } else { "" };
    let visits = of
        .visits
        .map(|visits| format!("{sign}{:.1e}", visits as f64));
    visits.unwrap_or_default()
}

/// The cost of a family as a multiple of Verlet's, or why there is none.
fn ratio(place: &Place, answer: &Answer, of: Family) -> String {
    let (Some(cost), Some(verlet)) = (answer.cost(of), answer.cost(Family::Verlet)) else {
        return "not run".to_owned();
    };
    let Some(least) = verlet.visits.map(|visits| visits as f64) else {
        return "(Verlet misses)".to_owned();
    };
    match cost.visits {
        Some(visits) => {
            let is_at_most = cost.is_at_most && !verlet.is_at_most;
            let sign = if is_at_most { "≤ " } else { "" };
            format!("{sign}{:.2}", visits as f64 / least)
        }
        None if cost.is_cut_short => format!("> {:.1}", place.visits_max as f64 / least),
        None => "misses".to_owned(),
    }
}

/// Why there is no cheapest family.
fn unanswered(place: &Place, answer: &Answer) -> Vec<String> {
    let told = match (answer.is_barred, place.amplification, answer.floor) {
        (true, Some(grown), _) => [
            "barred: noise".to_owned(),
            format!("grows {grown:.0e}-fold"),
        ],
        (true, None, _) => ["barred: growth of".to_owned(), "noise unknown".to_owned()],
        (false, _, None) => ["no reference".to_owned(), String::new()],
        (false, _, Some(floor)) if !answer.is_known => [
            "not known: floor".to_owned(),
            format!("at {:.1} %", 100.0 * floor),
        ],
        _ => ["nobody meets it".to_owned(), String::new()],
    };
    told.into()
}
