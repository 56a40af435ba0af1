//! Frames: which of their numbers stay, how many there are a second, and what an interruption
//! leaves of them.

use std::fs;

#[cfg(unix)]
use crate::harness::interrupted_at;
use crate::harness::{Folder, seen};

/// The number of vertices of a frame, and the vertex of each corner, from 1.
fn corners(text: &str) -> (usize, Vec<usize>) {
    let vertices = text.lines().filter(|line| line.starts_with("v ")).count();
    let faces = text.lines().filter_map(|line| line.strip_prefix("f "));
    let words = faces.flat_map(str::split_whitespace);
    let indices = words.map(|word| word.split('/').next().expect("an index"));
    let indices = indices.map(|index| index.parse().expect("a vertex"));
    (vertices, indices.collect())
}

fn count(folder: &Folder, name: &str) -> usize {
    let frames = fs::read_dir(folder.path(name)).expect("a folder of frames");
    frames.count()
}

/// Whoever follows a vertex by its number through the frames follows one vertex.
#[test]
fn a_corner_of_a_frame_changes_only_to_a_vertex_that_is_new_in_it() {
    let folder = Folder::new();
    let output = folder.run("tearmesh tear sheet.obj --scene rip --frames f -q -o torn.obj");
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    let (mut moved, mut reused) = (0, 0);
    let mut before = corners(&folder.read("f/frame_00000.obj"));
    for number in 1..count(&folder, "f") {
        let now = corners(&folder.read(&format!("f/frame_{number:05}.obj")));
        assert!(now.0 >= before.0, "frame {number} has lost vertices");
        for (was, is) in before.1.iter().zip(&now.1).filter(|(was, is)| was != is) {
            moved += 1;
            reused += usize::from(*is <= before.0);
            assert_ne!(was, is);
        }
        before = now;
    }
    assert!(moved > 100, "{moved}");
    assert_eq!(
        reused, 0,
        "corners of {moved} moved to a vertex that was another"
    );
}

#[test]
fn steps_longer_than_a_frame_are_warned_of() {
    let folder = Folder::new();
    let line = "tearmesh tear flag.obj --scene hang --solver pbd --seconds 1 --frames";
    for (name, dt_s, frames, is_warned) in [("few", 0.1, 11, true), ("all", 0.025, 31, false)] {
        let output = folder.run(&format!("{line} {name} --dt {dt_s} -o {name}.obj"));
        assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
        assert_eq!(count(&folder, name), frames);
        let said = seen(&output);
        assert_eq!(said.contains("W-FRAMES-FEW"), is_warned, "{said}");
        assert_eq!(said.contains("10 frames per second"), is_warned, "{said}");
    }
}

/// The frames with the faces of the last one are written at the end, and take their time.
#[cfg(unix)]
#[test]
fn a_simulation_is_saved_when_the_writing_of_its_frames_is_interrupted() {
    let folder = Folder::new();
    let line = "tear flag.obj --scene hang --solver pbd --dt 0.033 --seconds 20 --frames f \
                --frames-topology final -o saved.obj --report r.json";
    let mut command = folder.command();
    command.args(line.split_whitespace());
    let output = interrupted_at(&mut command, &folder.path("f/frame_00002.obj"));
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(130), "{said}");
    let frames = count(&folder, "f");
    assert!((3..600).contains(&frames), "{frames} frames");
    assert!(folder.path("saved.obj").exists(), "no mesh; said: {said}");
    assert!(said.contains("wrote saved.obj"), "{said}");
    let missing = format!("{frames} of 601 frames");
    assert!(
        said.contains("W-FRAMES-INTERRUPTED") && said.contains(&missing),
        "{said}"
    );
    let report: serde_json::Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    assert_eq!(report["status"], "done");
    assert_eq!(report["exit"], 130);
    assert_eq!(report["frames"]["count"], frames);
    assert!(corners(&folder.read("saved.obj")).0 >= 1089);
}
