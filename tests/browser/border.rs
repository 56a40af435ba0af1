//! The border of the module of `play`, in the engine that a page runs in, by the tables of `border.js`.

use crate::chrome::Chrome;
use crate::harness::Folder;

/// The module of the page, compiled.
const MODULE: &str = "new Response(new Blob([
    Uint8Array.from(atob(document.getElementById('module').textContent), (c) => c.charCodeAt(0))
]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer().then((bytes) => WebAssembly.compile(bytes))";

#[test]
#[ignore = "needs chromium"]
fn every_export_refuses_in_words_and_changes_nothing_or_does_what_it_is_asked() {
    let Some(mut chrome) = Chrome::start() else {
        return;
    };
    let folder = Folder::new();
    folder.done("play -o play.html");
    chrome.open(&folder.path("play.html"));
    let tables = include_str!("border.js");
    let report = chrome.value(&format!("{MODULE}.then({tables})"));
    let finds = report["finds"].as_array().expect("a list");
    println!("{} rows", report["rows"]);
    assert!(finds.is_empty(), "{finds:#?}");
    chrome.was_quiet();
}
