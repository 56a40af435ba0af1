//! The method `exact` against the oracle of straight cuts, which shares no code with it.

use std::collections::BTreeMap;
use std::path::Path;

use tearmesh::{
    CutEnd, CutMethod, CutReport, Edits, Masses, Mesh, PerCorner, Point, Positions, Ray, Scissor,
    Vector, mend,
};

use crate::oracle::straight::{Cut, Surface, judge, judge_polyline};
use crate::random::Random;
use crate::straight::{
    Rays, built, cases, is_worst_of_faces, random_generic_rays, said, surface, surfaces,
};
use crate::straight_polylines::{random_corners, sheets};

/// A mesh and all that follows it, in a cut.
struct Cutting {
    mesh: Mesh,
    positions: Positions,
    masses: Masses,
    /// For each corner where it is: linear data, which has to stay so.
    corners: PerCorner<[f64; 3]>,
    edits: Edits,
    /// Where the last cut ended.
    end: Option<CutEnd>,
}

impl Cutting {
    fn new(surface: &Surface) -> Cutting {
        let (mesh, positions) = built(surface);
        let corners = mesh
            .half_edges()
            .map(|h| positions.at(mesh.origin(h)).into());
        Cutting {
            masses: Masses::area(&mesh, &positions, 1.0).expect("it has an area"),
            corners: PerCorner::new(corners.collect()),
            mesh,
            positions,
            edits: Edits::new(),
            end: None,
        }
    }

    /// Cuts, and checks what holds of every cut.
    fn cut(&mut self, scissor: &Scissor) -> CutReport {
        let (mesh, positions) = (&mut self.mesh, &mut self.positions);
        let report = scissor.cut_measured(CutMethod::Exact, mesh, positions, &mut self.edits);
        let (cut, report) = report.expect("positions are in step");
        self.end = cut.ends().map(|[_, end]| end.clone());
        self.edits
            .replay(&mut (&mut self.masses, &mut self.corners));
        assert_eq!(self.mesh.check(), []);
        assert!(self.masses.ledger().is_balanced());
        for (h, corner) in self.mesh.half_edges().zip(self.corners.as_slice()) {
            let apart = self.positions.at(self.mesh.origin(h)) - Point::from(*corner);
            assert!(apart.norm() < 1e-12, "the data of {h} is {apart} off");
        }
        report
    }

    fn surface(&self) -> Surface {
        surface(&(self.mesh.clone(), self.positions.clone()))
    }
}

#[test]
fn straight_cuts_satisfy_the_oracle() {
    let mut cuts = 0;
    for case in cases(52) {
        let mut cutting = Cutting::new(&case.before);
        let report = cutting.cut(&case.scissor().snap(0.0));
        match judge(&case.before, &case.cut, &cutting.surface()) {
            Ok(facts) => {
                assert_eq!(report.pieces, facts.pieces, "{}", case.name);
                let straight = (report.seam_length_ratio - 1.0).abs() < 1e-9;
                assert!(straight || report.missed, "{report:?}");
                let over = report.tip_overshoots.iter().any(|over| over.abs() > 1e-12);
                assert!(!over && report.seam_deviation_max < 1e-12, "{report:?}");
            }
            Err(faults) => panic!("{}: {}", case.name, said(&faults)),
        }
        assert_eq!((report.lost, report.crumbs), (0, 0), "{}", case.name);
        assert!(report.separated, "{}: {report:?}", case.name);
        cuts += 1;
    }
    println!("{cuts} cuts");
    assert!(cuts >= 400, "only {cuts} cuts");
}

/// The triangles of a file, read in the plainest way: `v x y z` and `f a/… b/… c/…`, counted from 1.
fn file(path: &Path) -> Surface {
    let text = std::fs::read_to_string(path).expect("a file");
    let mut surface = Surface {
        points: Vec::new(),
        faces: Vec::new(),
    };
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let keyword = words.next();
        if keyword == Some("v") {
            let numbers: Vec<f64> = words.map(|word| word.parse().expect("a number")).collect();
            surface.points.push([numbers[0], numbers[1], numbers[2]]);
        } else if keyword == Some("f") {
            let index = |word: &str| word.split('/').next()?.parse::<u32>().ok();
            let corners: Vec<u32> = words
                .map(|word| index(word).expect("an index") - 1)
                .collect();
            for two in corners[1..].windows(2) {
                surface.faces.push([corners[0], two[0], two[1]]);
            }
        }
    }
    surface
}

