//! `chart`: each experiment is run, drawn and tabled, and its table is drawn again.

use crate::harness::{Folder, root};

/// A small chart: its name, the options that decide the numbers, how many runs it announces, the numbers of
/// threads that leave the same bytes; and between bars how some rows begin, and what the chart and the summary have.
struct Chart([&'static str; 2], usize, &'static [u32], [&'static str; 3]);

/// The fields of each line of a table.
fn fields(table: &str) -> Vec<Vec<String>> {
    let of = |line: &str| {
        let mut fields = vec![String::new()];
        let mut is_quoted = false;
        for c in line.chars() {
            match c {
                '"' => is_quoted = !is_quoted,
                ',' if !is_quoted => fields.push(String::new()),
                _ => fields.last_mut().expect("a field").push(c),
            }
        }
        assert!(!is_quoted, "{line}");
        fields
    };
    table.lines().map(of).collect()
}

/// The fields of a column, by its name.
fn column<'a>(table: &'a [Vec<String>], name: &str) -> Vec<&'a str> {
    let at = table[0].iter().position(|field| field == name);
    let at = at.unwrap_or_else(|| panic!("no {name} in {:?}", table[0]));
    table[1..].iter().map(|row| row[at].as_str()).collect()
}

/// A chart without the words on its origin, which come last. Their length differs with the command, the commit and
/// the processor, and so do their number of lines and the height in the first line.
fn without_origin<'a>(chart: &'a str, command: &str) -> Vec<&'a str> {
    let is_origin = |line: &&str| line.contains(&format!(">{command} · version "));
    let lines: Vec<&str> = chart.lines().collect();
    let origin = lines.iter().position(is_origin);
    lines[1..origin.expect("words on its origin")].to_vec()
}

impl Chart {
    /// Makes a chart in all ways, holds them against each other, and returns its table and what was printed.
    fn hold(&self, folder: &Folder) -> (Vec<Vec<String>>, String) {
        let Chart([name, options], runs, threads, [rows, words @ ..]) = *self;
        let command = format!("tearmesh chart {name} {options}");
        let first = threads[0];
        let line = format!("{command} --threads {first} -o a.svg --csv a.csv --json a.json");
        let answer = folder.run(&line);
        let (said, begin) = (answer.seen(), answer.error);
        assert_eq!(answer.exit, 0, "{said}");
        let begun = format!("{runs} runs, about ");
        let end = " (Ctrl-C stops and keeps finished runs)\n";
        assert!(begin.starts_with(&begun) && begin.ends_with(end), "{begin}");
        assert_eq!(begin.lines().count(), 1, "{begin}");
        assert!(said.ends_with("\nwrote a.svg, a.csv, a.json\n"), "{said}");

        let [chart, text] = ["a.svg", "a.csv"].map(|name| folder.read(name));
        assert!(chart.starts_with("<svg ") && chart.contains(&command));
        assert!(!chart.contains("NaN"), "{chart}");
        for (all, words) in [&chart, &said].into_iter().zip(words) {
            for word in words.split('|') {
                assert!(all.contains(word), "no {word}\n{all}");
            }
        }
        for row in rows.split('|') {
            let is_there = text.lines().any(|line| line.starts_with(row));
            assert!(is_there, "no {row}\n{text}");
        }
        let table = fields(&text);
        assert!(table.iter().all(|row| row.len() == table[0].len()));
        assert!(!column(&table, "status").contains(&"interrupted"));
        let json = folder.json("a.json");
        assert_eq!(json["provenance"]["command"], command);
        let count = json["rows"].as_array().map(Vec::len);
        assert_eq!(count, Some(table.len() - 1));

        // From its table it is drawn and told in the same way, and nothing is run.
        let line = format!("tearmesh chart {name} --from a.csv -o b.svg --csv b.csv");
        let told = said.strip_prefix(&*begin).expect("a summary");
        let told = told.replace("wrote a.svg, a.csv, a.json", "wrote b.svg, b.csv");
        assert_eq!(folder.done(&line), told);
        let drawn = folder.read("b.svg");
        assert!(drawn.contains("drawn from a.csv"));
        assert!(without_origin(&drawn, "drawn from a.csv") == without_origin(&chart, &command));
        assert_eq!(folder.read("b.csv"), text);

        for threads in &threads[1..] {
            let line = format!("{command} --threads {threads} -q -o - --csv c.csv");
            let again = folder.run(&line);
            assert_eq!(again.error, "");
            assert!(folder.read("c.csv") == text, "{threads} threads differ");
            assert!(again.text() == chart, "{threads} threads differ");
        }
        (table, said)
    }
}

#[test]
fn guide() {
    let chart = Chart(
        ["guide", "--size 8 --seeds 2 --diagonals 2"],
        233,
        &[2],
        [
            "hang,8,|flag,8,|rip,8,|trouser,8,|aftermath,8,",
            "hang|trouser",
            "Which method for my scene?|It fails when: ",
        ],
    );
    chart.hold(&Folder::new());
}

