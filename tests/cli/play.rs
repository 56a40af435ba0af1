//! Pages that are played: what mesh and what scene they have. (What is done on them is in `tests/browser`.)

use tearmesh::{Point, Ray, Vector, VertexId};
use tearmesh_cloth::{ColliderShape, Wind};
use tearmesh_obj::Document;
use tearmesh_play::{Plan, Player, Settings};

use crate::harness::Folder;
use crate::read_back::content;

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

/// A page exchanges numbers, and none of them may stop it for good.
#[test]
fn numbers_that_mean_nothing_are_refused_in_words() {
    let settings = |threshold: &str| {
        let lines = "cloth sheet 8\nscene rip\nup y\nmethod xpbd\nthreshold ";
        format!("{lines}{threshold}\n").parse::<Settings>()
    };
    for threshold in ["nan", "inf", "-1", "0", "1", "1e999"] {
        let refused = settings(threshold).map(drop).expect_err("no threshold");
        assert_eq!(refused, format!("there is no threshold `{threshold}`"));
    }
    let settings = settings("1.5").expect("settings");
    let document = settings.document(b"").expect("a document");
    let begun = || Player::new(&document, settings.clone()).expect("a player");
    let mut player = begun();
    player.number_hands_from(7);
    let down = |x| Ray::new(Point::new(x, 0.5, 5.0), -Vector::z()).expect("a ray");
    assert_eq!(player.grab(&down(9.0)), Ok(None));
    let hand = player.grab(&down(0.5)).expect("a hand");
    assert_eq!((hand, player.next_hand()), (Some(7), 8));
    let no_hand = || Err("there is no such hand".to_owned());
    for wrong in [0, 6, 8, u32::MAX as usize, usize::MAX] {
        assert_eq!(player.lead(wrong, Point::origin()), no_hand(), "{wrong}");
        assert_eq!(player.release(wrong), no_hand(), "{wrong}");
    }
    let far = Point::new(f64::NAN, 0.0, 0.0);
    player.lead(7, far).expect_err("no place");
    player.release(7).expect("a hand");
    player.release(7).expect_err("it was released");
    for coefficient in [f64::NAN, f64::INFINITY, -1.0] {
        let velocity_m_per_s = Vector::z();
        let wind = Wind {
            velocity_m_per_s,
            coefficient,
        };
        player.set_wind(Some(wind)).expect_err("no wind");
    }
    for seconds in [f64::NAN, f64::INFINITY, -1.0] {
        player.advance(seconds, 10).expect_err("no time");
    }
    // And nothing of that left a trace.
    let mut other = begun();
    other.grab(&down(0.5)).expect("a hand");
    other.release(0).expect("a hand");
    for player in [&mut player, &mut other] {
        player.advance(0.1, 1_000).expect("steps");
    }
    assert_eq!(player.digest(), other.digest());
}

/// A log begins with the settings, in which a name may be that of the next part.
#[test]
fn a_file_may_have_any_name_in_a_log() {
    let lines = "cloth file tearmesh inputs 1 digest.obj\nscene fall\nup y\nmethod scene\nthreshold scene\n";
    let settings: Settings = lines.parse().expect("settings");
    let square = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    let document = settings.document(square).expect("a document");
    let mut player = Player::new(&document, settings.clone()).expect("a player");
    player.advance(0.1, 100).expect("steps");
    let again = Player::replayed(&document, settings, &player.log()).expect("a replay");
    assert_eq!(again.digest(), player.digest());
}

/// A log that was saved while a hand held on: whoever grabs there takes over.
#[test]
fn a_hand_of_a_log_is_taken_over() {
    let lines = "cloth sheet 8\nscene rip\nup y\nmethod xpbd\nthreshold 1.5\n";
    let settings: Settings = lines.parse().expect("settings");
    let document = settings.document(b"").expect("a document");
    let mut player = Player::new(&document, settings.clone()).expect("a player");
    let down = |x, y| Ray::new(Point::new(x, y, 5.0), -Vector::z()).expect("a ray");
    let hand = player
        .grab(&down(0.5, 0.5))
        .expect("a hand")
        .expect("a hit");
    let to = Point::new(0.5, 0.4, 0.3);
    player.lead(hand, to).expect("a hand");
    player.advance(0.2, 1_000).expect("steps");
    let mut again = Player::replayed(&document, settings, &player.log()).expect("a replay");
    assert_eq!(again.digest(), player.digest());
    again.number_hands_from(3);
    assert_eq!(again.grab(&down(to.x, to.y)), Ok(Some(3)));
    assert_eq!(
        again
            .grab(&down(to.x, to.y))
            .map_err(|why| why.ends_with("in hand 0")),
        Err(true)
    );
    let middle = VertexId::new(40).expect("an id");
    assert!(again.is_held(middle));
    again.release(3).expect("a hand");
    assert!(!again.is_held(middle));
}
