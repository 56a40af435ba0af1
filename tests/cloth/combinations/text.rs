//! The scene file of a case: one text as TOML, which a user can repeat, and as JSON, which this crate reads.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use tearmesh_cloth::scene::file::SceneFile;
use tearmesh_cloth::scene::{Axis, Frame, Scene};

use super::factors::Case;
use super::shapes::Shape;
use crate::support::fixtures::block;

/// The frames of a sequence, of 1/60 s each, and those at which something begins or ends.
pub(super) const FRAMES: u64 = 18;
pub(super) const GRABBED: u64 = 2;
pub(super) const UNPICKED: [u64; 2] = [2, 12];
pub(super) const TAKEN: u64 = 3;
pub(super) const CUT: u64 = 4;
pub(super) const BLOWN: u64 = 6;
pub(super) const HEALED: u64 = 9;
pub(super) const FREED: u64 = 9;
pub(super) const RELEASED: u64 = 12;

/// The way of a hand, from where it grabbed, over eight frames.
pub(super) const LED_M: [f64; 3] = [-0.1, -0.15, 0.25];

/// The wind, its sway and the period of that.
pub(super) const WIND: [f64; 3] = [1.0, 0.5, 4.0];
pub(super) const COEFFICIENT: f64 = 1.2;
pub(super) const SWAY: [f64; 3] = [0.5, 0.0, 3.0];
pub(super) const PERIOD_S: f64 = 0.15;

/// The corners of the box that is a body, its way and its turn about y, in degrees, in the whole time.
pub(super) const BOX: [[f64; 3]; 2] = [[0.2, -0.5, -0.3], [0.8, -0.08, 0.3]];
pub(super) const BOX_MOVES_M: [f64; 3] = [0.0, 0.3, 0.1];
pub(super) const BOX_TURNS: f64 = 20.0;
pub(super) const BOX_ABOUT: [f64; 3] = [0.5, 0.0, 0.0];

/// A point of the plane and its normal; the ball's centre and its radius.
pub(super) const PLANE: [[f64; 3]; 2] = [[0.0, -0.15, 0.0], [0.0, 1.0, -0.3]];
pub(super) const BALL: ([f64; 3], f64) = ([0.5, -0.2, 0.1], 0.18);

/// The time of a frame, in seconds.
pub(super) fn at_s(frame: u64) -> f64 {
    frame as f64 / 60.0
}

/// A table by its name, empty at the top, and its keys with their values, which TOML and JSON write alike.
type Table = (&'static str, Vec<(&'static str, String)>);

/// A scene file.
#[derive(Clone, Debug)]
pub(super) struct Text(Vec<Table>);

/// The offsets of a hold that moves, by frames; one that turns does so besides, in a scene.
pub(super) fn moves(case: &Case) -> Vec<(u64, [f64; 3])> {
    match case.get("hold") {
        "moving" => vec![(TAKEN, [0.0; 3]), (12, [0.0, 0.08, 0.15])],
        "turning" => vec![
            (TAKEN, [0.0; 3]),
            (6, [0.06, 0.0, 0.06]),
            (9, [0.0, 0.0, 0.12]),
            (12, [-0.06, 0.0, 0.06]),
            (15, [0.0; 3]),
        ],
        _ => Vec::new(),
    }
}

impl Text {
    /// The scene file of a case. It has what scene files have: no healing, and the cut at its default snap.
    pub(super) fn of(case: &Case, shape: &Shape) -> Text {
        let mut tables = vec![top(case), fabric(case), solver(case)];
        tables.extend(wind(case));
        tables.extend(collider(case));
        tables.extend(hold(case, shape));
        tables.extend(hand(case, shape));
        tables.extend(seams(case, shape));
        tables.extend(cut(case, shape));
        tables.push(tear(case));
        tables.extend(strengths(case, shape));
        Text(tables)
    }

    /// Every key, as `table.key`, or `key` at the top.
    pub(super) fn keys(&self) -> BTreeSet<String> {
        let keys = self.0.iter().flat_map(|(table, keys)| {
            keys.iter().map(move |(key, _)| match *table {
                "" => (*key).to_owned(),
                table => format!("{table}.{key}"),
            })
        });
        keys.collect()
    }

