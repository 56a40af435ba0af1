//! Pages that are played: what mesh and what scene they have. (What is done on them is in `tests/browser`.)

use tearmesh::{Point, Ray, Vector};
use tearmesh_cloth::ColliderShape;
use tearmesh_obj::Document;
use tearmesh_play::{Plan, Player, Settings};

use crate::harness::{Folder, content};

#[test]
fn a_mesh_that_is_too_large_is_refused_with_its_number() {
    let folder = Folder::new();
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    folder.write("most.obj", [triangle, &"v 0 0 1\n".repeat(19_997)].concat());
    folder.write("many.obj", [triangle, &"v 0 0 1\n".repeat(19_998)].concat());
    folder.done("play most.obj -o most.html");
    let said = folder.ends("play many.obj -o many.html", 3);
    let refused = "the mesh has 20001 vertices, and a page plays with at most 20000";
    assert!(
        said.contains(&format!("E-PLAY-VERTICES]: {refused}")),
        "{said}"
    );
    assert!(!folder.path("many.html").exists());
    assert_eq!(tearmesh_play::VERTICES_MAX, 20_000);
}

/// The cloth of the page of a garment, and the settings.
fn begun(folder: &Folder) -> (Document, Settings) {
    let (text, obj) = content(&folder.read("dress.html"));
    let lines =
        "cloth file dress.obj\nscene file dress.toml\nup y\nmethod scene\nthreshold scene\n";
    let mut settings: Settings = lines.parse().expect("settings");
    let plan = text["plan"].as_str().expect("a plan");
    settings.plan = Some(Plan::read(plan.as_bytes()).expect("a scene"));
    (settings.document(&obj).expect("a document"), settings)
}

#[test]
fn a_garment_of_a_scene_file_is_sewn_cut_and_repeated() {
    let folder = Folder::new();
    let said = folder.done("play dress.obj --scene dress.toml -o dress.html");
    // What comes later is left to the hand, and is named.
    let left = said.contains("W-PLAY-HAND") && said.contains("hold 1, cut 1");
    assert!(said.contains("scene dress.toml") && left, "{said}");
    let (document, settings) = begun(&folder);
    let mut lost = settings.clone();
    lost.plan = None;
    let lost = Player::new(&document, lost).map(drop);
    let why = "the scene is in a file that is not here";
    assert_eq!(lost, Err(why.to_owned()));

    let mut player = Player::new(&document, settings.clone()).expect("a player");
    assert_eq!(player.simulation().open_pairs(), 38);
    player.advance(1.2, 100_000).expect("steps");
    let facts = player.facts();
    assert_eq!((facts.held_first, facts.sewn, facts.left), (0, 38, 0));
    let sim = player.simulation();
    assert_eq!(sim.mesh().components().count(), 1);
    // It hangs from the shoulders, and is nowhere inside.
    let shape = &sim.cloth().system().loads().colliders[0].shape;
    let ColliderShape::Body { body, .. } = shape else {
        panic!("{shape:?}");
    };
    let points = sim.cloth().positions().iter();
    let deepest = points.map(|&x| body.distance_m(x)).fold(1.0, f64::min);
    assert!(deepest > 0.0, "{deepest}");
    let ray = |y: f64| Ray::new(Point::new(0.0, y, 3.0), -Vector::z()).expect("a ray");
    let splits = player.cut([ray(0.14), ray(0.34)], true).expect("a cut");
    assert!(splits > 3, "{splits}");
    player.advance(0.1, 100_000).expect("steps");
    let again = Player::replayed(&document, settings, &player.log()).expect("a replay");
    assert_eq!(again.digest(), player.digest());
    folder.write("torn.obj", player.obj().expect("a file"));
    folder.done("check torn.obj");
}

#[test]
fn what_a_scene_file_unpicks_is_named_and_its_bodies_move() {
    let folder = Folder::new();
    let scene = folder.read("dress.toml");
    let moved = "[[collider]]\nmoves = [[0, 0, 0, 0], [1, 0, 0.1, 0]]\n";
    let scene = scene.replace("[[collider]]\n", moved);
    let unpicked = "name = \"left side\"\nunpick_at_s = 2\n";
    folder.write(
        "moved.toml",
        scene.replace("name = \"left side\"\n", unpicked),
    );
    let said = folder.done("play dress.obj --scene moved.toml -o dress.html");
    assert!(
        said.contains("exact: hold 1, cut 1, seam `left side`\n"),
        "{said}"
    );
    let (document, settings) = begun(&folder);
    let mut player = Player::new(&document, settings).expect("a player");
    let [before, after] = [0.0, 0.3].map(|seconds| {
        player.advance(seconds, 100_000).expect("steps");
        player.solids().0
    });
    assert_eq!(before.len(), 434);
    let up = player.simulation().time_s() * 0.1;
    for (before, after) in before.iter().zip(&after) {
        let off = after - before - Vector::y() * up;
        assert!(up > 0.02 && off.norm() < 1e-12, "{off}");
    }
}
