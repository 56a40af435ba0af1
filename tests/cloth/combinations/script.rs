//! The verbs of a case, performed on a simulation frame by frame.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use tearmesh::{Mesh, Point, Positions, Scissor, Vector, VertexId};
use tearmesh_cloth::scene::{Frame, Scene};
use tearmesh_cloth::{
    CutId, HandId, InputError, Simulation, SimulationDef, StepError, Unstable, Wind, Wounds,
};

use super::factors::Case;
use super::formulas::air;
use super::judge::{Fault, Judge, fault};
use super::shapes::Shape;
use super::text::{
    BLOWN, COEFFICIENT, CUT, FRAMES, FREED, GRABBED, HEALED, LED_M, RELEASED, SEAMS, TAKEN, Text,
    UNPICKED, at_s, moves,
};
use crate::follow;
use crate::parts::{ray, v};

/// The definition that a scene stands for, as somebody writes it who has no scenes.
pub(super) fn definition(scene: &Scene, frame: &Frame, shape: &Shape) -> SimulationDef {
    let strengths = scene.vertex_strengths(&shape.mesh, shape.positions.as_slice(), frame);
    SimulationDef {
        density_kg_per_m2: scene.areal_density_kg_per_m2,
        fabric: scene.fabric,
        method: scene.solver.clone(),
        tearing: scene.tearing,
        strengths: strengths.expect("regions with vertices"),
        rest: scene.rest.clone(),
        ripple_m: scene.ripple_m,
        seams: scene.seams.clone(),
        loads: scene.loads(),
        step_s: scene.step_s,
        ..SimulationDef::default()
    }
}

/// Everything that a simulation or a run computed, as words.
pub(super) fn words(mesh: &Mesh, positions: &[Point], velocities: &[Vector]) -> Vec<u64> {
    let points = positions.iter().flat_map(|x| [x.x, x.y, x.z]);
    let numbers = points.chain(velocities.iter().flat_map(|v| [v.x, v.y, v.z]));
    let indices = mesh.indices().iter().map(|&index| u64::from(index));
    numbers.map(f64::to_bits).chain(indices).collect()
}

pub(super) fn words_of(sim: &Simulation) -> Vec<u64> {
    let system = sim.cloth().system();
    words(sim.mesh(), system.positions(), system.velocities())
}

/// A script in progress.
pub(super) struct Script<'c> {
    case: &'c Case,
    shape: &'c Shape,
    pub(super) sim: Simulation,
    /// The vertices of the scene's hold.
    held: Vec<VertexId>,
    hands: [Option<(HandId, Point)>; 2],
    cut: Option<CutId>,
    /// The verbs that were performed, and a line of each.
    pub(super) verbs: BTreeSet<&'static str>,
    pub(super) lines: String,
    /// Why steps failed, without their times.
    pub(super) failures: Vec<String>,
    /// The pieces of cloth that momentum was followed of, and the vertices that touched a collider.
    pub(super) judged: [usize; 2],
    pub(super) soft: Vec<Fault>,
}

