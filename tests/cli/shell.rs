//! Completions and pages of the manual know what can be typed.

use std::collections::BTreeSet;
use std::process::Command;

use crate::harness::Folder;

/// The verbs that `tearmesh -h` lists, `help` aside.
fn verbs(folder: &Folder) -> Vec<String> {
    let help = folder.done("-h");
    let list = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let list = list.take_while(|line| !line.is_empty());
    let verbs = list.filter_map(|line| line.split_whitespace().next());
    verbs
        .filter(|verb| *verb != "help")
        .map(str::to_owned)
        .collect()
}

/// The long options that the help of a verb lists.
fn options(folder: &Folder, verb: &str) -> BTreeSet<String> {
    let help = folder.done(&format!("{verb} --help"));
    let list = help.lines().skip_while(|line| *line != "Options:");
    let named = list.filter(|line| line.trim_start().starts_with('-'));
    let words = named.flat_map(|line| line.split([' ', ',']));
    let is_name = |c: char| c == '-' || c.is_ascii_lowercase();
    let long = words.filter(|word| word.starts_with("--") && word.chars().all(is_name));
    long.map(str::to_owned).collect()
}

#[test]
fn each_page_of_the_manual_has_every_option_of_its_verb() {
    let folder = Folder::new();
    let mut seen = 0;
    for verb in verbs(&folder) {
        let page = folder.done(&format!("man {verb}"));
        assert!(page.contains(&format!(".TH tearmesh-{verb} 1")), "{page}");
        for option in options(&folder, &verb) {
            let written = option.replace('-', "\\-");
            let is_there = page.contains(&format!("\\fB{written}\\fR"));
            assert!(is_there, "{verb} {option}\n{page}");
            seen += 1;
        }
    }
    assert!(seen > 90, "{seen}");
    let page = folder.done("man");
    let is_there = |verb: &String| page.contains(&format!("tearmesh\\-{verb}(1)"));
    assert!(verbs(&folder).iter().all(is_there));
}

#[test]
fn bash_completes_verbs_and_options() {
    let folder = Folder::new();
    folder.write("complete.bash", folder.done("completions bash"));
    let completed = |words: &str| {
        let last = words.split(' ').count() - 1;
        let ask = format!(
            "source ./complete.bash; COMP_WORDS=({words}); COMP_CWORD={last}; \
             _tearmesh tearmesh ${{COMP_WORDS[{last}]}} ${{COMP_WORDS[{last} - 1]}}; \
             echo ${{COMPREPLY[@]}}"
        );
        let output = Command::new("bash")
            .args(["-c", &ask])
            .current_dir(folder.path("."))
            .output();
        let Ok(output) = output else {
            println!("skipped: there is no bash");
            return None;
        };
        let words = String::from_utf8(output.stdout).expect("text");
        let words = words.split_whitespace().map(str::to_owned);
        Some(words.collect::<BTreeSet<_>>())
    };
    let Some(found) = completed("tearmesh m") else {
        return;
    };
    assert_eq!(found, ["man", "mend"].map(str::to_owned).into());
    for verb in ["cut", "tear", "render"] {
        let found = completed(&format!("tearmesh {verb} --")).expect("bash");
        assert_eq!(found, options(&folder, verb), "{verb}");
    }
    for shell in ["zsh", "fish", "powershell", "elvish"] {
        let script = folder.done(&format!("completions {shell}"));
        assert!(script.contains("snap-move"), "{shell}");
    }
}
