//! Dumps what scripts do, and has it judged by what is extracted from the proof (`tests/proof`).

use std::fmt::Display;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::process::{Command, Stdio};

use tearmesh::insert::Point;
use tearmesh::script::{Step, World};
use tearmesh::{Edit, Edits, HalfEdgeId, MergeRefusal, Mesh, mend};

use crate::exhaustive::{for_each_gluing, glued};
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
    write_builds(&mut lines).expect("the judge reads on");
    for seed in 0..SCRIPTS {
        let torn = write_script(&mut lines, seed).expect("the judge reads on");
        write_sewing(&mut lines, &torn).expect("the judge reads on");
    }
    drop(lines);
    assert!(judge.wait().expect("an end").success(), "the proof objects");
}

/// All lists of one to three triangles, up to the names of their vertices, with all of these and with one
/// too few; and every connected gluing of up to four.
fn write_builds(to: &mut impl Write) -> std::io::Result<()> {
    let mut told = Ok(());
    let mut write = |vertices: usize, triangles: &[[u32; 3]]| {
        if told.is_ok() {
            told = write_build(to, vertices, triangles);
        }
    };
    for faces in 1..=3 {
        for_each_naming(3 * faces, &mut Vec::new(), &mut |corners| {
            let vertices = corners.iter().max().map_or(0, |&last| last as usize + 1);
            write(vertices, corners.as_chunks().0);
            write(vertices - 1, corners.as_chunks().0);
        });
    }
    for faces in 1..=4 {
        for_each_gluing(faces, &mut |opposite| {
            let (vertices, triangles) = glued(opposite);
            write(vertices, &triangles);
        });
    }
    told
}

/// Shows all ways to name so many corners by vertices, where each vertex is met before the next one.
fn for_each_naming(corners: usize, named: &mut Vec<u32>, show: &mut impl FnMut(&[u32])) {
    if named.len() == corners {
        return show(named);
    }
    for vertex in 0..=named.iter().max().map_or(0, |last| last + 1) {
        named.push(vertex);
        for_each_naming(corners, named, show);
        named.pop();
    }
}

fn write_build(
    to: &mut impl Write,
    vertices: usize,
    triangles: &[[u32; 3]],
) -> std::io::Result<()> {
    let mesh = Mesh::build(vertices, triangles).ok();
    let outcome = if mesh.is_some() {
        "accepted"
    } else {
        "refused"
    };
    write!(to, "build {outcome} {vertices} {}", triangles.len())?;
    write_list(to, triangles.as_flattened())?;
    writeln!(to)?;
    mesh.map_or(Ok(()), |mesh| write_state(to, &mesh))
}

/// Writes a script, and returns the mesh that it ends with.
fn write_script(to: &mut impl Write, seed: u64) -> std::io::Result<Mesh> {
    writeln!(to, "script")?;
    let mut seen = 0;
    let mut told = Ok(());
    let world = script(seed).run(|world, step| {
        if told.is_ok() && world.mesh.face_count() <= FACES_MAX {
            told = write_step(to, world, step, &mut seen);
        }
    });
    told.map(|()| world.mesh)
}

/// Builds the panels of a torn mesh as those of a garment, and sews them vertex by vertex.
fn write_sewing(to: &mut impl Write, torn: &Mesh) -> std::io::Result<()> {
    if torn.face_count() > FACES_MAX {
        return Ok(());
    }
    let (triangles, roots) = (torn.indices().as_chunks().0, torn.roots());
    let mut mesh = Mesh::build_torn(triangles, &roots).expect("what scripts left can be sewn");
    writeln!(to, "script")?;
    write_state(to, &mesh)?;
    let copy = |mesh: &Mesh| mesh.vertices().find(|&v| mesh.root(v) != v);
    while let Some(gone) = copy(&mesh) {
        let kept = mesh.root(gone);
        let merge = mend::merge(&mut mesh, kept, gone, [1.0; 2], &mut Edits::new()).is_ok();
        assert!(merge, "copies have one root");
        writeln!(to, "merge {} {}", kept.index(), gone.index())?;
        write_state(to, &mesh)?;
    }
    Ok(())
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
            Edit::Insert(_) => write!(to, "insert{}", place(step))?,
            Edit::Slide(_) => continue,
            _ => unreachable!("there is no other edit"),
        }
        writeln!(to)?;
    }
    *seen = world.edits.cursor().number();
    write_refusal(to, step)?;
    write_state(to, mesh)
}

fn write_state(to: &mut impl Write, mesh: &Mesh) -> std::io::Result<()> {
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

/// Where a plan puts its point, if it has one alone; the model has no plan of several.
fn place(step: &Step<'_>) -> String {
    let Step::Insert { plan, .. } = step else {
        return String::new();
    };
    match (plan.points(), plan.chords()) {
        (&[Point::Edge { h, .. }], []) => format!(" edge {}", h.index()),
        (&[Point::Face { f, .. }], []) => format!(" face {}", f.index()),
        _ => String::new(),
    }
}

/// A split that was refused, with the faces that were given; and a merge of vertices of two roots, or of one vertex.
fn write_refusal(to: &mut impl Write, step: &Step<'_>) -> std::io::Result<()> {
    match *step {
        Step::Split {
            vertex: v,
            faces,
            outcome: Err(_),
        } => {
            write!(to, "refused split {}", v.index())?;
            write_list(to, faces.iter().map(|f| f.index()))?;
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
