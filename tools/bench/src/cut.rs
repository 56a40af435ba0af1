//! `cut`: a plane through an irregular sheet, both sides kept.
//!
//! First the contest, on two sizes of sheet; then two tables of ours alone (`cut/tables.rs`).

pub(crate) mod facts;
mod rival;
mod tables;
mod ways;

use tearmesh_lab::sheet::through;
use tearmesh_lab::statistics::median;

use crate::measure::{Contestant, median_of, rounds, timed_on_cpu};
use crate::options::Options;
use crate::table::{line, table};
use facts::{Facts, Sheet, mean_edge, sheet};
use rival::{Handover, Rival};
use ways::{Form, WAYS, time};

/// The contest on a tenth of the faces and on all, and the tables.
pub(crate) fn run(options: &Options) -> String {
    let sheets = [options.faces.div_ceil(10), options.faces].map(|faces| {
        let sheet = sheet(faces);
        contest(&sheet, options)
    });
    format!("{}\n{}", sheets.join("\n"), tables::run(options))
}

/// A rival, what it does, and what it took elsewhere for 100,352 and for 1,002,528 faces, in ms.
struct Elsewhere {
    name: &'static str,
    note: &'static str,
    quoted: Option<[f64; 2]>,
}

const RIVALS: [Elsewhere; 4] = [
    Elsewhere {
        name: "meshlib",
        note: "trimWithPlane in place, the other part beside; f32",
        quoted: Some([9.7, 131.0]),
    },
    Elsewhere {
        name: "trimesh",
        note: "slice_plane twice, no cap",
        quoted: Some([13.7, 179.0]),
    },
    Elsewhere {
        name: "vtk-plane",
        note: "vtkPolyDataPlaneClipper twice, no cap",
        quoted: None,
    },
    Elsewhere {
        name: "vtk-clip",
        note: "vtkClipPolyData with its clipped output",
        quoted: Some([31.0, 313.0]),
    },
];

impl Elsewhere {
    fn not_installed(&self, faces: usize) -> String {
        let Some([small, large]) = self.quoted else {
            return "not installed".to_owned();
        };
        let (ms, faces) = if faces < 300_000 {
            (small, "100,352")
        } else {
            (large, "1,002,528")
        };
        format!("not installed; {ms} ms for {faces} faces on another machine")
    }
}

fn contest(sheet: &Sheet, options: &Options) -> String {
    let (mesh, positions) = sheet;
    // Oblique, and through no vertex.
    let scissor = through([0.503, 0.471], 1.1);
    let handover = Handover::new(mesh, positions, &scissor.plane()).expect("a folder for files");
    let rivals = RIVALS.map(|rival| {
        let started = Rival::start(rival.name, &options.python, &handover);
        (rival, started)
    });
    let ours = WAYS.map(|way| {
        let scissor = scissor.clone().with_snap(way.snap);
        move |sheet: &Sheet| Some(time(&scissor, way.method, way.form, sheet))
    });
    let theirs = rivals
        .each_ref()
        .map(|(_, rival)| move |_: &Sheet| rival.as_ref().map(Rival::cut));
    let mut contestants: Vec<Contestant<'_, Sheet>> = Vec::new();
    for (way, run) in WAYS.iter().zip(&ours) {
        let note = way.form.note();
        contestants.push(Contestant {
            name: way.name,
            note,
            run,
        });
    }
    let walk = |(mesh, _): &Sheet| Some(timed_on_cpu(|| mesh.components().count()).1);
    contestants.push(Contestant {
        name: "components",
        note: "one walk over all: a report may add this and a cut",
        run: &walk,
    });
    for ((rival, _), run) in rivals.iter().zip(&theirs) {
        contestants.push(Contestant {
            name: rival.name,
            note: rival.note,
            run,
        });
    }
    let results = rounds(sheet, &contestants, options);
    let is_rival = |name: &str| RIVALS.iter().any(|rival| rival.name == name);
    let fastest = results
        .iter()
        .filter(|(contestant, _)| is_rival(contestant.name))
        .filter_map(|(_, times)| median(times.clone()))
        .reduce(f64::min);

    let mean_edge = mean_edge((mesh, positions));
    let mut speeds = vec![line(["", "ms", "least ms", "x best rival", ""])];
    let mut looks = vec![line([
        "",
        "faces",
        "seam",
        "cracks",
        "deviation",
        "in edges",
        "length",
        "area",
        "pieces",
        "mass",
        "altitude",
        "child",
        "uv",
    ])];
    for (contestant, times) in &results {
        let name = contestant.name;
        let rival = rivals.iter().find(|(rival, _)| rival.name == name);
        if let Some((rival, None)) = rival {
            let missing = rival.not_installed(mesh.face_count());
            speeds.push(line([name, "", "", "", &missing]));
            continue;
        }
        let median = median_of(times, |seconds| *seconds);
        let least = times.iter().copied().fold(f64::INFINITY, f64::min);
        let ratio = fastest.map_or(String::new(), |time| format!("{:.2}", time / median));
        let note = match rival {
            Some((_, Some(rival))) => format!("{}: {}", rival.version(), contestant.note),
            _ => contestant.note.to_owned(),
        };
        let [ms, least] = [median, least].map(|s| format!("{:.2}", s * 1e3));
        speeds.push(line([name, &ms, &least, &ratio, &note]));
        if let Some((_, Some(rival))) = rival {
            looks.push(look_of_rival(name, rival, mean_edge));
        }
        if let Some(way) = WAYS
            .iter()
            .find(|way| way.name == name && way.form == Form::First)
        {
            let facts = Facts::new(&scissor.clone().with_snap(way.snap), way.method, sheet);
            looks.push(look_of_ours(name, &facts, mean_edge));
        }
    }
    format!(
        "through cut of {} vertices, {} faces; CPU time of {} rounds\n{}\n{}",
        mesh.vertex_count(),
        mesh.face_count(),
        options.rounds,
        table(&speeds),
        table(&looks)
    )
}

fn look_of_ours(name: &str, facts: &Facts, mean_edge: f64) -> Vec<String> {
    let report = &facts.report;
    line([
        name,
        &facts.faces.to_string(),
        &(report.ghost_pairs / 2).to_string(),
        &facts.cracks.to_string(),
        &format!("{:.1e}", report.seam_deviation_max),
        &format!("{:.1e}", report.seam_deviation_max_edges),
        &format!("{:.6}", report.seam_length_ratio),
        &format!("{:.1e}", facts.area),
        &format!("{} of {}", report.pieces, report.pieces_expected),
        if facts.mass_is_exact { "exact" } else { "lost" },
        &format!("{:.1e}", report.altitude_min / mean_edge),
        &format!("{:.1e}", facts.child_altitude),
        &format!("{:.1e}", facts.texture),
    ])
}

fn look_of_rival(name: &str, rival: &Rival, mean_edge: f64) -> Vec<String> {
    let facts = rival.check();
    line([
        name,
        &facts.faces.to_string(),
        &facts.seam.to_string(),
        &facts.cracks.to_string(),
        &format!("{:.1e}", facts.deviation),
        &format!("{:.1e}", facts.deviation / mean_edge),
        "",
        &format!("{:.1e}", facts.area),
    ])
}
