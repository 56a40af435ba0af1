//! Scenes and what they hold, as data: written and read they are the same to the bit, and what cannot be played is
//! not read.

use serde_json::Value;
use tearmesh::Vector;
use tearmesh_cloth::scene::{Axis, Frame, Region, Run, Scene};
use tearmesh_cloth::{Fabric, Method, Tearing, Threshold, implicit};

use crate::digest;
use crate::parts::scenes::{play, square, staged};
use crate::parts::woven::of_moduli;

/// Everything that a scene can hold, for a sheet of a metre.
fn everything() -> Value {
    serde_json::from_str(include_str!("scene.json")).expect("JSON")
}

fn read(data: &Value) -> Result<Scene, String> {
    serde_json::from_str(&data.to_string()).map_err(|error| error.to_string())
}

fn digest_of(run: Run) -> u64 {
    let run = play(run);
    let bits = run.cloth().positions().iter().flat_map(|x| [x.x, x.y, x.z]);
    let bytes = bits.flat_map(f64::to_le_bytes);
    let faces = run.mesh().indices().iter().flat_map(|v| v.to_le_bytes());
    digest::after(digest::EMPTY, bytes.chain(faces))
}

/// And its data have the names that they had.
#[test]
fn a_scene_that_was_written_and_read_plays_the_same() {
    let written = staged(16, |_| read(&everything()).expect("a scene"));
    let data = serde_json::to_value(written.scene()).expect("data");
    assert_eq!(data, everything());
    let again = staged(16, |_| read(&data).expect("a scene"));
    assert_eq!(
        format!("{:?}", again.scene()),
        format!("{:?}", written.scene())
    );
    assert!(
        again.scene().colliders == written.scene().colliders,
        "the grid is made again"
    );
    assert_eq!(digest_of(again), digest_of(written));
}

/// The format of scenes, and the digest of the names in [`everything`].
const FORMAT: (u32, u64) = (2, 0x389e_c698_24be_fd27);

/// All names in data, with those that they are in.
fn names(data: &Value, within: &str) -> Vec<String> {
    let parts: Vec<(String, &Value)> = match data {
        Value::Object(fields) => {
            let named = |(name, value)| (format!("{within}.{name}"), value);
            fields.iter().map(named).collect()
        }
        Value::Array(values) => {
            let nameless = |value| (within.to_owned(), value);
            values.iter().map(nameless).collect()
        }
        _ => Vec::new(),
    };
    let of_part = |(name, value): (String, &Value)| {
        let inner = names(value, &name);
        std::iter::once(name).chain(inner)
    };
    parts.into_iter().flat_map(of_part).collect()
}

/// The committed module of `play` reads scenes of one format.
#[test]
fn data_with_other_names_is_of_another_format() {
    let mut names = names(&everything(), "");
    names.sort_unstable();
    names.dedup();
    let digest = digest::after(digest::EMPTY, names.concat().bytes());
    assert_eq!(
        FORMAT,
        (Scene::FORMAT, digest),
        "raise Scene::FORMAT, and write its digest here: {digest:#018x}"
    );
}

#[test]
fn parts_and_ready_scenes_are_read_as_they_were_written() {
    fn same<T>(written: T)
    where
        T: serde::Serialize + for<'de> serde::Deserialize<'de> + std::fmt::Debug,
    {
        let text = serde_json::to_string(&written).expect("data");
        let read: T = serde_json::from_str(&text).expect("it is read");
        assert_eq!(format!("{read:?}"), format!("{written:?}"));
    }
    Method::NAMES.map(Method::named).into_iter().for_each(same);
    same(Method::Implicit(implicit::Settings {
        method: implicit::Method::Bdf2,
        ..implicit::Settings::default()
    }));
    let warp = Vector::new(0.1, 1.0, 0.0);
    same(Fabric::orthotropic(of_moduli(
        [800.0, 500.0, 0.1 + 0.2],
        warp,
    )));
    same(Fabric::of_edges(1e-300));
    let axis = Vector::y();
    same(Tearing::new(Threshold::WarpWeft {
        warp: 1.2,
        weft: 1.3,
        axis,
    }));
    for (_, ready) in Scene::PRESETS {
        same(staged(4, ready).scene().clone());
    }
}

/// Rows of the table beside this file: `reading` or `playing`, what is changed in the scene, to which value, and a
/// part of what is said. A scene that can be read may still not be playable on a mesh.
#[test]
fn scenes_that_cannot_be_played_are_refused() {
    let (mesh, positions) = square(8);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let good = everything();
    read(&good).map(drop).expect("the scene itself");
    for row in include_str!("refused.txt").lines() {
        let (change, said) = row.split_once(" => ").expect("what is said");
        let [when, place, bad] = change.splitn(3, ' ').collect::<Vec<_>>()[..] else {
            panic!("{row}");
        };
        let mut data = good.clone();
        *data.pointer_mut(place).expect(row) = serde_json::from_str(bad).expect(row);
        let why = match read(&data) {
            Err(why) => format!("reading {why}"),
            Ok(scene) => {
                let refused = Run::new(mesh.clone(), &positions, scene, &frame);
                format!("playing {}", refused.expect_err(row))
            }
        };
        assert!(why.starts_with(when) && why.contains(said), "{row}: {why}");
    }
}

/// Rows of the table beside this file: a region, and the vertices in it of a sheet of 4 × 4 cells.
#[test]
fn regions_hold_what_lies_in_them() {
    let (mesh, positions) = square(4);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    for row in include_str!("regions.txt").lines() {
        let (region, expected) = row.split_once(" => ").expect("vertices");
        let region: Region = serde_json::from_str(region).expect(row);
        let found = region.vertices(&mesh, positions.as_slice(), &frame);
        let found: Vec<String> = found.iter().map(|v| v.index().to_string()).collect();
        assert_eq!(found.join(" "), expected, "{row}");
    }
}
