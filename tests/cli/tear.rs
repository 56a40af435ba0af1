//! Simulations: the table of forces.

use crate::harness::Folder;

/// In the end what holds bear is what hangs on them.
#[test]
fn the_table_of_forces_ends_with_the_weight() {
    let folder = Folder::new();
    folder.write(
        "calm.toml",
        "base = \"hang\"\nseconds = 5\ndrag_per_s = 8\n",
    );
    let line = "tear flag.obj --scene calm.toml --forces f.csv -o t.obj";
    let report = folder.report(line);
    let table = folder.read("f.csv");
    let mut lines = table.lines();
    let head = lines.next().expect("a head");
    assert!(
        head.starts_with("end_s,hold_1_x_n,hold_1_y_n,hold_1_z_n"),
        "{head}"
    );
    let last = lines.next_back().expect("frames").split(',');
    let numbers: Vec<f64> = last.map(|n| n.parse().expect("a number")).collect();
    assert!((numbers[0] - 5.0).abs() < 1e-6);
    let up: f64 = numbers[1..].chunks(3).map(|force| force[1]).sum();
    let kilograms = report["mass"]["after"].as_f64().expect("a mass");
    let off = (up / (9.81 * kilograms) - 1.0).abs();
    assert!(off < 0.01, "{up} N, {kilograms} kg");
    assert_eq!(table.lines().count(), 1 + 300);
}
