//! What is said of cuts that split nothing: where it is cut already, where the mesh is only touched,
//! and advice that works when it is typed.

use tearmesh_cli::Exit;

use crate::harness::{Folder, in_memory, seen};
use crate::in_process::Case;

/// Two squares side by side, each of two faces.
const SQUARES: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n\
                       f 1 2 3\nf 1 3 4\nf 2 5 6\nf 2 6 3\n";

#[test]
fn regression_a_second_cut_in_the_same_place_is_told_that_it_is_cut() {
    let folder = Folder::new();
    folder.write("squares.obj", SQUARES);
    let along = "--rays 1,2,5:0,0,-1 1,-1,5:0,0,-1";
    let across = "--rays 0.31,2,5:0,0,-1 0.25,-2,5:0,0,-1";
    for (mesh, first, again) in [
        ("squares.obj", along.to_owned(), along.to_owned()),
        ("squares.obj", along.to_owned(), format!("{along} --snap 0")),
        (
            "squares.obj",
            along.to_owned(),
            format!("{along} --through"),
        ),
        ("flag.obj", across.to_owned(), across.to_owned()),
        ("flag.obj", across.to_owned(), format!("{across} --snap 0")),
        (
            "flag.obj",
            format!("{across} --method partition"),
            format!("{across} --method partition"),
        ),
        (
            "sheet.obj",
            "--rays 0.3,0.8,5:0,0,-1 0.3,0.2,5:0,0,-1".to_owned(),
            "--rays 0.3,0.7,5:0,0,-1 0.3,0.3,5:0,0,-1".to_owned(),
        ),
    ] {
        let output = folder.run(&format!("tearmesh cut {mesh} {first} -o torn.obj"));
        assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
        let said = seen(&folder.run(&format!("tearmesh cut torn.obj {again} -o twice.obj")));
        // A straight slit through a snapped seam may have something left to cut.
        if said.ends_with("(exit 1)\n") {
            assert!(said.contains("it is already cut there. twice"), "{said}");
        } else {
            assert!(mesh == "sheet.obj", "{again}: {said}");
        }
    }
    let said = seen(&folder.run(&format!(
        "tearmesh cut squares.obj {along} {along} -o torn.obj"
    )));
    assert!(
        said.contains("cut 2: no face lies between the rays: it is"),
        "{said}"
    );
}

#[test]
fn a_cut_beside_the_seam_is_not_told_that_it_is_cut() {
    let cut = "tearmesh cut - --rays 0.5,2,5:0,0,-1 0.5,-1,5:0,0,-1";
    let (_, torn, _) = in_memory(cut, SQUARES.as_bytes(), false);
    let (exit, _, said) = in_memory(cut, &torn, false);
    assert_eq!(exit, Exit::NothingCut);
    assert!(said.contains("it is already cut there"), "{said}");
    let beside = "tearmesh cut - --rays 0.5,5,5:0,0,-1 0.5,4,5:0,0,-1";
    let (exit, _, said) = in_memory(beside, &torn, false);
    assert_eq!(exit, Exit::NothingCut);
    assert!(
        !said.contains("already cut") && said.contains("nearest"),
        "{said}"
    );
    // The seam's faces lie on both sides of this one, but the seam is further off than the snap.
    let cut = "tearmesh cut - --rays 0.4,2,5:0,0,-1 0.4,-1,5:0,0,-1";
    let (_, torn, _) = in_memory(cut, SQUARES.as_bytes(), false);
    let short = "tearmesh cut - --rays 0.5,0.7,5:0,0,-1 0.5,0.72,5:0,0,-1";
    let (exit, _, said) = in_memory(short, &torn, false);
    assert_eq!(exit, Exit::NothingCut);
    assert!(said.contains("shorter than the snap"), "{said}");
}

#[test]
fn regression_what_is_only_touched_is_not_0_away() {
    let folder = Folder::new();
    folder.write("squares.obj", SQUARES);
    for rays in [
        "0,2,5:0,0,-1 0,-1,5:0,0,-1",
        "0,0,5:0,0,-1 -1,-1,5:0,0,-1",
        "-1,1,5:0,0,-1 1,-1,5:0,0,-1",
    ] {
        for snap in ["0", "0.05"] {
            let line = format!("tearmesh cut squares.obj --rays {rays} --snap {snap} -o x.obj");
            let said = seen(&folder.run(&line));
            assert!(said.contains("only touches the mesh. x.obj not"), "{said}");
        }
    }
}

/// Every cut between two points of a lattice, some of which lie on corners and edges and some within
/// the snap of them; and each of them twice.
#[test]
fn cuts_on_a_lattice_say_what_is_so() {
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
    println!("{cases} cuts, {twice} of them made twice");
    assert!(twice > 100);
}

#[test]
fn on_a_terminal_it_is_said_first_that_no_mesh_will_be_written() {
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
    let cut = "tearmesh cut bad.obj --plane 0,0,0:0,1,0";
    let answer = |options: &str| {
        let output = folder.run(&format!("{cut} {options}"));
        assert_eq!(output.status.code(), Some(3));
        let said = String::from_utf8([output.stderr, output.stdout].concat());
        said.expect("text")
    };
    let blocks = |said: &str| said.matches("error[E-MESH-EDGE]").count();
    let few = answer("");
    assert_eq!(blocks(&few), 3, "{few}");
    assert_eq!(
        few.matches("and 6 more of E-MESH-EDGE; -v shows all\n")
            .count(),
        1,
        "{few}"
    );
    // What tells of all stands at the last one.
    assert!(few.contains("or add --repair"), "{few}");
    let all = answer("-v");
    assert_eq!(
        (blocks(&all), all.matches(" more of ").count()),
        (9, 0),
        "{all}"
    );
    let report = answer("--format json");
    assert_eq!(
        report.matches("\"code\": \"E-MESH-EDGE\"").count(),
        9,
        "{report}"
    );
}
