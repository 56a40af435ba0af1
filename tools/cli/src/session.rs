//! The common part of the verbs that change a mesh: an input, an output, a report, and the promise
//! that no mesh is written that breaks an invariant.

use std::ffi::OsString;
use std::io::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::Instant;

use tearmesh::{MassError, MassLedger, Mesh, Place, Point, Positions, Vector, VertexId};
use tearmesh_obj::{Document, Repair, WriteSummary};
use tearmesh_view::{ANGLE_OF_VIEW, Moment, Page, PictureSize, RenderOptions, fit, render};

use crate::args::{FileArgs, Format, LookArgs};
use crate::exit::{Exit, Stop};
use crate::files::Names;
use crate::input::Input;
use crate::measure::area;
use crate::picture::Texture;
use crate::report::{self, Entry, Report, Timing};
use crate::say::{Fault, count, short, shown};
use crate::streams::Streams;
use crate::{bug, defects, files, output, page, picture};

/// A run in progress, and all that will be said about it.
pub(crate) struct Session<'a, 's> {
    pub(crate) streams: &'a mut Streams<'s>,
    files: &'a FileArgs,
    /// The file that the mesh goes to, or why it goes nowhere.
    destination: Result<PathBuf, &'static str>,
    pub(crate) report: Report,
    pub(crate) faults: Vec<Fault>,
    input: Option<Input>,
    /// The summary.
    pub(crate) words: Vec<String>,
    /// How the run ends, where the work was done all the same.
    pub(crate) exit: Exit,
    pub(crate) timing: Timing,
    /// How many of the faults have been shown already.
    shown: usize,
}

/// What was read.
pub(crate) struct Opened {
    pub(crate) document: Document,
    pub(crate) mesh: Mesh,
    pub(crate) positions: Positions,
    /// By vertex of the file, the one that it became when seams were sewn.
    pub(crate) welded: Option<Vec<VertexId>>,
    /// How long it took to read the document, and to build its mesh.
    timing_ms: [f64; 2],
}

impl<'a, 's> Session<'a, 's> {
    /// Runs a verb, says what was done, and gives the exit status. `typed` is for the reproducer.
    pub(crate) fn run(
        verb: &'static str,
        files: &'a FileArgs,
        names: &Names<'_>,
        typed: &[OsString],
        streams: &'a mut Streams<'s>,
        work: impl FnOnce(&mut Session<'a, 's>) -> Result<(), Stop>,
    ) -> Exit {
        let output_is_terminal = streams.output_is_terminal;
        let mut session = Session {
            streams,
            files,
            destination: files::destination(files, output_is_terminal),
            report: Report::new(verb),
            faults: Vec::new(),
            input: None,
            words: Vec::new(),
            exit: Exit::Done,
            timing: Timing::default(),
            shown: 0,
        };
        // A panic is a broken invariant too, and deserves a reproducer as much.
        let ended = catch_unwind(AssertUnwindSafe(|| {
            files::check(files)?;
            names.check()?;
            if let Some(unwritten) = files::unwritten(files, output_is_terminal) {
                session.faults.push(unwritten);
                session.warn_now();
            }
            work(&mut session)
        }));
        let mut broken = Vec::new();
        let exit = match ended {
            Ok(Ok(())) => session.exit,
            Ok(Err(Stop { exit, faults })) => {
                session.faults.extend(faults);
                exit
            }
            Err(panic) => {
                let text = panic.downcast_ref::<String>().map(String::as_str);
                let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
                broken.push(text.unwrap_or("a panic without words").to_owned());
                Exit::Bug
            }
        };
        broken.extend_from_slice(&session.report.invariants.violations);
        if exit == Exit::Bug && !broken.is_empty() {
            let fault = bug::report(typed, session.input.as_ref(), &broken);
            session.faults.push(fault);
        }
        session.tell(exit)
    }

    /// Reads the input and builds its mesh.
    pub(crate) fn open(&mut self, repair: Option<Repair>) -> Result<Opened, Stop> {
        let input = Input::find(&self.files.input, self.streams.input)?;
        let input = &*self.input.insert(input);
        let opened = open(input, repair, "or add", &mut self.faults)?;
        [self.timing.read, self.timing.build] = opened.timing_ms;
        self.report.input = Some(report::File::of(Some(input.name.clone()), &opened.mesh));
        Ok(opened)
    }

