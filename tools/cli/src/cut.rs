//! The verb `cut`.

mod files;
mod scissors;
mod words;

use std::ffi::OsString;
use std::io::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

use tearmesh::{Edits, Ledger, MassError, Masses, Mesh, Point, Positions};
use tearmesh_obj::{Document, Repair, TornDocument};

use self::files::Destination;
use crate::args::{CutArgs, Format, Mass, Method};
use crate::input::Input;
use crate::report::{self, Entry, Report};
use crate::say::{Fault, Screen, Severity, count, is_colored};
use crate::{Exit, Streams, bug, defects, output};

/// Cuts, says what was done, and gives the exit status. `typed` is for the reproducer.
pub(crate) fn run(args: &CutArgs, typed: &[OsString], streams: &mut Streams<'_>) -> Exit {
    let mut cutting = Cutting {
        args,
        destination: Destination::of(args, streams.output_is_terminal),
        report: Report::new("cut"),
        faults: Vec::new(),
        input: None,
        words: Vec::new(),
    };
    // A panic is a broken invariant too, and deserves a reproducer as much.
    let ended = catch_unwind(AssertUnwindSafe(|| cutting.work(streams)));
    let exit = match ended {
        Ok(Ok(())) => Exit::Done,
        Ok(Err(Stop { exit, faults })) => {
            cutting.faults.extend(faults);
            exit
        }
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
            let broken = [text.unwrap_or("a panic without words").to_owned()];
            cutting
                .faults
                .push(bug::report(typed, cutting.input.as_ref(), &broken));
            Exit::Bug
        }
    };
    if exit == Exit::Bug && !cutting.report.invariants.violations.is_empty() {
        let broken = &cutting.report.invariants.violations;
        cutting
            .faults
            .push(bug::report(typed, cutting.input.as_ref(), broken));
    }
    cutting.tell(exit, streams)
}

/// A run that ended early, and what has to be said about it.
struct Stop {
    exit: Exit,
    faults: Vec<Fault>,
}

impl Stop {
    fn new(exit: Exit, fault: Fault) -> Stop {
        Stop {
            exit,
            faults: vec![fault],
        }
    }
}

/// A cut in progress, and all that will be said about it.
struct Cutting<'a> {
    args: &'a CutArgs,
    destination: Destination,
    report: Report,
    faults: Vec<Fault>,
    input: Option<Input>,
    /// The summary.
    words: Vec<String>,
}

