//! Measurements of tearmesh beside other programs, each in one run on one machine.
//!
//! ```console
//! $ cargo run --release --manifest-path tools/bench/Cargo.toml -- read
//! $ cargo run --release --manifest-path tools/bench/Cargo.toml -- write --rounds 9 --record
//! $ taskset -c 1 cargo run --release --manifest-path tools/bench/Cargo.toml -- cut --python PATH
//! $ taskset -c 1 cargo run --release --manifest-path tools/bench/Cargo.toml -- cloth --record
//! ```
//!
//! | subcommand | measures |
//! |---|---|
//! | `read` | OBJ bytes in memory to a document in memory, beside five crates and a plain loop |
//! | `write` | a document to OBJ bytes in memory, beside `{}` and shortest digits |
//! | `build` | faces to a mesh, and walks round all vertices, beside lox and CGAL |
//! | `cloth` | a step of a hanging sheet, beside Bullet; what size and splits cost |
//! | `cut` | a plane through a sheet, both sides kept, beside three Python packages |
//! | `growth` | each stage of a cut as sheets and fans grow tenfold, to `--faces` and to a million |
//!
//! | option | meaning |
//! |---|---|
//! | `--faces N` | about how many faces each file or sheet has (1,000,000) |
//! | `--rounds N` | how often everything is measured (7); the table has medians |
//! | `--only WORD` | only contestants and files whose name holds the word, for a profiler |
//! | `--python PATH` | for `cut`: the Python that has the rivals (`python3`) |
//! | `--fast-obj DIR` | for `read`: the folder with `fast_obj.h` |
//! | `--record` | also writes the table to `record/<CPU>/<subcommand>.txt` |
//!
//! Everything runs on one thread, and what is counted is CPU time. In each round every contestant runs
//! once, so a slow spell of the machine falls on all of them: trust the ratios, not the MB/s. They
//! share one allocator, too, and what one leaves behind, the next starts from; so ratios differ by
//! some tenths with other company (`--only`). A record names the commit, the compiler and the CPU.
//!
//! `cut` has rivals in Python: `python3 -m venv DIR`, `DIR/bin/pip install numpy meshlib trimesh
//! networkx scipy shapely vtk`, and `--python DIR/bin/python`. One that is missing is said to be. Each is
//! a process of its own (`rivals/cut.py`) that gets the sheet as a file, once, and cuts once a
//! round; what it measures is the cutting call alone. `cut` counts CPU time, all threads of a
//! process together, and confines the rivals to one core; `taskset` gives ours the same one. Its
//! other tables (snap against quality, methods) are of ours alone, on a smaller sheet.
//!
//! `read` has `fast_obj` as a rival, too, if `--fast-obj` says where it is (a clone of
//! `github.com/thisistherk/fast_obj`). It and ours are processes of their own, which get a file and read it
//! from memory: a new process each round, for the first time (`fresh`) and then ten times (`in a loop`).
//!
//! `build` has lox and CGAL as rivals: `apt-get install libcgal-dev g++`. Where a program of fifty lines
//! (`rivals/cgal.cpp`) cannot be compiled, the table says so.
//!
//! `cloth` has Bullet as its rival: `apt-get install libbullet-dev pkg-config g++`. A program of a
//! hundred lines (`rivals/bullet.cpp`) is compiled against it, gets the same net, and steps it;
//! where it cannot be compiled, the table says so. A projection is timed by the
//! difference of a run with eleven times the iterations; `of bullet` is the part of the time of
//! Bullet with its links in the order of the mesh. `longest` is the largest length of an edge in
//! the end, as a multiple of its rest length. `--faces` does not concern it.

mod build;
mod cloth;
mod cut;
mod growth;
mod measure;
mod options;
mod process;
mod read;
mod record;
mod rivals;
mod sheet;
mod table;
mod write;

use std::process::ExitCode;

use crate::options::Options;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let subcommand = arguments.next().unwrap_or_default();
    if subcommand == read::fast_obj::OURS {
        read::fast_obj::answer(&arguments.next().unwrap_or_default());
        return ExitCode::SUCCESS;
    }
    let run: fn(&Options) -> String = match &*subcommand {
        "build" => build::run,
        "cloth" => cloth::run,
        "cut" => cut::run,
        "growth" => growth::run,
        "read" => read::run,
        "write" => write::run,
        _ => {
            eprintln!(
                "expected a subcommand: build, cloth, cut, growth, read or write (see the top of main.rs)"
            );
            return ExitCode::FAILURE;
        }
    };
    let options = match Options::parse(arguments) {
        Ok(options) => options,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::FAILURE;
        }
    };
    let report = format!("{}\n{}", record::heading(&subcommand), run(&options));
    print!("{report}");
    if options.record
        && let Err(error) = record::keep(&subcommand, &report)
    {
        eprintln!("cannot record: {error}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
