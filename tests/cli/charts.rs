//! `chart`: each experiment is run, drawn and tabled, and its table is drawn again.

use crate::harness::{Folder, root};

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

/// Makes a small chart in all ways, holds them against each other, and returns its table and what was printed.
///
/// A paragraph of `charts.txt` has its name and the options that decide the numbers, how many runs it announces, the
/// numbers of threads that leave the same bytes; and between bars how some rows begin, and what the chart and the
/// summary have.
fn hold(name: &str) -> (Vec<Vec<String>>, String) {
    let folder = Folder::new();
    let charts = include_str!("charts.txt").split("\n\n");
    let mut charts = charts.map(|text| text.lines().collect::<Vec<_>>());
    let chart = charts.find(|lines| lines[0].split(' ').next() == Some(name));
    let chart = chart.expect("a chart of this name");
    let [line, runs, threads, rows, ref words @ ..] = chart[..] else {
        panic!("six lines")
    };
    let command = format!("tearmesh chart {line}");
    let mut threads = threads.split(' ');
    let first = threads.next().expect("a number");
    let line = format!("{command} --threads {first} -o a.svg --csv a.csv");
    let answer = folder.run(&line);
    let (said, begin) = (answer.seen(), answer.error);
    assert_eq!(answer.exit, 0, "{said}");
    let begun = format!("{runs} runs, about ");
    let end = " (Ctrl-C stops and keeps finished runs)\n";
    assert!(begin.starts_with(&begun) && begin.ends_with(end), "{begin}");
    assert_eq!(begin.lines().count(), 1, "{begin}");
    assert!(said.ends_with("\nwrote a.svg, a.csv\n"), "{said}");

    let [chart, text] = ["a.svg", "a.csv"].map(|name| folder.read(name));
    assert!(chart.starts_with("<svg ") && chart.contains(&command));
    assert!(!chart.contains("NaN"), "{chart}");
    for (all, words) in [&chart, &said].into_iter().zip(words) {
        for word in words.split('|').map(|word| word.replace("\\n", "\n")) {
            assert!(all.contains(&word), "no {word}\n{all}");
        }
    }
    for row in rows.split('|') {
        let is_there = text.lines().any(|line| line.starts_with(row));
        assert!(is_there, "no {row}\n{text}");
    }
    let table = fields(&text);
    assert!(table.iter().all(|row| row.len() == table[0].len()));
    assert!(!column(&table, "status").contains(&"interrupted"));

    // From its table it is drawn and told in the same way, and nothing is run.
    let line = format!("tearmesh chart {name} --from a.csv -o b.svg --csv b.csv");
    let told = said.strip_prefix(&*begin).expect("a summary");
    let told = told.replace("wrote a.svg, a.csv", "wrote b.svg, b.csv");
    assert_eq!(folder.done(&line), told);
    let drawn = folder.read("b.svg");
    assert!(drawn.contains("drawn from a.csv"));
    assert!(without_origin(&drawn, "drawn from a.csv") == without_origin(&chart, &command));
    assert_eq!(folder.read("b.csv"), text);

    for threads in threads {
        let line = format!("{command} --threads {threads} -q -o - --csv c.csv");
        let again = folder.run(&line);
        assert_eq!(again.error, "");
        assert!(folder.read("c.csv") == text, "{threads} threads differ");
        assert!(again.text() == chart, "{threads} threads differ");
    }
    (table, said)
}

/// At rest there is one shape, whatever finds it, but for methods whose sweeps are soft; and what the
/// references do not know recommends nothing.
#[test]
fn guide_has_errors_of_methods_that_references_know() {
    let (table, said) = hold("guide");
    let at = |name| table[0].iter().position(|field| field == name).expect(name);
    let columns = ["topic", "cells", "role", "step_multiple", "method"].map(at);
    let error = |method: &str| -> f64 {
        let is_it =
            |row: &&Vec<String>| columns.map(|at| &*row[at]) == ["hang", "8", "method", "", method];
        let row = table.iter().find(is_it).expect("a run at the default step");
        row[at("error")].parse().expect("it is known")
    };
    for (method, range) in [
        ("verlet", 0.0..1e-3),
        ("implicit", 0.0..1e-3),
        ("provot", 0.0..1e-3),
        ("xpbd", 0.1..f64::INFINITY),
    ] {
        assert!(
            range.contains(&error(method)),
            "{method}: {}",
            error(method)
        );
    }
    let floor = at("error_floor");
    let apart = table.iter().cloned().map(|mut row| {
        if row[0] == "hang" && !row[floor].is_empty() {
            row[floor] = "0.1".to_owned();
        }
        format!("\"{}\"\n", row.join("\",\""))
    });
    let folder = Folder::new();
    folder.write("apart.csv", apart.collect::<String>());
    let told = folder.done("chart guide --from apart.csv -o apart.svg");
    let unknown = |told: &str| told.matches("not known, as the references").count();
    assert_eq!(unknown(&told), unknown(&said) + 1);
}

#[test]
fn pareto() {
    hold("pareto");
}

