//! `cut` with its seam written, and in small units far away.

use std::collections::BTreeSet;

use crate::harness::Folder;
use crate::plain::Plain;

/// Two sheets of squares, 1 and 0 high.
const SHEETS: &str = include_str!("sheets.obj");

#[test]
fn the_seam_is_written_as_lines() {
    let folder = Folder::new();
    folder.write("sheets.obj", SHEETS);
    let line = "tearmesh cut sheets.obj --rays 0.5,1.4,9:0,0,-1 3.1,2.3,9:0,0,-1 \
                --rays 2.2,-1,9:0,0,-1 2.4,9,9:0,0,-1 --seam seam.obj -o cut.obj";
    let report = folder.report(line);
    let text = folder.read("seam.obj");
    let begun = |begin| text.lines().filter(move |line| line.starts_with(begin));
    assert_eq!(begun("o ").count(), 2);
    let seam = Plain::read(&text);
    // Two slits, and two cuts across that the slits divide.
    assert_eq!(seam.lines.len(), 2 + 4);
    let length = |[a, b]: [usize; 2]| {
        let off = [0, 1, 2].map(|i| seam.vertices[b][i] - seam.vertices[a][i]);
        off.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    let edges = seam
        .lines
        .iter()
        .flat_map(|line| line.windows(2).map(|two| [two[0], two[1]]));
    let sum: f64 = edges.map(length).sum();
    let cuts = report["cuts"].as_array().expect("cuts").iter();
    let told: f64 = cuts
        .map(|cut| cut["seam_length"].as_f64().expect("a length"))
        .sum();
    assert!((sum - told).abs() < 1e-9, "{sum} and {told}");
    // Every point is a vertex of the mesh, to the letter.
    let mesh = folder.read("cut.obj");
    let vertices: BTreeSet<&str> = mesh.lines().filter(|line| line.starts_with("v ")).collect();
    assert!(begun("v ").all(|v| vertices.contains(v)));
    // Read as it is written: a sphere cut in two has one line, which goes round.
    let ball = "tearmesh cut ball.obj --plane 0,0,0.01:0,0.1,1 --seam round.obj -o half.obj";
    let vertices = "v 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n";
    let sides = [[1, 2], [2, 3], [3, 4], [4, 1]];
    let faces = sides.map(|[a, b]| format!("f {a} {b} 5\nf {b} {a} 6\n"));
    folder.write("ball.obj", vertices.to_owned() + &faces.concat());
    assert_eq!(folder.report(ball)["cuts"][0]["pieces"], 2);
    let round = Plain::read(&folder.read("round.obj")).lines;
    assert_eq!((round.len(), round[0].first()), (1, round[0].last()));
}

/// A sheet of one millimetre, wherever it lies: an inserted vertex is as far off the surface as its
/// coordinates are rounded, and the check of the area knows that.
#[test]
fn a_small_sheet_far_from_the_origin_is_cut() {
    let folder = Folder::new();
    for far in [0.0, 1e3, 1e5, 1e6, 1e7] {
        let mut sheet = String::new();
        for (x, y) in (0..121).map(|i| (f64::from(i % 11), f64::from(i / 11))) {
            let z = 3e-4 * (1.7 * x + 0.9 * y).sin();
            sheet += &format!("v {} {} {}\n", far + 1e-4 * x, far + 1e-4 * y, far + z);
        }
        for a in (0..110).filter(|i| i % 11 < 10).map(|i| i + 1) {
            let [b, c, d] = [a + 1, a + 11, a + 12];
            sheet += &format!("f {a} {b} {c}\nf {b} {d} {c}\n");
        }
        folder.write("sheet.obj", sheet);
        for slope in 0..20 {
            let [y0, y1] = [3.3, 7.1 - 0.3 * f64::from(slope)].map(|y| far + 1e-4 * y);
            let [x0, x1, z] = [far + 1e-4, far + 9e-4, far + 5.0];
            let rays = format!("{x0},{y0},{z}:0,0,-1 {x1},{y1},{z}:0,0,-1");
            folder.done(&format!("cut sheet.obj --rays {rays} --dry-run"));
        }
    }
}
