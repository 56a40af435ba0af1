//! Cuts of scripts go where their words say, and unsewn shapes have the seams that they name.

use tearmesh::CutMethod;
use tearmesh::script::{Script, Step, World};
use tearmesh::unsewn::UnsewnSeams;

use crate::lockstep;

/// The world that a script leaves, after its steps were checked.
fn run(text: &str) -> World {
    let script: Script = text.parse().expect("a script");
    lockstep::check(&script);
    script.run(|_, _| {})
}

fn pieces(text: &str) -> usize {
    run(text).mesh.components().count()
}

/// The polyline runs round the middle of a sheet.
const SLIT: &str = "grid 5 5 0
    cut exact eye 0 0 120 -30 -30 0 30 -25 0
    cut exact continued 0 0 120 28 30 0
    cut exact continued 0 0 120 -25 28 0";

#[test]
fn a_closed_polyline_cuts_out_a_piece() {
    assert_eq!(pieces(SLIT), 1, "a slit");
    assert_eq!(pieces(&format!("{SLIT}\ncut exact closed")), 2);
    // A cut between two rays begins another polyline, which one by a plane has not.
    let other = "cut exact eye 0 0 120 -50 -50 0 -45 -50 0\ncut exact closed";
    assert_eq!(pieces(&format!("{SLIT}\n{other}")), 1);
    let world = run(&format!("{SLIT}\ncut exact plane 64 0 0 1 0 0"));
    assert_eq!(world.polyline, None);
}

#[test]
fn an_end_of_a_polyline_follows_what_is_done_between_two_cuts() {
    let lines: Vec<&str> = SLIT.lines().collect();
    let (first, rest) = (lines[..2].join("\n"), lines[2..].join("\n"));
    let polyline = run(&first).polyline.expect("a cut between rays");
    let [end] = polyline[1].vertices() else {
        panic!("the cut ends at one vertex");
    };
    let end = end.index();
    for between in [
        format!("slide {end} 1 8"),
        format!("split {end} 0b1"),
        format!("split {end} 0b1\nslide {end} 0 8\nclear\nmerge 2 1 1 1"),
    ] {
        let text = format!("{first}\n{between}\n{rest}\ncut exact closed");
        assert_eq!(pieces(&text), 2, "{between}");
    }
}

/// What spans no plane, and what has nothing to go on from, changes nothing.
#[test]
fn cuts_that_have_no_plane_do_nothing() {
    for cut in [
        "continued 0 0 100 0 0 0",
        "closed",
        "plane 0 0 0 0 0 0",
        "eye 0 0 100 0 0 0 0 0 0",
        "eye 0 0 0 0 0 0 1 0 0",
        "parallel 0 0 0 1 0 0 2 0 0",
        "converging 0 0 9 0 0 9 0 0 0",
        "skew 0 0 9 0 0 0 0 0 9 0 0 0",
    ] {
        let script: Script = format!("grid 2 2 0\ncut exact {cut}").parse().expect(cut);
        let mut steps = 0;
        script.run(|_, step| {
            assert!(
                matches!(step, Step::Built | Step::Nothing),
                "{cut}: {step:?}"
            );
            steps += 1;
        });
        assert_eq!(steps, 2, "{cut}");
    }
}

/// Rays of one eye have that in both side planes, and those that converge the point where they meet.
#[test]
fn rays_are_related_as_their_words_say() {
    let mut seen = 0;
    for far in ["", "far 3 ", "far 20 "] {
        for (path, is_one) in [
            ("eye 10 20 90 -30 5 0 30 7 0", true),
            ("converging -60 0 90 70 3 90 8 9 0", false),
            ("parallel 3 5 -40 -30 5 0 30 7 0", false),
        ] {
            let text = format!("tube 5 2\ncut exact {far}{path}");
            let script: Script = text.parse().expect(path);
            script.run(|_, step| {
                if let Step::Cut {
                    scissor, settings, ..
                } = step
                {
                    assert_eq!(settings.method, CutMethod::Exact);
                    assert!(scissor.skew() < 1e-9, "{text} is of one plane");
                    let [a, b] = scissor.sides().expect("rays").map(|side| side.point());
                    assert_eq!(a == b, is_one, "{text}");
                    seen += 1;
                }
            });
        }
    }
    assert_eq!(seen, 9);
}

#[test]
fn unsewn_shapes_have_seams_that_coincide() {
    for (faces, pieces, seams) in [
        ("0b0", 1, 0),
        ("0b11", 2, 2),
        ("0b10101010", 6, 6),
        ("0b11111111", 1, 0),
    ] {
        let World {
            mesh, positions, ..
        } = run(&format!("unsewn {faces} grid 2 2 0b0110"));
        assert_eq!(mesh.components().count(), pieces, "{faces}");
        let found = UnsewnSeams::find(&mesh, &positions);
        assert_eq!(found.edges().len(), seams, "{faces}");
        let is_torn = mesh.half_edges().any(|h| mesh.ghost_pair(h).is_some());
        assert!(!is_torn, "{faces}: nothing is known of the seams");
    }
}

/// A cut along which seams are closed crosses them as if they were tears: both sides get the same points.
#[test]
fn cuts_across_unsewn_seams_keep_them_closed() {
    let sheet = "unsewn 0b110101 grid 3 2 0b10";
    let cut = "cut exact snap 0 seams skew -100 -13 90 -100 -13 0 100 17 90 100 17 0";
    let [before, after] = [sheet, &format!("{sheet}\n{cut}")].map(|text| {
        let world = run(text);
        UnsewnSeams::find(&world.mesh, &world.positions)
    });
    assert!(
        after.edges().len() > before.edges().len(),
        "it crosses seams"
    );
    // The outline of the sheet, and two points on it.
    let outline = |seams: &UnsewnSeams| seams.boundary_edges() - 2 * seams.edges().len();
    assert_eq!((outline(&before), outline(&after)), (10, 12));
}
