//! A file that is being written, and is put in the place of another once it is whole.
//!
//! ```text
//!   unnamed ──── link ────────────────────────▶ out.obj        where there was none
//!   unnamed ──── link ──▶ .out.obj.tearmesh-AbC123.tmp ─ rename ─▶ out.obj
//!   named                 .out.obj.tearmesh-AbC123.tmp ─ rename ─▶ out.obj
//! ```
//!
//! On Linux a draft has no name (`O_TMPFILE`), so that nothing is left of it however the program
//! ends. A link cannot replace a file: where there is one already, the whole draft gets a
//! name of its own for the moment between two system calls. Elsewhere, and on file systems that know no
//! files without a name, a draft has that name all the time.
//!
//! A program that is killed while its draft has a name leaves it. So the name tells which file
//! it is a draft of, the draft is locked as long as its owner lives, and the next draft of the same
//! file [removes](sweep) those that nobody holds. Where there are no locks none is removed.

use std::ffi::OsStr;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

/// The name of the draft that is being written, if it has one.
static NAMED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Removes the file that is being written, if any, and prevents later files from being completed.
/// Intended for a program that is about to exit.
pub fn abandon() {
    let mut named = registry();
    if let Some(path) = named.take() {
        // Whether or not it is still there, there is nothing more to do about it.
        let _ = fs::remove_file(path);
    }
    // Held for ever: a file that is just being finished waits, and ends with the program.
    std::mem::forget(named);
}

/// A file that is being written.
pub(super) enum Draft {
    #[cfg(target_os = "linux")]
    Unnamed(File),
    Named(Named),
}

impl Draft {
    /// A draft of a file, in the same folder, with the permissions of any new file.
    pub(super) fn new(path: &Path) -> io::Result<Draft> {
        #[cfg(target_os = "linux")]
        if let Ok(file) = linux::unnamed(folder(path)) {
            return Ok(Draft::Unnamed(file));
        }
        // Whatever is wrong with the folder is wrong here too, and is said.
        Ok(Draft::Named(Named::new(path)?))
    }

    pub(super) fn file(&self) -> &File {
        match self {
            #[cfg(target_os = "linux")]
            Draft::Unnamed(file) => file,
            Draft::Named(named) => named.file.as_file(),
        }
    }

    /// Puts the draft, which is whole, in the place of the file.
    pub(super) fn publish(self, path: &Path) -> io::Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Draft::Unnamed(file) => linux::publish(file, path),
            Draft::Named(named) => named.publish(path),
        }
    }
}

/// A draft that has a name.
pub(super) struct Named {
    file: NamedTempFile,
    registered: Registered,
}

impl Named {
    fn new(path: &Path) -> io::Result<Named> {
        sweep(path);
        for _ in 0..TRIES {
            let file = named(path, create)?;
            let lock = file.as_file().try_lock();
            // Another run may sweep between the making and the locking: it holds the lock, or the
            // name, which never comes again, is gone.
            if !matches!(lock, Err(TryLockError::WouldBlock)) && file.path().exists() {
                let registered = Registered::new(file.path());
                return Ok(Named { file, registered });
            }
        }
        Err(io::Error::other("other runs remove every draft of it"))
    }

    fn publish(self, path: &Path) -> io::Result<()> {
        let Named { file, registered } = self;
        let mut registry = registry();
        let published = file.persist(path);
        *registry = None;
        drop(registry);
        drop(registered); // It takes the registry as well.
        published.map(drop).map_err(|failed| failed.error)
    }
}

/// How often to make a draft anew; that another run sweeps at just that moment is rare.
const TRIES: usize = 100;

/// Keeps the name of the draft known while it has one.
struct Registered;

impl Registered {
    fn new(path: &Path) -> Registered {
        *registry() = Some(path.to_owned());
        Registered
    }
}

impl Drop for Registered {
    fn drop(&mut self) {
        *registry() = None;
    }
}

fn registry() -> MutexGuard<'static, Option<PathBuf>> {
    NAMED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Finds a name for a draft of a file, by which it can be made.
fn named<R>(path: &Path, make: impl FnMut(&Path) -> io::Result<R>) -> io::Result<NamedTempFile<R>> {
    let prefix = prefix(path);
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX).rand_bytes(RANDOM);
    builder.make_in(folder(path), make)
}

/// A new file as any other: with the permissions that the system gives, and not those of a secret.
/// Its error does not speak of the draft, whose name nobody gave.
fn create(name: &Path) -> io::Result<File> {
    File::options()
        .read(true)
        .write(true)
        .create_new(true)
        .open(name)
}

/// Removes the drafts of a file that runs left which are gone.
fn sweep(path: &Path) {
    let Ok(entries) = fs::read_dir(folder(path)) else {
        return; // A folder that may be written but not read.
    };
    let prefix = prefix(path);
    for entry in entries.flatten() {
        // A pipe of such a name is none of ours, and would wait for a writer.
        let is_file = || entry.file_type().is_ok_and(|found| found.is_file());
        if is_draft(&entry.file_name(), &prefix) && is_file() {
            let _ = remove_if_left(&entry.path()); // It stays, as it would have.
        }
    }
}

fn remove_if_left(draft: &Path) -> io::Result<()> {
    let both = File::options().read(true).write(true).open(draft);
    // A draft may be one of a file that nobody may write.
    let file = both.or_else(|_| File::open(draft))?;
    file.try_lock()?;
    fs::remove_file(draft)
}

/// How the names of all drafts of a file begin. A long name is cut, since that of a draft is longer.
fn prefix(path: &Path) -> String {
    let mut name = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    while name.len() > 100 {
        name.pop();
    }
    format!(".{name}.tearmesh-")
}

