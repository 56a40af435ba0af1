//! Dumps what scripts do, and has it judged by what is extracted from the proof (`tests/proof`).

use std::fmt::Display;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::process::{Command, Stdio};

use tearmesh::script::{Step, World};
use tearmesh::{Edit, FaceId, HalfEdgeId, MergeRefusal, Mesh, SplitRefusal, VertexId};

use crate::scripts::script;

/// How many scripts are judged, and how many faces a mesh may have that is.
const SCRIPTS: u64 = 3_000;
const FACES_MAX: usize = 40;

#[test]
#[ignore = "needs Coq: cargo test --test main -- --ignored --nocapture proof"]
fn scripts_are_judged_by_the_proof() {
    let run = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/proof/run");
    let mut judge = Command::new(run);
    let mut judge = judge.arg("judge").stdin(Stdio::piped()).spawn();
    let judge = judge.as_mut().expect("a shell");
    let mut lines = BufWriter::new(judge.stdin.take().expect("a pipe"));
    for seed in 0..SCRIPTS {
        write_script(&mut lines, seed).expect("the judge reads on");
    }
    drop(lines);
    assert!(judge.wait().expect("an end").success(), "the proof objects");
}

fn write_script(to: &mut impl Write, seed: u64) -> std::io::Result<()> {
    writeln!(to, "script")?;
    let mut seen = 0;
    let mut told = Ok(());
    script(seed).run(|world, step| {
        if told.is_ok() && world.mesh.face_count() <= FACES_MAX {
            told = write_step(to, world, step, &mut seen);
        }
    });
    told
}

fn write_step(
    to: &mut impl Write,
    world: &World,
    step: &Step<'_>,
    seen: &mut u64,
) -> std::io::Result<()> {
    let mesh = &world.mesh;
    for edit in world.edits.iter().filter(|edit| edit.number() >= *seen) {
        match edit {
            Edit::Split(split) => {
                write!(to, "split {} {}", split.old.index(), split.new.index())?;
                write_list(to, split.corners.iter().map(|h| h.index()))?;
            }
            Edit::Merge(merge) => {
                write!(to, "merge {} {}", merge.kept.index(), merge.gone.index())?;
            }
            Edit::Insert(_) => write!(to, "insert")?,
            Edit::Slide(_) => continue,
        }
        writeln!(to)?;
    }
    *seen = world.edits.cursor().number();
    write_refusal(to, mesh, step)?;
    write!(to, "state {} {}", mesh.face_count(), mesh.vertex_count())?;
    let links = |h| mesh.pair_or_ghost(h).map_or(-1, |g| g.index() as i64);
    write_list(to, mesh.half_edges().map(|h| mesh.origin(h).index()))?;
    write_list(to, mesh.half_edges().map(links))?;
    let torn = |h| u8::from(mesh.ghost_pair(h).is_some());
    write_list(to, mesh.half_edges().map(torn))?;
    for v in mesh.vertices() {
        let walk: Vec<usize> = mesh.corners_of(v).map(HalfEdgeId::index).collect();
        write!(to, " {}", walk.len())?;
        write_list(to, walk)?;
    }
    writeln!(to)
}

/// A split that would leave a side empty, and a merge of vertices of two roots, or of one vertex.
fn write_refusal(to: &mut impl Write, mesh: &Mesh, step: &Step<'_>) -> std::io::Result<()> {
    let corner = |v: VertexId, f: FaceId| mesh.corners_of(v).find(|h| h.face() == f);
    match *step {
        Step::Split {
            vertex: v,
            faces,
            outcome: Err(SplitRefusal::Empty { .. } | SplitRefusal::Everything { .. }),
        } => {
            write!(to, "refused split {}", v.index())?;
            let corners = faces.iter().filter_map(|&f| corner(v, f));
            write_list(to, corners.map(HalfEdgeId::index))?;
            writeln!(to)
        }
        Step::Merge {
            one,
            other,
            outcome: Err(MergeRefusal::Roots { .. } | MergeRefusal::Same { .. }),
            ..
        } => writeln!(to, "refused merge {} {}", one.index(), other.index()),
        _ => Ok(()),
    }
}

fn write_list<T: Display>(
    to: &mut impl Write,
    items: impl IntoIterator<Item = T>,
) -> std::io::Result<()> {
    items.into_iter().try_for_each(|item| write!(to, " {item}"))
}
