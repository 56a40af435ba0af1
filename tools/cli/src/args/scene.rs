//! The arguments that change a scene, and the mesh that it is played with.

use clap::Args;
use tearmesh_cloth::Method;
use tearmesh_cloth::scene::Axis;

/// What is typed in the place of what the scene says.
#[derive(Debug, Args)]
pub(crate) struct ChangeArgs {
    /// The method: verlet (default), xpbd, pbd, provot or implicit.
    #[arg(long, value_parser = crate::choice::method(), value_name = "METHOD", hide_possible_values = true)]
    pub(crate) solver: Option<Method>,

    /// Tear edges at this many times their rest length (default: 1.5).
    ///
    /// The paper's rule. Finer meshes tear more easily: to compare forces, use --toughness.
    #[arg(long, value_name = "RATIO", allow_negative_numbers = true, value_parser = super::read::stretch,
        conflicts_with_all = ["toughness", "threshold_newton"])]
    pub(crate) threshold: Option<f64>,

    /// Tear by energy, in joules per metre of tear.
    ///
    /// The force depends much less on the mesh: `chart tear` measures it.
    #[arg(
        long,
        value_name = "J_PER_M",
        allow_negative_numbers = true,
        value_parser = super::read::positive,
        conflicts_with = "threshold_newton"
    )]
    pub(crate) toughness: Option<f64>,

    /// First, sew boundary edges that lie on each other.
    ///
    /// Programs that write a vertex for each texture coordinate or normal leave such seams, and the parts
    /// are loose. With --weld=D, sides that are up to D apart are sewn in their middle. Edges at which
    /// more than two sides meet stay apart. The output has the seams sewn.
    #[arg(long, value_name = "D", num_args = 0..=1, require_equals = true, default_missing_value = "0",
        value_parser = super::read::distance)]
    pub(crate) weld: Option<f64>,

    /// Tear edges that pull with more than this force, in newtons.
    #[arg(long, value_name = "F", allow_negative_numbers = true, value_parser = super::read::positive)]
    pub(crate) threshold_newton: Option<f64>,

    /// The duration in seconds (default: that of the scene).
    ///
    /// hang and fall: 2; flag and rip: 3; trouser: 4.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = super::read::seconds)]
    pub(crate) seconds: Option<f64>,

    /// The time step in seconds (default: chosen for the method).
    ///
    /// verlet: the step at which neighbours have to help a tenth of the vertices; provot: 0.7 of the
    /// stability limit; xpbd: h/c, the time that a pull takes along an edge; pbd: 3.2 h/c; implicit:
    /// 1/240; at most 1/120. A step that is not stable is refused: for verlet, one of more than twice
    /// the default.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = super::read::positive)]
    pub(crate) dt: Option<f64>,

    /// The direction that is up: x, y, z, -x, -y or -z (default: y).
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = super::read::up_axis)]
    pub(crate) up: Option<Axis>,

    /// Cut between two rays at --cut-at; may be given repeatedly.
    ///
    /// Replaces the cuts of the scene.
    #[arg(long, value_name = "A B", requires = "cut_at")]
    pub(crate) rays: Vec<String>,

    /// The time of the cut, in seconds.
    #[arg(
        long,
        value_name = "S",
        requires = "rays",
        allow_negative_numbers = true,
        value_parser = super::read::seconds
    )]
    pub(crate) cut_at: Option<f64>,
}
