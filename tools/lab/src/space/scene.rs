//! The scenes that are played on several meshes.

use super::measure::Measure;
use crate::pareto::{Case, MeshKind, Observable, SCENES, Scene, Until};

/// A scene that is played on several meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpaceScene {
    /// A sheet hangs by its upper edge, at rest.
    Hang,
    /// A sheet swings about its upper edge.
    Swing,
    /// A strip is pulled to its first tear. The finer the mesh, the later toughness tears it.
    Strip,
    /// A strip with a slit across half of its width is pulled to its first tear.
    Slit,
}

/// The longest time of a strip in seconds. On finer meshes an edge needs more strain to reach a toughness.
const STRIP_S: f64 = 1.0;

/// The part of the width that the slit takes.
const SLIT: f64 = 0.5;

impl SpaceScene {
    /// All scenes.
    pub const ALL: [SpaceScene; 4] = [
        SpaceScene::Hang,
        SpaceScene::Swing,
        SpaceScene::Strip,
        SpaceScene::Slit,
    ];

    /// Returns the name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            SpaceScene::Hang => "hang",
            SpaceScene::Swing => "swing",
            SpaceScene::Strip => "strip",
            SpaceScene::Slit => "slit",
        }
    }

    /// Returns a short description of the scene.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            SpaceScene::Slit => "S9 with a slit across half of the strip, which toughness asks for",
            _ => self.of_pareto().about,
        }
    }

    /// Returns the measures of the scene. Reactions at rest equal the weight on any mesh, and are none.
    #[must_use]
    pub fn measures(self) -> &'static [Measure] {
        match self {
            SpaceScene::Hang => &[Measure::Displacement, Measure::Sag],
            SpaceScene::Swing => &[Measure::Displacement, Measure::ReactionLargest],
            SpaceScene::Strip | SpaceScene::Slit => &[
                Measure::ToughTime,
                Measure::ToughForce,
                Measure::TearTime,
                Measure::TearForce,
            ],
        }
    }

    /// The scene on a mesh of so many cells.
    pub(super) fn case(self, cells: u32) -> Case {
        let mut case = Case::new(&self.of_pareto(), MeshKind::Grid, cells);
        if self == SpaceScene::Slit {
            slit(&mut case);
        }
        case
    }

    /// The scene on which it builds, without what is not asked here.
    fn of_pareto(self) -> Scene {
        let name = match self {
            SpaceScene::Slit => "strip",
            _ => self.name(),
        };
        let found = SCENES.into_iter().find(|scene| scene.name == name);
        let found = found.expect("each scene has one on which it builds");
        let observables: &[Observable] = match self {
            SpaceScene::Hang => &[Observable::Displacement],
            SpaceScene::Swing => &[Observable::Displacement, Observable::ReactionLargest],
            SpaceScene::Strip | SpaceScene::Slit => {
                return Scene {
                    name: self.name(),
                    until: Until::Tears(STRIP_S),
                    ..found
                };
            }
        };
        Scene {
            observables,
            ..found
        }
    }
}

/// Leaves out the springs between two rows of particles at half the height, from the left edge to the tip.
fn slit(case: &mut Case) {
    let side_m = case.scene.side_m;
    let points = case.sheet.points.clone();
    let is_below = |i: usize| points[i].y <= 0.5 * side_m;
    let is_left = |i: usize| points[i].x < SLIT * side_m;
    case.edges.retain(|&[a, b]| {
        let crosses = is_below(a) != is_below(b);
        !(crosses && (is_left(a) || is_left(b)))
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slit_leaves_no_spring_from_its_left_end_to_its_tip() {
        for cells in [4, 8, 12] {
            let [whole, slit] =
                [SpaceScene::Strip, SpaceScene::Slit].map(|scene| scene.case(cells));
            let points = &slit.sheet.points;
            let (side, h) = (0.1, 0.1 / f64::from(cells));
            let above = 0.5 * side + 0.5 * h;
            for &[a, b] in &slit.edges {
                let [p, q] = [points[a], points[b]];
                let crosses = (p.y < above) != (q.y < above);
                let middle = 0.5 * (p.x + q.x);
                assert!(!crosses || middle > 0.5 * side - 0.1 * h, "{p:?} {q:?}");
            }
            // Of each of the n/2 cells its left side and its diagonal.
            assert_eq!(whole.edges.len() - slit.edges.len(), cells as usize);
        }
    }
}
