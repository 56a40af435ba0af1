//! The keys that name vertices, which holds and strengths share.

use super::number::{Finite, NotNegative, Range, Vertices};
use super::on::{Place, SceneFault, one_of};
use super::{HoldTable, StrengthTable};
use crate::scene::Region;

/// The keys of a table that name vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct RegionKeys<'t> {
    near: Option<&'t Finite<2>>,
    radius: Option<&'t NotNegative>,
    across: Option<&'t Range>,
    along: Option<&'t Range>,
    from: Option<&'t Finite<3>>,
    to: Option<&'t Finite<3>>,
    centre: Option<&'t Finite<3>>,
    radius_m: Option<&'t NotNegative>,
    vertices: Option<&'t Vertices>,
}

macro_rules! region_keys {
    ($table:ident) => {
        impl $table {
            pub(super) fn region_keys(&self) -> RegionKeys<'_> {
                RegionKeys {
                    near: self.near.as_ref(),
                    radius: self.radius.as_ref(),
                    across: self.across.as_ref(),
                    along: self.along.as_ref(),
                    from: self.from.as_ref(),
                    to: self.to.as_ref(),
                    centre: self.centre.as_ref(),
                    radius_m: self.radius_m.as_ref(),
                    vertices: self.vertices.as_ref(),
                }
            }
        }
    };
}

region_keys!(HoldTable);
region_keys!(StrengthTable);

impl RegionKeys<'_> {
    /// The region that the keys of one kind name; `what` is what has to have one.
    pub(super) fn region(self, place: Place, what: &str) -> Result<Region, SceneFault> {
        let groups = [
            present!(self, near, radius),
            present!(self, across, along),
            present!(self, from, to),
            present!(self, centre, radius_m),
            present!(self, vertices),
        ];
        let group = one_of(place, what, &groups)?;
        let whole = |range: Option<&Range>| range.map_or([0.0, 1.0], |range| ***range);
        let region = match group[0].0 {
            "near" => self.near.map(|at| Region::Near {
                at: **at,
                radius: self.radius.map_or(0.0, |radius| **radius),
            }),
            "across" => Some(Region::Patch {
                across: whole(self.across),
                along: whole(self.along),
            }),
            "from" => self.from.zip(self.to).map(|(from, to)| Region::Box {
                from: from.point(),
                to: to.point(),
            }),
            "centre" => {
                let ball = self.centre.zip(self.radius_m);
                ball.map(|(centre, radius_m)| Region::Ball {
                    centre: centre.point(),
                    radius_m: **radius_m,
                })
            }
            _ => self.vertices.map(|named| Region::Vertices(named.ids())),
        };
        region.ok_or_else(|| place.lacks(group))
    }
}
