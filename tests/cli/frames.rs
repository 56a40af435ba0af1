//! Frames: which of their numbers stay, where their corners are, and what an interruption leaves of them; and caches,
//! which have the same places.

use std::fs;

use crate::harness::Folder;
#[cfg(unix)]
use crate::harness::interrupted_at;
use crate::plain::Plain;
use crate::vectors::{length, minus};

#[test]
fn frames_of_one_topology_have_the_same_corners() {
    let folder = Folder::new();
    let rip = "tear sheet.obj --scene rip --seconds 1.5";
    folder.done(&format!("{rip} --frames own -o own.obj"));
    let options = "--frames final --frames-topology final -o final.obj --report r.json";
    folder.done(&format!("{rip} {options}"));
    assert_eq!(folder.read("own.obj"), folder.read("final.obj"));
    let names = folder.list("own");
    assert_eq!(names, folder.list("final"));
    assert_eq!((names.len(), &*names[45]), (46, "frame_00045.obj"));
    let last = Plain::read(&folder.read("final.obj"));
    let mut grown = 0;
    for name in &names {
        let [own, one] =
            ["own", "final"].map(|of| Plain::read(&folder.read(&format!("{of}/{name}"))));
        assert_eq!(one.faces, last.faces, "{name}: one index buffer");
        assert_eq!(one.vertices.len(), last.vertices.len());
        assert!(own.corners().eq(one.corners()), "{name}");
        // Vertices keep their order, and new ones are appended.
        grown = own.vertices.len();
        assert_eq!(own.vertices[..], one.vertices[..grown]);
    }
    let report = folder.json("r.json");
    assert_eq!(report["frames"]["count"], 46);
    assert_eq!(
        report["frames"]["corners_checked"],
        46 * 3 * last.faces.len()
    );
    // The last frame is the output, which has more copies behind those: of vertices whose faces
    // share no edge.
    let splits = report["splits"].as_u64().expect("a count") as usize;
    assert!(splits > 0 && grown == 600 + splits && grown < last.vertices.len());
}

/// The faces of a frame before the cut are divided already, but on the same surface.
#[test]
fn frames_before_a_cut_have_its_vertices_on_their_edges() {
    let folder = Folder::new();
    for options in ["--frames own", "--frames final --frames-topology final"] {
        let line = "tear sheet.obj --scene tests/data/scarf.toml";
        folder.done(&format!("{line} {options} -o out.obj"));
    }
    for name in folder.list("own") {
        let [own, one] =
            ["own", "final"].map(|of| Plain::read(&folder.read(&format!("{of}/{name}"))));
        assert_eq!(
            own.vertices[..],
            one.vertices[..own.vertices.len()],
            "{name}"
        );
        let [before, after] = [own.area(), one.area()];
        assert!(
            (before - after).abs() < 1e-9 * before,
            "{name}: {before} {after}"
        );
    }
}

/// The frames with the faces of the last one are written at the end, and take their time.
#[cfg(unix)]
#[test]
fn frames_interrupted_in_writing_leave_a_saved_run() {
    let folder = Folder::new();
    let line = "tear flag.obj --scene hang --solver pbd --dt 0.033 --seconds 20 --frames f \
                --frames-topology final -o saved.obj --report r.json";
    let answer = interrupted_at(folder.command(line), &folder.path("f/frame_00002.obj"));
    let said = answer.seen();
    assert_eq!(answer.exit, 130, "{said}");
    let frames = folder.list("f").len();
    assert!((3..600).contains(&frames), "{frames} frames");
    for part in [
        "wrote saved.obj",
        "W-FRAMES-INTERRUPTED",
        &format!("{frames} of 601 frames"),
    ] {
        assert!(said.contains(part), "{said}");
    }
    let report = folder.json("r.json");
    assert_eq!(report["status"], "done");
    assert_eq!(report["exit"], 130);
    assert_eq!(report["frames"]["count"], frames);
    assert!(Plain::read(&folder.read("saved.obj")).vertices.len() >= 1089);
}

