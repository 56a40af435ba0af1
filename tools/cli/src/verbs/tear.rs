//! The verb `tear`.

mod advice;
mod check;
mod frames;
mod precision;
mod recorder;
mod still;
mod summary;

use std::ffi::OsString;
use std::io::Write;
use std::time::Instant;

use indicatif::ProgressBar;
use tearmesh::{Cursor, CutReport, Scissor};
use tearmesh_cloth::StepError;
use tearmesh_cloth::scene::{Frame, Run, Scene, TearLog, Warning};
use tearmesh_obj::TornDocument;

use self::frames::{Frames, places};
use self::precision::Precision;
use self::recorder::Recorder;
use self::still::Still;
use crate::args::{Format, TearArgs};
use crate::cuts::no_op::NoOpReason;
use crate::exit::{Exit, Stop};
use crate::interrupt::Guard;
use crate::measure::Piece;
use crate::picture::{Texture, with_bodies};
use crate::scene::SceneSource;
use crate::session::{Opened, Session, milliseconds};
use crate::streams::Streams;
use crate::{cuts, files, output, report, simulation, weld};

/// Simulates, says what was done, and gives the exit status. `typed` is for the reproducer.
pub(crate) fn run(args: &TearArgs, typed: &[OsString], streams: &mut Streams<'_>) -> Exit {
    let (files, names) = (&args.files, check::names(args));
    Session::run("tear", files, &names, typed, streams, |session| {
        work(args, session)
    })
}

fn work(args: &TearArgs, session: &mut Session<'_, '_>) -> Result<(), Stop> {
    // What was typed is refused before a large file is read.
    let cache = args.cache.as_deref();
    cache.map_or(Ok(()), |path| files::check_format(path, "PC2", &["pc2"]))?;
    let source = SceneSource::find(&args.scene, session.streams)?;
    let cuts = simulation::typed_cuts(&args.change, &mut session.faults)?;
    let mut opened = session.open(None)?;
    weld::seams(
        &mut opened,
        args.change.weld,
        &mut session.words,
        &mut session.faults,
    )?;
    let up = args.change.up.unwrap_or_else(|| source.up());
    let frame = Frame::new(&opened.mesh, opened.positions.as_slice(), up);
    let scene = simulation::scene(&args.change, cuts, &source, &frame)?;
    check::known_forces(args, &scene)?;
    let run = simulation::begin(scene, &opened, &frame, &source)?;
    check::points_stay(args, &run, &source)?;
    let precision = Precision::new(args.cache_origin, &opened.mesh, &opened.positions);
    if args.cache.is_some() {
        let name = |v| format!("vertex {}", opened.document.number_of_vertex(v));
        precision.check(|| opened.positions.as_slice().iter().copied(), name)?;
    }
    simulation::record_seams(&run, &mut opened, &source)?;
    session.faults.extend(check::moved(&opened));
    let number = |v| opened.document.number_of_vertex(v);
    session.faults.extend(advice::before(&run, &frame, &number));
    session.faults.extend(advice::times(&run, args));
    session.warn_now();
    let play = Play {
        name: source.name().to_owned(),
        args,
        opened: &opened,
        frame: &frame,
        precision,
        guard: Guard::new(),
    };
    play.perform(run, session)
}

/// A scene that is about to be played.
struct Play<'a> {
    name: String,
    args: &'a TearArgs,
    opened: &'a Opened,
    frame: &'a Frame,
    /// That of the point cache.
    precision: Precision,
    /// An interruption ends the steps, or the writing of frames; what was done is written.
    guard: Guard,
}

/// The records of a run, which are kept up step by step.
struct Records<'d> {
    torn: TornDocument<'d>,
    frames: Frames,
    tear_log: TearLog,
    recorder: Option<Recorder>,
    still: Option<Still>,
}

impl Records<'_> {
    /// Records a frame and a moment of the page, if it is time for them.
    fn record(&mut self, run: &Run) -> Result<(), Stop> {
        self.frames.record(run, &self.torn)?;
        self.still.iter_mut().for_each(|still| still.record(run));
        let recorder = self.recorder.as_mut();
        recorder.map_or(Ok(()), |recorder| recorder.record(run))
    }
}

/// What the end of a run is compared with.
struct Beginning {
    vertices: usize,
    pieces: usize,
    crumbs: usize,
    torn_m: f64,
}

impl Beginning {
    fn of(run: &Run) -> Beginning {
        let pieces = Piece::all(run.mesh(), run.cloth().positions());
        Beginning {
            vertices: run.mesh().vertex_count(),
            pieces: pieces.len(),
            crumbs: Piece::crumbs(&pieces),
            torn_m: run.torn_length_m(),
        }
    }
}

