//! Planted rows with known answers, a small study that must agree with itself, the same bytes, and an end at
//! once.

use std::sync::atomic::{AtomicU64, Ordering};

use tearmesh_cloth::statistics::Random;

use super::*;
use crate::pareto::Family;
use crate::pareto::Status;

const MEASURE: Measure = Measure::Sag;

/// A run that costs n³/part, with such an error.
fn row(method: &str, cells: u32, part: f64, total: f64) -> Row {
    let n = f64::from(cells);
    Row {
        method: method.to_owned(),
        family: Family::Verlet,
        cells,
        part,
        dt_s: Some(part),
        status: Status::Ok,
        why: String::new(),
        steps: 1,
        visits: (n * n * n / part) as u64,
        errors: vec![Error {
            measure: MEASURE,
            value: None,
            total,
            of_step: None,
            of_mesh: None,
            vouched: 0.0,
            is_at_floor: false,
            is_on_front: false,
            buy: None,
        }],
    }
}

fn ranked(rows: Vec<Row>, floor: f64) -> SceneStudy {
    let mut scene = SceneStudy {
        scene: "planted".to_owned(),
        about: String::new(),
        amplification: None,
        is_barred: false,
        references: Vec::new(),
        floors: vec![Floor {
            measure: MEASURE,
            value: None,
            floor: Some(floor),
        }],
        rows,
    };
    scene.rank();
    scene
}

/// A method whose errors are those of a formula.
fn planted(floor: f64, error: impl Fn(f64, f64) -> f64) -> SceneStudy {
    let mut rows = Vec::new();
    for cells in CELLS {
        for part in STEPS {
            rows.push(row("one", cells, part, error(1.0 / f64::from(cells), part)));
        }
    }
    ranked(rows, floor)
}

fn buy(scene: &SceneStudy, cells: u32, part: f64) -> Option<Buy> {
    let mut rows = scene.rows.iter();
    let row = rows.find(|row| row.cells == cells && row.part == part);
    row?.error(MEASURE)?.buy
}

#[test]
fn the_better_buy_is_what_the_error_is_made_of() {
    let near = |a: Option<f64>, b: f64| (a.expect("a number") - b).abs() < 1e-12;
    // Errors that are of the mesh alone, of the step alone, and of neither.
    let mesh = planted(0.0, |h, _| h);
    let step = planted(0.0, |_, dt| 0.01 * dt * dt);
    let none = planted(0.0, |_, _| 0.5);
    for cells in [16, 32] {
        for part in [2.0, 1.0, 0.5] {
            let [mesh, step, none] = [&mesh, &step, &none].map(|of| buy(of, cells, part));
            let [mesh, step, none] = [mesh, step, none].map(|buy| buy.expect("a buy"));
            // Half the edge is eight times the work, half the step twice.
            assert_eq!(mesh.better, Better::Mesh);
            assert!(near(mesh.by_mesh, 0.5) && near(mesh.rate_of_mesh, 1.0 / 3.0));
            assert!(near(mesh.by_step, 0.0) && near(mesh.rate_of_step, 0.0));
            assert_eq!(step.better, Better::Step);
            assert!(near(step.by_step, 0.75) && near(step.rate_of_step, 2.0));
            assert!(near(step.by_mesh, 0.0));
            assert_eq!(none.better, Better::Neither);
        }
    }
    // Where one of the two was not tried nobody knows.
    assert_eq!(buy(&mesh, 64, 1.0), None);
    assert_eq!(buy(&mesh, 16, 0.25), None);
}

