//! Pages, read back by a reader of its own that shares no code with them.

use std::io::Read as _;

use base64::prelude::{BASE64_STANDARD, Engine as _};
use proptest::prelude::*;
use serde_json::Value;
use tearmesh::nalgebra::Matrix3x4;
use tearmesh::{CutMethod, Edits, Mesh, Point, Positions, Ray, Scissor, Vector, shapes};
use tearmesh_view::{CameraError, CutLine, Moment, Page, is_page};

use crate::digest;
use crate::meshes::soup;

/// What a page shows at one time.
#[derive(Debug, Default, PartialEq)]
struct Shown {
    corners: Vec<u32>,
    kinds: Vec<u32>,
    pieces: Vec<u32>,
    places: Vec<[f64; 3]>,
}

/// A page that was read.
struct Read {
    text: Value,
    shown: Vec<Shown>,
}

fn written(page: &Page) -> String {
    let mut html = Vec::new();
    page.write(&mut html).expect("memory takes everything");
    String::from_utf8(html).expect("a page is text")
}

/// Reads a page by what its documentation says.
fn read(html: &str) -> Read {
    let (_, after) = html
        .split_once("<script id=\"data\" type=\"text/plain\">")
        .expect("data");
    let (packed, _) = after.split_once("</script>").expect("an end");
    let mut bytes = Vec::new();
    let packed = BASE64_STANDARD.decode(packed).expect("base 64");
    flate2::read::ZlibDecoder::new(&packed[..])
        .read_to_end(&mut bytes)
        .expect("zlib");
    let length = u32::from_le_bytes(bytes[..4].try_into().expect("four bytes")) as usize;
    let text: Value = serde_json::from_slice(&bytes[4..4 + length]).expect("JSON");
    let faces = 4 + length + count(&text["faceBytes"]);
    let solids = text["solids"].as_array().map_or(0, Vec::len);
    let states = states(&bytes[4 + length..faces], count(&text["states"]), solids);
    let shown = moments(&bytes[faces..], &text, &states);
    Read { text, shown }
}

fn count(value: &Value) -> usize {
    value.as_u64().expect("a count") as usize
}

fn unfolded(x: u64) -> i64 {
    if x % 2 == 1 {
        -(x as i64 + 1) / 2
    } else {
        x as i64 / 2
    }
}

/// Three lists a state: corners, kinds, pieces; and the corners of each solid.
fn states(bytes: &[u8], count: usize, solids: usize) -> Vec<[Vec<u32>; 3]> {
    let mut rest = bytes.iter();
    let mut number = || {
        let (mut sum, mut shift) = (0u64, 0);
        loop {
            let byte = *rest.next().expect("more bytes");
            sum |= u64::from(byte % 128) << shift;
            shift += 7;
            if byte < 128 {
                return sum;
            }
        }
    };
    let mut last: [Vec<u32>; 3] = Default::default();
    let mut all = Vec::new();
    for state in 0..count + solids {
        let lists = if state < count { 3 } else { 1 };
        if state >= count {
            last = Default::default();
        }
        for list in &mut last[..lists] {
            let (length, mut at, mut value) = (number() as usize, 0, 0);
            list.resize(length, 0);
            while at < length {
                at += number() as usize;
                for _ in 0..number() {
                    value += unfolded(number());
                    list[at] = value as u32;
                    at += 1;
                }
            }
        }
        all.push(last.clone());
    }
    assert!(rest.next().is_none(), "nothing is left over");
    all
}

