//! What is wrong with a mesh, in the terms of its file; most is in `files.txt`.

use super::read;

#[test]
fn all_defects_are_in_the_value_and_twenty_in_the_message() {
    let mut file = String::new();
    for i in 0..30 {
        file += &"v 0 0 0\n".repeat(3);
        let face = format!("f {} {} {}\n", 3 * i + 1, 3 * i + 2, 3 * i + 3);
        file += &face.repeat(2);
    }
    let document = read(file.as_bytes());
    let error = document.mesh().expect_err("duplicates");
    assert_eq!((error.error().count(), error.shown().len()), (30, 20));
    let message = error.to_string();
    assert_eq!(message.lines().count(), 21);
    assert!(message.ends_with("and 10 more"), "{message}");
    let last = error.error().defects().last().expect("thirty");
    let last = document.describe(last);
    assert_eq!(
        last.to_string(),
        "line 150: 2 faces have the same vertices 88, 89, 90 (lines 149, 150)"
    );
}