/// What every failure is told by: the whole summary.
#[test]
fn stability() {
    hold("stability");
}

#[test]
fn tear() {
    let (table, _) = hold("tear");
    let [rules, cells, forces] =
        ["rule", "cells", "largest_force_n"].map(|name| column(&table, name));
    assert_eq!(rules.iter().filter(|rule| rule.is_empty()).count(), 12);
    // The force at which a strip tears grows with its edges, less so by toughness.
    let force = |rule: &str, count: &str| -> f64 {
        let is_it = |&i: &usize| rules[i] == rule && cells[i] == count;
        let row = (0..rules.len()).find(is_it).expect("a strip");
        forces[row].parse().expect("it tears")
    };
    let grown = ["stretch", "toughness"].map(|rule| force(rule, "4") / force(rule, "6"));
    assert!(grown[0] > 1.1 && grown[1] < grown[0], "{grown:?}");
}

#[test]
fn cut() {
    let (table, _) = hold("cut");
    let cuts = column(&table, "cuts").into_iter();
    assert_eq!(cuts.filter(|cuts| *cuts == "3").count(), 20);
    let mut times = column(&table, "ns_per_face").into_iter();
    assert!(times.all(|time| time.parse::<f64>().is_ok_and(|ns| ns > 0.0)));
}

#[test]
fn fig7() {
    let (table, _) = hold("fig7");
    assert_eq!(table.len(), 1 + 2 * 3 * 10);
    assert!(!column(&table, "splits").contains(&"0"));
}

/// All of it would take hours.
#[cfg(unix)]
#[test]
fn an_interrupted_chart_ends_at_once_with_what_was_done() {
    use std::io::{BufRead as _, BufReader, Read as _};
    use std::process::Stdio;
    use std::time::{Duration, Instant};

    let folder = Folder::new();
    let line = "chart pareto --scene undamped --size 2,32 --threads 1 --visits-max 100000000000 \
                -o p.svg --csv p.csv";
    let mut command = folder.command(line);
    let piped = command.stderr(Stdio::piped()).stdout(Stdio::null());
    let mut child = piped.spawn().expect("a run");
    let mut words = BufReader::new(child.stderr.take().expect("words"));
    let mut said = String::new();
    words.read_line(&mut said).expect("how long it will take");
    // The small mesh is done by then, and nothing of the other.
    std::thread::sleep(Duration::from_secs(1));
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

/// The README's table of methods and its seconds, against the marks of the recorded chart: within rounding.
#[test]
fn the_readme_has_errors_and_costs_of_the_recorded_chart() {
    let read = |name: &str| std::fs::read_to_string(root().join(name)).expect("a file");
    let readme = read("README.md");
    let [chart, summary] = ["svg", "txt"].map(|end| read(&format!("tools/lab/record/guide.{end}")));
    let number = |text: &str, before: &str, after: &str| -> f64 {
        let (_, rest) = text.split_once(before).expect("a mark");
        let (number, _) = rest.split_once(after).expect("its end");
        number.parse().expect("a number")
    };
    // The error of a method at its default in per cent, and its CPU seconds a second.
    let recorded = |scene: &str, method: &str| -> [f64; 2] {
        let solver = match method {
            "verlet" => String::new(),
            other => format!(" --solver {other}"),
        };
        let mark = format!(">tearmesh tear in.obj --scene {scene}{solver} -o out.obj: error, % ");
        let (_, at) = chart.split_once(&mark).expect("a mark");
        [number(at, "", ", "), number(at, ", ", " CPU s")]
    };
    let of_the_mesh = |scene: &str| -> f64 {
        let scene = format!("\n{scene}: ");
        let (_, of_scene) = summary.split_once(&scene).expect("a scene");
        number(of_scene, "other diagonals of the mesh: ", " %")
    };
    let is_rounded = |said: &str, known: f64| {
        let said = said.trim_end_matches(" %");
        let decimals = said.split_once('.').map_or(0, |(_, after)| after.len());
        let off = said.parse::<f64>().expect("a number") - known;
        assert!(
            off.abs() < 0.51 * 10_f64.powi(-(decimals as i32)),
            "{said} for {known}"
        );
    };
    let second = recorded("rip", "verlet")[1];
    let (_, said) = readme
        .split_once("A second of `rip` takes `verlet` ")
        .expect("said");
    is_rounded(said.split_once(" s ").expect("seconds").0, second);
    let rows = readme
        .lines()
        .skip_while(|line| !line.starts_with("| `--solver`"));
    let rows = rows.skip(2).take_while(|line| line.starts_with('|'));
    let mut count = 0;
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let method = cells[1].split('`').nth(1);
        for (scene, said) in ["rip", "trouser", "hang"].into_iter().zip(&cells[2..]) {
            let known =
                method.map_or_else(|| of_the_mesh(scene), |method| recorded(scene, method)[0]);
            is_rounded(said, known);
        }
        if let Some(method) = method {
            is_rounded(cells[5], recorded("rip", method)[1] / second);
        }
        count += 1;
    }
    assert_eq!(count, 6);
}