    /// Checks every invariant and the ledger of masses. `broken` is what is wrong besides.
    pub(crate) fn verify(
        &mut self,
        mesh: &Mesh,
        ledger: &MassLedger,
        unit: &'static str,
        broken: Option<String>,
    ) -> Result<report::Mass, Stop> {
        let start = Instant::now();
        let mass = *self.report.mass.insert(report::Mass {
            before: ledger.before.to_f64(),
            after: ledger.after.to_f64(),
            unit,
        });
        self.report.invariants.checked = true;
        let violations = &mut self.report.invariants.violations;
        violations.extend(mesh.check().iter().map(ToString::to_string));
        violations.extend(broken);
        if !ledger.is_balanced() {
            let report::Mass { before, after, .. } = mass;
            violations.push(format!("I20 (mass): {before:e} became {after:e}"));
        }
        if !violations.is_empty() {
            return Err(Stop::explained(Exit::Bug));
        }
        self.timing.check = milliseconds(start);
        Ok(mass)
    }

    /// The name of the file that the mesh goes to, if it goes anywhere.
    fn name(&self) -> Option<String> {
        Some(self.destination.as_ref().ok()?.display().to_string())
    }

    /// The file that the mesh goes to, if it is one.
    fn file(&self) -> Option<&Path> {
        let path = self.destination.as_deref().ok()?;
        (path != Path::new("-")).then_some(path)
    }

    /// Ends the summary of a mesh that had so many vertices before.
    pub(crate) fn end(&mut self, vertices_before: usize, mesh: &Mesh, mass: report::Mass) {
        let mut sums = change("mass", [mass.before, mass.after]);
        if mass.unit != report::AREA {
            sums += &format!(" {}", mass.unit);
        }
        if let Some(report::Area { before, after }) = self.report.area {
            sums += &format!(" · {}", change("area", [before, after]));
        }
        let (vertices, faces) = (mesh.vertex_count(), mesh.face_count());
        let ending = match (&self.destination, self.file()) {
            (Err(why), _) => (*why).to_owned(),
            (_, None) => "wrote standard output".to_owned(),
            (_, Some(path)) => format!("wrote {}", shown(path)),
        };
        self.words.push(format!(
            "{sums} · vertices {vertices_before} -> {vertices} · faces {faces} · invariants hold · {ending}"
        ));
    }

    /// Says that there was nothing to do, and so nothing was written; warnings have said why.
    pub(crate) fn nothing_done(&mut self) -> Stop {
        let unwritten = |path: &Path| format!(". {} not written", path.display());
        let unwritten = self.file().map(unwritten);
        if let (Some(unwritten), Some(last)) = (unwritten, self.faults.last_mut()) {
            last.message.push_str(&unwritten);
        }
        self.words.clear();
        Stop::explained(Exit::NothingCut)
    }

    /// Refuses places that could not be written: before work that takes long.
    pub(crate) fn check_places(&self) -> Result<(), Stop> {
        let report = self.files.report.as_deref();
        let mut files = self.file().into_iter().chain(report);
        Ok(files.try_for_each(output::check)?)
    }

    /// Writes the mesh, as a whole or not at all.
    pub(crate) fn write(
        &mut self,
        mesh: &Mesh,
        fill: impl Fn(&mut dyn Write) -> io::Result<WriteSummary>,
    ) -> Result<(), Stop> {
        let start = Instant::now();
        let written = match &self.destination {
            Ok(path) => output::write_or_print(path, self.streams.output, fill)?,
            Err(_) => None,
        };
        self.timing.write = milliseconds(start);
        self.report.output = Some(report::File::of(self.name(), mesh));
        let (unspoken, separated) = written.map_or((0, 0), |one| (one.unspoken, one.separated));
        if unspoken > 0 {
            let statements = count(unspoken, "statement", "statements");
            let message = format!(
                "duplicates of vertices do not have the `nl`, `ny`, `nv` or `vv` data of their originals \
                 ({statements})"
            );
            self.faults.push(Fault::warning("W-OBJ-FOREIGN", message));
        }
        if separated > 0 {
            let one = "duplicate of a vertex was written, because its";
            let many = "duplicates of vertices were written, because their";
            let copies = count(separated, one, many);
            let message = format!("{copies} faces no longer share an edge");
            self.faults.push(Fault::note("W-OBJ-FANS", message));
        }
        Ok(())
    }