#[test]
fn the_dearer_halving_is_the_better_buy_only_if_it_lowers_the_error_by_more_for_its_cost() {
    // By the mesh from 1 to 1/3 for eight times the work, or by the step to `left` for twice.
    let by_step = |left: f64| {
        let rows = vec![
            row("one", 16, 1.0, 1.0),
            row("one", 16, 0.5, left),
            row("one", 32, 1.0, 1.0 / 3.0),
        ];
        buy(&ranked(rows, 0.0), 16, 1.0).expect("a buy").better
    };
    // (1/3)^(1/3) = 0.693: as good for each doubling.
    assert_eq!(by_step(0.68), Better::Step);
    assert_eq!(by_step(0.71), Better::Mesh);
    // Nearly for nothing, but by less than a tenth.
    assert_eq!(by_step(0.95), Better::Mesh);
}

#[test]
fn what_is_below_ten_floors_is_no_better_for_more_work() {
    let scene = planted(0.01, |h, dt| h * dt);
    for row in &scene.rows {
        let error = row.error(MEASURE).expect("an error");
        let is_low = error.total < 0.1;
        assert_eq!(error.is_at_floor, is_low, "{row:?}");
        if let Some(buy) = error.buy.filter(|_| is_low) {
            assert_eq!(buy.better, Better::Neither, "{row:?}");
        }
    }
}

#[test]
fn an_error_that_passes_zero_by_luck_vouches_for_what_shorter_steps_have() {
    let totals = [0.5, 1e-9, 0.2, 0.3];
    let rows = STEPS.into_iter().zip(totals);
    let scene = ranked(
        rows.map(|(part, total)| row("one", 16, part, total))
            .collect(),
        0.0,
    );
    let vouched = scene
        .rows
        .iter()
        .map(|row| row.error(MEASURE).map(|e| e.vouched));
    assert_eq!(vouched.flatten().collect::<Vec<_>>(), [0.5, 0.3, 0.3, 0.3]);
}

#[test]
fn a_front_is_of_one_method_over_all_its_meshes_and_steps() {
    let mut random = Random::new(3);
    for _ in 0..50 {
        let mut rows = Vec::new();
        for method in ["one", "other"] {
            for cells in CELLS {
                // One step a mesh, so that each vouches for itself.
                let part = STEPS[random.below(STEPS.len())];
                rows.push(row(method, cells, part, random.next()));
            }
        }
        let scene = ranked(rows, 0.0);
        let of = |row: &Row| {
            (
                row.visits as f64,
                row.error(MEASURE).expect("an error").total,
            )
        };
        for row in &scene.rows {
            let (cost, total) = of(row);
            let mut own = scene.rows.iter().filter(|other| other.method == row.method);
            let is_beaten = own.any(|other| {
                let (other_cost, other_total) = of(other);
                let is_as_good = other_cost <= cost && other_total <= total;
                is_as_good && (other_cost <= 0.9 * cost || other_total <= 0.9 * total)
            });
            let error = row.error(MEASURE).expect("an error");
            assert_eq!(error.is_on_front, !is_beaten, "{:?}", scene.rows);
        }
    }
}

fn small() -> Options {
    Options {
        scenes: vec![SpaceScene::Hang, SpaceScene::Slit],
        cells: vec![4, 2],
        finest: 8,
        methods: ["xpbd-4", "verlet"].map(str::to_owned).to_vec(),
        parts: vec![0.25, 2.0, 0.5],
        threads: NonZero::<usize>::MIN,
        visits_max: 10_000_000,
    }
}

fn made(options: &Options, stop: &(dyn Fn() -> bool + Sync)) -> Study {
    let plan = Plan::new(options).expect("a plan");
    plan.study(Provenance::default(), stop, |_, _| {})
}

