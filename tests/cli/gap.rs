//! `cut --gap`: lips stand apart, no face turns over, and nothing else changes. Files are read line by
//! line here, by nothing of ours.

use serde_json::Value;
use tearmesh::{Positions, shapes};
use tearmesh_cli::Exit;

use crate::harness::{Folder, file_of, files_in};
use crate::in_process::{Ran, in_memory};
use crate::plain::{Plain, pieces};
use crate::random::Random;
use crate::support::cases::stride;
use crate::vectors::{cross, dot, length, minus};

/// A file as its lines have it: where each `v` says that it is, where the record says so, and faces.
struct Apart {
    shown: Vec<[f64; 3]>,
    is: Vec<[f64; 3]>,
    faces: Vec<Vec<usize>>,
}

impl Apart {
    fn read(bytes: &[u8]) -> Apart {
        let text = std::str::from_utf8(bytes).expect("text");
        let plain = Plain::read(text);
        let shown: Vec<_> = (0..plain.vertices.len()).map(|v| plain.at(v)).collect();
        let items = |name: &str| -> Vec<Vec<f64>> {
            let items = text.lines().filter_map(|line| line.strip_prefix(name));
            let numbers = items.map(|item| item.split(' ').map(|x| x.parse().expect("a number")));
            numbers.map(Iterator::collect).collect()
        };
        let mut is = shown.clone();
        for item in items("#~ apart ") {
            let v = item[0] as usize - 1;
            assert_eq!(shown[v], item[4..7], "the record says what the file does");
            is[v] = [item[1], item[2], item[3]];
        }
        for item in items("#~ fan ") {
            is[item[0] as usize - 1] = is[item[1] as usize - 1];
        }
        let faces = plain.faces;
        Apart { shown, is, faces }
    }

    /// How many pieces there are where points that are equal to eight digits are one, and faces that
    /// share an edge one piece: as trimesh loads a file.
    fn welded_pieces(&self) -> usize {
        let key = |v: usize| self.shown[v].map(|x| (x * 1e8).round() as i64);
        let sides = self.faces.iter().map(|face| {
            let side = |i: usize| {
                let mut ends = [face[i], face[(i + 1) % 3]].map(key);
                ends.sort_unstable();
                ends
            };
            [0, 1, 2].map(side).to_vec()
        });
        let pieces = pieces(sides);
        (0..pieces.len()).filter(|&f| pieces[f] == f).count()
    }
}

/// Runs a command on a mesh in memory.
fn run(typed: &str, mesh: &[u8]) -> Ran {
    in_memory(typed.split(' '), mesh, false)
}

fn normal(face: &[usize], points: &[[f64; 3]]) -> [f64; 3] {
    let [a, b, c] = [0, 1, 2].map(|i| points[face[i]]);
    cross(minus(b, a), minus(c, a))
}

/// What was checked.
#[derive(Debug, Default)]
struct Counts {
    /// Whether all that lies at one place is joined in the meshes before they are cut.
    is_welded: bool,
    made: usize,
    divided: u64,
    moved: u64,
    clamped: u64,
    /// Second cuts.
    undone: u64,
}

