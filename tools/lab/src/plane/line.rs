//! The line along which XPBD and Verlet's method cost the same: at each mass ratio, the stiffness at which the
//! cheaper of the two changes.

use serde::{Deserialize, Serialize};

use super::place::{Asked, Place, QUESTIONS};
use crate::pareto::Family;

/// The methods with which XPBD is compared: Verlet's method with and without guards for light particles.
pub(super) const OPPONENTS: [Family; 2] = [Family::Verlet, Family::Plain];

/// Who is cheaper, XPBD or an opponent, along the stiffness at one mass ratio.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Line {
    /// The tolerance.
    pub asked: Asked,
    /// The opponent.
    pub opponent: Family,
    /// The mass ratio.
    pub mass_ratio: f64,
    /// The stiffness values in N/m at which it is known who is cheaper, in ascending order.
    pub known_n_per_m: Vec<f64>,
    /// Whether XPBD is the cheaper one at the lowest of these; `None` if there is none.
    pub begins_with_xpbd: Option<bool>,
    /// The changes of who is cheaper, by ascending stiffness.
    pub crossings: Vec<Crossing>,
}

/// A change of who is cheaper.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Crossing {
    /// The highest stiffness of the plane below the change, in N/m.
    pub from_n_per_m: f64,
    /// The lowest stiffness of the plane above the change, in N/m.
    pub to_n_per_m: f64,
    /// The stiffness in N/m at which both cost the same, by linear interpolation between the logarithms of
    /// stiffness and of the ratio of costs. `None` if one of the two misses the tolerance on one side.
    pub at_n_per_m: Option<f64>,
    /// Whether XPBD is cheaper above the change, instead of below.
    pub is_to_xpbd: bool,
}

/// The costs of XPBD and of its opponent at a stiffness; at least one of them is known.
struct Duel {
    stiffness_n_per_m: f64,
    visits: [Option<u64>; 2],
}

impl Duel {
    /// One that misses the tolerance is dearer than one that meets it; equals are not cheaper.
    fn is_of_xpbd(&self) -> bool {
        match self.visits {
            [Some(xpbd), Some(opponent)] => xpbd < opponent,
            [xpbd, _] => xpbd.is_some(),
        }
    }

    /// The logarithm of the ratio of costs.
    fn ratio(&self) -> Option<f64> {
        let [xpbd, opponent] = self.visits;
        Some((xpbd? as f64 / opponent? as f64).ln())
    }
}

/// The lines of all questions, opponents and mass ratios. The places must be ordered by stiffness.
pub(super) fn lines(places: &[Place]) -> Vec<Line> {
    let mut ratios: Vec<f64> = places.iter().map(|place| place.mass_ratio).collect();
    ratios.sort_by(|a, b| b.total_cmp(a));
    ratios.dedup();
    let mut lines = Vec::new();
    for asked in QUESTIONS {
        for opponent in OPPONENTS {
            for &mass_ratio in &ratios {
                let row = places.iter().filter(|place| place.mass_ratio == mass_ratio);
                let duels: Vec<Duel> = row
                    .filter_map(|place| duel(place, asked, opponent))
                    .collect();
                lines.push(Line {
                    asked,
                    opponent,
                    mass_ratio,
                    known_n_per_m: duels.iter().map(|duel| duel.stiffness_n_per_m).collect(),
                    begins_with_xpbd: duels.first().map(Duel::is_of_xpbd),
                    crossings: duels.windows(2).filter_map(crossing).collect(),
                });
            }
        }
    }
    lines
}

/// `None` where neither meets the tolerance, or it is not known who does.
fn duel(place: &Place, asked: Asked, opponent: Family) -> Option<Duel> {
    let answer = place.answer(asked.observable)?;
    let visits = [Family::Xpbd, opponent].map(|family| answer.visits(family));
    let has_both = [Family::Xpbd, opponent].map(|family| answer.cost(family).is_some());
    (has_both == [true; 2] && visits != [None; 2]).then_some(Duel {
        stiffness_n_per_m: place.stiffness_n_per_m,
        visits,
    })
}

fn crossing(neighbours: &[Duel]) -> Option<Crossing> {
    let [a, b] = neighbours else {
        return None;
    };
    let between = |(first, last): (f64, f64)| {
        let [low, high] = [a, b].map(|duel| duel.stiffness_n_per_m.ln());
        (low + (high - low) * first / (first - last)).exp()
    };
    (a.is_of_xpbd() != b.is_of_xpbd()).then(|| Crossing {
        from_n_per_m: a.stiffness_n_per_m,
        to_n_per_m: b.stiffness_n_per_m,
        at_n_per_m: a.ratio().zip(b.ratio()).map(between),
        is_to_xpbd: b.is_of_xpbd(),
    })
}