/// The samples of a point cache, read by what is known of the format.
fn samples(bytes: &[u8]) -> Vec<Vec<[f32; 3]>> {
    let word = |at: usize| -> [u8; 4] { bytes[at..at + 4].try_into().expect("four bytes") };
    let int = |at| usize::try_from(i32::from_le_bytes(word(at))).expect("a count");
    let float = |at| f32::from_le_bytes(word(at));
    assert_eq!(&bytes[..12], b"POINTCACHE2\0");
    assert_eq!(int(12), 1, "the version");
    let (points, samples) = (int(16), int(28));
    assert_eq!(bytes.len(), 32 + samples * points * 12);
    assert_eq!([float(20), float(24)], [1.0, 1.0], "the start and the rate");
    let point = |at: usize| [0, 4, 8].map(|x| float(32 + at * 12 + x));
    let sample = |s: usize| (0..points).map(|p| point(s * points + p)).collect();
    (0..samples).map(sample).collect()
}

#[test]
fn caches_have_the_places_of_frames_and_mesh() {
    let folder = Folder::new();
    let places = |name: &str| -> Vec<[f32; 3]> {
        let plain = Plain::read(&folder.read(name));
        let all = 0..plain.vertices.len();
        all.map(|v| plain.at(v).map(|x| x as f32)).collect()
    };
    folder.write("s.toml", "base = \"hang\"\nseconds = 0.5\n");
    let quilt = "quilt.obj --scene s.toml --rays 1,2,9:0,0,-1 1,-2,9:0,0,-1 --cut-at 0.2";
    for what in ["sheet.obj --scene rip --seconds 1.5", quilt] {
        let line = format!("tear {what} --frames f --frames-topology final");
        folder.done(&format!("{line} --cache c.pc2 -o t.obj --report r.json"));
        let bytes = folder.bytes("c.pc2");
        let samples = samples(&bytes);
        let frames = folder.list("f");
        assert_eq!(samples.len(), frames.len());
        for (frame, sample) in frames.iter().zip(&samples) {
            assert!(*sample == places(&format!("f/{frame}")), "{what}: {frame}");
        }
        let last = places("t.obj");
        assert_eq!(samples[0].len(), last.len());
        let report = folder.json("r.json");
        assert_eq!(report["cache"]["samples"], frames.len());
        assert_eq!(report["cache"]["points"], last.len());
        assert!(Some(last.len() as u64) > report["input"]["vertices"].as_u64());
        // The same cache comes without frames, and beside frames with faces of their own.
        for other in ["", "--frames g"] {
            folder.done(&format!(
                "tear {what} {other} --cache again.pc2 -q -o t.obj"
            ));
            assert!(folder.bytes("again.pc2") == bytes, "{other}");
        }
        fs::remove_dir_all(folder.path("f")).expect("no frames");
        fs::remove_dir_all(folder.path("g")).expect("no frames");
    }
}

/// The file of a sheet that lies elsewhere.
fn moved(folder: &Folder, by: [f64; 3]) -> String {
    let plain = Plain::read(&folder.read("sheet.obj"));
    let all = 0..plain.vertices.len();
    let places = all
        .map(|v| plain.at(v))
        .map(|p| [0, 1, 2].map(|i| p[i] + by[i]));
    let vertices = places.map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = plain.faces.iter().map(|face| {
        let corners = face.iter().map(|v| format!(" {}", v + 1));
        format!("f{}\n", corners.collect::<String>())
    });
    vertices.chain(faces).collect()
}