/// A cut with a gap, against the same without: `second` is cut after it.
fn gapped_cut(name: &str, mesh: &[u8], cut: &str, (gap, second): (&str, &str), tally: &mut Counts) {
    let cut = format!("tearmesh cut - {cut}");
    let ran = run(&format!("{cut} -q -o -"), mesh);
    if ran.exit != Exit::Done {
        return;
    }
    let plain = ran.output;
    tally.made += 1;
    let line = format!("{cut} --gap {gap}");
    let ran = run(&format!("{line} -q -o -"), mesh);
    let (gapped, said) = (ran.output, ran.error);
    assert_eq!(ran.exit, Exit::Done, "{said}");
    let [report, other] = [&line, &cut].map(|line| -> Value {
        let report = run(&format!("{line} --format json"), mesh).output;
        serde_json::from_slice(&report).expect("JSON")
    });
    assert_eq!(
        report["mass"], other["mass"],
        "masses are of the true points"
    );
    assert_eq!(report["cuts"], other["cuts"]);
    let count = |name: &str| report["gap"][name].as_u64().expect("a count");
    let apart = report["gap"]["length"].as_f64().expect("a length");
    tally.moved += count("vertices_moved");
    tally.clamped += count("vertices_clamped");
    assert_eq!(
        said.contains("W-CUT-GAP"),
        count("vertices_clamped") > 0,
        "{said}"
    );

    // What the record says is what the mesh without a gap has; nothing is farther than half a gap,
    // and no face turns over.
    let (one, other) = (Apart::read(&gapped), Apart::read(&plain));
    let coordinates = one.is.as_flattened().iter();
    let rounding = 1e-12 * coordinates.fold(1.0, |most: f64, x| most.max(x.abs()));
    assert_eq!(
        (&one.is, &one.faces),
        (&other.shown, &other.faces),
        "{line}"
    );
    let pieces_moved = count("pieces_moved");
    let most = match pieces_moved {
        0 => apart / 2.0,
        // With their own lips, and those between others by more.
        more => apart * (more - 1) as f64,
    };
    let mut full = 0;
    for (is, shown) in one.is.iter().zip(&one.shown) {
        let far = length(minus(*is, *shown));
        assert!(far <= most + rounding, "{line}: {far}");
        full += u64::from((far - apart / 2.0).abs() <= 1e-9 * apart + rounding);
    }
    assert!(
        full + count("vertices_clamped") >= count("vertices_moved") || pieces_moved > 0,
        "{line}: {full}"
    );
    for face in &one.faces {
        let (before, after) = (normal(face, &one.is), normal(face, &one.shown));
        assert!(
            dot(before, after) > 0.0 || dot(before, before) == 0.0,
            "{line}: {face:?}"
        );
    }

    // Who joins what lies at one place finds the pieces that there are.
    let pieces = report["cuts"][0]["pieces"].as_u64().expect("a count");
    if tally.is_welded && count("vertices_clamped") == 0 {
        assert_eq!(one.welded_pieces() as u64, pieces, "{name} {line}");
        let before = report["cuts"][0]["pieces_before"]
            .as_u64()
            .expect("a count");
        tally.divided += u64::from(pieces > before);
        let glued = other.welded_pieces() as u64;
        assert!(
            pieces == before || glued < pieces,
            "without it they are joined"
        );
    }

    // Mended it is what it was; cut again, what the file without a gap is.
    let mut whole = Vec::new();
    for options in ["", " --simplify"] {
        let mend = format!("tearmesh mend -{options} -q -o -");
        let [one, other] = [&gapped, &plain].map(|bytes| run(&mend, bytes).output);
        assert!(one == other, "{name} {line}{options}");
        whole = one;
    }
    let miss = "tearmesh cut - --plane 1e9,0,0:1,0,0 --allow-miss -q -o -";
    assert!(whole == run(miss, mesh).output, "{name} {line}");
    let again = format!("tearmesh cut - {second} --gap 0 --allow-miss -q -o -");
    let [one, other] = [&gapped, &plain].map(|bytes| run(&again, bytes).output);
    assert!(one == other, "{name} {line}, then {second}");
    // One that says nothing of the gap leaves it open, where it is not cut across.
    let again = format!("tearmesh cut - {second} --allow-miss");
    let twice = run(&format!("{again} -q -o -"), &gapped).output;
    let both = Apart::read(&twice);
    assert_eq!(both.is, Apart::read(&other).shown);
    assert!(count("vertices_moved") == 0 || both.is != both.shown);
    // Undone, it leaves the first as it was.
    let report = run(&format!("{again} --format json"), &gapped).output;
    let report: Value = serde_json::from_slice(&report).expect("JSON");
    if report["cuts"][0]["splits"] != 0 {
        let undo = "tearmesh mend - --last 1 --simplify -q -o -";
        let [undone, first] = [&run(undo, &twice).output, &gapped].map(|bytes| Apart::read(bytes));
        let is_same = (undone.is, undone.faces) == (first.is, first.faces);
        assert!(is_same, "{name} {line}, then {second}");
        tally.undone += 1;
    }
}

