//! The paths that a verb reads and writes, and the files that it refuses to replace.

use std::path::{Path, PathBuf};

use crate::args::{FileArgs, Format};
use crate::exit::Stop;
use crate::output;
use crate::say::Fault;

/// The file that the mesh goes to, `-` being standard output; or why it goes nowhere.
pub(crate) fn destination(
    args: &FileArgs,
    output_is_terminal: bool,
) -> Result<PathBuf, &'static str> {
    match &args.output {
        _ if args.dry_run => Err("dry run, no mesh written"),
        Some(path) => Ok(path.clone()),
        None if args.format == Format::Json => Err("nothing written"),
        None if output_is_terminal => Err("nothing written: name a file with -o OUT"),
        None => Ok(PathBuf::from("-")),
    }
}

/// Refuses streams that are wanted twice, and names that promise another format.
pub(crate) fn check(args: &FileArgs) -> Result<(), Stop> {
    let is_stream = |path: &PathBuf| path == Path::new("-");
    if args.in_place && is_stream(&args.input) {
        let help = "name the file to read, or leave out --in-place";
        return Err(Stop::usage("standard input cannot be replaced", help));
    }
    args.output.as_deref().map_or(Ok(()), check_mesh)?;
    args.picture.as_deref().map_or(Ok(()), check_picture)?;
    args.view.as_deref().map_or(Ok(()), check_page)?;
    if args.format == Format::Json && args.output.as_ref().is_some_and(is_stream) {
        let message = "`-o -` and `--format json` both use standard output";
        let help = "write the mesh to a file, or the report with --report FILE";
        return Err(Stop::usage(message, help));
    }
    Ok(())
}

/// The files that a verb reads and writes, by what each is, and the options of those that are written.
pub(crate) struct Names<'a> {
    read: Vec<(&'a Path, &'static str)>,
    written: Vec<(&'static str, &'a Path, &'static str)>,
    in_place: bool,
}

