//! Panels that are sewn, unpicked, slit across a seam, and refused.

use std::collections::BTreeMap;

use tearmesh::{Edit, Mesh, Point, Positions, Ray, Scissor, Vector};
use tearmesh_cloth::scene::{Axis, Frame, Run, RunError, Scene, Warning, Wording};
use tearmesh_cloth::{
    Event, Fabric, InputError, Loads, Seam, Simulation, SimulationDef, SimulationError, Wounds,
};

use crate::follow::{check, check_anew};
use crate::parts::cloths::bent;
use crate::parts::{plane, v};

/// Panels as they are drawn: points and faces.
#[derive(Clone, Default)]
struct Panels {
    points: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
}

impl Panels {
    /// Adds a panel with these columns and rows. One that is turned over shows its other side.
    fn add(mut self, [columns, rows]: [&[f64]; 2], z: f64, is_turned: bool) -> Panels {
        let (first, width) = (self.points.len() as u32, columns.len() as u32);
        for &y in rows {
            self.points.extend(columns.iter().map(|&x| [x, y, z]));
        }
        for row in 0..rows.len() as u32 - 1 {
            for a in (0..width - 1).map(|column| first + row * width + column) {
                let cell = [[a, a + 1, a + width], [a + width, a + 1, a + width + 1]];
                let turned = cell.map(|[a, b, c]| [a, c, b]);
                self.faces.extend(if is_turned { turned } else { cell });
            }
        }
        self
    }

    fn mesh(&self) -> Mesh {
        Mesh::build(self.points.len(), &self.faces).expect("panels")
    }

    fn positions(&self) -> Positions {
        Positions::new(self.points.iter().copied()).expect("finite")
    }

    fn sim(&self, seams: Vec<Seam>) -> Result<Simulation, SimulationError> {
        Simulation::new(self.mesh(), &self.positions(), def(seams))
    }
}

fn seam(
    name: &str,
    one: impl IntoIterator<Item = usize>,
    other: impl IntoIterator<Item = usize>,
) -> Seam {
    Seam {
        name: name.to_owned(),
        one: one.into_iter().map(v).collect(),
        other: other.into_iter().map(v).collect(),
    }
}

fn fabric() -> Fabric {
    bent(Fabric::default(), 0.5)
}

fn def(seams: Vec<Seam>) -> SimulationDef {
    SimulationDef {
        fabric: fabric(),
        tearing: None,
        loads: Loads::default(),
        seams,
        ..SimulationDef::default()
    }
}

/// A front of four columns and a back of five, both of five rows, and their side seams: the back's are a tenth longer.
fn shirt() -> (Panels, Vec<Seam>) {
    let front = [&[0.0, 0.1, 0.2, 0.3][..], &[0.0, 0.1, 0.2, 0.3, 0.4]];
    let back = [
        &[0.0, 0.08, 0.15, 0.22, 0.3][..],
        &[0.0, 0.12, 0.22, 0.33, 0.44],
    ];
    let panels = Panels::default().add(front, 0.03, false);
    let side = |name, one: usize, other: usize| {
        let [one, other] = [(one, 4), (other, 5)].map(|(v, by)| (v..).step_by(by).take(5));
        seam(name, one, other)
    };
    let seams = vec![side("left", 0, 20), side("right", 3, 24)];
    (panels.add(back, -0.03, true), seams)
}

/// Lets time pass until all seams are sewn.
fn sew(sim: &mut Simulation) {
    for _ in 0..60 {
        if sim.open_pairs() > 0 {
            sim.advance(1.0 / 60.0, 1000).expect("a step");
        }
    }
    let healed = sim
        .events()
        .filter(|event| matches!(event, Event::Healed { left: 0, .. }));
    assert_eq!((healed.count(), sim.open_pairs()), (1, 0));
    verify(sim);
}

/// What holds of a cloth at all times: lengths, stiffnesses and bends are those of its faces at rest.
fn verify(sim: &Simulation) {
    assert_eq!(sim.mesh().check(), []);
    check(sim.mesh(), sim.cloth(), true);
    check_anew(sim.mesh(), sim.cloth(), fabric(), true);
}