/// Flags, sleeves and, where `TEARMESH_CORPUS` names their folder, garments.
#[test]
fn straight_cuts_of_garments_satisfy_the_oracle() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let mut files = vec![
        data.join("flag.obj"),
        data.join("sleeve.obj"),
        data.join("sheet.obj"),
    ];
    if let Some(corpus) = std::env::var_os("TEARMESH_CORPUS") {
        let names = [
            "arcsim_tshirt",
            "arcsim_dress3",
            "snug_tshirt",
            "snug_tank",
            "assistive_hospitalgown",
        ];
        files.extend(names.map(|name| Path::new(&corpus).join(name).with_extension("obj")));
    }
    let mut random = Random(61);
    for path in files {
        let before = file(&path);
        for _ in 0..12 {
            let (rays, cut) = random_generic_rays(&before, &mut random);
            let mut cutting = Cutting::new(&before);
            cutting.cut(&scissor(rays).through(cut.sides.is_empty()).snap(0.0));
            if let Err(faults) = judge(&before, &cut, &cutting.surface()) {
                panic!("{}: {}", path.display(), said(&faults));
            }
        }
        println!("{}: 12 cuts", path.display());
    }
}

/// Cuts across older cuts, whose ghost links the second one has to cross, satisfy the oracle too,
/// and mending everything leaves the surface whole.
#[test]
fn cuts_across_cuts_satisfy_the_oracle_and_can_be_mended() {
    let mut random = Random(37);
    let (mut cuts, mut torn_edges_crossed) = (0, 0);
    for (name, before) in surfaces() {
        for _ in 0..13 {
            let mut cutting = Cutting::new(&before);
            for _ in 0..3 {
                let before = cutting.surface();
                let (rays, cut) = random_generic_rays(&before, &mut random);
                let ghosts = cutting
                    .mesh
                    .half_edges()
                    .filter(|&h| cutting.mesh.ghost_pair(h).is_some())
                    .count();
                let report = cutting.cut(&scissor(rays).through(cut.sides.is_empty()).snap(0.0));
                is_worst_of_faces(&report, &cutting.mesh, &cutting.positions, name);
                torn_edges_crossed += usize::from(ghosts > 0);
                if let Err(faults) = judge(&before, &cut, &cutting.surface()) {
                    panic!("{name}: {}", said(&faults));
                }
                cuts += 1;
            }
            let Cutting {
                mut mesh,
                positions,
                mut masses,
                mut edits,
                ..
            } = cutting;
            let pieces = built(&before).0.components().count();
            let stitches = mend::stitches(&mesh, |_| true);
            mend::sew(
                &mut mesh,
                &positions,
                &stitches,
                |v| masses.at(v),
                0.0,
                &mut edits,
            )
            .expect("nothing moved");
            edits.replay(&mut masses);
            assert_eq!(mesh.check(), []);
            assert!(masses.ledger().is_balanced());
            assert!(mesh.half_edges().all(|h| mesh.ghost_pair(h).is_none()));
            assert_eq!(mesh.components().count(), pieces, "{name}");
        }
    }
    println!("{cuts} cuts, {torn_edges_crossed} of torn meshes");
    assert!(cuts >= 300 && torn_edges_crossed >= 150);
}

pub(crate) fn scissor([a, b]: Rays) -> Scissor {
    Scissor::new(ray(a), ray(b)).expect("a plane")
}

pub(crate) fn ray((origin, along): ([f64; 3], [f64; 3])) -> Ray {
    Ray::new(Point::from(origin), Vector::from(along)).expect("a ray")
}

/// Cuts along a polyline of points of the plane z = 0, seen from above.
fn along_polyline(cutting: &mut Cutting, corners: &[[f64; 2]], snap: f64) -> Vec<CutReport> {
    let mut reports: Vec<CutReport> = Vec::new();
    for two in corners.windows(2) {
        let [from, to] = [two[0], two[1]].map(crate::straight::down);
        let scissor = match &cutting.end {
            Some(end) => Scissor::continued(end, ray(to), &cutting.positions).expect("a plane"),
            None => scissor([from, to]),
        };
        reports.push(cutting.cut(&scissor.snap(snap)));
    }
    reports
}