impl<'a> Names<'a> {
    /// Those of all verbs that change a mesh, and those of one of them.
    pub(crate) fn new(
        args: &'a FileArgs,
        read: &[(Option<&'a Path>, &'static str)],
        written: &[(&'static str, &'a Option<PathBuf>, &'static str)],
    ) -> Names<'a> {
        let read = read.iter().filter_map(|&(path, what)| Some((path?, what)));
        let of_all = [
            ("-o", &args.output, "the output"),
            ("--report", &args.report, "the report"),
            ("--picture", &args.picture, "the picture"),
            ("--view", &args.view, "the page"),
        ];
        let written = written.iter().chain(&of_all);
        let written =
            written.filter_map(|&(option, path, what)| Some((option, path.as_deref()?, what)));
        let input = [(&*args.input, "the input")].into_iter();
        Names {
            read: input.chain(read).collect(),
            written: written.collect(),
            in_place: args.in_place,
        }
    }

    /// Refuses files that would replace what is read or what else is written, and those beside the mesh
    /// that cannot be written.
    pub(crate) fn check(&self) -> Result<(), Stop> {
        let read: Vec<&Path> = self.read.iter().map(|(path, _)| *path).collect();
        one_stream(&read)?;
        let mut taken = self.read.clone();
        for &(option, path, what) in &self.written {
            let is_output = option == "-o";
            if path == Path::new("-") && !is_output {
                let message = format!("`{option}` takes the name of a file");
                return Err(Stop::usage(message, format!("write {what} to a file")));
            }
            let may_replace = |what| is_output && self.in_place && what == "the input";
            let is_lost = |(other, what): &&(&Path, _)| is_same(other, path) && !may_replace(*what);
            if let Some((_, lost)) = taken.iter().find(is_lost) {
                let can_be_meant = is_output && *lost == "the input";
                let or = can_be_meant.then_some(", or add --in-place");
                return Err(replaced(path, lost, or.unwrap_or_default()));
            }
            // The other two may be in a folder that is made for frames.
            if !matches!(option, "-o" | "--report") {
                output::check(path)?;
            }
            taken.push((path, what));
        }
        Ok(())
    }

    /// Refuses files that the numbered ones of a folder would replace: those whose names are like this.
    pub(crate) fn keep_from(
        &self,
        folder: &Path,
        (one, many): (&str, &str),
        is_name: impl Fn(&str) -> bool,
    ) -> Result<(), Stop> {
        let written = self.written.iter().map(|&(_, path, what)| (path, what));
        for (path, what) in self.read.iter().copied().chain(written) {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let own = output::folder(path);
            if is_name(&name) && (own == folder || output::is_same_file(folder, own)) {
                let message = format!("{one} would replace {what}, `{}`", path.display());
                let help = format!("write {many} into a folder of their own");
                return Err(Stop::usage(message, help));
            }
        }
        Ok(())
    }
}

/// Refuses more than one input from standard input.
pub(crate) fn one_stream<P: AsRef<Path>>(inputs: &[P]) -> Result<(), Stop> {
    let is_stream = |path: &&P| path.as_ref() == Path::new("-");
    if inputs.iter().filter(is_stream).count() > 1 {
        let message = "two inputs both come from standard input";
        return Err(Stop::usage(message, "name a file for one of them"));
    }
    Ok(())
}

/// Refuses a file that is named like one of another format than the only one that is written.
pub(crate) fn check_format(path: &Path, format: &str, endings: &[&str]) -> Result<(), Stop> {
    let is_of = |ending: String| endings.contains(&&*ending);
    match ending(path).is_none_or(is_of) {
        true => Ok(()),
        false => Err(only(format, path, &format!("name it x.{}", endings[0]))),
    }
}

/// That a file is named like one of another format.
fn only(format: &str, path: &Path, help: &str) -> Stop {
    let name = path.display();
    let message = format!("cannot write `{name}`: only {format} output is supported");
    Stop::usage(message, help)
}

/// Refuses a picture that is named like a file of another format.
pub(crate) fn check_picture(path: &Path) -> Result<(), Stop> {
    check_format(path, "PNG", &["png"])
}

/// Refuses a page that is named like a file of another format.
pub(crate) fn check_page(path: &Path) -> Result<(), Stop> {
    check_format(path, "HTML", &["html", "htm"])
}

/// Refuses a mesh that is named like a file of a format other than OBJ.
pub(crate) fn check_mesh(path: &Path) -> Result<(), Stop> {
    let ending = ending(path).unwrap_or_default();
    let is_of = |(endings, _): &&(&str, _)| endings.split(' ').any(|one| one == ending);
    match FOREIGN.iter().find(is_of) {
        Some((_, help)) => {
            let help = format!("name it x.obj, and {help}").replace("x.*", &format!("x.{ending}"));
            Err(only("OBJ", path, &help))
        }
        None => Ok(()),
    }
}

/// The ending of a name in small letters. Those of streams and devices have none.
fn ending(path: &Path) -> Option<String> {
    Some(path.extension()?.to_string_lossy().to_ascii_lowercase())
}

/// Endings of names, and what to do instead.
const FOREIGN: [(&str, &str); 5] = [
    ("png", "draw a picture with --picture F.png"),
    ("htm html", "show it on a page with --view F.html"),
    ("pc2", "write the cache of `tear` with --cache F.pc2"),
    ("json", "write the report with --report F.json"),
    (
        "3ds 3mf abc blend bmp dae dxf fbx glb gltf jpeg jpg mdd mtl off ply step stl stp svg usd usda usdc \
         usdz vtk vtp vtu wrl x3d",
        "convert that, as with `assimp export x.obj x.*`",
    ),
];

/// What to say before anything is done, if a run writes no mesh and was not told so: it may take long.
pub(crate) fn unwritten(args: &FileArgs, output_is_terminal: bool) -> Option<Fault> {
    let is_meant = args.dry_run || args.format == Format::Json || args.output.is_some();
    let message = "the mesh will not be written, because no -o OUT was given";
    let fault = Fault::warning("W-OUTPUT-NONE", message);
    let fault = fault.help("add -o OUT, or --dry-run if that is intended");
    (output_is_terminal && !is_meant).then_some(fault)
}

/// Refuses a page or a picture, or standard output, that would replace an input or cannot be written.
pub(crate) fn check_shown(path: &Path, inputs: &[PathBuf], what: &str) -> Result<(), Stop> {
    if inputs.iter().any(|input| is_same(input, path)) {
        return Err(replaced(path, what, ""));
    }
    if path != Path::new("-") {
        output::check(path)?;
    }
    Ok(())
}

/// That a file would be written over that is `what`.
fn replaced(path: &Path, what: &str, or: &str) -> Stop {
    let message = format!("`{}` is {what}, and would be replaced", path.display());
    Stop::usage(message, format!("write to another file{or}"))
}

/// Whether two names are of one file, which need not exist yet.
pub(crate) fn is_same(a: &Path, b: &Path) -> bool {
    a != Path::new("-") && b != Path::new("-") && (a == b || output::is_same_place(a, b))
}
