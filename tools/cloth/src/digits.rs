//! Numbers in messages.

use std::fmt;

/// A number to three digits or all of those before the point.
pub(crate) struct Digits(pub(crate) f64);

impl fmt::Display for Digits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let x = self.0.abs();
        if x >= 100.0 || x == 0.0 {
            write!(f, "{:.0}", self.0)
        } else if x < 1e-6 {
            write!(f, "{:.2e}", self.0)
        } else {
            let mut digits = 1;
            let mut scale = 10.0;
            while x < scale {
                digits += 1;
                scale /= 10.0;
            }
            write!(f, "{:.digits$}", self.0)
        }
    }
}