/// How the steps ended, unless one failed: the status in the report, and the exit status.
type Ended = Result<(&'static str, Exit), StepError>;

/// Verifies the mesh, its masses and the momentum, and returns the masses.
fn verify(run: &Run, session: &mut Session<'_, '_>) -> Result<report::Mass, Stop> {
    let drift = run.tally().momentum_drift;
    // Each of some millions of terms is rounded; a lost particle, our bug, is far more.
    let broken =
        (drift > 1e-6).then(|| format!("edits changed the momentum by the fraction {drift:e}"));
    let ledger = run.cloth().masses().ledger();
    session.verify(run.mesh(), &ledger, report::KILOGRAM, broken)
}

impl Play<'_> {
    fn perform(&self, mut run: Run, session: &mut Session<'_, '_>) -> Result<(), Stop> {
        let beginning = Beginning::of(&run);
        let mut records = self.records(&run)?;
        session.check_places()?; // One may be in the folder of the frames.
        let start = Instant::now();
        let ended = self.steps(&mut run, &mut records, session)?;
        session.timing.simulate = Some(milliseconds(start));
        let mass = verify(&run, session)?;
        self.report(&run, &records, &beginning, &ended, session);
        if let Err(error) = ended {
            session.faults.push(simulation::failure(&error, &run));
            if run.tally().steps == 0 && run.edits().cursor() == Cursor::START {
                session.words.clear();
                return self.finish(records, &run, session);
            }
        }
        self.write(&run, &records, session)?;
        session.end(beginning.vertices, run.mesh(), mass);
        self.finish(records, &run, session)
    }

    /// The records before the first step.
    fn records(&self, run: &Run) -> Result<Records<'_>, Stop> {
        let files = &self.args.files;
        let name = files.input.display().to_string();
        let title = format!("{}: {}", crate::page::title(Some(&name)), self.name);
        let up = self.frame.up.vector();
        let is_drawn = files.wanted(&files.picture).is_some();
        Ok(Records {
            torn: TornDocument::new(&self.opened.document),
            frames: Frames::open(self.args, run)?,
            tear_log: TearLog::new(run),
            recorder: files
                .wanted(&files.view)
                .map(|_| Recorder::new(&title, up, &run.scene().colliders)),
            still: is_drawn
                .then(|| Still::new(self.args.picture_at, Texture::of(&self.opened.document))),
        })
    }

    /// Reports the steps in numbers and words, with what gives reason to doubt them, and sets the exit status.
    fn report(
        &self,
        run: &Run,
        records: &Records<'_>,
        beginning: &Beginning,
        ended: &Ended,
        session: &mut Session<'_, '_>,
    ) {
        let (status, exit) = match ended {
            Ok(ended) => *ended,
            Err(StepError::BlowUp { .. }) => ("blown up", Exit::Simulation),
            Err(StepError::Implicit { .. }) => ("unsolved", Exit::Simulation),
            Err(StepError::Pressed { .. }) => ("pressed", Exit::Simulation),
            Err(_) => ("unstable", Exit::Simulation),
        };
        let tear = self.numbers(run, &records.tear_log, beginning, status);
        session.faults.extend(advice::after(run));
        session.words.extend(tear.bodies.iter().map(summary::body));
        session.words.extend(summary::ripple(run));
        session
            .words
            .extend(tear.seams.as_ref().map(summary::seams));
        let has_cuts = !session.report.cuts.is_empty();
        session.words.push(summary::simulation(&tear, has_cuts));
        session.words.extend(summary::first_tear(&records.tear_log));
        session.words.push(summary::balance(run));
        if self.args.files.verbose {
            session.words.push(summary::cost(&tear.counters.features));
        }
        session.report.tear = Some(tear);
        session.exit = match exit {
            Exit::Done if self.guard.is_interrupted() => Exit::Interrupted,
            exit => exit,
        };
    }

    /// The numbers of the report.
    fn numbers(
        &self,
        run: &Run,
        log: &TearLog,
        beginning: &Beginning,
        status: &'static str,
    ) -> report::Tear {
        let tally = run.tally();
        let pieces = Piece::all(run.mesh(), run.cloth().positions());
        report::Tear {
            scene: self.name.clone(),
            solver: run.scene().solver.name(),
            status,
            steps: tally.steps,
            dt_s: run.step_s(),
            bodies: summary::bodies(run),
            ripple_m: run.ripple_m(),
            seams: (!run.scene().seams.is_empty()).then(|| summary::pairs(run)),
            time_simulated_s: run.elapsed_s(),
            time_planned_s: run.scene().duration_s,
            splits: tally.splits,
            cap_hit: tally.steps_at_cap > 0,
            steps_at_cap: tally.steps_at_cap,
            pieces_before: beginning.pieces,
            crumbs_before: beginning.crumbs,
            pieces: pieces.len(),
            crumbs: Piece::crumbs(&pieces),
            tear_length_m: run.torn_length_m() - beginning.torn_m + 0.0, // Which is never −0.
            max_stretch: tally.stretch_ratio_max,
            momentum_drift: tally.momentum_drift,
            energy_j: summary::energy(run),
            quality: run.quality(),
            counters: report::Counters {
                counters: run.cloth().system().counters(),
                features: summary::features(run),
            },
            largest_force_n: log.largest_force_n(),
            peak_force_n: log.peak_force_n(),
            first_force_n: log.first_force_n(),
            tears: log.events().to_vec(),
            frames: None,
            cache: None,
        }
    }

    /// Writes the mesh, the picture and the table of forces.
    fn write(
        &self,
        run: &Run,
        records: &Records<'_>,
        session: &mut Session<'_, '_>,
    ) -> Result<(), Stop> {
        let positions = places(run)?;
        let mesh = run.mesh();
        let fill = |mut out: &mut dyn Write| records.torn.write(mesh, &positions, &mut out);
        session.write(mesh, fill)?;
        if let Some(still) = &records.still {
            let end = (mesh, positions.as_slice());
            let (shown, time_s) = still.shown(end, run.elapsed_s());
            let (shown, points, texture) = with_bodies(shown, &run.scene().colliders, time_s);
            let up = self.frame.up.vector();
            session.show_mesh(&self.opened.document, &shown, &points[..], up, &texture)?;
        }
        // A measurement, like the report: a dry run is often made for it.
        if let Some(path) = &self.args.forces {
            output::write(path, |out| {
                summary::write_forces(run, &records.tear_log, out)
            })?;
        }
        Ok(())
    }

    /// Writes the page, which ends with the mesh as it was written, and then the frames that waited.
    /// These may take as long as the steps, so they come last, and an interruption that did not end
    /// the steps ends them.
    fn finish(
        &self,
        records: Records<'_>,
        run: &Run,
        session: &mut Session<'_, '_>,
    ) -> Result<(), Stop> {
        if let Some((recorder, path)) = records.recorder.zip(self.args.files.view.as_ref()) {
            // A run that did nothing has written nothing.
            let output = session.report.output.as_ref();
            let name = output.and_then(|file| file.path.as_deref());
            let facts = [
                ("scene", self.name.clone()),
                ("method", run.scene().solver.name().to_owned()),
                ("steps", run.tally().steps.to_string()),
                ("vertices split", run.tally().splits.to_string()),
            ];
            let page = recorder.finish(run, &records.tear_log, name, &facts)?;
            output::write(path, |out| page.write(out))?;
        }
        let was_interrupted = session.exit == Exit::Interrupted;
        let is_enough = || !was_interrupted && self.guard.is_interrupted();
        let Records { frames, torn, .. } = records;
        frames.finish(run, &torn, (&self.precision, is_enough), session)?;
        if session.exit == Exit::Done && self.guard.is_interrupted() {
            session.exit = Exit::Interrupted;
        }
        Ok(())
    }

    /// Takes all steps, or as many as can be.
    fn steps(
        &self,
        run: &mut Run,
        records: &mut Records<'_>,
        session: &mut Session<'_, '_>,
    ) -> Result<Ended, Stop> {
        let bar = self.bar(run.steps_planned(), "step {pos} of {len}", session);
        let mut ended = Ok(("done", Exit::Done));
        records.record(run)?;
        while !run.is_over() && ended == Ok(("done", Exit::Done)) {
            if self.guard.is_interrupted() {
                ended = Ok(("interrupted", Exit::Interrupted));
                break;
            }
            let step = run.step();
            run.edits().replay(&mut records.torn);
            records.frames.follow(run.edits());
            let still = records.still.iter_mut();
            still.for_each(|still| still.texture.follow(run.edits()));
            for cut in run.cuts_made() {
                self.note_cut(run.scene(), cut, session);
                records.torn.next_cut();
            }
            match step {
                Ok(step) => {
                    records.tear_log.note(run, &step);
                    records.record(run)?;
                }
                Err(error) => ended = Err(error),
            }
            if ended.is_ok() && Warning::has_exploded(run) {
                ended = Ok(("gained energy", Exit::Simulation));
            }
            bar.set_position(run.tally().steps);
        }
        bar.finish_and_clear();
        Ok(ended)
    }

    fn note_cut(&self, scene: &Scene, done: &CutReport, session: &mut Session<'_, '_>) {
        let number = session.report.cuts.len();
        let cut = &scene.cuts[number];
        let Ok(scissor) = Scissor::new(cut.rays[0], cut.rays[1]) else {
            return; // It was made with these rays.
        };
        let how = (cut.method, cut.through);
        let entry = report::Cut::new(Some(&cut.rays), &scissor, how, done, None);
        let many = (scene.cuts.len() > 1).then_some(number + 1);
        let at = crate::say::short(cut.at_s);
        let line = cuts::summary::cut(many, done);
        session.words.push(format!("{line} · at {at} s"));
        // The cloth has moved since, and there is no snap to choose.
        let warnings = cuts::summary::warnings(many, &entry, NoOpReason::Unknown, None);
        session.faults.extend(warnings);
        session.report.cuts.push(entry);
    }

    /// A progress bar, unless the words are to be few or JSON.
    fn bar(&self, length: u64, what: &str, session: &Session<'_, '_>) -> ProgressBar {
        let files = &self.args.files;
        let is_wanted = !files.quiet && files.format == Format::Text;
        let template = format!("{{bar:40}} {what}, {{eta}} left");
        session.streams.bar(length, &template, is_wanted)
    }
}
