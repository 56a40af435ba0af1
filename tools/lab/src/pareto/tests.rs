//! Cases with known answers, the same bytes, and an end at once.

mod fronts;

use std::num::NonZero;
use std::sync::atomic::{AtomicU64, Ordering};

use tearmesh::Point;

use super::scene::{Held, Scene, Start, Until};
use super::*;

/// A weight on a spring: ω = 20 rad/s for .6 s, pulled down by a tenth and let go.
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
        is_gated: false,
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

fn bounds() -> Bounds<'static> {
    Bounds {
        visits_max: u64::MAX,
        clock: None,
        stop: &|| false,
    }
}

fn assessed(case: &Case) -> CaseStudy {
    let plan = plan(case);
    let outcomes: Vec<Outcome> = plan
        .iter()
        .map(|planned| planned.carry_out(case, &bounds()))
        .collect();
    assess(case, &plan, &outcomes)
}

/// Relative L2 of one weight, largest of ten checkpoints, of what moves as cos w t.
fn off(w: f64) -> f64 {
    let each = (1..=10).map(|i| {
        let t = SECONDS * f64::from(i) / 10.0;
        let exact = (OMEGA * t).cos();
        ((w * t).cos() - exact).abs() / (exact - 1.0).abs()
    });
    each.fold(0.0, f64::max)
}

#[test]
fn verlet_is_off_by_what_theory_says_at_every_step() {
    let study = assessed(&oscillator());
    let mut count = 0;
    for row in study.rows.iter().filter(|row| row.series == "verlet-plain") {
        let Some(error) = row.error(Observable::Displacement) else {
            assert_eq!(row.status, Status::Refused, "{}", row.run);
            continue;
        };
        // Its frequency is w with cos w Δt = 1 − (ω Δt)²/2.
        let dt_s = row.dt_s.expect("it ran");
        let z = OMEGA * dt_s;
        let theory = off((1.0 - z * z / 2.0).acos() / dt_s);
        let known = study.floors[0].floor.expect("two references");
        assert!(
            (error.total - theory).abs() < 1e-3 * theory + 10.0 * known,
            "{}: {} {theory}",
            row.run,
            error.total
        );
        count += 1;
    }
    assert!(count >= 6, "{count} steps");
}

#[test]
fn errors_of_an_oscillator_fall_at_the_orders_of_the_methods() {
    let study = assessed(&oscillator());
    // From twice this part to it; of RK4 where it is well above what the references know, and steps
    // are long enough for the next order to show.
    for (series, order, part) in [
        ("verlet", 2.0, 0.0625),
        ("verlet-plain", 2.0, 0.0625),
        ("rk4", 4.0, 0.25),
        ("euler", 1.0, 0.0625),
        ("xpbd-1", 1.0, 0.0625),
        ("euler-back-10", 1.0, 0.0625),
        ("bdf2-10", 2.0, 0.0625),
    ] {
        let at = |part: f64| {
            let mut rows = study.rows.iter();
            let row = rows.find(|row| row.series == series && row.part == Some(part));
            let row = row.expect("a row for each part");
            let error = row.error(Observable::Displacement);
            (row.dt_s.expect("it ran"), error.expect("it is known").total)
        };
        let [(long, coarse), (short, fine)] = [at(2.0 * part), at(part)];
        assert!((long / short - 2.0).abs() < 1e-9, "{series}");
        let found = (coarse / fine).log2();
        let most = if series == "rk4" { 0.5 } else { 0.25 };
        assert!((found - order).abs() < most, "{series}: order {found}");
    }
}

#[test]
fn the_model_of_a_method_that_converges_is_the_truth_and_pbd_is_no_model() {
    let study = assessed(&oscillator());
    let finest = |series: &str| {
        let mut rows = study.rows.iter();
        let row = rows.find(|row| row.series == series && row.part == Some(0.0625));
        *row.and_then(|row| row.error(Observable::Displacement))
            .expect("it is known")
    };
    let known = study.floors[0].floor.expect("two references");
    for series in ["verlet-plain", "rk4", "euler", "bdf2-10"] {
        let error = finest(series);
        let model = error.model.unwrap_or_else(|| panic!("{series}: no limit"));
        assert!(
            model < 0.1 * error.total + FLOORS * known,
            "{series}: {error:?}"
        );
        let rest = error.discretisation.expect("a limit");
        assert!(
            (rest - error.total).abs() <= model * 1.001,
            "{series}: {error:?}"
        );
    }
    // A rigid spring does not swing, whatever its step: it snaps back, or flies apart.
    for row in study.rows.iter().filter(|row| row.family == Family::Pbd) {
        let error = row.error(Observable::Displacement);
        let is_far = error.is_none_or(|error| error.total > 0.3);
        assert!(is_far, "{}: {error:?}", row.run);
    }
}

