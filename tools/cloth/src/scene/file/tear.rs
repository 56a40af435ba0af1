//! The table `[tear]`.

use super::TearTable;
use super::number::Finite;
use super::on::{Place, SceneFault, one_of};
use crate::cloth::tearing::{Tearing, Threshold};
use crate::scene::Scene;
use crate::scene::frame::Frame;

const PLACE: Place = Place::of("tear", 0);

impl TearTable {
    /// How the cloth tears; `None` if it never does by itself.
    pub(super) fn tearing(&self, frame: &Frame) -> Result<Option<Tearing>, SceneFault> {
        if self.never == Some(true) {
            return match self.first_other() {
                None => Ok(None),
                Some(key) => {
                    let message = format!("`never` and `{key}` cannot go together");
                    Err(PLACE.fault(key, "E-SCENE-CLASH", message))
                }
            };
        }
        let mut tearing = Tearing::new(self.threshold(frame)?);
        tearing.splits_per_step_max = self
            .splits_per_step
            .as_ref()
            .map(|most| most.get() as usize);
        if let Some(weakening) = self.weakening.as_deref().copied() {
            if weakening == 0.0 {
                let message = "`weakening` is above 0";
                return Err(PLACE.fault("weakening", "E-SCENE-RANGE", message));
            }
            tearing.weakening = (weakening < 1.0).then_some(weakening);
        }
        Ok(Some(tearing))
    }

    /// A key beside `never`.
    fn first_other(&self) -> Option<&'static str> {
        let others = present!(
            self,
            threshold,
            toughness_j_per_m,
            threshold_n,
            principal_stretch,
            threshold_warp,
            threshold_weft,
            warp,
            splits_per_step,
            weakening
        );
        let mut given = others.into_iter().filter(|(_, is_given)| *is_given);
        given.next().map(|(key, _)| key)
    }

    fn threshold(&self, frame: &Frame) -> Result<Threshold, SceneFault> {
        let groups = [
            present!(self, threshold),
            present!(self, toughness_j_per_m),
            present!(self, threshold_n),
            present!(self, principal_stretch),
            present!(self, threshold_warp, threshold_weft, warp),
        ];
        let group = match one_of(PLACE, "a threshold", &groups) {
            Err(fault) if fault.code == "E-SCENE-MISSING" => {
                return Ok(Threshold::Stretch(Scene::STRETCH_RATIO));
            }
            group => group?,
        };
        let axis = || {
            self.warp
                .as_ref()
                .map_or(frame.along.vector(), Finite::vector)
        };
        let threshold = match group[0].0 {
            "threshold" => self.threshold.as_deref().copied().map(Threshold::Stretch),
            "toughness_j_per_m" => {
                let toughness = self.toughness_j_per_m.as_deref().copied();
                toughness.map(Threshold::Toughness)
            }
            "threshold_n" => self.threshold_n.as_deref().copied().map(Threshold::Force),
            "principal_stretch" => {
                let ratio = self.principal_stretch.as_deref().copied();
                ratio.map(Threshold::PrincipalStretch)
            }
            _ => {
                let both = self
                    .threshold_warp
                    .as_ref()
                    .zip(self.threshold_weft.as_ref());
                both.map(|(warp, weft)| Threshold::WarpWeft {
                    warp: **warp,
                    weft: **weft,
                    axis: axis(),
                })
            }
        };
        threshold.ok_or_else(|| PLACE.lacks(group))
    }
}