fn moments(bytes: &[u8], text: &Value, states: &[[Vec<u32>; 3]]) -> Vec<Shown> {
    let told = text["moments"].as_array().expect("moments");
    let first = 3 * count(&told[0]["vertices"]);
    let float = |i: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[byte * first + i]));
    let planes = &bytes[4 * first..];
    let total = planes.len() / 3;
    let mut at = 0;
    let mut off = || {
        let x = [2, 1, 0].map(|plane| u64::from(planes[plane * total + at]));
        at += 1;
        unfolded(x[0] << 16 | x[1] << 8 | x[2])
    };
    // Along each axis: where each vertex was.
    let mut tracks: [Vec<i64>; 3] = [0, 1, 2].map(|axis| {
        let of_axis = (0..first / 3).map(|v| float(axis * first / 3 + v));
        of_axis
            .map(|x| (f64::from(x) * 65536.0).round() as i64)
            .collect()
    });
    let mut shown = Vec::new();
    let solids = text["solids"].as_array().into_iter().flatten();
    let of_states = told.iter().map(|moment| count(&moment["state"]));
    let of_states = of_states.chain(count(&text["states"])..);
    let all = told.iter().chain(solids).zip(of_states);
    for (number, (one, state)) in all.enumerate() {
        let (vertices, [corners, kinds, pieces]) = (count(&one["vertices"]), &states[state]);
        for track in tracks.iter_mut().filter(|_| number > 0) {
            track.resize(vertices, 0);
            let mut moved = 0;
            for place in track {
                moved += off();
                *place += moved;
            }
        }
        let part = |axis: usize, v: usize| match number {
            0 => f64::from(float(axis * first / 3 + v)),
            _ => tracks[axis][v] as f64 / 65536.0,
        };
        let side = text["side"].as_f64().expect("a length");
        let origin = |axis: usize| text["origin"][axis].as_f64().expect("a coordinate");
        let place = |v| [0, 1, 2].map(|axis| origin(axis) + side * part(axis, v));
        shown.push(Shown {
            corners: corners.clone(),
            kinds: kinds.clone(),
            pieces: pieces.clone(),
            places: (0..vertices).map(place).collect(),
        });
    }
    assert_eq!(at, total, "nothing is left over");
    shown
}

/// Checks that a page shows meshes, and gives what was read.
fn shows(page: &Page, meshes: &[(Mesh, Positions)]) -> Read {
    let read = read(&written(page));
    assert_eq!(read.shown.len(), meshes.len());
    let is_shown = |mesh: &Mesh, v: usize| mesh.indices().contains(&(v as u32));
    let coordinates = meshes.iter().flat_map(|(mesh, positions)| {
        let points = positions.as_slice().iter().enumerate();
        points.filter(|&(v, _)| is_shown(mesh, v)).map(|(_, p)| p)
    });
    let (least, most) =
        coordinates.fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), |(a, b), p| {
            (
                [0, 1, 2].map(|i| p[i].min(a[i])),
                [0, 1, 2].map(|i| p[i].max(b[i])),
            )
        });
    let side = (0..3).map(|i| most[i] - least[i]).fold(0.0, f64::max);
    for (number, ((mesh, positions), shown)) in meshes.iter().zip(&read.shown).enumerate() {
        assert_eq!(shown.corners, mesh.indices());
        let kind = |h| u32::from(mesh.pair(h).is_none()) + u32::from(mesh.ghost_pair(h).is_some());
        assert_eq!(shown.kinds, mesh.half_edges().map(kind).collect::<Vec<_>>());
        let components = mesh.components();
        let pairs = mesh
            .faces()
            .map(|f| (components.of(f), shown.pieces[f.index()]));
        let pairs: std::collections::BTreeSet<_> = pairs.collect();
        assert_eq!(pairs.len(), components.count(), "a number for each piece");
        let numbers: std::collections::BTreeSet<_> = pairs.iter().map(|pair| pair.1).collect();
        assert_eq!(
            numbers.len(),
            components.count(),
            "and a piece for each number"
        );
        // Half a step of the lattice, or of the last bit of a float; and what adding the origin rounds.
        let largest = least
            .iter()
            .chain(&most)
            .fold(0.0, |max: f64, x| max.max(x.abs()));
        let step = if number == 0 {
            side / f64::from(1 << 24)
        } else {
            side / 65536.0
        };
        let allowed = step / 2.0 * (1.0 + 1e-9) + largest * 1e-15;
        for (v, (is, p)) in shown.places.iter().zip(positions.as_slice()).enumerate() {
            for axis in (0..3).filter(|_| is_shown(mesh, v)) {
                let off = (is[axis] - p[axis]).abs();
                assert!(
                    off <= allowed,
                    "moment {number}: v{v} is {off} off, of {allowed}"
                );
            }
        }
    }
    read
}

fn page_of(meshes: &[(Mesh, Positions)]) -> Page {
    let mut page = Page::new("some meshes", Vector::y());
    for (mesh, positions) in meshes {
        page.add(mesh, positions, Moment::default())
            .expect("it has faces");
    }
    page
}

