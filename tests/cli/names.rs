//! Names of files that hold an escape sequence and a line end: whatever a verb says of them, a terminal gets symbols
//! in the place of control characters, and a line stays one.

use std::fs;

use crate::harness::{Folder, root};

/// The beginning of each name. `quit` would begin a line of its own.
const NAME: &str = "a\u{1b}[31m\u{7}\nquit";

/// The files of a folder, by the name of each without [`NAME`], which `~` stands for.
fn folder() -> Folder {
    let folder = Folder::new();
    let data = |name: &str| fs::read_to_string(root().join("tests/data").join(name)).expect("data");
    for (name, text) in [
        ("~.obj", data("flag.obj")),
        ("~/in.obj", data("flag.obj")),
        (
            "~bad.obj",
            "v 0 0 0\nv 1 0 0\nv 1 0,5 0\nf 1 2 3\n".to_owned(),
        ),
        (
            "~book.obj",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n".to_owned(),
        ),
        ("~.ply", "ply\n".to_owned()),
        ("~.txt", "0.3,2,5:0,0,-1 0.3,-2,5:0,0,-1\n".to_owned()),
        ("~bad.txt", "0.3,2,5:0,0,-1 nothing\n".to_owned()),
        ("~.toml", "base = \"hang\"\nseconds = 0.05\n".to_owned()),
        ("~bad.toml", "base = \"hang\"\nsecond = 0.05\n".to_owned()),
        (
            "~none.toml",
            "[[collider]]\nbody = \"a\\u001b[31m\\u0007\\nquit-none.obj\"\n".to_owned(),
        ),
        ("~.html", "mine\n".to_owned()),
        ("~.csv", "no table\n".to_owned()),
        ("~f/frame_00002.obj", String::new()),
        ("~old/piece_00000.obj", String::new()),
    ] {
        folder.write(&name.replace('~', NAME), text);
    }
    folder
}

/// What is typed, `~` in the place of [`NAME`], and how it ends.
const LINES: &str = "\
0 check '~.obj'
0 check -v '~.obj' '~/in.obj'
0 check --format json '~.obj'
0 check -r '~'
1 check '~bad.obj' '~book.obj' '~.ply'
1 check -v '~bad.obj' '~book.obj'
3 check '~' '~no.obj' '~no*.obj'
0 cut '~.obj' --plane 0.31,0,0:1,0,0 -o '~cut.obj'
0 cut '~.obj' --plane 0.31,0,0:1,0,0 -o '~cut.obj' --report '~r.json' --picture '~p.png' --view '~p.html' --seam '~s.obj' --map '~m.json' --pieces '~pieces'
0 cut '~.obj' --rays-file '~.txt' -o '~cut.obj'
2 cut '~.obj' --rays-file '~bad.txt' -o '~cut.obj'
3 cut '~.obj' --rays-file '~no.txt' -o '~cut.obj'
1 cut '~.obj' --plane 9,0,0:1,0,0 -o '~miss.obj'
2 cut '~.obj' --plane 0.31,0,0:1,0,0 -o '~.obj'
2 cut '~.obj' --plane 0.31,0,0:1,0,0 -o '~.stl'
7 cut '~.obj' --plane 0.31,0,0:1,0,0 -o '~.obj/x.obj'
7 cut '~.obj' --plane 0.31,0,0:1,0,0 -o '~no/x.obj'
7 cut '~.obj' --plane 0.31,0,0:1,0,0 -o '~'
2 cut '~.obj' --plane 0.31,0,0:1,0,0 -o x.obj --pieces '~old'
3 cut '~n.obj' --plane 0.31,0,0:1,0,0 -o x.obj
3 cut '~' --plane 0.31,0,0:1,0,0 -o x.obj
3 cut '~bad.obj' --plane 0.31,0,0:1,0,0 -o x.obj
3 cut '~book.obj' --plane 0.31,0,0:1,0,0 -o x.obj
3 cut '~.ply' --plane 0.31,0,0:1,0,0 -o x.obj
2 cut '~.obj' --plane 0.31,0,0:1,0,0 --plane '~'
2 cut '~.obj' '~.obj' --plane 0.31,0,0:1,0,0
2 cut '~.obj' '--~'
2 '~'
0 tear '~.obj' --scene '~.toml' -o '~t.obj' --frames '~frames' --cache '~.pc2' --forces '~f.csv' --view '~t.html' --picture '~t.png'
0 tear '~.obj' --scene '~.toml' -o '~t.obj' --frames '~f' --report '~t.json'
2 tear '~.obj' --scene '~.toml' -o '~f/frame_00002.obj' --frames '~f'
2 tear '~.obj' --scene '~bad.toml' -o '~t.obj'
3 tear '~.obj' --scene '~none.toml' -o '~t.obj'
3 tear '~.obj' --scene '~no.toml' -o '~t.obj'
2 tear '~.obj' --scene '~' -o '~t.obj' --up '~'
0 mend '~cut.obj' -o '~mended.obj'
1 mend '~.obj' -o '~mended.obj'
0 render '~.obj' -o '~d.png' --obj '~d.obj'
2 render '~.obj' -o '~d.stl'
0 view '~.obj' '~/in.obj' -o '~v.html'
2 view '~.obj'
0 view '~' -o '~dir.html'
0 view '~cut.obj'
0 play '~.obj' -o '~play.html'
0 play '~.obj' --scene '~.toml' -o '~play.html'
2 play --scene '~.toml' -o '~play.html'
3 play '~no.obj' -o '~play.html'
0 chart cut --size 4 --cuts 1 -o '~c.svg' --csv '~c.csv'
3 chart cut --from '~.csv' -o '~c.svg'
3 chart cut --from '~no.csv' -o '~c.svg'
2 chart cut --from '~.csv' -o '~c.csv' --csv '~c.csv'
2 completions '~'
2 man '~'
";

#[test]
fn no_name_of_a_file_reaches_a_terminal_as_it_is() {
    let folder = folder();
    for line in LINES.lines() {
        let (exit, typed) = line.split_once(' ').expect("an exit status");
        let answer = folder.run(&typed.replace('~', NAME));
        let seen = answer.seen();
        assert_eq!(answer.exit.to_string(), exit, "{line}\n{seen}");
        let is_control = |c: char| c.is_control() && c != '\n';
        let found = seen
            .find(is_control)
            .map(|at| &seen[at.saturating_sub(9)..at]);
        assert_eq!(found, None, "{line}\n{seen:?}");
        assert!(
            seen.lines().all(|line| !line.starts_with("quit")),
            "{line}\n{seen}"
        );
    }
}

/// Colours are of the command, and of no name.
#[test]
fn a_name_has_no_colours_where_these_are_wanted() {
    let folder = folder();
    let line = "cut '~n.obj' --plane 0.31,0,0:1,0,0 --color always".replace('~', NAME);
    let seen = folder.ends(&line, 3);
    assert!(seen.contains('\u{1b}'), "{seen:?}");
    assert!(
        !seen.contains("a\u{1b}") && !seen.contains('\u{7}'),
        "{seen:?}"
    );
    assert!(seen.contains("`a␛[31m␇␊quitn.obj`"), "{seen:?}");
}
