//! `chart plane`: the cheapest method by stiffness and mass ratio.

use crate::harness::{Folder, seen};

#[test]
fn a_small_plane_is_drawn_with_its_table_and_its_figures() {
    let folder = Folder::new();
    let options =
        "--stiffness 1000,10000 --ratio 1,0.01 --method verlet,xpbd-1 --size 4 --cost-max 16";
    let line = format!("tearmesh chart plane {options} -o p.svg --csv p.csv --json p.json");
    let output = folder.run(&line);
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    for words in [
        " runs, some ",
        "the largest mean force at the holds within 5 %\n",
        "of 4 places: ",
        "at ratio 1e-2, against Verlet: ",
        "wrote p.svg, p.csv, p.json",
    ] {
        assert!(said.contains(words), "{words}\n{said}");
    }
    let report: serde_json::Value = serde_json::from_str(&folder.read("p.json")).expect("JSON");
    assert_eq!(report["schema"], "tearmesh.chart.plane/1");
    let command = format!("tearmesh chart plane {options}");
    assert_eq!(report["provenance"]["command"], command);
    let places = report["places"].as_array().expect("places");
    assert_eq!(places.len(), 4);
    for place in places {
        assert_eq!(place["answers"].as_array().map(Vec::len), Some(2));
    }
    let table = folder.read("p.csv");
    for line in ["\nanswer,1e3,1e0,Verlet,", "\nrun,1e4,1e-2,XPBD,xpbd-1@2,"] {
        assert!(table.contains(line), "no {line}");
    }
    let chart = folder.read("p.svg");
    assert!(chart.starts_with("<svg ") && chart.contains("displacements within 1 %"));
}

#[test]
fn a_place_that_is_none_is_refused() {
    let folder = Folder::new();
    for option in [
        "--ratio=0",
        "--ratio=2",
        "--stiffness=0",
        "--method=magic",
        "--cost-max=0.5",
    ] {
        let said = seen(&folder.run(&format!("tearmesh chart plane {option} -o p.svg")));
        assert!(said.ends_with("(exit 2)\n"), "{option}\n{said}");
    }
}
