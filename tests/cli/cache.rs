//! `tear --cache`: read back by a reader of its own, and compared with frames.

use std::fs;

use crate::harness::Folder;
use crate::plain::Plain;

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
