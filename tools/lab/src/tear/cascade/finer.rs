//! What changes as the step or the mesh gets finer, and what that costs: space against time, for numbers that
//! are chaotic.

use serde::Serialize;
use tearmesh_cloth::scene::ensemble::Ensemble;
use tearmesh_cloth::statistics::{Comparison, Verdict, median};

use super::{Cascade, TOLD, compared};

/// What halving the step and going to the next finer mesh change, for one quantity of a cascade.
#[derive(Clone, Debug, Serialize)]
pub struct Finer {
    /// The name of the scene.
    pub scene: String,
    /// The number of cells across.
    pub cells: u32,
    /// The number of cells across of the next finer mesh.
    pub finer_cells: u32,
    /// The name of the method.
    pub method: String,
    /// The key of the quantity.
    pub quantity: &'static str,
    /// The change from the step to half of it; `None` without values.
    pub by_step: Option<Move>,
    /// The change to the next finer mesh, at the step that the method has there; `None` without values.
    pub by_mesh: Option<Move>,
    /// The way that is the better buy. `None` if neither is known to change the median, so that there is
    /// nothing to buy as far as so few runs tell.
    pub better: Option<&'static str>,
}

/// The change of a median, and what it costs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Move {
    /// The comparison of the medians.
    pub change: Comparison,
    /// The median cost afterwards divided by that before, in visits to constraints.
    pub cost_ratio: f64,
}

impl Move {
    /// How much the median changes per factor of cost: what is bought with it. What costs next to nothing
    /// counts as costing a tenth more.
    fn rate(&self) -> f64 {
        self.change.ratio.ln().abs() / self.cost_ratio.max(1.1).ln()
    }

    fn differs(&self) -> bool {
        self.change.verdict == Verdict::Differ
    }
}

/// Returns the changes for each quantity of each cascade of which the same method has a finer one.
///
/// Errors are not known where there is no reference. But what still changes much is far from its limit, so the
/// way that changes more per factor of cost is the better buy.
#[must_use]
pub fn finer(cascades: &[Cascade]) -> Vec<Finer> {
    let mut found = Vec::new();
    for coarse in cascades {
        let is_finer = |other: &&Cascade| {
            (&other.scene, &other.method) == (&coarse.scene, &coarse.method)
                && other.cells > coarse.cells
        };
        let next = cascades.iter().filter(is_finer);
        let Some(fine) = next.min_by_key(|other| other.cells) else {
            continue;
        };
        for quantity in TOLD {
            let change = |from: Option<&Ensemble>, to: Option<&Ensemble>| {
                let (from, to) = (from?, to?);
                Some(Move {
                    change: compared(&from.numbers(quantity), &to.numbers(quantity))?,
                    cost_ratio: cost(to)? / cost(from)?,
                })
            };
            let [step, half] = [0, 1].map(|i| coarse.ensembles.get(i));
            let by_step = change(step, half);
            let by_mesh = change(step, fine.ensembles.first());
            found.push(Finer {
                scene: coarse.scene.clone(),
                cells: coarse.cells,
                finer_cells: fine.cells,
                method: coarse.method.clone(),
                quantity: quantity.key(),
                better: better(by_step, by_mesh),
                by_step,
                by_mesh,
            });
        }
    }
    found
}

/// Of the two ways those count that are known to change the median.
fn better(by_step: Option<Move>, by_mesh: Option<Move>) -> Option<&'static str> {
    let rate = |way: Option<Move>| way.filter(Move::differs).map(|way| way.rate());
    match (rate(by_step), rate(by_mesh)) {
        (None, None) => None,
        (step, mesh) if step > mesh => Some("step"),
        _ => Some("mesh"),
    }
}

/// The median cost of an ensemble's runs.
fn cost(ensemble: &Ensemble) -> Option<f64> {
    let seen = ensemble.members.iter().filter_map(|member| member.observed);
    median(seen.map(|seen| seen.visits as f64).collect())
}
