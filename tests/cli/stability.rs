//! `chart stability`: nothing differs from what is expected, and nothing fails without a word.

use crate::harness::{Folder, seen};

#[test]
fn nothing_differs_and_nothing_fails_without_a_word() {
    let folder = Folder::new();
    let line = "tearmesh chart stability --stiffness 1000 -o s.svg --csv s.csv --json s.json";
    let output = folder.run(line);
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains("66 limits and scenes, some ") && said.contains("wrote s.svg, s.csv, s.json"),
        "{said}"
    );
    assert!(
        said.contains("0 differ from what is expected, 0 failed without a word"),
        "{said}"
    );
    let report: serde_json::Value = serde_json::from_str(&folder.read("s.json")).expect("JSON");
    assert_eq!(report["schema"], "tearmesh.chart.stability/1");
    let command = "tearmesh chart stability --stiffness 1000";
    assert_eq!(report["provenance"]["command"], command);

    // Each way to fail has its code.
    let codes = |scene: &str, method: &str| {
        let verdicts = report["verdicts"].as_array().expect("verdicts").iter();
        let mut of = verdicts.filter(|one| one["trial"] == scene && one["method"] == method);
        let told = of.next().expect("a verdict")["told"]
            .as_array()
            .expect("told");
        let codes = told
            .iter()
            .map(|told| told["code"].as_str().expect("a code"));
        codes.map(str::to_owned).collect::<Vec<_>>()
    };
    for (scene, method, code) in [
        ("hang", "xpbd", "W-SIM-SOFT"),
        ("hang", "pbd", "W-SIM-RIGID"),
        ("long steps", "pbd", "W-SIM-COARSE"),
        ("long steps", "verlet", "E-SIM-UNSTABLE"),
        ("short steps", "pbd", "W-SIM-RIGID"),
        ("ringing", "implicit", "W-SIM-DAMPED"),
        ("crushed", "provot", "W-SIM-ENERGY"),
        ("compression", "implicit", "E-SIM-UNSOLVED"),
        ("wind", "implicit", "E-SIM-UNSTABLE"),
        ("too far apart", "provot", "W-SIM-LIMIT"),
    ] {
        let codes = codes(scene, method);
        assert!(
            codes.iter().any(|said| said == code),
            "{scene}, {method}: {codes:?}"
        );
    }
    assert_eq!(codes("short steps", "verlet"), Vec::<String>::new());

    let table = folder.read("s.csv");
    for line in [
        "\nlimit,halved,1e3,RK4,",
        "\nstep,sheet,1e3,PBD,1000,",
        "\nscene,wind,,provot,",
    ] {
        assert!(table.contains(line), "no {line}");
    }
    let chart = folder.read("s.svg");
    assert!(
        chart.starts_with("<svg ") && chart.contains("W-SIM-ENERGY") && chart.contains(command)
    );
}

#[test]
fn a_stiffness_that_is_none_is_refused() {
    let folder = Folder::new();
    for given in ["0", "-1", "nan", "1e10", "much"] {
        let said = seen(&folder.run(&format!(
            "tearmesh chart stability --stiffness={given} -o s.svg"
        )));
        assert!(said.ends_with("(exit 2)\n"), "{given}\n{said}");
    }
}