#[test]
fn a_small_study_agrees_with_itself_and_is_the_same_bytes() {
    let study = made(&small(), &|| false);
    let threads = NonZero::new(2).expect("two");
    let again = made(&Options { threads, ..small() }, &|| false);
    assert_eq!(format!("{study:?}"), format!("{again:?}"));
    for scene in &study.scenes {
        let names: Vec<(u32, &str, f64)> = scene
            .rows
            .iter()
            .map(|row| (row.cells, row.method.as_str(), row.part))
            .collect();
        let expected = [2, 4].into_iter().flat_map(|cells| {
            let of = |method| [2.0, 0.5, 0.25].map(|part| (cells, method, part));
            [of("verlet"), of("xpbd-4")].concat()
        });
        assert_eq!(names, expected.collect::<Vec<_>>());
        for known in &scene.floors {
            let mut errors = scene.rows.iter().flat_map(|row| &row.errors);
            assert!(errors.any(|error| error.measure == known.measure));
            assert!(known.floor.expect("a floor") < 0.05, "{known:?}");
        }
        for row in &scene.rows {
            // Twice its limit is too long for Verlet.
            let is_refused = row.method == "verlet" && row.part == 2.0;
            assert_eq!(row.status == Status::Refused, is_refused, "{row:?}");
            assert_eq!(row.errors.is_empty(), is_refused, "{row:?}");
            row.errors.iter().for_each(|error| sane(scene, row, error));
        }
    }
    let drawn = svg(&study).expect("a chart");
    assert!(drawn.contains("slit · toughness-time") && drawn.contains("hang · sag"));
    let lines: Vec<usize> = csv(&study)
        .lines()
        .map(|line| line.split(',').count())
        .collect();
    assert!(lines.iter().all(|count| *count == lines[0]), "{lines:?}");
    let words = summary(&study);
    assert!(words.contains("failed: 2 verlet refused"), "{words}");
}

/// What holds of every error.
fn sane(scene: &SceneStudy, row: &Row, error: &Error) {
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * (1.0 + b.abs());
    let [of_step, of_mesh] = [error.of_step, error.of_mesh].map(|e| e.expect("a shortest step"));
    assert!(error.total <= of_step + of_mesh + 1e-12, "{row:?}");
    assert!(of_mesh <= of_step + error.total + 1e-12, "{row:?}");
    if row.part == 0.25 {
        assert!(of_step == 0.0 && of_mesh == error.total, "{row:?}");
    }
    let mut floors = scene.floors.iter();
    let known = floors.find(|known| known.measure == error.measure);
    let value = known.expect("a floor").value;
    assert_eq!(value.is_some(), error.measure != Measure::Displacement);
    if let (Some(value), Some(own)) = (value, error.value) {
        assert!(close(error.total, (own / value - 1.0).abs()), "{row:?}");
    }
}

#[test]
fn a_study_that_is_stopped_ends_at_once_and_every_run_stands_there() {
    let asked = AtomicU64::new(0);
    let study = made(&small(), &|| asked.fetch_add(1, Ordering::Relaxed) >= 100);
    assert!(study.is_interrupted && asked.load(Ordering::Relaxed) < 300);
    let missing = study.missing.iter().map(|one| one.part.as_str());
    let scenes = study.scenes.iter().map(|one| one.scene.as_str());
    assert!(missing.eq(scenes));
    for scene in &study.scenes {
        assert_eq!(scene.rows.len(), 12);
        assert!(
            scene
                .rows
                .iter()
                .any(|row| row.status == Status::Interrupted)
        );
    }
    assert!(svg(&study).is_some());
    assert!(summary(&study).contains("interrupted"));
}

#[test]
fn options_that_compare_nothing_are_refused() {
    let check = |change: fn(&mut Options)| {
        let mut options = small();
        change(&mut options);
        options.check()
    };
    assert_eq!(check(|_| {}), Ok(()));
    assert_eq!(check(|of| of.cells.clear()), Err(OptionsError::NoCells));
    let [given, coarsest] = [5, 2];
    let refused = Err(OptionsError::NotNested { given, coarsest });
    assert_eq!(check(|of| of.cells.push(5)), refused);
    let refused = Err(OptionsError::NotFiner { given: 4, limit: 4 });
    assert_eq!(check(|of| of.finest = 4), refused);
    assert_eq!(
        check(|of| of.parts = vec![0.7, 0.5]),
        Err(OptionsError::NoHalf)
    );
}