impl Cutting<'_> {
    fn work(&mut self, streams: &mut Streams<'_>) -> Result<(), Stop> {
        files::check(self.args)?;
        let cuts = scissors::scissors(self.args, streams, &mut self.faults)?;
        let input = Input::find(&self.args.input, streams.input);
        let input = &*self
            .input
            .insert(input.map_err(|fault| Stop::new(Exit::Input, fault))?);

        let clock = Clock::start();
        let document = read(input, repair(self.args), &mut self.faults)?;
        let read_ms = clock.milliseconds();
        let clock = Clock::start();
        let (document, mut mesh) = build(input, document)?;
        let build_ms = clock.milliseconds();
        self.report.input = Some(report::File::of(Some(input.name.clone()), &mesh));
        let vertices_before = mesh.vertex_count();
        let mut positions = Positions::new(document.positions().iter().copied())
            .expect("the reader accepts no coordinate that positions refuse");
        let mut masses = self.masses(&mesh, &positions)?;

        let clock = Clock::start();
        let mut edits = Edits::new();
        let mut torn = TornDocument::new(&document);
        for (i, (rays, scissor)) in cuts.iter().enumerate() {
            let number = (cuts.len() > 1).then_some(i + 1);
            let done = scissor.cut(self.method(), &mut mesh, &mut positions, &mut edits);
            let done = done.expect("positions that follow every cut are in step");
            edits.replay(&mut (&mut masses, &mut torn));
            edits.clear();
            torn.next_cut();
            let method = self.args.method.name();
            let (through, tips) = (self.args.through, self.args.tips.name());
            let entry = report::Cut::new(rays, scissor, (method, through, tips), &done);
            self.report.cuts.push(entry);
            self.words.push(words::cut(number, &done));
            self.faults.extend(words::warnings(number, through, &done));
        }
        let cut_ms = clock.milliseconds();

        let clock = Clock::start();
        let ledger = masses.ledger();
        self.verify(&torn, &mesh, &positions, &ledger)?;
        let check_ms = clock.milliseconds();
        if edits.next_number() == 0 && !self.args.allow_miss {
            return Err(self.nothing_cut());
        }

        let clock = Clock::start();
        let mut to = self.destination.name();
        self.write(&torn, &mesh, &positions, streams)
            .map_err(|error| {
                let name = to.take().unwrap_or_default();
                Stop::new(Exit::Output, cannot_write(&name, &error))
            })?;
        let write_ms = clock.milliseconds();
        let [read, build, cut, check, write] = [read_ms, build_ms, cut_ms, check_ms, write_ms];
        self.report.timing_ms = Some(report::Timing {
            read,
            build,
            cut,
            check,
            write,
        });
        self.report.output = Some(report::File::of(self.destination.name(), &mesh));
        self.words.push(words::ending(
            vertices_before,
            &mesh,
            &ledger,
            &self.destination,
        ));
        Ok(())
    }

    fn method(&self) -> tearmesh::Method {
        match self.args.method {
            Method::Partition => tearmesh::Method::Partition,
            Method::Uniform => tearmesh::Method::Uniform,
            Method::Alternating => tearmesh::Method::Alternating,
        }
    }

    fn masses(&self, mesh: &Mesh, positions: &Positions) -> Result<Masses, Stop> {
        let masses = match self.args.mass {
            Mass::Area => Masses::area(mesh, positions, 1.0),
            Mass::Half => Masses::half(mesh, positions, 1.0),
        };
        masses.map_err(|error| {
            let fault = Fault::error("E-MASS", error.to_string());
            let fault = match error {
                MassError::TooLight { .. } => fault.help("use --mass area"),
                _ => fault,
            };
            Stop::new(Exit::Input, fault)
        })
    }

    /// Checks every invariant, that the surface is where it was, and the ledger of masses.
    fn verify(
        &mut self,
        torn: &TornDocument<'_>,
        mesh: &Mesh,
        positions: &Positions,
        ledger: &Ledger,
    ) -> Result<(), Stop> {
        let (before, after) = (ledger.before.to_f64(), ledger.after.to_f64());
        self.report.mass = Some(report::Mass { before, after });
        self.report.invariants.checked = true;
        let violations = mesh.check();
        let broken = &mut self.report.invariants.violations;
        broken.extend(violations.iter().map(ToString::to_string));
        broken.extend(moved(torn.document(), mesh, positions));
        if !ledger.is_balanced() {
            broken.push(format!("I20 (mass): {before:e} became {after:e}"));
        }
        if broken.is_empty() {
            Ok(())
        } else {
            Err(Stop {
                exit: Exit::Bug,
                faults: Vec::new(),
            })
        }
    }

    /// The warnings have said why; this adds that nothing was written.
    fn nothing_cut(&mut self) -> Stop {
        if let (Some(name), Some(last)) = (self.destination.name(), self.faults.last_mut())
            && name != "-"
        {
            last.message.push_str(&format!(". {name} not written"));
        }
        self.words.clear();
        Stop {
            exit: Exit::NothingCut,
            faults: Vec::new(),
        }
    }

    fn write(
        &mut self,
        torn: &TornDocument<'_>,
        mesh: &Mesh,
        positions: &Positions,
        streams: &mut Streams<'_>,
    ) -> io::Result<()> {
        let fill = |mut out: &mut dyn Write| torn.write(mesh, positions, &mut out);
        let written = match &self.destination {
            Destination::Nowhere { .. } => return Ok(()),
            Destination::File(path) => output::write(path, fill)?,
            Destination::Output => match fill(streams.output) {
                Ok(written) => written,
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
                Err(error) => return Err(error),
            },
        };
        if written.separated > 0 {
            let copies = count(written.separated, "more vertex", "more vertices");
            self.faults.push(Fault {
                severity: Severity::Note,
                code: "W-OBJ-FANS",
                message: format!(
                    "the file has {copies} than the mesh: a vertex whose faces share no edge is \
                     written once for each fan"
                ),
                ..Fault::default()
            });
        }
        Ok(())
    }

    /// Says everything there is to say, in words or as JSON.
    fn tell(mut self, exit: Exit, streams: &mut Streams<'_>) -> Exit {
        self.report.ok = exit == Exit::Done;
        self.report.exit = exit as u8;
        self.report.diagnostics = self.faults.iter().map(Entry::new).collect();
        if self.args.no_timing || exit != Exit::Done {
            self.report.timing_ms = None;
        }
        let mut json = serde_json::to_string_pretty(&self.report)
            .expect("a report of strings and finite numbers is JSON");
        json.push('\n');
        let mut exit = exit;
        if let Some(path) = &self.args.report
            && exit != Exit::Usage
            && let Err(error) = output::write(path, |out| out.write_all(json.as_bytes()))
        {
            self.faults
                .push(cannot_write(&path.display().to_string(), &error));
            exit = Exit::Output;
        }
        if self.args.format == Format::Json {
            let printed = output::ignore_closed_pipe(streams.output.write_all(json.as_bytes()));
            return if printed == Exit::Done { exit } else { printed };
        }
        let colored = is_colored(self.args.color, streams.error_is_terminal);
        let mut screen = Screen {
            error: streams.error,
            colored,
        };
        for fault in &self.faults {
            if screen.show(fault).is_err() {
                break; // Standard error is closed: nowhere is left to complain.
            }
        }
        if self.args.quiet || exit != Exit::Done {
            return exit;
        }
        let words = self.words.join("\n") + "\n";
        let said = match self.destination {
            Destination::Output => streams.error.write_all(words.as_bytes()),
            _ => streams.output.write_all(words.as_bytes()),
        };
        let printed = output::ignore_closed_pipe(said);
        if printed == Exit::Done { exit } else { printed }
    }
}

