//! The method `exact` against the oracle of straight cuts, which shares no code with it.

use std::collections::BTreeSet;
use std::path::Path;

use tearmesh::{CutEnd, CutMethod, CutReport, Edit, Scissor, VertexId};

use crate::oracle::straight::{Cut, Surface, is_generic, judge_polyline, minus};
use crate::random::Random;
use crate::straight::{judged, random_generic_cut, said};
use crate::straight_polylines::random_corners;
use crate::surfaces::{corpus, read, sheets, surfaces};
use crate::work::{Work, area, between, down, is_measured, ray};

impl Work {
    fn exact(&mut self, scissor: &Scissor) -> CutReport {
        self.cut(CutMethod::Exact, scissor).1
    }
}

/// Flags, sleeves and, where `TEARMESH_CORPUS` names their folder, garments.
#[test]
fn straight_cuts_of_garments_satisfy_the_oracle() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let files = ["flag", "sleeve", "sheet"].map(|name| data.join(name).with_extension("obj"));
    let mut garments = corpus(&[
        "arcsim_tshirt",
        "arcsim_dress3",
        "snug_tshirt",
        "snug_tank",
        "assistive_hospitalgown",
    ]);
    garments.extend(files);
    let mut random = Random(61);
    for path in garments {
        let before = read(&path);
        for _ in 0..12 {
            let (scissor, cut) = random_generic_cut(&before, &mut random);
            let mut work = Work::of(&before);
            work.exact(&scissor);
            judged(&before, &cut, &work.surface(), &path.display().to_string());
        }
    }
}

/// The ghost links of older cuts are crossed; mending everything leaves the surface whole.
#[test]
fn cuts_across_cuts_satisfy_the_oracle_and_are_mended() {
    let mut random = Random(37);
    let mut of_torn = 0;
    for (name, whole) in surfaces() {
        let pieces = Work::of(&whole).mesh.components().count();
        for _ in 0..13 {
            let mut work = Work::of(&whole);
            for _ in 0..3 {
                let before = work.surface();
                let (scissor, cut) = random_generic_cut(&before, &mut random);
                of_torn += usize::from(work.torn() > 0);
                let report = work.exact(&scissor);
                is_measured(&report, &work, before.mean_edge(), name);
                judged(&before, &cut, &work.surface(), name);
            }
            work.sew_all();
            assert_eq!(work.mesh.components().count(), pieces, "{name}");
        }
    }
    assert!(of_torn >= 150, "{of_torn} cuts of torn meshes");
}

/// A ray through a point of the plane z = 0.
type View<'v> = &'v dyn Fn([f64; 2]) -> ([f64; 3], [f64; 3]);

/// Cuts along a polyline of points of the plane z = 0.
fn along_polyline(work: &mut Work, corners: &[[f64; 2]], view: View<'_>, snap: f64) {
    let mut last: Option<CutEnd> = None;
    for two in corners.windows(2) {
        let scissor = match &last {
            Some(end) => Scissor::continued(end, ray(view(two[1])), &work.positions),
            None => Scissor::new(ray(view(two[0])), ray(view(two[1]))),
        };
        let scissor = scissor.expect("a plane").with_snap(snap);
        let (cut, _) = work.cut(CutMethod::Exact, &scissor);
        last = cut.ends().map(|[_, end]| end.clone());
    }
}

/// The boundary loops after each of so many random polylines well inside a sheet.
fn loops_of_polylines(sheet: &Surface, count: usize, snap: f64, seed: u64) -> Vec<usize> {
    let mut random = Random(seed);
    let inside = |p: &[f64; 2]| p.iter().all(|x| *x > 0.05 && *x < 0.95);
    let lines = std::iter::repeat_with(|| random_corners(&mut random));
    let lines = lines.filter(|corners| corners.iter().all(inside));
    let cut = |corners: Vec<[f64; 2]>| {
        let mut work = Work::of(sheet);
        along_polyline(&mut work, &corners, &down, snap);
        work.mesh.boundary_loops().len()
    };
    lines.take(count).map(cut).collect()
}

