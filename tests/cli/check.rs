//! What `check` says of a mesh, by plain sums over the lines of its file.

use crate::harness::Folder;

#[test]
fn sizes_are_those_of_the_file() {
    let folder = Folder::new();
    let cut = "tearmesh cut flag.obj --plane 0.31,0,0:1,0.4,0 --plane 0,0.2,0:0,1,0 -q -o torn.obj";
    assert!(folder.run(cut).status.success());
    for (name, pieces) in [("flag.obj", 1), ("sleeve.obj", 1), ("torn.obj", 4)] {
        let output = folder.run(&format!("tearmesh check --format json {name}"));
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let mesh = &report["mesh"];
        let text = folder.read(name);
        let numbers = |keyword: &str| -> Vec<Vec<f64>> {
            let lines = text.lines().filter_map(|line| line.strip_prefix(keyword));
            let words = lines.map(|line| line.split_whitespace());
            let first = |word: &str| word.split('/').next().and_then(|word| word.parse().ok());
            words
                .map(|words| words.filter_map(first).collect())
                .collect()
        };
        let (places, faces) = (numbers("v "), numbers("f "));
        for axis in 0..3 {
            let all = places.iter().map(|place| place[axis]);
            let [least, most] = ["min", "max"].map(|end| mesh["bounds"][end][axis].as_f64());
            assert_eq!(least, Some(all.clone().fold(f64::INFINITY, f64::min)));
            assert_eq!(most, Some(all.fold(f64::NEG_INFINITY, f64::max)));
        }
        let (mut lengths, mut area) = (Vec::new(), 0.0);
        for face in &faces {
            let corner = |i: usize| &places[face[i % 3] as usize - 1];
            let sides = [0, 1, 2].map(|i| {
                let (a, b) = (corner(i), corner(i + 1));
                (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
            });
            let half = sides.iter().sum::<f64>() / 2.0;
            area += sides
                .iter()
                .fold(half, |product, side| product * (half - side))
                .sqrt();
            let ends = [0, 1, 2].map(|i| {
                let (a, b) = (face[i] as usize, face[(i + 1) % 3] as usize);
                (a.min(b), a.max(b))
            });
            lengths.extend(ends.into_iter().zip(sides));
        }
        lengths.sort_by_key(|&(ends, _)| ends);
        lengths.dedup_by_key(|(ends, _)| *ends);
        let all = lengths.iter().map(|&(_, length)| length);
        let near = |said: &serde_json::Value, is: f64| {
            let said = said.as_f64().expect("a number");
            assert!((said - is).abs() <= 1e-9 * is, "{name}: {said} {is}");
        };
        near(
            &mesh["edges"]["shortest"],
            all.clone().fold(f64::INFINITY, f64::min),
        );
        near(&mesh["edges"]["longest"], all.clone().fold(0.0, f64::max));
        near(
            &mesh["edges"]["mean"],
            all.sum::<f64>() / lengths.len() as f64,
        );
        let said = mesh["pieces"].as_array().expect("pieces");
        assert_eq!(said.len(), pieces);
        let sum = said
            .iter()
            .map(|piece| piece["area"].as_f64().expect("an area"));
        near(&serde_json::json!(sum.sum::<f64>()), area);
        let counts = said
            .iter()
            .map(|piece| piece["faces"].as_u64().expect("a count"));
        assert_eq!(counts.sum::<u64>(), faces.len() as u64);
    }
}

#[test]
fn folders_and_patterns_name_the_files_that_they_should() {
    let folder = Folder::new();
    let mesh = folder.read("sheet.obj");
    std::fs::create_dir_all(folder.path("many/deep")).expect("folders");
    std::fs::create_dir(folder.path("none")).expect("a folder");
    for name in [
        "many/b.obj",
        "many/A.OBJ",
        "many/deep/c.Obj",
        "many/.hidden.obj",
        "many/no.txt",
    ] {
        folder.write(name, &mesh);
    }
    let checked = |args: &str| {
        let output = folder.run(&format!("tearmesh check {args}"));
        let text = String::from_utf8(output.stdout).expect("text");
        let names = text.lines().filter_map(|line| line.split(' ').next());
        let names: Vec<String> = names.map(str::to_owned).collect();
        (output.status.code(), names.join(" "))
    };
    // A folder's files by name, those of the folders in it included.
    let all = "many/.hidden.obj many/A.OBJ many/b.obj many/deep/c.Obj";
    assert_eq!(checked("-r many"), (Some(0), all.to_owned()));
    // No shell has seen these. What begins with a dot has to be asked for.
    assert_eq!(checked("many/*.obj"), (Some(0), "many/b.obj".to_owned()));
    assert_eq!(
        checked("many/.*.obj"),
        (Some(0), "many/.hidden.obj".to_owned())
    );
    assert_eq!(checked("*/?.obj"), (Some(0), "many/b.obj".to_owned()));
    // Nothing at all is no success.
    assert_eq!(checked("-r none"), (Some(3), "none".to_owned()));
    assert_eq!(checked("none/*.obj"), (Some(3), "none/*.obj".to_owned()));
}