    /// Draws the picture of a mesh that came from a document, if one is wanted.
    pub(crate) fn show_mesh(
        &self,
        document: &Document,
        mesh: &Mesh,
        place: &(impl Place + ?Sized),
        up: Vector,
        texture: &Texture,
    ) -> Result<(), Stop> {
        let Some(path) = self.files.wanted(&self.files.picture) else {
            return Ok(());
        };
        let size = PictureSize::USUAL;
        let camera = fit(mesh, place, up, ANGLE_OF_VIEW, size.as_f64());
        let camera = camera.map_err(picture::no_camera)?;
        let options = RenderOptions {
            crease_deg: picture::crease(document),
            ground: Some(up),
            texture: texture.values.clone(),
            ..RenderOptions::default()
        };
        let picture = render(mesh, place, &camera, size, &options);
        Ok(output::write(path, |out| picture.write_png(out))?)
    }

    /// Shows the mesh as it is in the end on a page, if one is wanted.
    pub(crate) fn show_page(
        &self,
        mesh: &Mesh,
        place: &(impl Place + ?Sized),
        up: Vector,
    ) -> Result<(), Stop> {
        let Some(path) = self.files.wanted(&self.files.view) else {
            return Ok(());
        };
        let name = self.name();
        let title = page::title(name.as_deref());
        let mut page = Page::new(title.clone(), up);
        let moment = Moment {
            label: title,
            cut: name.map(|name| page::cut_line(&name, "")),
            ..Moment::default()
        };
        let added = page.add(mesh, place, moment);
        added.map_err(picture::no_camera)?;
        Ok(output::write(path, |out| page.write(out))?)
    }

    /// Shows the warnings so far, unless they are to be JSON: before something that takes long.
    pub(crate) fn warn_now(&mut self) {
        if self.files.format == Format::Text {
            self.show();
        }
    }

    fn show(&mut self) {
        let files = self.files;
        let is_shown = |fault: &&Fault| files.verbose || fault.code != "W-OBJ-FANS";
        let new = self.faults[self.shown..].iter().filter(is_shown);
        let new: Vec<Fault> = new.cloned().collect();
        self.streams.show(&new, files.color, files.verbose);
        self.shown = self.faults.len();
    }

    /// Says everything there is to say, in words or as JSON, and in the report.
    fn tell(mut self, mut exit: Exit) -> Exit {
        let keeps_report = exit != Exit::Usage;
        if keeps_report && let Err(fault) = self.keep_report(exit) {
            // It may have been found out before.
            if self.faults.iter().all(|one| one.message != fault.message) {
                self.faults.push(fault);
            }
            exit = Exit::Output;
        }
        let Err(mut fault) = self.print(exit) else {
            return exit;
        };
        let written = self.file().filter(|_| self.report.output.is_some());
        let written = written.map(|path| format!("`{}` was written", path.display()));
        fault.help = written.or(fault.help.take());
        self.faults.push(fault);
        self.show();
        if keeps_report {
            // So that it tells what the exit status does. If it cannot be written, that was said.
            let _ = self.keep_report(Exit::Output);
        }
        Exit::Output
    }

    /// The report, of a run that ends so.
    fn json(&mut self, exit: Exit) -> String {
        self.report.ok = exit == Exit::Done;
        self.report.exit = exit as u8;
        self.report.diagnostics = self.faults.iter().map(Entry::new).collect();
        let is_timed = !self.files.no_timing && exit == Exit::Done;
        self.report.timing_ms = is_timed.then_some(self.timing);
        let json = serde_json::to_string_pretty(&self.report);
        json.expect("a report of strings and finite numbers is JSON") + "\n"
    }

    /// Writes the report into its file, if one is wanted.
    fn keep_report(&mut self, exit: Exit) -> Result<(), Fault> {
        let Some(path) = &self.files.report else {
            return Ok(());
        };
        let json = self.json(exit);
        output::write(path, |out| out.write_all(json.as_bytes()))
    }

    /// Shows what there is to say, or prints it as JSON.
    fn print(&mut self, exit: Exit) -> Result<(), Fault> {
        if self.files.format == Format::Json {
            let json = self.json(exit);
            return output::print_text(self.streams.output, &json);
        }
        self.show();
        let has_words = matches!(exit, Exit::Done | Exit::Simulation | Exit::Interrupted);
        if self.files.quiet || !has_words || self.words.is_empty() {
            return Ok(());
        }
        let words = self.words.join("\n") + "\n";
        if self.name().as_deref() == Some("-") {
            // Nowhere is left to complain if standard error is closed.
            let _ = self.streams.error.write_all(words.as_bytes());
            return Ok(());
        }
        output::print_text(self.streams.output, &words)
    }
}