#[test]
fn pareto() {
    let chart = Chart(
        [
            "pareto",
            "--scene swing --mesh grid --size 3 --visits-max 100000",
        ],
        163,
        &[1, 2],
        [
            "swing,grid,3,1000.0,1.0,verlet@default,verlet,|swing,grid,3,1000.0,1.0,rk4@2,|swing,grid,3,1000.0,1.0,gate,",
            "default|--scene swing",
            "swing S2: |the cheapest run for each tolerance",
        ],
    );
    chart.hold(&Folder::new());
}

#[test]
fn stability_tells_every_failure_by_its_code() {
    let chart = Chart(
        ["stability", "--stiffness 1000"],
        18,
        &[2, 1],
        [
            "halved,1000.0,RK4,0.998,|sheet,1000.0,PBD,1000.0,|wind,,provot,",
            "W-SIM-ENERGY",
            "No method failed silently: 0 of 333 steps and scenes differ from what is expected",
        ],
    );
    let (table, said) = chart.hold(&Folder::new());
    assert!(!said.contains(", expected "), "{said}");
    assert!(!column(&table, "is_silent").contains(&"true"));
    assert!(!column(&table, "agrees").contains(&"false"));
    let [places, methods, codes] = ["where", "method", "codes"].map(|name| column(&table, name));
    let codes = |scene: &str, method: &str| {
        let is = |i: &usize| places[*i] == scene && methods[*i] == method;
        let row = (0..places.len()).find(is).expect("a row");
        let codes = codes[row].split(" | ").filter(|code| !code.is_empty());
        codes.collect::<Vec<_>>()
    };
    for (scene, method, code) in [
        ("hang", "xpbd", "W-SIM-SOFT"),
        ("hang", "pbd", "W-SIM-RIGID"),
        ("long steps", "pbd", "W-SIM-COARSE"),
        ("long steps", "verlet", "E-SIM-UNSTABLE"),
        ("short steps", "pbd", "W-SIM-RIGID"),
        ("ringing", "implicit", "W-SIM-DAMPED"),
        ("crushed", "provot", "W-SIM-ENERGY"),
        ("wind", "implicit", "E-SIM-UNSTABLE"),
        ("too far apart", "provot", "W-SIM-LIMIT"),
    ] {
        let codes = codes(scene, method);
        assert!(codes.contains(&code), "{scene}, {method}: {codes:?}");
    }
    assert_eq!(codes("short steps", "verlet"), Vec::<&str>::new());
    let [outcomes, codes] = ["measured", "codes"].map(|name| column(&table, name));
    let (mut dissipated, mut all) = (0, 0);
    for (outcome, codes) in outcomes.into_iter().zip(codes) {
        let is_damped = codes.contains("W-SIM-DAMPED");
        let is_dissipated = outcome == "dissipated";
        assert!(!is_dissipated || is_damped, "{codes}");
        assert!(!is_damped || outcome != "ok", "{codes}");
        dissipated += usize::from(is_dissipated);
        all += usize::from(is_damped);
    }
    assert!(dissipated > 5 && all > dissipated, "{dissipated} of {all}");
    let damped = "crushed, implicit: dissipated; W-SIM-DAMPED";
    assert!(said.contains(damped), "{said}");
}

#[test]
fn tear() {
    let chart = Chart(
        [
            "tear",
            "--strips 4,6 --scene rip --method implicit,pbd --seeds 2 --size 6",
        ],
        16,
        &[2, 1],
        [
            "trouser,4,ok,stretch,1.5,verlet,1,|trouser,6,ok,toughness,|rip,6,ok,,,pbd,4,",
            "--seeds 2",
            "rip of 6 cells, torn length, m; |half the step: ",
        ],
    );
    let (table, _) = chart.hold(&Folder::new());
    let runs = column(&table, "rule").into_iter();
    let runs = runs.filter(|rule| rule.is_empty());
    assert_eq!(runs.count(), 12);
}

