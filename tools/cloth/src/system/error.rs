//! Why particles, constraints or loads were refused.

use std::fmt;

/// A setting, such as one of a method, a fabric or a load, with a value that cannot be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettingError {
    /// The name of the setting.
    pub setting: &'static str,
    /// The value that was given; for a vector, its unusable component.
    pub given: f64,
    /// The values that are allowed, in words.
    pub allowed: &'static str,
}

impl SettingError {
    pub(crate) fn unless(
        holds: bool,
        setting: &'static str,
        given: f64,
        allowed: &'static str,
    ) -> Result<(), SettingError> {
        let error = SettingError {
            setting,
            given,
            allowed,
        };
        if holds { Ok(()) } else { Err(error) }
    }

    /// Refuses a number that is negative or not finite.
    pub(crate) fn unless_at_least_0(setting: &'static str, given: f64) -> Result<(), SettingError> {
        let holds = given >= 0.0 && given.is_finite();
        SettingError::unless(holds, setting, given, "finite and at least 0")
    }

    /// Refuses a number that is not above 0, or not finite.
    pub(crate) fn unless_above_0(setting: &'static str, given: f64) -> Result<(), SettingError> {
        let holds = given > 0.0 && given.is_finite();
        SettingError::unless(holds, setting, given, "finite and above 0")
    }
}

impl fmt::Display for SettingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (given, allowed) = (self.given, self.allowed);
        write!(f, "{} is {given}, and has to be {allowed}", self.setting)
    }
}

impl std::error::Error for SettingError {}

/// The reason why a particle or a constraint was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemError {
    /// The ends of the constraint; the particle twice if it is one.
    pub particles: [usize; 2],
    /// The number that cannot be used.
    pub number: SettingError,
}

impl fmt::Display for SystemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b] = self.particles;
        match a == b {
            true => write!(f, "particle {a}: {}", self.number),
            false => write!(f, "constraint {a}-{b}: {}", self.number),
        }
    }
}

impl std::error::Error for SystemError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.number)
    }
}
