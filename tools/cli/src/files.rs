//! The paths that a verb reads and writes, and the files that it refuses to replace.

use std::path::{Path, PathBuf};

use tearmesh::Mesh;

use crate::args::{FileArgs, Format};
use crate::exit::Stop;
use crate::output;
use crate::report;
use crate::say::{Fault, short};

/// Where the mesh goes.
pub(crate) enum Destination {
    Nowhere { why: &'static str },
    Output,
    File(PathBuf),
}

impl Destination {
    pub(crate) fn of(args: &FileArgs, output_is_terminal: bool) -> Destination {
        match &args.output {
            _ if args.dry_run => Destination::Nowhere {
                why: "dry run, no mesh written",
            },
            Some(path) if path == Path::new("-") => Destination::Output,
            Some(path) => Destination::File(path.clone()),
            None if args.format == Format::Json => Destination::Nowhere {
                why: "nothing written",
            },
            None if output_is_terminal => Destination::Nowhere {
                why: "nothing written: name a file with -o OUT",
            },
            None => Destination::Output,
        }
    }

    pub(crate) fn name(&self) -> Option<String> {
        match self {
            Destination::Nowhere { .. } => None,
            Destination::Output => Some("-".to_owned()),
            Destination::File(path) => Some(path.display().to_string()),
        }
    }
}

/// Refuses streams and files that are wanted twice.
pub(crate) fn check(args: &FileArgs) -> Result<(), Stop> {
    let usage = |message: String, help: &str| Err(Stop::usage(message, help));
    let (input, output, report) = (
        Some(&args.input),
        args.output.as_ref(),
        args.report.as_ref(),
    );
    let is_stream = |path: &PathBuf| path == Path::new("-");
    if args.in_place && is_stream(&args.input) {
        let message = "standard input cannot be replaced".to_owned();
        return usage(message, "name the file to read, or leave out --in-place");
    }
    if let Some((path, help)) = output.and_then(|path| Some((path, foreign(path)?))) {
        return Err(only("OBJ", path, help));
    }
    args.picture.as_deref().map_or(Ok(()), check_picture)?;
    args.view.as_deref().map_or(Ok(()), check_page)?;
    if args.format == Format::Json && output.is_some_and(is_stream) {
        let message = "`-o -` and `--format json` both use standard output".to_owned();
        return usage(
            message,
            "write the mesh to a file, or the report with --report FILE",
        );
    }
    if report.is_some_and(is_stream) {
        let message = "`--report` takes the name of a file".to_owned();
        return usage(message, "print the report with --format json");
    }
    let same =
        |a: Option<&PathBuf>, b: Option<&PathBuf>| a.zip(b).is_some_and(|(a, b)| is_same(a, b));
    if same(input, output) && !args.in_place {
        let name = output
            .map(|path| path.display().to_string())
            .unwrap_or_default();
        let message = format!("`{name}` is the input, and would be replaced");
        return usage(message, "write to another file, or add --in-place");
    }
    if same(input, report) || same(output, report) {
        let message = "the report would replace the mesh".to_owned();
        return usage(message, "write the report to a file of its own");
    }
    let mut taken = vec![input, output, report];
    for (option, path) in seen(args) {
        let is_taken = taken.iter().any(|&other| same(other, Some(path)));
        if is_taken || is_stream(path) {
            let message = format!("`{option}` takes the name of a file of its own");
            return usage(message, "name a file that is not used for anything else");
        }
        output::check(path)?;
        taken.push(Some(path));
    }
    Ok(())
}

/// Refuses more than one input from standard input.
pub(crate) fn one_stream<P: AsRef<Path>>(inputs: &[P]) -> Result<(), Stop> {
    let is_stream = |path: &&P| path.as_ref() == Path::new("-");
    match inputs.iter().filter(is_stream).count() {
        0 | 1 => Ok(()),
        _ => Err(Stop::usage(
            "two inputs both come from standard input",
            "name a file for one of them",
        )),
    }
}

/// That a file is named like one of another format than the only one that is written.
fn only(format: &str, path: &Path, help: &str) -> Stop {
    let name = path.display();
    let message = format!("cannot write `{name}`: only {format} output is supported");
    Stop::usage(message, help)
}

/// Refuses a picture that is named like a file of another format.
pub(crate) fn check_picture(path: &Path) -> Result<(), Stop> {
    match has_ending(path, &["png"]) {
        true => Ok(()),
        false => Err(only("PNG", path, "name it x.png")),
    }
}

/// Refuses a page that is named like a file of another format.
pub(crate) fn check_page(path: &Path) -> Result<(), Stop> {
    match has_ending(path, &["html", "htm"]) {
        true => Ok(()),
        false => Err(only("HTML", path, "name it x.html")),
    }
}

/// Whether a name has one of these endings, or none, as the names of streams and devices.
fn has_ending(path: &Path, endings: &[&str]) -> bool {
    let is_one =
        |ending: &std::ffi::OsStr| endings.iter().any(|one| ending.eq_ignore_ascii_case(one));
    path.extension().is_none_or(is_one)
}

/// What to do instead, if a file's name promises a format that is not OBJ.
fn foreign(path: &Path) -> Option<&'static str> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    let of = |(endings, _): &&(&[&str], _)| endings.contains(&&*ending);
    FOREIGN.iter().find(of).map(|&(_, help)| help)
}