#[test]
fn tear_without_seeds_has_strips_alone() {
    let folder = Folder::new();
    let line = "chart tear --strips 4,6 --seeds 0 -q --json t.json";
    assert_eq!(folder.done(line), "");
    let json = folder.json("t.json");
    let rows = json["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 4);
    assert!(rows.iter().all(|row| row["rule"].is_string()));
}

#[test]
fn cut() {
    let chart = Chart(
        ["cut", "--size 8,12 --cuts 3"],
        20,
        &[1],
        [
            "uniform,128,ok,3,|exact .05 moved,288,ok,3,",
            "exact .05 moved|Stable step of springs",
            "uniform              128 |exact .2 moved       288 ",
        ],
    );
    let (table, _) = chart.hold(&Folder::new());
    let cuts = column(&table, "cuts").into_iter();
    assert_eq!(cuts.filter(|cuts| *cuts == "3").count(), 20);
    let mut times = column(&table, "ns_per_face").into_iter();
    assert!(times.all(|time| time.parse::<f64>().is_ok_and(|ns| ns > 0.0)));
}

#[test]
fn fig7() {
    let chart = Chart(
        ["fig7", "--size 4,8"],
        2,
        &[1],
        [
            "4,32,|8,128,",
            "ghost pairs",
            "8 × 8 cells, half-edge with ghost pairs: ",
        ],
    );
    let (table, _) = chart.hold(&Folder::new());
    assert_eq!(table.len(), 1 + 2 * 3 * 10);
    assert!(!column(&table, "splits").contains(&"0"));
}

#[test]
fn files_that_are_no_table_are_refused_before_runs() {
    let folder = Folder::new();
    folder.done("chart fig7 --size 4 -q --csv fig7.csv");
    let table = folder.read("fig7.csv");
    folder.write("short.csv", &table[..table.len() - 9]);
    folder.write("words.csv", table.replace(",ok\n", ",fine\n"));
    for name in ["short", "words"] {
        let said = folder.ends(&format!("chart fig7 --from {name}.csv -o x.svg"), 3);
        assert!(said.contains("E-CHART-TABLE"), "{said}");
        assert!(!said.contains(" runs, about "), "{said}");
    }
    assert!(!folder.path("x.svg").exists());
}

/// All of it would take hours.
#[cfg(unix)]
#[test]
fn an_interrupted_chart_ends_at_once_with_what_was_done() {
    use std::io::{BufRead as _, BufReader, Read as _};
    use std::process::Stdio;
    use std::time::{Duration, Instant};

    let folder = Folder::new();
    let line =
        "chart pareto --scene undamped --size 3,32 --visits-max 100000000000 -o p.svg --csv p.csv";
    let mut command = folder.command(line);
    let piped = command.stderr(Stdio::piped()).stdout(Stdio::null());
    let mut child = piped.spawn().expect("a run");
    let mut words = BufReader::new(child.stderr.take().expect("words"));
    let mut said = String::new();
    words.read_line(&mut said).expect("how long it will take");
    // The small mesh is done by then, and nothing of the other.
    std::thread::sleep(Duration::from_secs(4));
    let begun = Instant::now();
    crate::harness::signal("-INT", child.id());
    let status = child.wait().expect("an end");
    assert!(begun.elapsed() < Duration::from_secs(30));
    words.read_to_string(&mut said).expect("the rest");
    assert_eq!(status.code(), Some(130), "{said}");
    assert!(said.contains("W-CHART-INTERRUPTED"), "{said}");
    let table = fields(&folder.read("p.csv"));
    let of = |status: &str| {
        let all = column(&table, "status").into_iter();
        all.filter(|is| *is == status).count()
    };
    assert!(of("interrupted") > 100 && of("ok") > 0, "{said}");
    assert!(folder.read("p.svg").contains("INTERRUPTED"));
}

/// The errors in the README's table of methods, against the marks of the recorded chart: within rounding.
#[test]
fn the_readme_has_the_errors_of_the_recorded_chart() {
    let read = |name: &str| std::fs::read_to_string(root().join(name)).expect("a file");
    let readme = read("README.md");
    let [chart, summary] = ["svg", "txt"].map(|end| read(&format!("tools/lab/record/guide.{end}")));
    let number = |text: &str, before: &str, after: &str| -> f64 {
        let (_, rest) = text.split_once(before).expect("a mark");
        let (number, _) = rest.split_once(after).expect("its end");
        number.parse().expect("a number")
    };
    let recorded = |scene: &str, row: &str| -> f64 {
        let solver = match row.split('`').nth(1) {
            None => {
                let (_, of_scene) = summary
                    .split_once(&format!("\n{scene}: "))
                    .expect("a scene");
                return number(of_scene, "other diagonals of the mesh: ", " %");
            }
            Some("verlet") => String::new(),
            Some(other) => format!(" --solver {other}"),
        };
        let mark = format!(">tearmesh tear in.obj --scene {scene}{solver} -o out.obj: error, % ");
        number(&chart, &mark, "<")
    };
    let rows = readme
        .lines()
        .skip_while(|line| !line.starts_with("| `--solver`"));
    let rows = rows.skip(2).take_while(|line| line.starts_with('|'));
    let mut count = 0;
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        for (scene, cell) in ["rip", "trouser", "hang"].into_iter().zip(&cells[2..]) {
            let said = cell.trim_end_matches(" %");
            let decimals = said
                .split_once('.')
                .map_or(0, |(_, decimals)| decimals.len());
            let unit = 10_f64.powi(-(decimals as i32));
            let known = recorded(scene, cells[1]);
            let off = said.parse::<f64>().expect("a number") - known;
            assert!(
                off.abs() < 0.51 * unit,
                "{row} in {scene}: {said} for {known}"
            );
        }
        count += 1;
    }
    assert_eq!(count, 6);
}