/// Cuts at random: across and into sheets, a tube and quads, by all methods.
#[test]
fn gapped_cuts_change_nothing_but_what_is_seen() {
    let wanted = 200 / stride();
    let folder = Folder::new();
    let mut random = Random(17);
    let mut tally = Counts {
        is_welded: true,
        ..Counts::default()
    };
    for case in 0.. {
        if tally.made == wanted {
            break;
        }
        let name = ["flag", "sheet", "sleeve", "quilt"][case % 4];
        let mesh = folder.bytes(&format!("{name}.obj"));
        let mut x = || 2.0 * random.next() - 0.7;
        let mut point = || format!("{},{}", x(), x());
        let pair = |a: String, b: String| format!("--rays {a},9:0,0,-1 {b},9:0,0,-1");
        let (first, second) = (pair(point(), point()), pair(point(), point()));
        let second = second + ["", " --snap 0.3 --snap-move"][case / 2 % 2];
        let method = [
            "exact",
            "exact --snap 0",
            "exact --through",
            "exact --snap 0.3 --snap-move",
            "partition",
            "partition --through",
            "alternating",
        ][case / 4 % 7];
        let gap = ["4%", "10%", "0.003", "30%", "150%"][case / 3 % 5];
        let cut = format!("{first} --method {method}");
        gapped_cut(name, &mesh, &cut, (gap, &second), &mut tally);
    }
    let least = wanted as u64;
    assert!(5 * tally.divided > least && 4 * tally.clamped > least && tally.moved > 20 * least);
    assert!(2 * tally.undone > least, "{tally:?}");
}

/// Real files of up to 300 kB, where they are at hand, cut through and slit.
#[test]
fn real_files_with_a_gap_are_what_they_were() {
    let Some(folder) = std::env::var_os("TEARMESH_CORPUS") else {
        return;
    };
    let (mut tally, mut cuts) = (Counts::default(), 0);
    for path in files_in(folder.as_ref()) {
        let name = path.display().to_string();
        if !name.ends_with(".obj") || path.metadata().is_ok_and(|file| file.len() > 300_000) {
            continue;
        }
        let bytes = std::fs::read(&path).expect("a file");
        let checked = run("tearmesh check - --format json", &bytes);
        if checked.exit != Exit::Done {
            continue;
        }
        let report: Value = serde_json::from_slice(&checked.output).expect("JSON");
        let bounds = &report["mesh"]["bounds"];
        let at = |part: f64| -> Vec<f64> {
            let axis = |i: usize| {
                let [least, most] = ["min", "max"].map(|end| bounds[end][i].as_f64().expect("x"));
                least + (most - least) * part
            };
            (0..3).map(axis).collect()
        };
        let (low, middle, high) = (at(0.3), at(0.47), at(0.8));
        let (x, y, z) = (middle[0], middle[1], middle[2]);
        let plane = format!("--plane {x},{y},{z}:1,0.3,0.2");
        let across = format!("--plane {x},{y},{z}:-0.2,1,0.1");
        let (from, to, above) = (low[0], high[0], at(2.0)[2]);
        let slit = format!("--rays {from},{y},{above}:0,0,-1 {to},{y},{above}:0,0,-1");
        let partition = format!("{plane} --method partition");
        for (cut, gap) in [(plane, "5%"), (slit, "60%"), (partition, "5%")] {
            cuts += 1;
            if cuts % stride() == 0 {
                gapped_cut(&name, &bytes, &cut, (gap, &across), &mut tally);
            }
        }
    }
    assert!(tally.made > 40 / stride());
}

