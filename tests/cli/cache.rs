//! `tear --cache`: read back by a reader of its own, and compared with frames.

use std::fs;

use crate::harness::{Folder, seen};

/// A point cache, read by what is known of the format.
struct Cache {
    start: f32,
    rate: f32,
    samples: Vec<Vec<[f32; 3]>>,
}

fn cache(bytes: &[u8]) -> Cache {
    let word = |at: usize| -> [u8; 4] { bytes[at..at + 4].try_into().expect("four bytes") };
    let int = |at| usize::try_from(i32::from_le_bytes(word(at))).expect("a count");
    let float = |at| f32::from_le_bytes(word(at));
    assert_eq!(&bytes[..12], b"POINTCACHE2\0");
    assert_eq!(int(12), 1, "the version");
    let (points, samples) = (int(16), int(28));
    assert_eq!(bytes.len(), 32 + samples * points * 12);
    let point = |at: usize| [0, 4, 8].map(|x| float(32 + at * 12 + x));
    let sample = |s: usize| (0..points).map(|p| point(s * points + p)).collect();
    Cache {
        start: float(20),
        rate: float(24),
        samples: (0..samples).map(sample).collect(),
    }
}

/// The places of the `v` of a file, as a cache has them.
fn places(text: &str) -> Vec<[f32; 3]> {
    let lines = text.lines().filter_map(|line| line.strip_prefix("v "));
    let numbers = lines.map(|line| line.split(' ').map(|x| x.parse::<f64>().expect("a number")));
    numbers
        .map(|mut numbers| [(); 3].map(|()| numbers.next().expect("three numbers") as f32))
        .collect()
}

#[test]
fn a_cache_has_the_places_of_the_frames_and_of_the_mesh_that_is_written() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"hang\"\nseconds = 0.5\n");
    let quilt = "quilt.obj --scene s.toml --rays 1,2,9:0,0,-1 1,-2,9:0,0,-1 --cut-at 0.2";
    for (what, are_born) in [("sheet.obj --scene rip --seconds 1.5", true), (quilt, true)] {
        let line = format!("tearmesh tear {what} --frames f --frames-topology final");
        let output = folder.run(&format!("{line} --cache c.pc2 -o t.obj --report r.json"));
        assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
        let bytes = fs::read(folder.path("c.pc2")).expect("a cache");
        let Cache {
            start,
            rate,
            samples,
        } = cache(&bytes);
        assert_eq!((start, rate), (1.0, 1.0));
        let frames = fs::read_dir(folder.path("f")).expect("frames").count();
        assert_eq!(samples.len(), frames);
        for (number, sample) in samples.iter().enumerate() {
            let frame = places(&folder.read(&format!("f/frame_{number:05}.obj")));
            assert!(*sample == frame, "{what}: sample {number}");
        }
        let last = places(&folder.read("t.obj"));
        assert_eq!(samples[0].len(), last.len());
        let report: serde_json::Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
        assert_eq!(report["cache"]["samples"], frames);
        assert_eq!(report["cache"]["points"], last.len());
        let born = last.len() > report["input"]["vertices"].as_u64().expect("a count") as usize;
        assert_eq!(born, are_born);
        // The same cache comes without frames, and beside frames with faces of their own.
        for other in ["", "--frames g"] {
            let line = format!("tearmesh tear {what} {other} --cache again.pc2 -q -o t.obj");
            let output = folder.run(&line);
            assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
            assert!(
                fs::read(folder.path("again.pc2")).expect("a cache") == bytes,
                "{other}"
            );
        }
        fs::remove_dir_all(folder.path("f")).expect("no frames");
        fs::remove_dir_all(folder.path("g")).expect("no frames");
    }
}

#[test]
fn a_cache_replaces_nothing() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"hang\"\nseconds = 0.1\n");
    for (options, exit) in [
        ("--cache sheet.obj -o t.obj", 2),
        ("--cache s.toml -o t.obj", 2),
        ("--cache t.obj -o ./t.obj", 2),
        ("--cache c.csv --forces c.csv -o t.obj", 2),
        ("--cache - -o t.obj", 2),
        ("--cache no/c.pc2 -o t.obj", 7),
    ] {
        let before = folder.names();
        let output = folder.run(&format!("tearmesh tear sheet.obj --scene s.toml {options}"));
        assert_eq!(
            output.status.code(),
            Some(exit),
            "{options}\n{}",
            seen(&output)
        );
        assert_eq!(folder.names(), before, "{options}");
    }
}