/// A quantity before and after, for the summary.
fn change(of: &str, numbers: [f64; 2]) -> String {
    let [before, after] = numbers.map(short);
    format!("{of} {before} -> {after}")
}

/// Finds a mesh to look at, and opens it.
pub(crate) fn look(
    path: &Path,
    args: &LookArgs,
    faults: &mut Vec<Fault>,
    streams: &mut Streams<'_>,
) -> Result<(Input, Opened), Stop> {
    let input = Input::find(path, streams.input)?;
    let repair = repair(args.repair, args.separate_fans);
    let opened = open(&input, repair, "or add", faults)?;
    Ok((input, opened))
}

/// What may be done to an input: all there is, or only giving each fan its own vertex.
pub(crate) fn repair(all: bool, fans: bool) -> Option<Repair> {
    match (all, fans) {
        (true, _) => Some(Repair::All),
        (false, true) => Some(Repair::SeparateFans),
        (false, false) => None,
    }
}

/// Reads a document and builds its mesh. `or` stands before the option that would repair it.
pub(crate) fn open(
    input: &Input,
    repair: Option<Repair>,
    or: &str,
    faults: &mut Vec<Fault>,
) -> Result<Opened, Stop> {
    let start = Instant::now();
    let mut document = input.document()?;
    if let Some(repair) = repair {
        document = document.repaired(repair);
    }
    let diagnostics = document.diagnostics().iter();
    faults.extend(diagnostics.map(|one| Fault::of_file(&input.name, one)));
    let read = milliseconds(start);
    let start = Instant::now();
    let mesh = match document.mesh() {
        Ok(mesh) => mesh,
        Err(error) => return Err(defects::faults(input, document, &error, or).into()),
    };
    let timing_ms = [read, milliseconds(start)];
    let positions = Positions::new(document.positions().iter().copied())
        .expect("the reader accepts no coordinate that positions refuse");
    Ok(Opened {
        document,
        mesh,
        positions,
        welded: None,
        timing_ms,
    })
}

/// What is not where it was, in words: a corner, or where faces were divided, a vertex of the
/// document, or the area.
pub(crate) fn moved(document: &Document, mesh: &Mesh, positions: &Positions) -> Option<String> {
    let bits = |point: Point| [point.x, point.y, point.z].map(f64::to_bits);
    let was = document.positions();
    if mesh.face_count() == document.triangles().len() {
        let corners = document.triangles().as_flattened().iter();
        let mut corners = corners.map(|&v| was[v as usize]).zip(mesh.half_edges());
        let (was, h) = corners.find(|&(was, h)| bits(positions.at(mesh.origin(h))) != bits(was))?;
        let is = positions.at(mesh.origin(h));
        return Some(format!("I20 (positions): {h} was at {was}, and is at {is}"));
    }
    let mut vertices = mesh.vertices().zip(was);
    if let Some((v, was)) = vertices.find(|&(v, &was)| bits(positions.at(v)) != bits(was)) {
        let is = positions.at(v);
        return Some(format!("I20 (positions): {v} was at {was}, and is at {is}"));
    }
    let corners = || {
        let faces = mesh.faces().map(|f| mesh.face_vertices(f));
        faces.map(|corners| corners.map(|v| positions.at(v)))
    };
    let triangles = document.triangles().iter();
    let before: f64 = triangles.map(|t| area(t.map(|v| was[v as usize]))).sum();
    let after: f64 = corners().map(area).sum();
    // Each area and each sum is rounded, and so are the coordinates of each vertex that was inserted: where
    // they are large, it is off the surface by that. What is lost or twice there would be far more.
    let rounding = |[a, b, c]: [Point; 3]| {
        let around = (b - a).norm() + (c - b).norm() + (a - c).norm();
        let largest = [a, b, c].map(|p| p.coords.amax());
        around * largest.into_iter().fold(0.0, f64::max) * f64::EPSILON
    };
    let bound = 1e-9 * before + 2.0 * corners().map(rounding).sum::<f64>();
    ((after - before).abs() > bound).then(|| format!("I20 (area): {before:e} became {after:e}"))
}

/// Why masses could not be computed.
impl From<MassError> for Fault {
    fn from(error: MassError) -> Fault {
        let fault = Fault::error("E-MASS", error.to_string());
        match error {
            MassError::TooLight { .. } => fault.help("use --mass area"),
            _ => fault,
        }
    }
}

/// The time since, to a microsecond.
pub(crate) fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_micros() as f64 / 1000.0
}