/// Grids with random diagonals are cut through. Each piece is congruent to what it was, and both are
/// apart by the gap, square to the cut.
#[test]
fn pieces_that_part_wholly_move_as_they_are() {
    let folder = Folder::new();
    let mut random = Random(5);
    for case in 0..30 {
        let n = 3 + case % 8;
        let (mesh, square) =
            shapes::grid_with_diagonals(n as u32, n as u32, |_, _| random.next() < 0.5);
        let points = square.as_slice().iter().map(|p| p * n as f64);
        let positions = Positions::new(points).expect("small");
        folder.write("grid.obj", file_of(&(mesh, positions)));
        let middle = n as f64 * (0.3 + 0.4 * random.next());
        let [x, y] = [random.next() - 0.5, random.next() - 0.5];
        let plane = format!(
            "--plane {middle},{middle},0:{x},{y},0 --snap {}",
            [0.0, 0.05][case % 2]
        );
        let gap = [0.01, 0.3, 50.0][case % 3];
        let line = format!("tearmesh cut grid.obj {plane} --gap {gap}");
        let text = folder.done(&format!("{line} -o cut.obj"));
        assert!(
            text.contains(&format!("gap: 2 pieces moved apart by {gap}")),
            "{text}"
        );
        let plain = Apart::read(&folder.bytes("cut.obj"));
        let size = n as f64 + gap;
        let far = |points: &[[f64; 3]], a: usize, b: usize| length(minus(points[b], points[a]));
        for face in &plain.faces {
            for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (face[i], face[j])) {
                let [is, shown] = [&plain.is, &plain.shown].map(|points| far(points, a, b));
                assert!((is - shown).abs() <= 1e-12 * size, "{line}: {is} {shown}");
            }
        }
        // Each vertex of the seam and its copy.
        let mut apart = 0;
        let norm = (x * x + y * y).sqrt();
        for a in 0..plain.is.len() {
            for b in a + 1..plain.is.len() {
                if plain.is[a] != plain.is[b] {
                    continue;
                }
                let way = minus(plain.shown[b], plain.shown[a]);
                assert!((length(way) - gap).abs() <= 1e-12 * size, "{line}: {way:?}");
                let square = (way[0] * x + way[1] * y).abs() / norm;
                assert!(
                    square >= [1.0 - 1e-9, 0.99][case % 2] * gap,
                    "{line}: {way:?}"
                );
                apart += 1;
            }
        }
        assert!(apart > 1, "{line}");
        folder.done("mend cut.obj --simplify -q -o whole.obj");
        let [whole, grid] = ["whole.obj", "grid.obj"].map(|name| Apart::read(&folder.bytes(name)));
        assert_eq!(whole.shown, grid.shown, "{line}");
    }
}

/// Beside the hub of a fan, each face that is brought back would have all be looked at again. With a
/// square in it, the second file takes sixteen times as long as the first.
#[test]
fn a_gap_beside_a_hub_takes_time_linear_in_its_faces() {
    let folder = Folder::new();
    let seconds = |faces: u32| {
        let name = format!("fan{faces}.obj");
        let angles = (0..faces).map(|i| std::f64::consts::TAU * f64::from(i) / f64::from(faces));
        let rim = angles.map(|angle| format!("v {:.9} {:.9} 0\n", angle.cos(), angle.sin()));
        let next = |i: u32| (i + 1) % faces + 2;
        let triangles = (0..faces).map(|i| format!("f 1 {} {}\n", i + 2, next(i)));
        let text: String = rim.chain(triangles).collect();
        folder.write(&name, format!("v 0 0 0\n{text}"));
        let line = format!(
            "tearmesh cut {name} --rays -2,0.1,5:0,0,-1 0.9,0.1,5:0,0,-1 --gap 0.01 -o cut{name}"
        );
        let start = std::time::Instant::now();
        let text = folder.done(&line);
        assert!(
            text.contains("vertices along the cut moved apart by up to 0.01"),
            "{text}"
        );
        start.elapsed().as_secs_f64()
    };
    let [few, many] = [5_000, 20_000].map(|faces| seconds(faces).min(seconds(faces)));
    assert!(many < 9.0 * few, "{few} s, {many} s");
}