#[test]
fn every_polyline_is_one_slit() {
    let mut random = Random(41);
    for snap in [0.0, Scissor::SNAP] {
        let (mut polylines, mut joints, mut joined) = (0, 0, 0);
        for sheet in sheets() {
            let mut done = 0;
            while done < 80 {
                let corners = random_corners(&mut random);
                let inside = |p: &[f64; 2]| p.iter().all(|x| *x > 0.03 && *x < 0.97);
                if !corners.iter().all(inside) {
                    continue;
                }
                done += 1;
                let mut cutting = Cutting::new(&sheet);
                let reports = along_polyline(&mut cutting, &corners, snap);
                joints += corners.len() - 2;
                // One slit inside a sheet is one more boundary loop.
                let loops = cutting.mesh.boundary_loops().len();
                let tips = reports.iter().map(|report| report.splits).sum::<usize>();
                assert!(tips > 0);
                if loops == 2 {
                    joined += corners.len() - 2;
                } else {
                    println!("snap {snap}: {loops} loops on {corners:?}");
                }
            }
            polylines += done;
        }
        println!("snap {snap}: {polylines} polylines, {joined} of {joints} joints");
        assert_eq!(joined, joints, "snap {snap}");
    }
}

#[test]
fn polylines_satisfy_the_oracle() {
    let mut random = Random(43);
    let mut judged = 0;
    for sheet in sheets() {
        let mut done = 0;
        while done < 40 {
            let corners = random_corners(&mut random);
            let cuts: Vec<Cut> = corners
                .windows(2)
                .map(|two| Cut::between([two[0], two[1]].map(crate::straight::down)))
                .collect();
            if !cuts
                .iter()
                .all(|cut| crate::oracle::straight::is_generic(&sheet, cut))
            {
                continue;
            }
            done += 1;
            let mut cutting = Cutting::new(&sheet);
            along_polyline(&mut cutting, &corners, 0.0);
            if let Err(faults) = judge_polyline(&sheet, &cuts, &cutting.surface()) {
                panic!("{corners:?}: {}", said(&faults));
            }
        }
        judged += done;
    }
    assert_eq!(judged, 120);
}

/// The table of snap against quality: through cuts of a random sheet.
#[test]
fn a_snap_keeps_faces_from_getting_thin() {
    let mut random = Random(47);
    let mut table = BTreeMap::new();
    for sheet in sheets() {
        for _ in 0..40 {
            let (rays, _) = random_generic_rays(&sheet, &mut random);
            for (i, snap) in [0.0, 0.02, 0.05, 0.1, 0.2].into_iter().enumerate() {
                let mut cutting = Cutting::new(&sheet);
                let before = altitudes(&cutting.mesh, &cutting.positions);
                let report = cutting.cut(&scissor(rays).through(true).snap(snap));
                let after = altitudes(&cutting.mesh, &cutting.positions);
                let parents = parents(&cutting.edits, before.len());
                let ratio = |(child, altitude): (usize, &f64)| altitude / before[parents[child]];
                let ratios: Vec<f64> = after.iter().enumerate().map(ratio).collect();
                let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
                let bound = snap * (1.0 - snap);
                assert!(
                    least >= bound * (1.0 - 1e-9),
                    "snap {snap}: {least} of {bound}"
                );
                let slivers = ratios.iter().filter(|ratio| **ratio < 0.02).count();
                let row: &mut Vec<_> = table.entry(i).or_insert_with(Vec::new);
                row.push((report.seam_deviation_max_edges, least, slivers));
            }
        }
    }
    for (i, mut row) in table {
        row.sort_by(|a, b| a.0.total_cmp(&b.0));
        let least = row.iter().map(|one| one.1).fold(f64::INFINITY, f64::min);
        let slivers = row.iter().map(|one| one.2).sum::<usize>() as f64 / row.len() as f64;
        let median = row[row.len() / 2].0;
        println!(
            "snap {i}: deviation {median:.1e} edges, altitude ratio {least:.1e}, {slivers:.2} slivers a cut"
        );
        assert!(i < 2 || slivers == 0.0);
    }
}