/// A sheet that is cut three times, and waves.
fn waving() -> Vec<(Mesh, Positions)> {
    let (mut mesh, mut positions) = shapes::grid(12, 9);
    let mut edits = Edits::new();
    let mut all = Vec::new();
    for number in 0..20u32 {
        if number % 6 == 3 {
            let at = f64::from(number) / 20.0 + 0.07;
            let down = |y| Ray::new(Point::new(at, y, 5.0), -Vector::z()).expect("a ray");
            let scissor = Scissor::new(down(-0.1), down(1.1)).expect("a plane");
            let cut = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits);
            assert!(cut.is_ok(), "positions follow");
            assert_eq!(mesh.components().count(), 2 + number as usize / 6);
        }
        let time = f64::from(number) / 6.0;
        let moved = positions.as_slice().iter().map(|p| {
            let lift = (p.x * 3.0 - time) * (p.x * 2.0 + p.y - 1.0 + time * time) * 0.1;
            Point::new(p.x + waving_at().x, p.y - time * time / 3.0, p.z + lift)
        });
        all.push((mesh.clone(), Positions::new(moved).expect("they are small")));
    }
    all
}

#[test]
fn a_page_has_the_faces_and_the_places_of_every_moment() {
    let meshes = waving();
    let read = shows(&page_of(&meshes), &meshes);
    assert_eq!(read.text["states"], 4, "faces are stored where they change");
    let torn: Vec<f64> = read.text["moments"]
        .as_array()
        .expect("moments")
        .iter()
        .map(|moment| moment["torn"].as_f64().expect("a length"))
        .collect();
    assert!(torn[2] == 0.0 && torn[19] > 3.0, "{torn:?}");
    // A piece keeps its number while others come off.
    let [before, after] = [8, 9].map(|i| &read.shown[i].pieces);
    let kept = before
        .iter()
        .zip(after)
        .filter(|(before, after)| before == after)
        .count();
    assert!(kept > before.len() / 2, "{kept} of {}", before.len());
}

/// Those of a page stand behind its moments as they were made, and each moment says where they are.
#[test]
fn solids_are_where_each_moment_places_them() {
    let meshes = waving();
    let (solid, skin) = shapes::octahedron();
    let skin: Vec<Point> = skin.as_slice().iter().map(|p| p + waving_at()).collect();
    let mut page = Page::new("", Vector::y());
    for _ in 0..2 {
        page.add_solid(skin.clone(), solid.indices().as_chunks().0);
    }
    // The first turns by a right angle and more, and the second is pushed.
    let turn = [[0.0, 0.6, 0.8], [-1.0, 0.0, 0.0], [0.0, -0.8, 0.6]].map(Vector::from);
    let [still, axes] = [[Vector::x(), Vector::y(), Vector::z()], turn];
    let placed = |axes: [Vector; 3], by: Vector, p: Point| {
        Point::from(axes[0] * p.x + axes[1] * p.y + axes[2] * p.z + by)
    };
    let places = |number: usize| {
        let back = waving_at() - placed(axes, Vector::zeros(), Point::from(waving_at())).coords;
        [(axes, back), (still, Vector::z() * number as f64)]
    };
    for (number, (mesh, positions)) in meshes.iter().enumerate() {
        let matrix =
            |([x, y, z], by): ([Vector; 3], Vector)| Matrix3x4::from_columns(&[x, y, z, by]);
        let moment = Moment {
            placings: places(number).map(matrix).to_vec(),
            ..Moment::default()
        };
        page.add(mesh, positions, moment).expect("it has faces");
    }
    let read = read(&written(&page));
    let side = read.text["side"].as_f64().expect("a length");
    let origin = [0, 1, 2].map(|axis| read.text["origin"][axis].as_f64().expect("a coordinate"));
    let (moments, solids) = read.shown.split_at(meshes.len());
    assert_eq!(moments[19].corners, meshes[19].0.indices());
    for (number, shown) in solids.iter().enumerate() {
        assert_eq!(shown.corners, solid.indices());
        for moment in 0..meshes.len() {
            let matrix = &read.text["solids"][number]["placings"][moment];
            let column =
                |i: usize| [0, 1, 2].map(|axis| matrix[3 * i + axis].as_f64().expect("a number"));
            let columns = [0, 1, 2, 3].map(|i| Vector::from(column(i)));
            for (is, &made) in shown.places.iter().zip(&skin) {
                let part = [0, 1, 2].map(|axis| (is[axis] - origin[axis]) / side);
                let is = placed(
                    [columns[0], columns[1], columns[2]],
                    columns[3],
                    part.into(),
                );
                let is = Point::from(origin) + is.coords * side;
                let (axes, by) = places(moment)[number];
                let off = (is - placed(axes, by, made)).amax();
                assert!(
                    off < side / 65536.0,
                    "solid {number}, moment {moment}: {off}"
                );
            }
        }
    }
}

