//! What is said of cuts that split nothing: where it is cut already, where the mesh is only touched,
//! and advice that works when it is typed.

use tearmesh_cli::Exit;

use crate::harness::{Folder, in_memory};
use crate::in_process::Case;

/// Two squares side by side, each of two faces.
const SQUARES: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n\
                       f 1 2 3\nf 1 3 4\nf 2 5 6\nf 2 6 3\n";

/// Every cut between two points of a lattice, some of which lie on corners and edges and some within
/// the snap of them; and each of them twice.
#[test]
fn cuts_on_a_lattice_are_told_as_they_are() {
    let (xs, ys) = ([-0.5, 0.0, 0.02, 0.5, 1.0, 2.5], [-0.5, 0.0, 0.3, 1.0]);
    let points: Vec<_> = xs.iter().flat_map(|x| ys.map(|y| (*x, y))).collect();
    let (mut cases, mut twice) = (0, 0);
    for snap in ["0", "0.05", "0.3"] {
        for (i, (ax, ay)) in points.iter().enumerate() {
            for (bx, by) in &points[i + 1..] {
                let rays = format!("--rays={ax},{ay},5:0,0,-1;{bx},{by},5:0,0,-1");
                cases += 1;
                let bytes = format!("{rays}|--snap={snap}\n{SQUARES}");
                if Case::from_bytes(bytes.as_bytes()).check() != Exit::Done {
                    continue;
                }
                let cut = format!("tearmesh cut - {rays} --snap={snap}");
                let (_, torn, _) = in_memory(&cut, SQUARES.as_bytes(), false);
                let (exit, _, said) = in_memory(&cut, &torn, false);
                if exit == Exit::Done {
                    continue; // A seam that was snapped is not where the plane is.
                }
                twice += 1;
                let is_said = said.contains("it is already cut there");
                let is_advised = said.contains("use --snap 0");
                assert!(is_said || is_advised, "{cases}: {cut}\n{said}");
                let mut again = format!("{rays}|--snap={snap}\n").into_bytes();
                again.extend(torn);
                Case::from_bytes(&again).check();
            }
        }
    }
    assert!(twice > 100);
}

#[test]
fn a_terminal_is_told_that_no_mesh_is_written() {
    let cut = "tearmesh cut - --plane 0.5,0,0:1,0,0";
    let (exit, output, said) = in_memory(cut, SQUARES.as_bytes(), true);
    assert_eq!(exit, Exit::Done);
    assert!(said.contains("W-OUTPUT-NONE"), "{said}");
    assert!(output.starts_with(b"cut: "), "words, and no mesh");
    for meant in ["--dry-run", "--format json", "-o -"] {
        let (_, _, said) = in_memory(&format!("{cut} {meant}"), SQUARES.as_bytes(), true);
        assert!(!said.contains("W-OUTPUT-NONE"), "{meant}: {said}");
    }
    let (_, output, said) = in_memory(cut, SQUARES.as_bytes(), false);
    assert!(
        !said.contains("W-OUTPUT-NONE") && output.starts_with(b"v "),
        "a pipe takes the mesh"
    );
}

/// A bad mesh floods no terminal: what is said of it is still there for those who ask.
#[test]
fn three_of_a_kind_are_shown_and_all_are_reported() {
    let folder = Folder::new();
    let mut mesh = String::new();
    for i in 0..9 {
        let [a, b, c, d, e] = [1, 2, 3, 4, 5].map(|corner| 5 * i + corner);
        mesh += &format!("v {i} 0 0\nv {i} 1 0\nv {i} 0 1\nv {i} 0 2\nv {i} 0 3\n");
        mesh += &format!("f {a} {b} {c}\nf {a} {b} {d}\nf {a} {b} {e}\n");
    }
    folder.write("bad.obj", &mesh);
    let answer = |options: &str| {
        let cut = "cut bad.obj --plane 0,0,0:0,1,0";
        folder.ends(&format!("{cut} {options}"), 3)
    };
    let few = answer("");
    let all = answer("-v");
    let report = answer("--format json");
    for (said, part, count) in [
        (&few, "error[E-MESH-EDGE]", 3),
        (&few, "and 6 more of E-MESH-EDGE; -v shows all\n", 1),
        // What tells of all stands at the last one.
        (&few, "or add --repair", 1),
        (&all, "error[E-MESH-EDGE]", 9),
        (&all, " more of ", 0),
        (&report, "\"code\": \"E-MESH-EDGE\"", 9),
    ] {
        assert_eq!(said.matches(part).count(), count, "{said}");
    }
}
