//! Files that another program edited between a cut and its mending.

use crate::harness::Folder;
use crate::plain::Plain;

/// The text with this `v` for a vertex, which counts from 1.
fn moved(text: &str, vertex: usize, statement: &str) -> String {
    let is_v = |line: &&str| line.starts_with("v ");
    let old = text
        .lines()
        .filter(is_v)
        .nth(vertex - 1)
        .expect("the vertex");
    let start = old.as_ptr() as usize - text.as_ptr() as usize;
    [&text[..start], statement, &text[start + old.len()..]].concat()
}

/// The first numbers of the items of a record that begin so.
fn numbers(text: &str, begins: &[&str]) -> Vec<usize> {
    let of = |line: &str| {
        let item = begins.iter().find_map(|begin| line.strip_prefix(begin))?;
        item.split(' ').next()?.parse().ok()
    };
    text.lines().filter_map(of).collect()
}

/// A cut sheet, sewn but not simplified, and the vertices that are on record as inserted.
fn sewn(folder: &Folder) -> (String, Vec<usize>) {
    folder.done("cut sheet.obj --rays 0.3,2,5:0,0,-1 0.7,0.4,5:0,0,-1 -q -o torn.obj");
    folder.done("mend torn.obj -q -o sewn.obj");
    let text = folder.read("sewn.obj");
    let inserted = numbers(&text, &["#~ edge ", "#~ face "]);
    (text, inserted)
}

/// Runs a line, and fails unless the areas in its report are those of the files that it reads and writes, and the mass
/// is kept. Returns the two areas.
fn measured(folder: &Folder, line: &str) -> [f64; 2] {
    let report = folder.report(line);
    assert_eq!(report["mass"]["before"], report["mass"]["after"]);
    [("input", "before"), ("output", "after")].map(|(file, when)| {
        let name = report[file]["path"].as_str().expect("a name");
        let is = Plain::read(&folder.read(name)).area();
        let said = report["area"][when].as_f64().expect("an area");
        let off = (said - is).abs();
        assert!(
            off <= 1e-12 * is,
            "{line}: {said} is said of {name}, which has {is}"
        );
        is
    })
}

#[test]
fn regression_an_inserted_vertex_moved_since_is_kept() {
    let folder = Folder::new();
    let (text, inserted) = sewn(&folder);
    folder.write(
        "moved.obj",
        moved(&text, inserted[inserted.len() / 2], "v 0.5 0.5 0.25"),
    );
    let answer = folder.run("mend moved.obj --simplify --format json -o simple.obj");
    let report = answer.json();
    let mut said = report["diagnostics"].as_array().expect("a list").iter();
    assert!(said.any(|one| one["code"] == "W-MEND-EDITED"), "{report:#}");
    if answer.exit == 0 {
        assert!(folder.read("simple.obj").contains("v 0.5 0.5 0.25\n"));
    }
}

/// The two sides of a cut that stand apart meet halfway, and the sheet has another area then.
#[test]
fn regression_the_area_reported_is_of_sides_met_halfway() {
    let folder = Folder::new();
    let _sewn = sewn(&folder);
    let text = folder.read("torn.obj");
    let copy = numbers(&text, &["#~ split "])[0];
    folder.write("moved.obj", moved(&text, copy, "v 0.4 0.6 0.5"));
    for simplify in ["", "--simplify"] {
        measured(&folder, &format!("mend moved.obj {simplify} -o whole.obj"));
    }
}

/// Nothing at all can go, or only what is away from the edit: in any case the area is that of the file that is
/// written.
#[test]
fn the_area_reported_is_that_of_the_file_written() {
    let folder = Folder::new();
    let (_, inserted) = sewn(&folder);
    // Of a second cut, across the first, which still has to be sewn.
    folder.done("cut sewn.obj --rays 2,0.81,5:0,0,-1 -1,0.83,5:0,0,-1 -q -o twice.obj");
    let torn = folder.read("twice.obj");
    for vertex in inserted.iter().step_by(inserted.len() / 5) {
        folder.write("moved.obj", moved(&torn, *vertex, "v 0.4 0.6 0.3"));
        measured(&folder, "mend moved.obj --simplify -o simple.obj");
    }
}

/// With vertices that slid on a surface that is not flat, and with a gap that only the file shows.
#[test]
fn the_area_reported_of_a_cut_is_that_of_the_file() {
    let folder = Folder::new();
    let mut changed = 0;
    for options in ["", "--snap-move", "--gap 20%", "--snap-move --gap 20%"] {
        for name in ["flag", "sheet"] {
            let slit = "--rays 0.3,0.7,5:0,0,-1 0.7,0.41,5:0,0,-1 --snap 0.3";
            let [before, after] = measured(
                &folder,
                &format!("cut {name}.obj {slit} {options} -o torn.obj"),
            );
            changed += usize::from((after - before).abs() > 1e-7 * before);
            // Read and written again, it has the gap that it had.
            let miss = "cut torn.obj --plane 1e9,0,0:1,0,0 --allow-miss -o same.obj";
            let [torn, same] = measured(&folder, miss);
            assert_eq!(torn, same, "{name} {options}");
            let [_, whole] = measured(&folder, "mend torn.obj --simplify -o whole.obj");
            assert_eq!(whole, before, "{name} {options}");
        }
    }
    assert!(changed >= 5, "{changed}");
}