/// About where [`waving`] is.
fn waving_at() -> Vector {
    Vector::new(1e5, 0.0, 0.0)
}

#[test]
fn one_mesh_is_kept_to_24_bits_wherever_it_is() {
    for (scale, off) in [
        (1.0, 0.0),
        (1e-6, 0.0),
        (1e-6, 1e3),
        (1e3, -1e6),
        (1.0, 1e9),
    ] {
        let (mesh, positions) = shapes::torus(24, 12);
        let points = positions
            .as_slice()
            .iter()
            .map(|p| p * scale + Vector::new(off, -off, off));
        let meshes = [(mesh, Positions::new(points).expect("usable"))];
        shows(&page_of(&meshes), &meshes);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn meshes_that_have_nothing_in_common_are_shown(meshes in prop::collection::vec(soup(), 1..6)) {
        shows(&page_of(&meshes), &meshes);
    }
}

/// The digest of a page. Whoever changes how pages look looks at one, and says so in the commit.
#[test]
fn the_same_moments_give_the_same_bytes() {
    let [one, other] = [(); 2].map(|()| written(&page_of(&waving())));
    assert!(one == other);
    let (_, data) = one.split_once("text/plain\">").expect("data");
    let (data, _) = data.split_once('<').expect("an end");
    let digest = digest::after(digest::EMPTY, data.bytes());
    assert_eq!(digest, 0x93fd_a709_894b_7ae1, "{digest:#018x}");
}

#[test]
fn no_text_breaks_out_of_a_page() {
    let (mesh, positions) = shapes::triangle();
    let bad = "</title></script><script>alert('1\")</script><!--&amp;{data}{script}\u{2028}\0";
    let mut page = Page::new(bad, Vector::y());
    let cut = CutLine {
        file: bad.to_owned(),
        options: bad.to_owned(),
        output: bad.to_owned(),
    };
    let moment = Moment {
        label: bad.to_owned(),
        time_s: Some(0.0),
        cut: Some(cut),
        ..Moment::default()
    };
    page.add(&mesh, &positions, moment).expect("it has a face");
    page.tell(bad, bad);
    page.plot(bad, bad, &[(bad.to_owned(), vec![[0.0, 1.0]])]);
    let html = written(&page);
    for (tag, count) in [
        ("<script", 2),
        ("</script", 2),
        ("<title", 1),
        ("</title", 1),
        ("<!--", 0),
    ] {
        assert_eq!(html.matches(tag).count(), count, "{tag}");
    }
    let text = read(&html).text;
    assert_eq!(text["title"], bad);
    assert_eq!(text["moments"][0]["cut"][0], bad);
    assert_eq!(text["facts"][0][1], bad);
    assert_eq!(text["plots"][0]["lines"][0]["name"], bad);
    for word in [
        "http:",
        "https:",
        "fetch(",
        "XMLHttpRequest",
        "import(",
        "eval(",
    ] {
        let own = html.replace("http://www.w3.org/2000/svg", "");
        assert!(!own.contains(word), "{word}");
    }
    assert!(html.contains("default-src 'none'"));
    assert!(is_page(html.as_bytes()) && !is_page(b"<!doctype html><title>x</title>"));
}

#[test]
fn what_cannot_be_seen_is_refused() {
    let (mesh, positions) = shapes::triangle();
    let nothing = Mesh::build(3, &[]).expect("no face");
    let mut page = Page::new("", Vector::y());
    let refused = page.add(&nothing, &positions, Moment::default());
    assert_eq!(refused, Err(CameraError::Empty));
    let mut page = Page::new("", Vector::zeros());
    assert!(matches!(
        page.add(&mesh, &positions, Moment::default()),
        Err(CameraError::Up)
    ));
    assert!(page.last_mut().is_none());
}

/// What hangs in one point, or in one line, is shown all the same.
#[test]
fn a_mesh_without_extent_is_shown() {
    let (mesh, _) = shapes::triangle();
    for points in [
        [[2.0, 2.0, 2.0]; 3],
        [[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]],
    ] {
        let positions = Positions::new(points).expect("usable");
        let meshes = [(mesh.clone(), positions.clone()), (mesh.clone(), positions)];
        shows(&page_of(&meshes), &meshes);
    }
}
