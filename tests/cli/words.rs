//! What is said of cuts that split nothing: where it is cut already, where the mesh is only touched,
//! and advice that works when it is typed.

use tearmesh_cli::Exit;

use crate::in_process::{Case, in_memory};
use crate::support::cases::stride;

/// Two squares side by side, each of two faces.
const SQUARES: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n\
                       f 1 2 3\nf 1 3 4\nf 2 5 6\nf 2 6 3\n";

/// Every cut between two points of a lattice (every fourth without CI's time), some of which lie on corners and
/// edges and some within the snap of them; and each of them twice.
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
                if cases % stride() != 0 {
                    continue;
                }
                let bytes = format!("{rays}|--snap={snap}\n{SQUARES}");
                if Case::from_bytes(bytes.as_bytes()).check() != Exit::Done {
                    continue;
                }
                let cut = format!("tearmesh cut - {rays} --snap={snap}");
                let torn = in_memory(cut.split(' '), SQUARES.as_bytes(), false).output;
                let ran = in_memory(cut.split(' '), &torn, false);
                if ran.exit == Exit::Done {
                    continue; // A seam that was snapped is not where the plane is.
                }
                let said = ran.error;
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
    assert!(twice > 100 / stride());
}

#[test]
fn a_terminal_is_told_that_no_mesh_is_written() {
    for (meant, terminal, begins) in [
        ("", true, "cut: "),
        (" --dry-run", true, "cut: "),
        (" --format json", true, "{"),
        (" -o -", true, "v "),
        // A pipe takes the mesh.
        ("", false, "v "),
    ] {
        let cut = format!("tearmesh cut - --plane 0.5,0,0:1,0,0{meant}");
        let ran = in_memory(cut.split(' '), SQUARES.as_bytes(), terminal);
        let is_told = ran.error.contains("W-OUTPUT-NONE");
        assert_eq!(ran.exit, Exit::Done);
        assert_eq!(is_told, meant.is_empty() && terminal);
        assert!(ran.output.starts_with(begins.as_bytes()), "{meant}");
    }
}