/// The corners of faces are at rest where the panels were drawn, to the bit.
fn rests_as_drawn(sim: &Simulation, panels: &Panels) {
    let drawn = panels.faces.as_flattened().iter();
    let drawn = drawn.map(|&v| Point::from(panels.points[v as usize]));
    assert!(drawn.eq(sim.cloth().rest_corners().iter().copied()));
}

/// The mesh is that of the panels, up to numbers of vertices.
fn is_as_drawn(sim: &Simulation, panels: &Panels) {
    let (mesh, drawn) = (sim.mesh(), panels.mesh());
    let mut names = [BTreeMap::new(), BTreeMap::new()];
    for h in drawn.half_edges() {
        let (one, other) = (drawn.origin(h), mesh.origin(h));
        assert_eq!(*names[0].entry(one).or_insert(other), other);
        assert_eq!(*names[1].entry(other).or_insert(one), one);
        assert_eq!(mesh.pair(h), drawn.pair(h));
    }
    assert_eq!(mesh.components().count(), drawn.components().count());
}

#[test]
fn sewn_panels_rest_as_drawn_and_part_when_unpicked() {
    let (panels, seams) = shirt();
    let recorded = SimulationDef {
        is_recorded: true,
        ..def(seams.clone())
    };
    let (mesh, positions) = (panels.mesh(), panels.positions());
    let sim = Simulation::new(mesh.clone(), &positions, recorded.clone());
    let mut sim = sim.expect("a garment");
    let total = sim.cloth().masses().total();
    assert_eq!((sim.open_pairs(), sim.mesh().components().count()), (10, 2));
    verify(&sim);
    sew(&mut sim);
    rests_as_drawn(&sim, &panels);
    assert_eq!(
        (sim.mesh().components().count(), sim.mesh().vertex_count()),
        (1, 35)
    );
    assert_eq!(sim.cloth().masses().total(), total);

    // Each part of an edge of the seam keeps its own length, and both balance: .1 m and .12 m.
    let shared = sim.mesh().edges().find(|&h| {
        let sides = [Some(h), sim.mesh().pair(h)].map(|h| {
            h.map_or(0.0, |h| {
                let rest = sim.cloth().rest_corners();
                (rest[h.next().index()] - rest[h.index()]).norm()
            })
        });
        (sides[0] - 0.1).abs() < 1e-9 && (sides[1] - 0.12).abs() < 1e-9
    });
    let shared = shared.expect("the lowest edge of a side");
    let springs = sim.cloth().system().stretches();
    let spring = springs.get(sim.cloth().stretch(shared));
    assert!(0.1 < spring.rest_length_m && spring.rest_length_m < 0.12);

    assert_eq!(sim.unpick("left").expect("a seam"), 5);
    verify(&sim);
    assert_eq!(sim.mesh().components().count(), 1);
    assert_eq!(sim.unpick("left").expect("a seam"), 0);
    sim.heal(Wounds::All).expect("wounds");
    sew(&mut sim);
    sim.heal(Wounds::All).expect("wounds");
    let unpicked = ["right", "left"].map(|name| sim.unpick(name).expect("a seam"));
    assert_eq!(unpicked, [5, 5]);
    verify(&sim);
    is_as_drawn(&sim, &panels);
    rests_as_drawn(&sim, &panels);
    assert_eq!(sim.cloth().masses().total(), total);
    let none = sim.unpick("collar");
    assert_eq!(none, Err(InputError::NoSeam("collar".to_owned())));

    let log = sim.log().expect("it is recorded").to_string().parse();
    let again = Simulation::replayed(mesh, &positions, recorded, &log.expect("a log"), |_, _| {});
    let again = again.expect("the same");
    assert_eq!(again.cloth().positions(), sim.cloth().positions());
    assert_eq!(again.mesh(), sim.mesh());
}