/// Moving the snapped vertices makes the seam straight and leaves faces well shaped; texture
/// coordinates go with them.
#[test]
fn a_snap_that_moves_makes_the_seam_straight() {
    let mut random = Random(53);
    let (mut deviations, mut moved) = (Vec::new(), 0);
    for sheet in sheets() {
        for _ in 0..40 {
            let (rays, _) = random_generic_rays(&sheet, &mut random);
            let mut cutting = Cutting::new(&sheet);
            let areas = |cutting: &Cutting| {
                let of = |f| {
                    let [a, b, c] = cutting
                        .mesh
                        .face_vertices(f)
                        .map(|v| cutting.positions.at(v));
                    (b - a).cross(&(c - a)).norm() / 2.0
                };
                cutting.mesh.faces().map(of).sum::<f64>()
            };
            let (before, altitude) = (
                areas(&cutting),
                altitudes(&cutting.mesh, &cutting.positions),
            );
            let scissor = scissor(rays).through(true).snap_move(true);
            let report = cutting.cut(&scissor);
            moved += cutting
                .edits
                .iter()
                .filter(|edit| matches!(edit, tearmesh::Edit::Slide(_)))
                .count();
            deviations.push(report.seam_deviation_max_edges);
            assert!((areas(&cutting) / before - 1.0).abs() < 1e-3);
            let after = altitudes(&cutting.mesh, &cutting.positions);
            let parents = parents(&cutting.edits, altitude.len());
            for (child, after) in after.iter().enumerate() {
                assert!(after / altitude[parents[child]] > 0.3 * 0.05 * 0.95);
            }
            // A corner that is less than the snap is touched and not cut off.
            assert!(report.crumbs == 0 && report.lost <= 1, "{report:?}");
        }
    }
    deviations.sort_by(f64::total_cmp);
    let straight = deviations
        .iter()
        .filter(|deviation| **deviation < 1e-12)
        .count();
    println!(
        "{moved} vertices moved, {straight} of {} seams straight",
        deviations.len()
    );
    assert!(deviations[deviations.len() / 2] < 1e-12 && moved > 150);
}

/// The smallest altitude of each face.
pub(crate) fn altitudes(mesh: &Mesh, positions: &Positions) -> Vec<f64> {
    let of = |f| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| positions.at(v));
        let longest = [(a, b), (b, c), (c, a)].map(|(p, q)| (q - p).norm());
        (b - a).cross(&(c - a)).norm() / longest.into_iter().fold(0.0, f64::max)
    };
    mesh.faces().map(of).collect()
}

/// The face of the mesh before the edits that each face now is a part of.
pub(crate) fn parents(edits: &Edits, faces: usize) -> Vec<usize> {
    let mut parents: Vec<usize> = (0..faces).collect();
    for edit in edits.iter() {
        if let tearmesh::Edit::Insert(insert) = edit {
            for child in insert
                .children
                .iter()
                .filter(|child| child.face != child.parent)
            {
                parents.push(parents[child.parent.index()]);
            }
        }
    }
    parents
}

#[test]
fn random_cuts_of_all_methods_can_be_mended() {
    let mut random = Random(59);
    let mut done = crate::cut_mend::Done::default();
    for _ in 0..4000 {
        let bytes = random.bytes(120);
        let result = std::panic::catch_unwind(|| crate::cut_mend::Case::from_bytes(&bytes).check());
        let Ok(one) = result else {
            panic!("{bytes:?}: {:?}", crate::cut_mend::Case::from_bytes(&bytes));
        };
        done.cuts += one.cuts;
        done.by_planes += one.by_planes;
        done.of_first += one.of_first;
        done.inserted += one.inserted;
        done.splits += one.splits;
        done.merges += one.merges;
    }
    println!("{done:?}");
    assert!(done.by_planes >= 500 && done.of_first >= 500);
}

/// A slit that ends inside a sheet is one slit of about the right length, whatever was snapped: a
/// snapped vertex stands for the crossing, also where it lies beyond a side plane itself.
#[test]
fn snapped_slits_are_whole_and_of_the_right_length() {
    for (snap, mean_max, most) in [(Scissor::SNAP, 0.02, 0.3), (0.2, 0.2, 1.3)] {
        let mut random = Random(67);
        let mut errors = Vec::new();
        for sheet in sheets() {
            for _ in 0..80 {
                let [x, y] = [0.25 + 0.5 * random.next(), 0.25 + 0.5 * random.next()];
                let turn = std::f64::consts::TAU * random.next();
                let half = 0.1 + 0.1 * random.next();
                let ends = [
                    [x - half * turn.cos(), y - half * turn.sin()],
                    [x + half * turn.cos(), y + half * turn.sin()],
                ];
                let mut cutting = Cutting::new(&sheet);
                let report = cutting.cut(&scissor(ends.map(crate::straight::down)).snap(snap));
                assert_eq!(cutting.mesh.boundary_loops().len(), 2, "{ends:?}");
                assert_eq!(report.tip_overshoots.len(), 2, "{ends:?}");
                let slit = report.seam_length / report.seam_length_ratio;
                errors.push((report.seam_length - slit).abs() / sheet.mean_edge());
            }
        }
        errors.sort_by(f64::total_cmp);
        let (count, longest) = (errors.len(), errors[errors.len() - 1]);
        let mean = errors.iter().sum::<f64>() / count as f64;
        println!("snap {snap}: {count} slits, length off by {mean:.3} edges, {longest:.3} at most");
        // Tips move rather than leave a thin face, by less than the way through one face.
        assert!(mean < mean_max && longest < most);
    }
}

