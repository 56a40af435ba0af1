//! Cases with known answers, and the fronts of a record.

use std::fs;
use std::path::Path;

use tearmesh::Point;

use super::scene::{Held, Start, Until};
use super::*;
use crate::experiment::{conduct, workers};
use crate::reference::Reference;
use crate::sheet::Sheet;

const UNBOUNDED: Bounds<'static> = Bounds {
    clock: None,
    stop: &|| false,
};

/// A weight on a spring: ω = 20 rad/s for 0.6 s, pulled down by a tenth and let go.
fn oscillator() -> Case {
    let scene = Scene {
        name: "oscillator",
        about: "",
        stiffness_n_per_m: 40.0,
        side_m: 1.0,
        gravity_m_per_s2: [0.0; 3],
        drag_per_s: 0.0,
        middle_mass_ratio: 1.0,
        start: Start::Flat,
        held: Held::Top,
        until: Until::Time(SECONDS),
        observables: &[Observable::Displacement],
    };
    let mut case = Case::new(&scene, MeshKind::Grid, 2);
    case.sheet = Sheet {
        points: vec![Point::new(0.0, 1.0, 0.0), Point::origin()],
        masses: vec![0.1; 2],
        edges: vec![[0, 1]],
        side_m: 1.0,
    };
    case.start = vec![Point::new(0.0, 1.0, 0.0), Point::new(0.0, -AMPLITUDE, 0.0)];
    case.edges = vec![[0, 1]];
    case
}

const OMEGA: f64 = 20.0;
const SECONDS: f64 = 0.6;
const AMPLITUDE: f64 = 0.1;

/// The error of a weight that moves as cos wt: the largest of ten checkpoints.
fn off(w: f64) -> f64 {
    let each = (1..=10).map(|i| {
        let t = SECONDS * f64::from(i) / 10.0;
        let exact = (OMEGA * t).cos();
        ((w * t).cos() - exact).abs() / (exact - 1.0).abs()
    });
    each.fold(0.0, f64::max)
}

#[test]
fn error_of_plain_verlet_is_of_its_discrete_frequency() {
    let experiment = Pareto {
        options: Options {
            visits_max: u64::MAX,
            ..options(&[], 2)
        },
        cases: vec![oscillator()],
    };
    let (rows, _) = conduct(&experiment, workers(), &UNBOUNDED, |_| {});
    let mut count = 0;
    for row in rows.iter().filter(|row| row.method == "verlet-plain") {
        let Some(error) = row.error_total else {
            assert_eq!(row.status, Status::Refused, "{}", row.run);
            continue;
        };
        // Its frequency is w with cos w Δt = 1 − (ω Δt)²/2.
        let dt_s = row.dt_s;
        let z = OMEGA * dt_s;
        let theory = off((1.0 - z * z / 2.0).acos() / dt_s);
        let floor = row.error_floor.expect("two references");
        let apart = (error - theory).abs();
        assert!(
            apart < 1e-3 * theory + 10.0 * floor,
            "{}: {error} {theory}",
            row.run
        );
        count += 1;
    }
    assert!(count >= 6, "{count} steps");
}

#[test]
fn scenes_at_rest_begin_with_a_step_that_newton_solves() {
    let scenes = SCENES.iter();
    let cases = scenes.map(|scene| Case::new(scene, MeshKind::Grid, 16));
    for case in cases.filter(|case| matches!(case.scene.until, Until::Rest(_))) {
        let keys = plan(&case, 0);
        let newton = keys.iter().find(|key| key.run == "reference-newton");
        let dt_s = newton.expect("a second reference").dt_s;
        let step = case.system().step(&mut Reference::to_rest(), dt_s);
        assert!(step.is_ok(), "{}: {step:?}", case.scene.name);
    }
}

fn options(scenes: &[&str], cells: u32) -> Options {
    Options {
        scenes: scenes.iter().map(|&name| name.to_owned()).collect(),
        meshes: vec![MeshKind::Grid],
        cells: vec![cells],
        stiffness_n_per_m: Vec::new(),
        mass_ratios: Vec::new(),
        visits_max: 3_000_000,
    }
}

/// The runs on each front by visits of edges, which are the same on every machine. So a change of a method
/// that moves one has to say so. With `TEARMESH_BLESS` set, the record is written anew.
#[test]
fn fronts_are_those_of_the_record() {
    let scenes = ["hang", "swing", "sliver", "taut", "strip"];
    let meshes = MeshKind::ALL.to_vec();
    let options = options(&scenes, 4);
    let experiment = Pareto::new(Options { meshes, ..options });
    let (rows, _) = conduct(&experiment, workers(), &UNBOUNDED, |_| {});
    let mut found = String::new();
    for group in chart::groups(&rows) {
        if group.floor.is_some() {
            let on = group.runs.iter().filter(|one| one.is_on_front);
            let on: Vec<&str> = on.map(|one| &*one.row.run).collect();
            let Row { scene, mesh, .. } = group.runs[0].row;
            let (mesh, name, on) = (mesh.name(), group.observable.name(), on.join(" "));
            found += &format!("{scene} on {mesh}, {name}: {on}\n");
        }
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/pareto/tests/fronts.txt");
    if std::env::var_os("TEARMESH_BLESS").is_some() {
        fs::write(&path, &found).expect("a record that can be written");
    }
    let record = fs::read_to_string(&path).expect("a record");
    for (found, record) in found.lines().zip(record.lines()) {
        assert_eq!(
            found, record,
            "a front has moved; set TEARMESH_BLESS if it is meant to"
        );
    }
    assert_eq!(found.lines().count(), record.lines().count());
}