    pub(super) fn toml(&self) -> String {
        let mut text = String::new();
        for (table, keys) in &self.0 {
            let line = match *table {
                "" => String::new(),
                table if is_list(table) => format!("[[{table}]]\n"),
                table => format!("[{table}]\n"),
            };
            text += &line;
            for (key, value) in keys {
                writeln!(text, "{key} = {value}").expect("a text takes lines");
            }
        }
        text
    }

    pub(super) fn json(&self) -> String {
        let object = |keys: &[(&str, String)]| {
            let pairs: Vec<String> = keys
                .iter()
                .map(|(key, value)| format!("\"{key}\": {value}"))
                .collect();
            pairs.join(", ")
        };
        let mut parts = Vec::new();
        let mut lists: Vec<(&str, Vec<String>)> = Vec::new();
        for (table, keys) in &self.0 {
            match *table {
                "" => parts.push(object(keys)),
                table if is_list(table) => {
                    match lists.iter_mut().find(|(name, _)| *name == table) {
                        Some((_, list)) => list.push(format!("{{{}}}", object(keys))),
                        None => lists.push((table, vec![format!("{{{}}}", object(keys))])),
                    }
                }
                table => parts.push(format!("\"{table}\": {{{}}}", object(keys))),
            }
        }
        let lists = lists
            .iter()
            .map(|(name, list)| format!("\"{name}\": [{}]", list.join(", ")));
        parts.extend(lists);
        format!("{{{}}}", parts.join(", "))
    }

    /// The scene for the frame of a shape; or why it is refused.
    pub(super) fn scene(&self, shape: &Shape) -> Result<(Scene, Frame), String> {
        let json = self.json();
        let file: SceneFile =
            serde_json::from_str(&json).map_err(|error| format!("{error}: {json}"))?;
        let frame = Frame::new(&shape.mesh, shape.positions.as_slice(), Axis::Y);
        let scene = file.on(&frame, None, &mut |_, _| Ok(block(BOX[0], BOX[1])));
        let scene = scene.map_err(|faults| format!("{} {}", faults[0].code, faults[0]))?;
        Ok((scene, frame))
    }
}

fn is_list(table: &str) -> bool {
    ["collider", "hold", "seam", "cut", "strength"].contains(&table)
}

fn quoted(word: &str) -> String {
    format!("\"{word}\"")
}

fn number(x: impl Into<f64>) -> String {
    // With a point or an exponent, so that TOML reads no whole number.
    format!("{:?}", x.into())
}

fn numbers(list: &[f64]) -> String {
    let list: Vec<String> = list.iter().map(|&x| number(x)).collect();
    format!("[{}]", list.join(", "))
}

fn rows(list: impl IntoIterator<Item = (u64, [f64; 3])>) -> String {
    let rows = list
        .into_iter()
        .map(|(frame, [x, y, z])| numbers(&[at_s(frame), x, y, z]));
    format!("[{}]", rows.collect::<Vec<_>>().join(", "))
}

/// Vertices as files count them.
fn vertices(ids: &[usize]) -> String {
    let ids: Vec<String> = ids.iter().map(|id| (id + 1).to_string()).collect();
    format!("[{}]", ids.join(", "))
}

fn top(case: &Case) -> Table {
    let gravity = match case.get("gravity") {
        "down" => number(9.81),
        "aslant" => numbers(&[1.0, -9.0, 2.0]),
        _ => number(0),
    };
    let drag = if case.is("drag", "some") { 0.5 } else { 0.0 };
    let mut keys = vec![
        ("base", quoted("fall")),
        ("seconds", number(at_s(FRAMES))),
        ("up", quoted("y")),
        ("gravity_m_per_s2", gravity),
        ("drag_per_s", number(drag)),
    ];
    match case.get("ripple") {
        "none" => keys.push(("ripple_m", number(0))),
        "large" => keys.push(("ripple_m", number(1e-3))),
        _ => {}
    }
    ("", keys)
}

