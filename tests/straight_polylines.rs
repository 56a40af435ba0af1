//! The oracle of straight cuts on polylines: cuts that go on where the one before ended.

use std::f64::consts::TAU;

use crate::oracle::naive_cut;
use crate::oracle::spoil::{BUGS, Bug, spoil};
use crate::oracle::straight::{Check, Cut, Surface, is_generic, judge_polyline};
use crate::random::Random;
use crate::straight::said;
use crate::surfaces::sheets;
use crate::work::down;

/// Polylines that each sheet gets.
const POLYLINES: usize = 20;

/// A cut from one point of the plane z = 0 to another.
fn straight(from: [f64; 2], to: [f64; 2]) -> Cut {
    Cut::between([down(from), down(to)])
}

/// The cuts of a polyline with these corners, and what the naive implementation makes of a
/// sheet; `None` if some cut comes too near to a special case. With a `gap`, each cut but the first
/// begins so far behind its joint, as if nobody knew of it.
fn polyline(sheet: &Surface, corners: &[[f64; 2]], gap: f64) -> Option<(Vec<Cut>, Surface)> {
    let mut after = sheet.clone();
    let mut cuts: Vec<Cut> = Vec::new();
    for two in corners.windows(2) {
        let [from, to] = [two[0], two[1]];
        let cut = straight(from, to);
        if !is_generic(sheet, &cut) {
            return None;
        }
        after = if cuts.is_empty() {
            naive_cut::cut(sheet, &cut)
        } else {
            go_on(&after, &cut, from, to, gap)?
        };
        cuts.push(cut);
    }
    Some((cuts, after))
}

/// Cuts on from a tip, or from a point a gap behind it.
fn go_on(before: &Surface, cut: &Cut, [x, y]: [f64; 2], to: [f64; 2], gap: f64) -> Option<Surface> {
    let near = |p: &[f64; 3]| (p[0] - x).abs() + (p[1] - y).abs() < 1e-12;
    let joint = before.points.iter().rposition(near)? as u32;
    let mut others = before.clone();
    others.faces.retain(|face| !face.contains(&joint));
    if !is_generic(&others, cut) {
        return None;
    }
    let after = naive_cut::cut_from(before, cut, joint);
    // A cut that ends before it leaves the faces of the joint has not split it.
    let copy = after.points.len() as u32 - 1;
    if !after.faces.iter().flatten().any(|&v| v == copy) {
        return None;
    }
    if gap == 0.0 {
        return Some(after);
    }
    let along = [to[0] - x, to[1] - y];
    let by = gap / along[0].hypot(along[1]);
    let late = straight([x + by * along[0], y + by * along[1]], to);
    Some(naive_cut::cut(before, &late))
}

/// The corners of a polyline of two or three cuts, which turns by less than a right angle.
pub(crate) fn random_corners(random: &mut Random) -> Vec<[f64; 2]> {
    let mut corner = [0.3 + 0.4 * random.next(), 0.3 + 0.4 * random.next()];
    let mut heading = TAU * random.next();
    let mut corners = vec![corner];
    for _ in 0..2 + random.below(2) {
        let (sin, cos) = heading.sin_cos();
        let size = 0.15 + 0.3 * random.next();
        corner = [corner[0] + size * cos, corner[1] + size * sin];
        corners.push(corner);
        heading += 1.2 * (random.next() - 0.5);
    }
    corners
}

/// Visits generic polylines of all sheets that stay on the sheet at their joints.
fn for_polylines(gap: f64, mut visit: impl FnMut(&Surface, &[Cut], &Surface)) -> usize {
    let mut random = Random(29);
    let mut count = 0;
    for sheet in sheets() {
        let mut done = 0;
        while done < POLYLINES {
            let corners = random_corners(&mut random);
            if let Some((cuts, after)) = polyline(&sheet, &corners, gap * sheet.mean_edge()) {
                visit(&sheet, &cuts, &after);
                done += 1;
            }
        }
        count += done;
    }
    count
}

#[test]
fn a_polyline_is_one_slit() {
    let mut tips = [0; 3];
    let count = for_polylines(0.0, |before, cuts, after| {
        match judge_polyline(before, cuts, after) {
            Ok(facts) => {
                assert_eq!((facts.chains, facts.tips + facts.boundary_ends), (1, 2));
                tips[facts.tips] += 1;
            }
            Err(faults) => panic!("a false alarm: {}", said(&faults)),
        }
    });
    assert!(count >= 60 && tips[1] > 5 && tips[2] > 5, "{tips:?}");
}

#[test]
fn a_polyline_that_is_not_joined_is_found() {
    let count = for_polylines(1e-3, |before, cuts, after| {
        let faults = judge_polyline(before, cuts, after).expect_err("a gap at each joint");
        for check in [Check::Chains, Check::Length, Check::Euler] {
            let found = faults.iter().any(|fault| fault.check == check);
            assert!(found, "{check:?} finds no gap, but: {}", said(&faults));
        }
    });
    assert!(count >= 60, "only {count} polylines");
}

#[test]
fn every_bug_of_a_polyline_is_found() {
    let mut random = Random(31);
    let mut random = || random.next();
    let (mut tried, mut missed) = (0, Vec::new());
    for_polylines(0.0, |before, cuts, after| {
        // Into how many faces a polyline cuts a face is not foreseen.
        for bug in BUGS.into_iter().filter(|&bug| bug != Bug::EdgeBisected) {
            if let Some(spoilt) = spoil(before, &cuts[0], after, bug, &mut random) {
                tried += 1;
                if judge_polyline(before, cuts, &spoilt).is_ok() {
                    missed.push(bug);
                }
            }
        }
    });
    assert!(tried >= 700, "only {tried} bugs");
    assert_eq!(missed, [], "of {tried} bugs");
}