fn options(scenes: &[&str], cells: u32) -> Options {
    let named = SCENES.iter().filter(|scene| scenes.contains(&scene.name));
    Options {
        scenes: named.copied().collect(),
        meshes: vec![MeshKind::Grid],
        cells: vec![cells],
        threads: NonZero::<usize>::MIN.saturating_add(1),
        visits_max: 3_000_000,
        repeats: 0,
    }
}

/// Of the table and the chart of two scenes on a small mesh. A commit that changes it says which
/// figures moved, and why.
const DIGEST: u64 = 0x47b4_e104_26bd_fe13;

#[test]
fn a_small_chart_is_the_same_bytes_however_many_work_on_it() {
    let made = |threads: usize| {
        let options = Options {
            threads: NonZero::new(threads).expect("one at least"),
            ..options(&["swing", "crushed"], 6)
        };
        study(&options, Provenance::default(), None, &|| false, |_, _| {})
    };
    let study = made(2);
    let text = csv(&study) + &svg(&study, By::Visits).expect("a chart");
    let again = made(1);
    assert_eq!(csv(&study), csv(&again));
    let digest = text
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325, |digest: u64, byte| {
            (digest ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
        });
    for case in &study.cases {
        // None is left out, however it ended.
        assert_eq!(
            case.rows.len(),
            METHODS.len() * PARTS.len() + Named::all().len()
        );
        assert_eq!(case.rows.iter().filter(|row| row.is_default).count(), 1);
        for row in &case.rows {
            let is_ok = row.status == Status::Ok;
            assert_eq!(is_ok, !row.errors.is_empty(), "{}", row.run);
        }
        let statuses: Vec<Status> = case.rows.iter().map(|row| row.status).collect();
        assert!(statuses.contains(&Status::Refused) && statuses.contains(&Status::TooDear));
    }
    assert_eq!(digest, DIGEST, "{digest:#018x}");
}

#[test]
fn an_interrupted_study_ends_within_a_step_of_each_run_and_leaves_no_gap() {
    // Where it is first asked to go on is before its first run.
    for patience in [0, 1000] {
        let asked = AtomicU64::new(0);
        let stop = || asked.fetch_add(1, Ordering::SeqCst) >= patience;
        let options = options(&["swing"], 6);
        let study = study(&options, Provenance::default(), None, &stop, |_, _| {});
        assert!(study.is_interrupted);
        assert_eq!(study.missing.len(), 1);
        let why = &study.missing[0].why;
        assert!(why.starts_with("interrupted after "), "{why}");
        let runs = study.cases[0].rows.len() + study.cases[0].references.len();
        // Once for each run, twice for those that were under way, and at the end.
        let after = asked.load(Ordering::SeqCst) - patience;
        assert!(after <= runs as u64 + 5, "{after} of {runs}");
        let rows = study.cases[0].rows.iter();
        assert!(rows.clone().any(|row| row.status == Status::Interrupted));
        assert_eq!(
            rows.count(),
            METHODS.len() * PARTS.len() + Named::all().len()
        );
        assert!(
            svg(&study, By::Visits)
                .expect("a chart")
                .contains("INTERRUPTED")
        );
    }
}

#[test]
fn who_is_at_rest_is_so_in_any_order_of_edges_but_for_those_that_sweep() {
    let options = Options {
        visits_max: 30_000_000,
        ..options(&["hang", "shuffled"], 6)
    };
    let study = study(&options, Provenance::default(), None, &|| false, |_, _| {});
    let [hang, shuffled] = &study.cases[..] else {
        panic!("two cases");
    };
    for (a, b) in hang.rows.iter().zip(&shuffled.rows) {
        let both = [a, b].map(|row| row.error(Observable::StrainRms).map(|error| error.total));
        let [Some(a_off), Some(b_off)] = both else {
            continue;
        };
        match a.family {
            Family::Pbd | Family::Xpbd => {}
            _ => assert!(a_off.max(b_off) < 1e-4, "{}: {a_off} {b_off}", a.run),
        }
        if a.run.ends_with("xpbd-1@1") {
            assert!(
                a_off > 0.3 && b_off > 0.3,
                "one sweep is soft: {a_off} {b_off}"
            );
        }
    }
}
