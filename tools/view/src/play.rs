//! A page on which a person plays with a cloth: the simulation runs in the page, as WebAssembly.
//!
//! The module is built from `play/`, a crate outside the workspace, by the script `play/build`, and lies here
//! compressed, since a package has no files of another crate. Building this crate needs no second toolchain.

use std::io::{self, Write};

use base64::Engine as _;
use serde_json::json;

use crate::fit::ANGLE_OF_VIEW;
use crate::page::{FRAME, STYLE, colors, escaped, fill, packed, script};
use crate::shade;

/// An HTML page on which a cloth is grabbed, ripped, cut and mended by hand. It needs no network.
///
/// ```
/// let [title, scene, up] = ["Cloth", "rip", "y"].map(String::from);
/// let page = tearmesh_view::PlayPage { title, file: None, scene, plan: None, up };
/// let mut html = Vec::new();
/// page.write(&mut html)?;
/// assert!(tearmesh_view::is_page(&html));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PlayPage {
    /// The title of the page.
    pub title: String,
    /// The name and the content of the OBJ file of the cloth; `None` for a sheet of 1 m.
    pub file: Option<(String, Vec<u8>)>,
    /// The scene that the page begins with: `rip`, `hang`, `flag`, `trouser` or `fall`, or the name of a file.
    pub scene: String,
    /// The scene of the file, as JSON; `None` for one that stands ready.
    pub plan: Option<String>,
    /// The upward direction: an axis, such as `y` or `-z`.
    pub up: String,
}

impl PlayPage {
    /// The largest number of vertices of a cloth that a page plays with.
    pub const VERTICES_MAX: usize = 20_000;

    /// Returns the format of the scenes that the page's module reads, as in [`PlayPage::plan`].
    #[must_use]
    #[expect(clippy::missing_panics_doc, reason = "the file of facts is ours")]
    pub fn scene_format() -> u32 {
        let mut lines = MODULE_FACTS.lines();
        let format = lines.find_map(|line| line.strip_prefix("scenes of format "));
        let format = format.and_then(|number| number.parse().ok());
        format.expect("the script that builds the module writes the format")
    }

    /// Writes the page as HTML. The same content gives the same bytes.
    ///
    /// # Errors
    ///
    /// Any I/O error of `out`.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        let file = self.file.as_ref();
        let text = json!({
            "title": self.title,
            "file": file.map(|(name, _)| name),
            "scene": self.scene,
            "plan": self.plan,
            "up": self.up,
            "angle": ANGLE_OF_VIEW,
            "colors": colors(),
            "light": shade::LIGHT,
        });
        let bytes = file.map_or(&[][..], |(_, bytes)| bytes);
        let module = base64::engine::general_purpose::STANDARD.encode(MODULE);
        let parts = [
            ("{title}", &*escaped(&self.title)),
            ("{style}", &[STYLE, PLAY_STYLE].concat()),
            ("{data}", &packed(&text.to_string(), bytes)?),
            ("{module}", &module),
            ("{script}", &script(&SCRIPTS)),
        ];
        fill(PLAY_FRAME, &parts, out)
    }
}

/// Returns whether a file is a [`Page`](crate::Page) or a [`PlayPage`], given its first bytes. 4096 bytes are
/// sufficient.
#[must_use]
pub fn is_page(start: &[u8]) -> bool {
    [FRAME, PLAY_FRAME].into_iter().any(|frame| {
        let before_title = frame.split("{title}").next();
        before_title.is_some_and(|before| start.starts_with(before.as_bytes()))
    })
}

const MODULE: &[u8] = include_bytes!("play/module.wasm.gz");
const MODULE_FACTS: &str = include_str!("play/module.txt");
const PLAY_FRAME: &str = include_str!("play/play.html");
const PLAY_STYLE: &str = include_str!("play/play.css");
const SCRIPTS: [&str; 2] = [include_str!("play/cloth.js"), include_str!("play/play.js")];