impl<'c> Script<'c> {
    pub(super) fn new(
        case: &'c Case,
        shape: &'c Shape,
        def: SimulationDef,
        held: Vec<VertexId>,
    ) -> Result<Script<'c>, Fault> {
        let sim = Simulation::new(shape.mesh.clone(), &shape.positions, def);
        let sim = sim.map_err(|error| fault("refused", format!("no simulation: {error}")))?;
        Ok(Script {
            case,
            shape,
            sim,
            held,
            hands: [None, None],
            cut: None,
            verbs: BTreeSet::new(),
            lines: String::new(),
            failures: Vec::new(),
            judged: [0; 2],
            soft: Vec::new(),
        })
    }

    /// Performs all verbs, and lets time pass.
    pub(super) fn play(&mut self) -> Result<(), Fault> {
        let case = self.case;
        let mut judge = Judge::new(case, self.sim.mesh(), self.sim.cloth());
        let steps = (at_s(1) / self.sim.step_s()).round() as u64;
        for frame in 0..FRAMES {
            let done = self.perform(frame);
            done.map_err(|error| fault("refused", format!("in frame {frame}: {error}")))?;
            if self.has_healed(frame) {
                judge.skip();
            }
            self.advance(frame, steps, &mut judge)?;
            let is_sewing =
                self.sim.open_pairs() > 0 || case.is("seams", "sewn") || self.has_healed(frame);
            judge.frame(self.sim.mesh(), self.sim.cloth(), is_sewing)?;
            follow::check(self.sim.mesh(), self.sim.cloth(), false);
            let corners = self.sim.mesh().half_edge_count();
            let drawn = self.sim.draw_buffers().indices().len();
            if drawn != corners {
                return Err(fault(
                    "buffers",
                    format!("{drawn} corners of {corners} are drawn"),
                ));
            }
            self.sim.events().for_each(drop);
        }
        self.judged = [judge.followed, judge.touched];
        self.soft = judge.soft;
        Ok(())
    }

    fn has_healed(&self, frame: u64) -> bool {
        !self.case.is("heal", "none") && frame >= HEALED
    }

    /// Takes the steps of a frame; one that fails leaves all as it was, and says why only once.
    fn advance(&mut self, frame: u64, steps: u64, judge: &mut Judge<'_>) -> Result<(), Fault> {
        // Every other frame step by step, so that the work of several calls and of one are both seen.
        let calls = if frame.is_multiple_of(2) { 1 } else { steps };
        for _ in 0..calls {
            let count = steps / calls;
            let before = self.sim.steps();
            let taken = self.sim.advance(count as f64 * self.sim.step_s(), count);
            match taken {
                Ok(reached) if reached.steps == count => {}
                Ok(reached) => {
                    let text = format!(
                        "in frame {frame} {} steps of {count} were taken",
                        reached.steps
                    );
                    return Err(fault("frames", text));
                }
                Err(error) => {
                    judge.skip();
                    return self.failed(&error, frame);
                }
            }
            let taken = self.sim.steps() - before;
            match calls > 1 && !self.case.is("wind", "swaying") {
                true => judge.step(
                    self.sim.mesh(),
                    self.sim.cloth(),
                    taken as f64 * self.sim.step_s(),
                ),
                false => judge.skip(),
            }
        }
        Ok(())
    }

    fn failed(&mut self, error: &StepError, frame: u64) -> Result<(), Fault> {
        let reason = error.to_string();
        let reason: String = reason.chars().filter(|c| !c.is_ascii_digit()).collect();
        if !error.code().starts_with("E-") {
            return Err(fault("finite", format!("{error} has no code")));
        }
        if self.failures.contains(&reason) {
            return Err(fault(
                "frames",
                format!("frame {frame} fails once more: {error}"),
            ));
        }
        self.failures.push(reason);
        Ok(())
    }

    fn say(&mut self, frame: u64, verb: &'static str, words: &str) {
        self.verbs.insert(verb);
        writeln!(self.lines, "frame {frame}: {verb} {words}").expect("a text takes lines");
    }

    fn perform(&mut self, frame: u64) -> Result<(), InputError> {
        self.hold(frame)?;
        self.hand(frame)?;
        self.unpick(frame)?;
        self.cut(frame)?;
        self.heal(frame)?;
        self.blow(frame)
    }

    /// Holds and frees what a hold of the scene does; one that moves is a hand.
    fn hold(&mut self, frame: u64) -> Result<(), InputError> {
        let way = moves(self.case);
        if self.held.is_empty() {
            return Ok(());
        }
        let vertices = self.held.clone();
        if way.is_empty() {
            if frame == 0 {
                self.sim.hold(vertices.iter().copied())?;
                self.say(frame, "hold", &format!("{vertices:?}"));
            } else if frame == FREED && self.case.is("hold", "released") {
                // Sewing gave some of them other numbers.
                let in_hands = self
                    .hands
                    .iter()
                    .flatten()
                    .filter_map(|(hand, _)| self.sim.in_hand(*hand).ok());
                let in_hands: Vec<VertexId> = in_hands.flatten().copied().collect();
                let is_held = |v: &VertexId| {
                    self.sim.cloth().system().is_held(v.index()) && !in_hands.contains(v)
                };
                let vertices: Vec<VertexId> = self.sim.mesh().vertices().filter(is_held).collect();
                self.sim.free(vertices.iter().copied())?;
                self.say(frame, "free", &format!("{vertices:?}"));
            }
            return Ok(());
        }
        if frame == TAKEN {
            self.grab(0, vertices[0], frame)?;
        } else if frame > TAKEN {
            let after = way.iter().rev().find(|(at, _)| *at <= frame);
            let by = after.map_or([0.0; 3], |(_, by)| *by);
            self.lead(0, by.into(), frame)?;
        }
        Ok(())
    }

    fn hand(&mut self, frame: u64) -> Result<(), InputError> {
        if self.case.is("hand", "none") {
            return Ok(());
        }
        match frame {
            GRABBED => self.grab(1, v(self.shape.hand), frame),
            _ if frame > GRABBED && frame < RELEASED => {
                let part = (frame - GRABBED) as f64 / 8.0;
                self.lead(1, Vector::from(LED_M) * part.min(1.0), frame)
            }
            RELEASED => {
                let (hand, _) = self.hands[1].expect("it was grabbed");
                self.say(frame, "release", "");
                self.sim.release(hand)
            }
            _ => Ok(()),
        }
    }

    fn grab(&mut self, hand: usize, vertex: VertexId, frame: u64) -> Result<(), InputError> {
        let at = self.sim.cloth().positions()[vertex.index()];
        // It may pick another vertex, or none, where the cloth is folded.
        let _picked = self.sim.pick(&ray(at.x, at.y));
        let id = self.sim.grab(vertex, Simulation::GRIP_RADIUS_M)?;
        self.hands[hand] = Some((id, at));
        self.say(frame, "grab", &format!("{vertex}"));
        Ok(())
    }

    fn lead(&mut self, hand: usize, by: Vector, frame: u64) -> Result<(), InputError> {
        let (id, from) = self.hands[hand].expect("it was grabbed");
        self.sim.lead(id, from + by)?;
        self.say(frame, "lead", &format!("by {:?}", by.as_slice()));
        assert!(!self.sim.in_hand(id)?.is_empty(), "a hand has a vertex");
        Ok(())
    }

    fn unpick(&mut self, frame: u64) -> Result<(), InputError> {
        let at = match self.case.get("unpick") {
            "none" => return Ok(()),
            level => UNPICKED[usize::from(level == "late")],
        };
        if frame == at {
            self.sim.unpick(SEAMS[0])?;
            self.say(frame, "unpick", SEAMS[0]);
        }
        Ok(())
    }

    fn cut(&mut self, frame: u64) -> Result<(), InputError> {
        if frame != CUT || self.case.is("cut", "none") {
            return Ok(());
        }
        let [a, b] = self.shape.slit.map(|[x, y]| ray(x, y));
        let scissor = Scissor::new(a, b).expect("a plane");
        let scissor = scissor.with_through(self.case.is("cut", "through"));
        let scissor = match self.case.get("cut") {
            "snap0" => scissor.with_snap(0.0),
            _ => scissor,
        };
        self.cut = Some(self.sim.cut(&scissor)?);
        self.say(frame, "cut", self.case.get("cut"));
        Ok(())
    }

    fn heal(&mut self, frame: u64) -> Result<(), InputError> {
        if frame == HEALED && !self.case.is("heal", "none") {
            let wounds = match self.case.get("heal") {
                "cut" => Wounds::Cut(self.cut.expect("a cut was made")),
                "seam" => Wounds::Seam("left"),
                _ => Wounds::All,
            };
            self.sim.heal(wounds)?;
            self.say(frame, "heal", self.case.get("heal"));
        }
        if frame == HEALED + 1 && self.case.is("heal", "ended") {
            self.sim.let_go(Wounds::All)?;
            self.say(frame, "let_go", "all");
        }
        Ok(())
    }

    fn blow(&mut self, frame: u64) -> Result<(), InputError> {
        let changes = match self.case.get("wind") {
            "swaying" => true,
            "later" => frame == 0 || frame == BLOWN,
            _ => false,
        };
        if changes {
            let wind = air(self.case, at_s(frame)).map(|velocity_m_per_s| Wind {
                velocity_m_per_s,
                coefficient: COEFFICIENT,
            });
            self.sim.set_wind(wind)?;
            self.say(frame, "set_wind", &format!("{wind:?}"));
        }
        Ok(())
    }
}