#[test]
fn a_slit_across_a_seam_leaves_each_part_its_seam() {
    let (panels, seams) = shirt();
    let mut sim = panels.sim(seams).expect("a garment");
    let total = sim.cloth().masses().total();
    sew(&mut sim);
    let ray = |x: f64| Ray::new(Point::new(x, 0.21, 1.0), Vector::new(0.0, 0.0, -1.0));
    let rays = [-0.1, 0.13].map(|x| ray(x).expect("a ray"));
    sim.cut(&Scissor::new(rays[0], rays[1]).expect("a plane"))
        .expect("a cut");
    assert_eq!(sim.mesh().components().count(), 1);
    verify(&sim);
    for name in ["left", "right"] {
        assert!(sim.unpick(name).expect("a seam") >= 5);
        verify(&sim);
    }
    // Front and back again, each with its slit, and nothing of one on the other.
    let parts = sim.mesh().components();
    assert_eq!(parts.count(), 2);
    let (rest, mut areas) = (sim.cloth().rest_corners(), [0.0_f64; 2]);
    for f in sim.mesh().faces() {
        let [a, b, c] = f.half_edges().map(|h| rest[h.index()]);
        assert!((a.z - b.z).abs() < 1e-15 && (b.z - c.z).abs() < 1e-15);
        areas[usize::from(a.z < 0.0)] += 0.5 * (b - a).cross(&(c - a)).norm();
        assert_eq!(parts.of(f), usize::from(a.z < 0.0));
    }
    assert!((areas[0] - 0.3 * 0.4).abs() < 1e-15 && (areas[1] - 0.3 * 0.44).abs() < 1e-15);
    assert_eq!(sim.cloth().masses().total(), total);
}

#[test]
fn a_dart_is_a_seam_within_a_panel() {
    // Two rings of five around a tip, open by a sixth.
    let mut panels = Panels::default();
    panels.points.push([0.0; 3]);
    for radius in [0.1, 0.2] {
        let angles = (0..5).map(|i| f64::from(i) * 75.0_f64.to_radians());
        panels
            .points
            .extend(angles.map(|a| [radius * a.cos(), radius * a.sin(), 0.0]));
    }
    for i in 1..5 {
        panels
            .faces
            .extend([[0, i, i + 1], [i, i + 5, i + 1], [i + 1, i + 5, i + 6]]);
    }
    let mut sim = panels
        .sim(vec![seam("dart", [6, 1, 0], [10, 5, 0])])
        .expect("a dart");
    sew(&mut sim);
    assert_eq!(
        (sim.mesh().vertex_count(), sim.mesh().boundary_loops().len()),
        (9, 1)
    );
    let around = sim.mesh().corners_of(v(0)).flat_map(|h| [h, h.prev()]);
    assert!(
        around.into_iter().all(|h| sim.mesh().pair(h).is_some()),
        "its tip is inside"
    );
    rests_as_drawn(&sim, &panels);
    assert_eq!(sim.unpick("dart").expect("a seam"), 2);
    is_as_drawn(&sim, &panels);
    verify(&sim);
}

/// Rows of the table beside this file: seams, each as one side = the other; the number of the first seam concerned,
/// from 0; the vertices concerned; and what is said.
#[test]
fn seams_that_cannot_meet_are_refused_with_their_vertices() {
    let (panels, _) = shirt();
    let third = [&[0.5, 0.6][..], &[0.0, 0.1, 0.2, 0.3, 0.4]];
    let panels = panels.add(third, 0.0, false);
    let side = |text: &str| -> Vec<usize> {
        let numbers = text.split(' ').map(|v| v.parse().expect("a number"));
        numbers.collect()
    };
    for row in include_str!("seams.txt").lines() {
        let [seams, told @ ..] = &row.split(" | ").collect::<Vec<_>>()[..] else {
            panic!("{row}");
        };
        let sides = seams.split(", ").filter_map(|seam| seam.split_once(" = "));
        let seams = sides.map(|(one, other)| seam("", side(one), side(other)));
        let Err(SimulationError::Seams(error)) = panels.sim(seams.collect()) else {
            panic!("it was not refused for its seams: {row}");
        };
        let vertices: Vec<String> = error.vertices.iter().map(ToString::to_string).collect();
        let found = [
            error.seam.to_string(),
            vertices.join(" "),
            error.to_string(),
        ];
        assert_eq!(found, told);
    }
}