fn fabric(case: &Case) -> Table {
    let mut keys = vec![("density_kg_per_m2", number(0.2))];
    keys.extend(match case.get("fabric") {
        "membrane" => vec![("modulus_n_per_m", number(200))],
        "woven" => vec![
            ("warp_n_per_m", number(250)),
            ("weft_n_per_m", number(180)),
            ("shear_n_per_m", number(30)),
            ("warp", numbers(&[0.2, 1.0, 0.3])),
        ],
        level => vec![
            ("stretch_n_per_m", number(150)),
            (
                "copies",
                quoted(if level == "whole" { "whole" } else { "halved" }),
            ),
        ],
    });
    keys.extend(match case.get("bending") {
        "none" => vec![],
        "buckling" => vec![
            ("bend_law", quoted("buckling")),
            ("rigidity_n_m", number(1e-4)),
            ("buckles_below", number(0.8)),
        ],
        level => vec![
            ("bend_law", quoted("spring")),
            ("bend_n_per_m", number(2)),
            (
                "unbend",
                quoted(if level == "vertex" { "vertex" } else { "seam" }),
            ),
        ],
    });
    let damping_s = match case.get("damping") {
        "default" => None,
        level => Some(if level == "none" { 0.0 } else { 0.02 }),
    };
    keys.extend(damping_s.map(|damping_s| ("damping_s", number(damping_s))));
    ("fabric", keys)
}

fn solver(case: &Case) -> Table {
    let mut keys = vec![("method", quoted(case.get("method")))];
    let parts = match case.get("step") {
        "default" => None,
        level => Some(if level == "short" { 40.0 } else { 12.0 }),
    };
    keys.extend(parts.map(|parts: f64| ("dt_s", number(at_s(1) / parts))));
    if case.is("settings", "changed") {
        keys.extend(match case.get("method") {
            "implicit" => vec![("order", quoted("2")), ("tolerance", number(100))],
            "provot" => vec![
                ("limit_ratio", number(1.3)),
                ("limit_passes", "5".to_owned()),
            ],
            "pbd" => vec![
                ("sweeps", "4".to_owned()),
                ("stiffness", number(0.8)),
                ("bend_stiffness", number(0.3)),
            ],
            _ => vec![("sweeps", "2".to_owned())],
        });
    }
    ("solver", keys)
}

fn wind(case: &Case) -> Option<Table> {
    let mut keys = vec![
        ("velocity_m_per_s", numbers(&WIND)),
        ("coefficient", number(COEFFICIENT)),
    ];
    match case.get("wind") {
        "still" => return None,
        "swaying" => keys.extend([
            ("sway_m_per_s", numbers(&SWAY)),
            ("period_s", number(PERIOD_S)),
        ]),
        "later" => keys.push(("from_s", number(at_s(BLOWN)))),
        _ => {}
    }
    Some(("wind", keys))
}

fn collider(case: &Case) -> Option<Table> {
    let body = vec![("body", quoted("block.obj")), ("cell_m", number(0.04))];
    let mut keys = match case.get("collider") {
        "none" => return None,
        "plane" => vec![
            ("point", numbers(&PLANE[0])),
            ("normal", numbers(&PLANE[1])),
        ],
        "ball" => vec![("centre", numbers(&BALL.0)), ("radius_m", number(BALL.1))],
        "body" => body,
        _ => {
            let turn = [0.0, BOX_TURNS, 0.0];
            let mut keys = body;
            keys.extend([
                ("thickness_m", number(0.03)),
                ("moves", rows([(0, [0.0; 3]), (FRAMES, BOX_MOVES_M)])),
                ("turns", rows([(0, [0.0; 3]), (FRAMES, turn)])),
                ("about", numbers(&BOX_ABOUT)),
            ]);
            keys
        }
    };
    match case.get("friction") {
        "none" => keys.push(("friction", number(0.0))),
        "some" => keys.push(("friction", number(0.4))),
        _ => {}
    }
    Some(("collider", keys))
}

fn hold(case: &Case, shape: &Shape) -> Option<Table> {
    // About the place where the cut is to go through, and far from the hand.
    let (corner, radius_m) = match shape.sides.is_empty() {
        true => ([0.0, shape.top_m, 0.0], 0.7),
        false => ([0.5, shape.top_m, 0.0], 0.12),
    };
    let keys = match case.get("hold") {
        "none" => return None,
        "still" => vec![
            ("across", numbers(&[0.0, 1.0])),
            ("along", numbers(&[0.97, 1.0])),
        ],
        "released" => vec![
            ("near", numbers(&[0.0, 1.0])),
            ("radius", number(0.3)),
            ("until_s", number(at_s(FREED))),
        ],
        "moving" => vec![
            ("from", numbers(&[-1.0, shape.top_m - 0.02, -1.0])),
            ("to", numbers(&[2.0, 2.0, 2.0])),
            ("from_s", number(at_s(TAKEN))),
            ("moves", rows(moves(case))),
        ],
        _ => vec![
            ("centre", numbers(&corner)),
            ("radius_m", number(radius_m)),
            ("from_s", number(at_s(TAKEN))),
            ("moves", rows(moves(case))),
            ("turns", rows([(TAKEN, [0.0; 3]), (12, [0.0, 15.0, 20.0])])),
            ("about", numbers(&corner)),
        ],
    };
    Some(("hold", keys))
}