/// A script that is recorded, before it begins, and what defines it.
fn begun<'c>(
    case: &'c Case,
    shape: &'c Shape,
    scene: &Scene,
    frame: &Frame,
) -> Result<(Script<'c>, SimulationDef), Fault> {
    let def = SimulationDef {
        is_recorded: true,
        when_unstable: Unstable::Substep,
        ..definition(scene, frame, shape)
    };
    let (mesh, points) = (&shape.mesh, shape.positions.as_slice());
    let hold = scene.holds.first().filter(|_| !case.is("hold", "none"));
    let held = hold.map_or_else(Vec::new, |hold| hold.region.vertices(mesh, points, frame));
    Ok((Script::new(case, shape, def.clone(), held)?, def))
}

/// The verbs of a case as far as they can be performed, a line each.
pub(super) fn lines(case: &Case, shape: &Shape) -> String {
    let read = Text::of(case, shape).scene(shape);
    let read = read.map_err(|error| fault("refused", error));
    let begun = read.and_then(|(scene, frame)| begun(case, shape, &scene, &frame));
    begun.map_or_else(
        |fault| fault.message,
        |(mut script, _)| {
            let ended = script.play().err();
            script.lines + &ended.map_or_else(String::new, |fault| fault.message)
        },
    )
}

/// Plays the script of a case, and its log again, which gives the same cloth.
pub(super) fn recorded<'c>(
    case: &'c Case,
    shape: &'c Shape,
    scene: &Scene,
    frame: &Frame,
) -> Result<Script<'c>, Fault> {
    let (mut script, def) = begun(case, shape, scene, frame)?;
    script.play()?;
    let log = script.sim.log().expect("it is recorded");
    let read = log
        .to_string()
        .parse()
        .map_err(|error| fault("replay", format!("{error:?}")))?;
    let positions: &Positions = &shape.positions;
    let again = Simulation::replayed(shape.mesh.clone(), positions, def, &read, |_, _| {});
    let again = again.map_err(|error| fault("replay", error.to_string()))?;
    if words_of(&again) != words_of(&script.sim) {
        return Err(fault("replay", "the log gives another cloth"));
    }
    Ok(script)
}