/// What is at rest as it was drawn does not care where it begins.
#[test]
fn a_rest_shape_by_corner_gives_lengths_and_masses() {
    let (panels, seams) = shirt();
    let drawn = panels.sim(seams.clone()).expect("a garment");
    // Each panel stands up and is rolled round a body of 10 cm, which shortens all that is not upright.
    let rolled = panels.points.iter().map(|&[x, y, z]| {
        let (sine, cosine) = (x / 0.1).sin_cos();
        [0.1 * sine, y, z + z.signum() * 0.1 * cosine]
    });
    let rolled = Positions::new(rolled).expect("finite");
    let corners = panels.faces.as_flattened().iter();
    let rest = corners.map(|&v| Point::from(panels.points[v as usize]));
    let standing = SimulationDef {
        rest: rest.collect(),
        ..def(seams.clone())
    };
    let mesh = panels.mesh();
    let mut sim = Simulation::new(mesh.clone(), &rolled, standing.clone()).expect("a garment");
    let numbers = |sim: &Simulation| {
        let system = sim.cloth().system();
        let families = [system.stretches(), system.bends()];
        let springs = families.map(|family| family.iter().map(|id| family.get(id)).collect());
        let [stretches, bends]: [Vec<_>; 2] = springs;
        (stretches, bends, system.masses().to_vec())
    };
    assert_eq!(numbers(&sim), numbers(&drawn));
    assert_eq!(sim.cloth().positions(), rolled.as_slice());
    let total = drawn.cloth().masses().total();
    assert_eq!(sim.cloth().masses().total(), total);
    rests_as_drawn(&sim, &panels);
    sew(&mut sim);
    let across = Scissor::by_plane(plane([0.0, 0.213, 0.0], Vector::y()));
    sim.cut(&across).expect("a cut");
    verify(&sim);
    assert_eq!(sim.cloth().masses().total(), total);

    let short = SimulationDef {
        rest: standing.rest[1..].to_vec(),
        ..standing.clone()
    };
    let refused = Simulation::new(mesh.clone(), &rolled, short).expect_err("a corner lacks");
    let text = "there are 167 places at rest for 168 corners";
    assert_eq!(refused.to_string(), text);
    let mut pointed = standing;
    pointed.rest[1] = pointed.rest[0];
    let refused = Simulation::new(mesh, &rolled, pointed).expect_err("an edge has no length");
    let text = refused.to_string();
    assert!(text.ends_with("has the rest length 0 m"), "{text}");
}

/// A seam of a scene is unpicked at its time, and the energy of that is of edits.
#[test]
fn a_scene_unpicks_seams_at_their_times() {
    let (panels, seams) = shirt();
    let (mesh, positions) = (panels.mesh(), panels.positions());
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let scene = |at_s: f64, name: &str| Scene {
        duration_s: 0.6,
        gravity_m_per_s2: Vector::zeros(),
        tearing: None,
        seams: seams.clone(),
        unpicks: vec![(0.5, "right".to_owned()), (at_s, name.to_owned())],
        ..Scene::fall(Axis::Y)
    };
    let run = |at_s, name| Run::new(mesh.clone(), &positions, scene(at_s, name), &frame);
    let mut sewn = run(0.5, "left").expect("a scene");
    let (mut least, mut splits) = (2, 0);
    while !sewn.is_over() {
        sewn.step().expect("a step");
        least = least.min(sewn.mesh().components().count());
        let is_split = |edit: &Edit<'_>| matches!(edit, Edit::Split(_));
        splits += sewn.edits().iter().filter(is_split).count();
    }
    assert_eq!(
        (least, sewn.mesh().components().count(), splits),
        (1, 2, 10)
    );
    let balance = sewn.energy_balance();
    assert!(balance.made_j() < 0.01 * balance.put_in_j(), "{balance:?}");
    let late = run(2.0, "left").expect("a scene");
    let late = Warning::before(&late, &frame, &Wording::default());
    let late: Vec<String> = late.iter().map(ToString::to_string).collect();
    let unpicked = "no seam is unpicked at 2 s: the scene is over after ";
    assert!(
        late.iter().any(|text| text.starts_with(unpicked)),
        "{late:?}"
    );
    for (at_s, name) in [(-1.0, "left"), (f64::NAN, "left"), (0.1, "collar")] {
        let refused = run(at_s, name).expect_err("no scene");
        assert_eq!(refused, RunError::Unpick { number: 1 });
    }
}
