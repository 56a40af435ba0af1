//! The watch over stability after something went wrong: a state that was no number, one that was
//! set, a step that failed.

use tearmesh::Vector;
use tearmesh::cloth::{Frequency, StepError, System, Verlet};

use crate::cloth_answers::row;

/// Ten springs of 1000 N/m between particles of 10 g: a step of 0.02 s is six times too long.
fn stiff() -> System {
    row(10, 0.01, 1000.0, 0.1, Vector::x() * 0.1)
}

const TOO_LONG_S: f64 = 0.02;

fn refused(system: &mut System, dt_s: f64) -> StepError {
    let taken = system.step(&mut Verlet::new(), dt_s);
    taken.expect_err("a step that is refused")
}

#[test]
fn a_state_that_was_no_number_does_not_switch_the_watch_off() {
    let mut system = stiff();
    let clean = refused(&mut system, TOO_LONG_S);
    let StepError::Unstable { limit_s, .. } = clean else {
        panic!("{clean}");
    };
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        let mut system = stiff();
        let good = system.positions()[3];
        system.state_mut().0[3].x = bad;
        let broken = refused(&mut system, TOO_LONG_S);
        assert_eq!(
            matches!(broken, StepError::BlowUp { .. }),
            !bad.is_finite(),
            "{broken}"
        );
        // Where nothing can be measured, the bound counts.
        let bound = system.frequency_bound();
        let Frequency {
            omega_rad_per_s,
            residual,
            ends,
        } = system.frequency();
        if bad.is_finite() {
            assert!(omega_rad_per_s > 0.5 * bound && residual.is_finite());
        } else {
            assert_eq!((omega_rad_per_s, residual, ends), (bound, 1.0, None));
        }

        system.state_mut().0[3] = good;
        let again = refused(&mut system, TOO_LONG_S);
        let StepError::Unstable { limit_s: limit, .. } = again else {
            panic!("{again}");
        };
        assert!((limit / limit_s - 1.0).abs() < 0.01, "{limit} {limit_s}");
        system.hold(10);
        refused(&mut system, TOO_LONG_S);
    }
}
