//! Cuts across seams that coincide and are not sewn, from file to file: what is mended is the file that
//! was cut, byte for byte, and what is undone the file that was cut last.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use tearmesh_cli::Exit;

use crate::in_process::in_memory;
use crate::random::Random;
use crate::support::cases::cases;

/// A sheet of squares that is not flat, in patches with a `v` of their own for each corner: a few that
/// hang together, or each face one.
fn patches(random: &mut Random) -> String {
    let (width, height) = (2 + random.below(5), 2 + random.below(5));
    let at = |x: usize, y: usize| y * (width + 1) + x;
    let mut places = Vec::new();
    for y in 0..=height {
        for x in 0..=width {
            let mut off = || 0.4 * (random.next() - 0.5);
            places.push([x as f64 + off(), y as f64 + off(), off()]);
        }
    }
    let (is_soup, is_mapped) = (random.below(4) == 0, random.below(2) == 0);
    let of_patch = 1 + random.below(3);
    let (mut vertices, mut faces) = (String::new(), String::new());
    let mut known = BTreeMap::new();
    for (x, y) in (0..width * height).map(|i| (i % width, i / width)) {
        let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
        let halves = match random.below(2) {
            0 => [[a, b, c], [a, c, d]],
            _ => [[a, b, d], [b, c, d]],
        };
        for (half, corners) in halves.into_iter().enumerate() {
            let patch = match is_soup {
                true => [x, y, half],
                false => [x / of_patch, y / of_patch, 0],
            };
            faces += "f";
            for place in corners {
                let next = known.len() + 1;
                let number = *known.entry((place, patch)).or_insert_with(|| {
                    let [x, y, z] = places[place];
                    writeln!(vertices, "v {x} {y} {z}\nvt {} {}", x / 9.0, y / 9.0).expect("text");
                    next
                });
                faces += &match is_mapped {
                    true => format!(" {number}/{number}"),
                    false => format!(" {number}"),
                };
            }
            faces += "\n";
        }
    }
    vertices + &faces
}

/// A plane or two rays through the sheet.
fn way(random: &mut Random) -> String {
    let [mut x, mut y, mut step] = [0.0; 3];
    let mut draw = || {
        x = 1.0 + 2.0 * random.next();
        y = 1.0 + 2.0 * random.next();
        step = random.next() - 0.5;
        (x, y, step)
    };
    let ((x, y, tilt), (to_x, to_y, lean)) = (draw(), draw());
    match random.below(3) {
        0 => format!("--plane {x},{y},0:{lean},{tilt},0.1"),
        1 => format!("--rays {x},{y},9:{lean},{tilt},-9 {to_x},{to_y},9:0,0,-9"),
        _ => format!("--rays {x},{y},9:0,0,-1 {to_x},{to_y},9:0,0,-1"),
    }
}

/// A cut by way of chance.
fn cut(random: &mut Random) -> String {
    let way = way(random);
    let gap = ["", "", " --gap 3%"][random.below(3)];
    let options = match random.below(3) {
        0 => " --method partition",
        1 => [" --snap 0", " --snap 0.2", " --snap 0.49", ""][random.below(4)],
        _ => [" --snap 0.2 --snap-move", " --snap-move"][random.below(2)],
    };
    format!("cut - {way}{gap}{options} --allow-miss")
}

/// The file that a command writes.
fn written(typed: &str, file: &[u8]) -> Vec<u8> {
    let typed = format!("tearmesh {typed} -q -o -");
    let ran = in_memory(typed.split(' '), file, false);
    assert_eq!(
        ran.exit,
        Exit::Done,
        "{typed}\n{}{}",
        ran.error,
        shown(file)
    );
    ran.output
}

fn shown(file: &[u8]) -> String {
    String::from_utf8_lossy(file).into_owned()
}

#[test]
fn cuts_across_unsewn_seams_are_mended_to_the_byte() {
    let mut random = Random(71);
    let (mut torn, mut twice, mut undo, mut closed) = (0, 0, 0, 0);
    let wanted = cases() / 10;
    while torn < wanted {
        let file = patches(&mut random).into_bytes();
        let (first, second) = (cut(&mut random), cut(&mut random));
        let whole = written("cut - --plane 1e9,0,0:1,0,0 --allow-miss", &file);
        let cut = written(&first, &file);
        if cut == whole {
            continue; // It misses, or ends in one face.
        }
        torn += 1;
        let is_whole = |cut: &[u8], typed: &str| {
            let mended = written("mend - --simplify", cut);
            let [file, mended] = [&file, &mended].map(|file| shown(file));
            assert!(
                mended.as_bytes() == whole,
                "{typed}\n{file}becomes\n{mended}"
            );
        };
        is_whole(&cut, &first);
        let again = written(&second, &cut);
        twice += u64::from(again != cut);
        is_whole(&again, &format!("{first}, then {second}"));
        // A gap is shown anew, at the same places.
        if again != cut && !first.contains("--gap") && !second.contains("--gap") {
            let undone = shown(&written("mend - --last 1 --simplify", &again));
            let [file, cut] = [&file, &cut].map(|file| shown(file));
            assert!(
                undone == cut,
                "{first}, then {second}\n{file}{cut}becomes\n{undone}"
            );
            undo += 1;
        }
        let ran = in_memory("tearmesh check -".split(' '), &file, false);
        closed += u64::from(shown(&ran.output).contains("W-MESH-UNSEWN"));
    }
    assert!(5 * undo > wanted, "{undo}");
    assert!(
        2 * twice > wanted && 2 * closed > wanted,
        "{twice} {closed}"
    );
}
