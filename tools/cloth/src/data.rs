//! Data that is read: what would be refused where it is used is refused where it is read.

use std::error::Error;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use tearmesh::Point;

use crate::cloth::fabric::Fabric;
use crate::cloth::tearing::Tearing;
use crate::method::Method;
use crate::scene::Scene;
use crate::system::error::SettingError;
use crate::system::path::Path;

/// What is read field by field, and is then refused for what a check says.
macro_rules! checked {
    ($data:ident, $check:expr) => {
        impl Serialize for $data {
            fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                $data::serialize(self, to)
            }
        }

        impl<'de> Deserialize<'de> for $data {
            fn deserialize<D: Deserializer<'de>>(from: D) -> Result<$data, D::Error> {
                let read = $data::deserialize(from)?;
                $check(&read).map_err(D::Error::custom).map(|()| read)
            }
        }
    };
}

checked!(Fabric, Fabric::check);
checked!(Method, |method: &Method| method.solver().check());
checked!(Scene, check);
checked!(Tearing, Tearing::check);

impl From<Path> for Vec<(f64, Point)> {
    fn from(path: Path) -> Vec<(f64, Point)> {
        path.points.to_vec()
    }
}

impl TryFrom<Vec<(f64, Point)>> for Path {
    type Error = &'static str;

    fn try_from(points: Vec<(f64, Point)>) -> Result<Path, &'static str> {
        Path::new(points).ok_or("a path has points that are finite, at times that ascend")
    }
}

/// Refuses a scene that no mesh could be played with.
fn check(scene: &Scene) -> Result<(), Box<dyn Error>> {
    SettingError::unless_at_least_0("duration_s", scene.duration_s)?;
    let factors = scene.strengths.iter().map(|(_, factor)| *factor);
    let numbers = [scene.areal_density_kg_per_m2, scene.step_s.unwrap_or(1.0)];
    for number in factors.chain(numbers) {
        SettingError::unless_above_0("a density, step or strength", number)?;
    }
    for (number, seam) in scene.seams.iter().enumerate() {
        seam.check_counts(number)?;
    }
    scene.check()?;
    Ok(scene.loads().check()?)
}