/// Where rays pass two sheets, a polyline is one slit on each.
#[test]
fn a_polyline_is_joined_on_every_sheet_that_it_passes() {
    let mut random = Random(71);
    for snap in [0.0, Scissor::SNAP, 0.2] {
        let (mut mesh, mut points) = (Vec::new(), Vec::new());
        // Two sheets, one below the other, and not alike.
        for (z, sheet) in [(0.0, &sheets()[1]), (-1.0, &sheets()[2])] {
            let first = points.len() as u32;
            mesh.extend(sheet.faces.iter().map(|face| face.map(|v| v + first)));
            points.extend(sheet.points.iter().map(|p| [p[0], p[1], p[2] + z]));
        }
        let both = Surface {
            points,
            faces: mesh,
        };
        let (mut done, mut joined) = (0, 0);
        while done < 60 {
            let corners = random_corners(&mut random);
            let inside = |p: &[f64; 2]| p.iter().all(|x| *x > 0.05 && *x < 0.95);
            if !corners.iter().all(inside) {
                continue;
            }
            let mut cutting = Cutting::new(&both);
            along_polyline(&mut cutting, &corners, snap);
            done += 1;
            joined += usize::from(cutting.mesh.boundary_loops().len() == 4);
        }
        println!("snap {snap}: {joined} of {done} polylines joined on both sheets");
        // The plane passes through the joint on one sheet, and by that on the other: where that tip
        // had to move so that no face got thin, it may pass too far away.
        let least = [(0.0, 60), (Scissor::SNAP, 60), (0.2, 57)];
        let (_, least) = least.into_iter().find(|one| one.0 == snap).expect("a snap");
        assert!(joined >= least, "snap {snap}: {joined}");
    }
}

/// A sheet folded along an edge on the plane, with both faces on one side, is touched and not
/// cut; so is one with a strip in the plane.
#[test]
fn touching_is_not_cutting() {
    let fold = Surface {
        points: vec![[0.0; 3], [0.0, 1.0, 0.0], [1.0, 0.5, 0.5], [1.0, 0.5, -0.5]],
        faces: vec![[0, 1, 2], [1, 0, 3]],
    };
    let strip = Surface {
        points: vec![
            [0.0; 3],
            [0.0, 1.0, 0.0],
            [0.0, 1.0, 1.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.5, -0.5],
            [1.0, 0.5, 1.5],
        ],
        faces: vec![[0, 1, 2], [0, 2, 3], [1, 0, 4], [3, 2, 5]],
    };
    for surface in [fold, strip] {
        let mut cutting = Cutting::new(&surface);
        let rays = [[0.0, -1.0], [0.0, 2.0]].map(crate::straight::down);
        let report = cutting.cut(&scissor(rays).through(true));
        assert_eq!(
            (report.splits, report.vertices_inserted),
            (0, 0),
            "{report:?}"
        );
        // Where the neighbours are on different sides it is a cut.
        let mut other = surface.clone();
        other.points[3][0] = -1.0;
        if other.faces.len() == 2 {
            let report = Cutting::new(&other).cut(&scissor(rays).through(true));
            assert_eq!((report.splits, report.pieces), (2, 2), "{report:?}");
        }
    }
}

/// Where a cut crosses an older one, both sides of that are snapped alike: of copies at one place
/// all are split, or none.
#[test]
fn copies_of_a_vertex_decide_together() {
    let mut random = Random(73);
    let mut together = 0;
    for sheet in sheets() {
        for _ in 0..60 {
            let mut cutting = Cutting::new(&sheet);
            let mut part = || 0.2 + 0.6 * random.next();
            let upright = [[part(), -1.0], [part(), 2.0]].map(crate::straight::down);
            let level = [[-1.0, part()], [2.0, part()]].map(crate::straight::down);
            cutting.cut(&scissor(upright).through(true).snap(0.2));
            let before = cutting.mesh.clone();
            let first = cutting.edits.cursor();
            cutting.cut(&scissor(level).through(true).snap(0.2));
            let mut split: Vec<_> = Vec::new();
            for edit in cutting.edits.since(first) {
                if let tearmesh::Edit::Split(split_of) = edit {
                    split.push(split_of.old);
                }
            }
            for v in before.vertices().filter(|v| split.contains(v)) {
                let copies = before
                    .vertices()
                    .filter(|&w| before.root(w) == before.root(v));
                for w in copies {
                    assert!(split.contains(&w), "{v} was split, and {w} was not");
                    together += usize::from(w != v);
                }
            }
        }
    }
    println!("{together} copies");
    assert!(together >= 20, "only {together}");
}