#[test]
fn every_polyline_is_one_slit_on_each_sheet_that_it_passes() {
    // Two sheets, one below the other, and not alike.
    let [one, mut two, other] = sheets();
    let first = two.points.len() as u32;
    let below = other.faces.iter().map(|face| face.map(|v| v + first));
    two.faces.extend(below);
    let below = other.points.iter().map(|&[x, y, z]| [x, y, z - 1.0]);
    two.points.extend(below);
    let [_, sheet, _] = sheets();
    for snap in [0.0, Scissor::SNAP] {
        for (seed, sheet) in (41..).zip([&one, &sheet, &other]) {
            let loops = loops_of_polylines(sheet, 80, snap, seed);
            assert_eq!(loops, [2; 80], "snap {snap}");
        }
        assert_eq!(
            loops_of_polylines(&two, 60, snap, 71),
            [4; 60],
            "snap {snap}"
        );
    }
    // The plane passes through the joint on one sheet, and by that on the other: where that tip
    // had to move so that no face got thin, it may pass too far away.
    let loops = loops_of_polylines(&two, 60, 0.2, 71);
    let joined = loops.iter().filter(|&&loops| loops == 4).count();
    assert!(joined >= 57, "{joined}");
}

/// A ray from an eye, or from a place that is so far from it, through a point of the plane z = 0.
fn from_eye([x, y]: [f64; 2], aside: f64) -> ([f64; 3], [f64; 3]) {
    // Another place for each point.
    let aside = [aside * (40.0 * x).sin(), aside * (40.0 * y).sin(), 0.0];
    let eye = minus([0.35, 0.6, 4.0], aside);
    (eye, minus([x, y, 0.0], eye))
}

/// From above, from one eye, and from eyes that are nearly one.
#[test]
fn polylines_satisfy_the_oracle() {
    satisfy_the_oracle(&down, &down);
    for aside in [0.0, 1e-15, 1e-12] {
        satisfy_the_oracle(&|p| from_eye(p, aside), &|p| from_eye(p, 0.0));
    }
}

/// `meant` is the view by which the oracle judges.
fn satisfy_the_oracle(view: View<'_>, meant: View<'_>) {
    let mut random = Random(43);
    for sheet in sheets() {
        let mut done = 0;
        while done < 40 {
            let corners = random_corners(&mut random);
            let cut = |two: &[[f64; 2]]| Cut::between([meant(two[0]), meant(two[1])]);
            let cuts: Vec<Cut> = corners.windows(2).map(cut).collect();
            if !cuts.iter().all(|cut| is_generic(&sheet, cut)) {
                continue;
            }
            done += 1;
            let mut work = Work::of(&sheet);
            along_polyline(&mut work, &corners, view, 0.0);
            if let Err(faults) = judge_polyline(&sheet, &cuts, &work.surface()) {
                panic!("{corners:?}: {}", said(&faults));
            }
        }
    }
}

/// Forty random through cuts of each sheet by a scissor: what is left of the altitude of each face.
fn for_through_cuts(
    seed: u64,
    make: impl Fn(Scissor) -> Scissor,
    mut visit: impl FnMut(&Work, &Work, &CutReport, &[f64]),
) {
    let mut random = Random(seed);
    for sheet in sheets() {
        for _ in 0..40 {
            let (scissor, _) = random_generic_cut(&sheet, &mut random);
            let before = Work::of(&sheet);
            let mut work = before.clone();
            let report = work.exact(&make(scissor.with_through(true)));
            visit(&before, &work, &report, &work.kept(&before.altitudes()));
        }
    }
}

#[test]
fn a_snap_keeps_faces_from_getting_thin() {
    for snap in [0.0, 0.02, Scissor::SNAP, 0.1, 0.2] {
        let (mut least, mut slivers) = (f64::INFINITY, 0);
        let make = |scissor: Scissor| scissor.with_snap(snap);
        for_through_cuts(47, make, |_, _, _, kept| {
            least = kept.iter().copied().fold(least, f64::min);
            slivers += kept.iter().filter(|kept| **kept < 0.02).count();
        });
        assert!(least >= snap * (1.0 - snap) * (1.0 - 1e-9), "snap {snap}");
        assert!(snap < Scissor::SNAP || slivers == 0);
    }
}