const SUFFIX: &str = ".tmp";
/// How many letters and digits there are between.
const RANDOM: usize = 6;

fn is_draft(name: &OsStr, prefix: &str) -> bool {
    let name = name.to_string_lossy();
    let random = name
        .strip_prefix(prefix)
        .and_then(|rest| rest.strip_suffix(SUFFIX));
    random.is_some_and(|random| {
        random.len() == RANDOM && random.bytes().all(|byte| byte.is_ascii_alphanumeric())
    })
}

/// The folder that a path names, if it names any.
pub(super) fn named_folder(path: &Path) -> Option<&Path> {
    path.parent().filter(|folder| *folder != Path::new(""))
}

/// The folder that a path is in.
pub(super) fn folder(path: &Path) -> &Path {
    named_folder(path).unwrap_or(Path::new("."))
}

#[cfg(target_os = "linux")]
mod linux {
    use std::io::Seek as _;
    use std::os::fd::AsRawFd as _;

    use rustix::fs::{AtFlags, CWD, Mode, OFlags};

    use super::*;

    /// A file without a name. The system applies the umask to its permissions.
    pub(super) fn unnamed(folder: &Path) -> io::Result<File> {
        let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
        let file = rustix::fs::open(folder, flags, Mode::from_raw_mode(0o666))?;
        Ok(File::from(file))
    }

    /// Gives a file a name, unless there is a file of that name.
    fn link(file: &File, name: &Path) -> io::Result<()> {
        let open = format!("/proc/self/fd/{}", file.as_raw_fd());
        rustix::fs::linkat(CWD, open, CWD, name, AtFlags::SYMLINK_FOLLOW)?;
        Ok(())
    }

    pub(super) fn publish(file: File, path: &Path) -> io::Result<()> {
        {
            // An interruption waits until there is no name again.
            let _registry = registry();
            match link(&file, path) {
                Ok(()) => return Ok(()),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    if let Ok(published) = replace(&file, path) {
                        return published;
                    }
                }
                Err(_) => {}
            }
        }
        // It can get no name, as where /proc is not there; its bytes can.
        copied(file, path)?.publish(path)
    }

    /// Gives a file a name, and with it the place of another. Fails where it can have no name; what
    /// is inside says whether it got the place.
    fn replace(file: &File, path: &Path) -> io::Result<io::Result<()>> {
        sweep(path);
        // Before there is a name by which another run could find it.
        let _ = file.try_lock();
        let named = named(path, |name| link(file, name))?;
        Ok(named.persist(path).map_err(|failed| failed.error))
    }

    /// A draft with a name, and with the bytes and the permissions of one without.
    pub(super) fn copied(mut file: File, path: &Path) -> io::Result<Named> {
        let mut copy = Named::new(path)?;
        file.rewind()?;
        io::copy(&mut file, copy.file.as_file_mut())?;
        let permissions = file.metadata()?.permissions();
        copy.file.as_file().set_permissions(permissions)?;
        copy.file.as_file().sync_all()?;
        Ok(copy)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    fn publish(draft: Draft, text: &str, path: &Path) {
        draft.file().write_all(text.as_bytes()).expect("room");
        draft.publish(path).expect("a file");
        assert_eq!(fs::read_to_string(path).expect("text"), text);
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("a folder");
        let names = entries.map(|entry| entry.expect("an entry").file_name());
        names
            .map(|name| name.to_string_lossy().into_owned())
            .collect()
    }

    /// Every way to a file: where there was none, and where there was one.
    #[test]
    fn a_draft_takes_the_place_of_a_file_and_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("x.obj");
        for _ in 0..2 {
            publish(Draft::new(&path).expect("a draft"), "one way", &path);
            let named = Named::new(&path).expect("a draft");
            assert_eq!(names(folder.path()).len(), 2, "a draft and a file");
            publish(Draft::Named(named), "another", &path);
            #[cfg(target_os = "linux")]
            {
                let mut file = tempfile::tempfile().expect("a file");
                file.write_all(b"a third").expect("room");
                let copied = linux::copied(file, &path).expect("a draft");
                copied.publish(&path).expect("a file");
                assert_eq!(fs::read_to_string(&path).expect("text"), "a third");
            }
            fs::remove_file(&path).expect("a file");
        }
    }

    /// Each sweeps before it makes a draft, and no draft is swept that somebody still writes.
    #[test]
    fn drafts_of_one_file_do_not_disturb_each_other() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("x.obj");
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..200 {
                        let named = Named::new(&path).expect("a draft");
                        named.publish(&path).expect("a file");
                    }
                });
            }
        });
        assert_eq!(names(folder.path()), ["x.obj"]);
    }

    #[test]
    fn a_draft_that_is_given_up_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("x.obj");
        drop(Draft::new(&path).expect("a draft"));
        drop(Named::new(&path).expect("a draft"));
        assert_eq!(names(folder.path()), [""; 0]);
    }

    #[test]
    fn drafts_are_told_by_their_names() {
        let long = "é".repeat(120);
        for name in ["x.obj", "", long.as_str()] {
            let prefix = prefix(Path::new(name));
            assert!(prefix.len() <= 112);
            assert!(is_draft(
                OsStr::new(&format!("{prefix}AbC123.tmp")),
                &prefix
            ));
            for other in [
                "AbC12.tmp",
                "AbC-23.tmp",
                "AbC123.obj",
                "AbC123.tmp.tmp",
                "",
            ] {
                assert!(!is_draft(OsStr::new(&format!("{prefix}{other}")), &prefix));
            }
        }
    }
}