/// A sheet of a metre in coordinates of a map, where numbers of 32 bits are .03 and .5 apart: it is refused before
/// anything is done, with the origin to give; and with that, each point of the cache is where it belongs.
#[test]
fn regression_a_cache_far_from_the_origin_takes_an_origin() {
    let folder = Folder::new();
    let mut tried = 0;
    for by in [
        [448_262.37, 4_411_932.61, 0.0],
        [-448_262.37, 1e4, -3e7],
        [1e9 / 3.0, 0.0, 0.0],
        [4e3, 0.0, 0.0],
        [40.0, 0.0, 0.0],
    ] {
        folder.write("map.obj", moved(&folder, by));
        let plain = Plain::read(&folder.read("map.obj"));
        let lengths = plain.faces.iter().flat_map(|face| plain.sides(face));
        let mean = lengths.clone().sum::<f64>() / lengths.count() as f64;
        let off = |p: [f64; 3], at: [f64; 3]| length(minus(p, at));
        let rounded = |p: [f64; 3]| p.map(|x| f64::from(x as f32));
        let places = || (0..plain.vertices.len()).map(|v| plain.at(v));
        let worst = places().map(|p| off(rounded(p), p)).fold(0.0, f64::max);
        let line = "tear map.obj --scene hang --seconds 0.1 --cache c.pc2 -o t.obj --frames f --frames-topology final";
        let mut origin = [0.0; 3];
        let mut line = line.to_owned();
        // (Which edges count is not the test's business where it is close.)
        if worst > 1.1e-3 * mean {
            let said = folder.ends(&line, 2);
            assert!(!folder.path("t.obj").exists() && !folder.path("c.pc2").exists());
            let (_, told) = said.split_once("would move vertex ").expect("a vertex");
            let named: usize = told
                .split(' ')
                .next()
                .and_then(|v| v.parse().ok())
                .expect("a number");
            let p = plain.at(named - 1);
            assert!(off(rounded(p), p) == worst, "{said}");
            let (_, told) = said.split_once("--cache-origin ").expect("an origin");
            let told = told.split(':').next().expect("three numbers");
            let numbers: Vec<f64> = told
                .split(',')
                .map(|x| x.parse().expect("a number"))
                .collect();
            origin = numbers.try_into().expect("three");
            line += &format!(" --cache-origin {told}");
            tried += 1;
        } else {
            assert!(worst < 0.9e-3 * mean);
        }
        folder.done(&format!("{line} --report r.json"));
        let told = &folder.json("r.json")["cache"]["origin"];
        assert_eq!(*told, serde_json::json!(origin));
        let samples = samples(&folder.bytes("c.pc2"));
        for (frame, sample) in folder.list("f").iter().zip(&samples) {
            let plain = Plain::read(&folder.read(&format!("f/{frame}")));
            for (v, &point) in sample.iter().enumerate() {
                let point = [0, 1, 2].map(|i| f64::from(point[i]) + origin[i]);
                assert!(
                    off(point, plain.at(v)) <= 1.1e-3 * mean,
                    "{by:?}: {frame}, {v}"
                );
            }
        }
        for name in ["t.obj", "c.pc2"] {
            fs::remove_file(folder.path(name)).expect("a file");
        }
        fs::remove_dir_all(folder.path("f")).expect("frames");
    }
    assert_eq!(tried, 4);
}

/// A cloth that is carried far away has no cache; all else is written, and the exit status says that something is not.
#[test]
fn a_cloth_that_moves_far_away_has_all_but_a_cache() {
    let folder = Folder::new();
    let carried = |to: f64| {
        let scene = format!(
            "seconds = 0.2\n[[hold]]\nacross = [0, 1]\nmoves = [[0, 0, 0, 0], [0.1, {to}, 0, 0]]\n"
        );
        folder.write("s.toml", scene);
        "tear sheet.obj --scene s.toml --cache c.pc2 -o t.obj --report r.json --frames f --frames-topology final"
    };
    let said = folder.ends(carried(1e6), 7);
    assert!(
        said.contains("error[E-CACHE-ORIGIN]: the cache would move vertex "),
        "{said}"
    );
    assert!(
        said.contains(" of frame ") && said.contains("no --cache-origin helps"),
        "{said}"
    );
    assert!(!folder.path("c.pc2").exists() && folder.path("t.obj").exists());
    let report = folder.json("r.json");
    assert_eq!(
        (&report["exit"], report["frames"]["count"].as_u64()),
        (&7.into(), Some(7))
    );
    assert!(report["cache"].is_null());
    assert_eq!(folder.list("f").len(), 7);
    folder.done(carried(10.0));
    assert!(folder.path("c.pc2").exists());
}