/// Texture coordinates go with the vertices that are moved.
#[test]
fn a_snap_that_moves_makes_the_seam_straight() {
    let (mut deviations, mut moved) = (Vec::new(), 0);
    let make = |scissor: Scissor| scissor.with_snap(Scissor::SNAP).with_snap_move(true);
    for_through_cuts(53, make, |before, work, report, kept| {
        let is_slide = |edit: &Edit<'_>| matches!(edit, Edit::Slide(_));
        moved += work.edits.iter().filter(is_slide).count();
        deviations.push(report.seam_deviation_max_edges);
        let [was, is] = [before, work].map(|work| area(&work.mesh, &work.positions));
        assert!((is / was - 1.0).abs() < 1e-3);
        assert!(kept.iter().all(|kept| *kept >= 0.05 * 0.95 * (1.0 - 1e-9)));
        // A corner that is less than the snap is touched and not cut off.
        assert!(report.crumbs == 0 && report.lost <= 1, "{report:?}");
    });
    deviations.sort_by(f64::total_cmp);
    let median = deviations[deviations.len() / 2];
    assert!(median < 1e-12 && moved > 150, "{median}, {moved} moved");
}

/// Whatever was snapped: a snapped vertex stands for the crossing, also where it lies beyond a side
/// plane itself.
#[test]
fn snapped_slits_are_whole_and_of_the_right_length() {
    for (snap, mean_max, most) in [(Scissor::SNAP, 0.02, 0.3), (0.2, 0.2, 1.3)] {
        let mut random = Random(67);
        let mut errors = Vec::new();
        for sheet in sheets() {
            for _ in 0..80 {
                let [x, y] = [0.25 + 0.5 * random.next(), 0.25 + 0.5 * random.next()];
                let (sin, cos) = (std::f64::consts::TAU * random.next()).sin_cos();
                let half = 0.1 + 0.1 * random.next();
                let end = |t: f64| [x + t * cos, y + t * sin];
                let mut work = Work::of(&sheet);
                let report = work.exact(&between(end(-half), end(half)).with_snap(snap));
                assert_eq!(work.mesh.boundary_loops().len(), 2, "{x} {y}");
                assert_eq!(report.tip_overshoots.len(), 2, "{x} {y}");
                let slit = report.seam_length / report.seam_length_ratio;
                errors.push((report.seam_length - slit).abs() / sheet.mean_edge());
            }
        }
        let longest = errors.iter().copied().fold(0.0, f64::max);
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        // Tips move rather than leave a thin face, by less than the way through one face.
        assert!(mean < mean_max && longest < most);
    }
}

/// Where a cut crosses an older one, both sides of that are snapped alike.
#[test]
fn copies_of_a_vertex_are_all_split_or_none() {
    let mut random = Random(73);
    let mut together = 0;
    for sheet in sheets() {
        for _ in 0..60 {
            let mut work = Work::of(&sheet);
            let mut part = || 0.2 + 0.6 * random.next();
            let cut = |a, b| between(a, b).with_through(true).with_snap(0.2);
            work.exact(&cut([part(), -1.0], [part(), 2.0]));
            let (before, first) = (work.mesh.clone(), work.edits.cursor());
            work.exact(&cut([-1.0, part()], [2.0, part()]));
            let split = work.edits.since(first).filter_map(|edit| match edit {
                Edit::Split(split) => Some(split.old),
                _ => None,
            });
            let split: BTreeSet<VertexId> = split.collect();
            for v in before.vertices().filter(|v| split.contains(v)) {
                let is_copy = |&w: &VertexId| w != v && before.root(w) == before.root(v);
                for w in before.vertices().filter(is_copy) {
                    assert!(split.contains(&w), "{v} was split, and {w} was not");
                    together += 1;
                }
            }
        }
    }
    assert!(together >= 20, "only {together}");
}