/// What may be done to the input.
fn repair(args: &CutArgs) -> Option<Repair> {
    match (args.repair, args.separate_fans) {
        (true, _) => Some(Repair::All),
        (false, true) => Some(Repair::SeparateFans),
        (false, false) => None,
    }
}

fn read(input: &Input, repair: Option<Repair>, faults: &mut Vec<Fault>) -> Result<Document, Stop> {
    let document = input
        .document()
        .map_err(|fault| Stop::new(Exit::Input, fault))?;
    let document = match repair {
        Some(repair) => document.repaired(repair),
        None => document,
    };
    let diagnostics = document.diagnostics().iter();
    faults.extend(diagnostics.map(|one| Fault::of_file(&input.name, one)));
    Ok(document)
}

fn build(input: &Input, document: Document) -> Result<(Document, Mesh), Stop> {
    match document.mesh() {
        Ok(mesh) => Ok((document, mesh)),
        Err(error) => Err(Stop {
            exit: Exit::Input,
            faults: defects::faults(input, document, error, "or add"),
        }),
    }
}

/// What is not where it was, in words: a corner, or where faces were divided, a vertex of the
/// document, or the area.
fn moved(document: &Document, mesh: &Mesh, positions: &Positions) -> Option<String> {
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
    let area = |[a, b, c]: [Point; 3]| (b - a).cross(&(c - a)).norm() / 2.0;
    let triangles = document.triangles().iter();
    let before: f64 = triangles.map(|t| area(t.map(|v| was[v as usize]))).sum();
    let faces = mesh.faces().map(|f| mesh.corners(f));
    let after: f64 = faces.map(|t| area(t.map(|v| positions.at(v)))).sum();
    // Each area and each sum is rounded; what is lost or twice there would be far more.
    let bound = 1e-9 * before;
    ((after - before).abs() > bound).then(|| format!("I20 (area): {before:e} became {after:e}"))
}

fn cannot_write(name: &str, error: &io::Error) -> Fault {
    Fault::error("E-IO-WRITE", format!("cannot write `{name}`: {error}"))
}

struct Clock(Instant);

impl Clock {
    fn start() -> Clock {
        Clock(Instant::now())
    }

    /// The time since, to a microsecond.
    fn milliseconds(&self) -> f64 {
        self.0.elapsed().as_micros() as f64 / 1000.0
    }
}
