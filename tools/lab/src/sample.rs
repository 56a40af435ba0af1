//! Points of a sample of numbers.

/// The middle of some numbers, or the mean of the two in the middle; `None` of none.
pub(crate) fn median(mut numbers: Vec<f64>) -> Option<f64> {
    numbers.sort_by(f64::total_cmp);
    point(&numbers, 0.5)
}

/// The number below which such a part of a sorted sample is, between neighbours in proportion; `None` of
/// none.
pub(crate) fn point(sorted: &[f64], part: f64) -> Option<f64> {
    let place = part * sorted.len().checked_sub(1)? as f64;
    let (below, above) = (
        sorted[place.floor() as usize],
        sorted[place.ceil() as usize],
    );
    if below == above {
        return Some(below); // Infinities as well.
    }
    Some(below + (above - below) * place.fract())
}