/// A hand, which in a scene is a hold.
fn hand(case: &Case, shape: &Shape) -> Option<Table> {
    let keys = vec![
        ("vertices", vertices(&[shape.hand])),
        ("from_s", number(at_s(GRABBED))),
        ("until_s", number(at_s(RELEASED))),
        ("moves", rows([(GRABBED, [0.0; 3]), (GRABBED + 8, LED_M)])),
        ("grip_m", number(0.2)),
    ];
    case.is("hand", "led").then_some(("hold", keys))
}

/// The names of the seams.
pub(super) const SEAMS: [&str; 2] = ["left", "right"];

fn seams(case: &Case, shape: &Shape) -> Vec<Table> {
    if case.is("seams", "none") {
        return Vec::new();
    }
    let seams = SEAMS.into_iter().zip(&shape.sides);
    let tables = seams.map(|(name, [one, other])| {
        let mut keys = vec![
            ("name", quoted(name)),
            ("one", vertices(one)),
            ("other", vertices(other)),
        ];
        let unpicked = match case.get("unpick") {
            "none" => None,
            level => Some(UNPICKED[usize::from(level == "late")]),
        };
        let unpicked = unpicked.filter(|_| name == SEAMS[0]);
        keys.extend(unpicked.map(|frame| ("unpick_at_s", number(at_s(frame)))));
        ("seam", keys)
    });
    tables.collect()
}

fn cut(case: &Case, shape: &Shape) -> Option<Table> {
    if case.is("cut", "none") {
        return None;
    }
    let rays = shape
        .slit
        .map(|[x, y]| quoted(&format!("{x},{y},5:0,0,-1")));
    let method = if case.is("cut", "partition") {
        "partition"
    } else {
        "exact"
    };
    let keys = vec![
        ("at_s", number(at_s(CUT))),
        ("rays", format!("[{}]", rays.join(", "))),
        ("through", case.is("cut", "through").to_string()),
        ("method", quoted(method)),
    ];
    Some(("cut", keys))
}

fn tear(case: &Case) -> Table {
    let mut keys = match case.get("threshold") {
        "never" => return ("tear", vec![("never", "true".to_owned())]),
        "stretch" => vec![("threshold", number(1.2))],
        "toughness" => vec![("toughness_j_per_m", number(0.4))],
        "force" => vec![("threshold_n", number(4))],
        "principal" => vec![("principal_stretch", number(1.25))],
        _ => vec![
            ("threshold_warp", number(1.2)),
            ("threshold_weft", number(1.3)),
            ("warp", numbers(&[0.2, 1.0, 0.3])),
        ],
    };
    if case.is("threshold", "stretch force") {
        keys.push(("splits_per_step", "3".to_owned()));
    } else {
        keys.push(("weakening", number(0.8)));
    }
    ("tear", keys)
}

fn strengths(case: &Case, shape: &Shape) -> Vec<Table> {
    let regions = [
        vec![("near", numbers(&[0.0, 0.0])), ("radius", number(0.2))],
        vec![
            ("across", numbers(&[0.5, 1.0])),
            ("along", numbers(&[0.0, 0.5])),
        ],
        vec![
            ("from", numbers(&[-1.0, 0.2, -1.0])),
            ("to", numbers(&[2.0, shape.top_m, 2.0])),
        ],
        vec![
            ("centre", numbers(&[0.5, shape.top_m, 0.0])),
            ("radius_m", number(0.3)),
        ],
        vec![("vertices", vertices(&[shape.hand]))],
    ];
    let factors = [0.8, 0.9, 1.2, 0.7, 3.0];
    let tables = regions.into_iter().zip(factors).map(|(mut keys, factor)| {
        keys.push(("factor", number(factor)));
        ("strength", keys)
    });
    tables.filter(|_| case.is("strength", "uneven")).collect()
}
