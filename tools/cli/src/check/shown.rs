//! The page of `check --view`.

use std::path::{Path, PathBuf};

use tearmesh::{Mesh, Positions, Vector};
use tearmesh_view::Page;

use crate::exit::Stop;
use crate::files::{check_page, is_same};
use crate::say::Fault;
use crate::{output, page};

/// The page of the meshes that can be cut.
pub(super) struct Shown {
    page: Page,
    path: PathBuf,
}

impl Shown {
    /// Refuses a page that would replace a file.
    pub(super) fn at(
        path: &Path,
        inputs: &[Result<PathBuf, (PathBuf, Fault)>],
    ) -> Result<Shown, Stop> {
        let mut inputs = inputs.iter().flatten();
        if path == Path::new("-") || inputs.any(|input| is_same(input, path)) {
            let message = "`--view` takes the name of a file of its own";
            let help = "name a file that nothing else is read from or written to";
            return Err(Stop::usage(message, help));
        }
        check_page(path)?;
        output::check(path)?;
        Ok(Shown {
            page: Page::new("checked", Vector::y()),
            path: path.to_owned(),
        })
    }

    /// Adds a mesh, which is in the file of this name.
    pub(super) fn add(&mut self, mesh: &Mesh, positions: &Positions, name: &str) {
        // Every mesh of a document has a face, and the y-axis is a direction.
        let added = self.page.add(mesh, positions, page::moment(Some(name)));
        added.expect("it can be seen");
    }

    /// Writes the page, if there is a mesh on it.
    pub(super) fn write(self) -> Result<(), Stop> {
        if self.page.is_empty() {
            let message = "there is no mesh to be shown on a page";
            return Err(Fault::error("E-VIEW-EMPTY", message).into());
        }
        Ok(output::write(&self.path, |out| self.page.write(out))?)
    }
}