const FOREIGN: [(&[&str], &str); 5] = [
    (
        &["png"],
        "name it x.obj, and draw a picture with --picture F.png",
    ),
    (
        &["htm", "html"],
        "name it x.obj, and show it on a page with --view F.html",
    ),
    (
        &["pc2"],
        "name it x.obj, and write the cache of `tear` with --cache F.pc2",
    ),
    (
        &["json"],
        "name it x.obj, and write the report with --report F.json",
    ),
    (
        &[
            "3ds", "3mf", "abc", "blend", "bmp", "dae", "dxf", "fbx", "glb", "gltf", "jpeg", "jpg",
            "mdd", "mtl", "off", "ply", "step", "stl", "stp", "svg", "usd", "usda", "usdc", "usdz",
            "vtk", "vtp", "vtu", "wrl", "x3d",
        ],
        "name it x.obj, and convert that, as with `assimp export x.obj x.ply`",
    ),
];

/// What to say before anything is done, if a run writes no mesh and was not told so: it may take long.
pub(crate) fn unwritten(args: &FileArgs, output_is_terminal: bool) -> Option<Fault> {
    let is_meant = args.dry_run || args.format == Format::Json || args.output.is_some();
    (output_is_terminal && !is_meant).then(|| {
        let message = "the mesh will not be written, because no -o OUT was given".to_owned();
        Fault::warning("W-OUTPUT-NONE", message)
            .help("add -o OUT, or --dry-run if that is intended")
    })
}

/// The files that show the mesh, by their options, as far as they are wanted.
fn seen(args: &FileArgs) -> impl Iterator<Item = (&'static str, &PathBuf)> {
    let files = [("--picture", &args.picture), ("--view", &args.view)];
    files
        .into_iter()
        .filter_map(|(option, path)| Some((option, path.as_ref()?)))
}

/// Refuses to write over a file that is read beside the mesh: `what`.
pub(crate) fn keep(args: &FileArgs, path: Option<&Path>, what: &str) -> Result<(), Stop> {
    let is_it = |written: &&PathBuf| path.is_some_and(|path| is_same(path, written));
    let written = [&args.output, &args.report].into_iter().flatten();
    let mut written = written.chain(seen(args).map(|(_, path)| path));
    match written.find(is_it) {
        Some(written) => Err(replaced(written, what)),
        None => Ok(()),
    }
}

/// Refuses a page or a picture, or standard output, that would replace an input or cannot be written.
pub(crate) fn check_shown(path: &Path, inputs: &[PathBuf], what: &str) -> Result<(), Stop> {
    if inputs.iter().any(|input| is_same(input, path)) {
        return Err(replaced(path, what));
    }
    match path == Path::new("-") {
        true => Ok(()),
        false => Ok(output::check(path)?),
    }
}

/// That a file would be written over that is `what`.
fn replaced(path: &Path, what: &str) -> Stop {
    let message = format!("`{}` is {what}, and would be replaced", path.display());
    Stop::usage(message, "write to another file")
}

/// Whether two names are of one file, which need not exist yet.
pub(crate) fn is_same(a: &Path, b: &Path) -> bool {
    a != Path::new("-") && b != Path::new("-") && (a == b || output::is_same_place(a, b))
}

/// Refuses files, each with what it is, that the numbered ones of a folder would replace: those whose names
/// are like this. None need exist yet.
pub(crate) fn keep_from(
    folder: &Path,
    (one, many): (&str, &str),
    is_name: impl Fn(&str) -> bool,
    files: &[(Option<&Path>, &str)],
) -> Result<(), Stop> {
    for &(path, what) in files {
        let Some(path) = path else { continue };
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let parent = path.parent().filter(|parent| *parent != Path::new(""));
        if is_name(&name) && output::is_same_file(folder, parent.unwrap_or(Path::new("."))) {
            let message = format!("{one} would replace {what}, `{}`", path.display());
            let help = format!("write {many} into a folder of their own");
            return Err(Stop::usage(message, help));
        }
    }
    Ok(())
}

/// The last line of the summary.
pub(crate) fn ending(
    vertices_before: usize,
    mesh: &Mesh,
    mass: report::Mass,
    destination: &Destination,
) -> String {
    let ending = match destination {
        Destination::Nowhere { why } => (*why).to_owned(),
        Destination::Output => "wrote standard output".to_owned(),
        Destination::File(path) => format!("wrote {}", path.display()),
    };
    format!(
        "{} · vertices {vertices_before} -> {} · faces {} · invariants hold · {ending}",
        summed(mass),
        mesh.vertex_count(),
        mesh.face_count(),
    )
}

/// What there was before and after, by the word for what it is.
fn summed(mass: report::Mass) -> String {
    let [before, after] = [mass.before, mass.after].map(short);
    match mass.unit {
        report::MassUnit::Area => format!("area {before} -> {after}"),
        report::MassUnit::Kilogram => format!("mass {before} -> {after} kg"),
    }
}
