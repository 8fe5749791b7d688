//! Output files: checked before the work begins; each is written whole or not at all.
//!
//! ```text
//!   arguments ──check──▶ ending, folder, no file twice, no input among them        nothing is opened yet
//!   write ─▶ folder/.selvedge-XXXXXX ──whole──▶ renamed to folder/name             a failure leaves the old file
//!        ├▶ a device, a pipe: written where it is
//!        └▶ `-`: standard output, in one piece
//!   begin ─▶ folder/.selvedge-XXXXXX ─replace──▶ renamed to folder/name            lines are added afterwards
//! ```

use anyhow::{Context, Result, bail};
use same_file::Handle;
use selvedge_io::import::Import;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Links that are followed at the end of a path, as many as Linux follows.
const MOST_LINKS: usize = 40;

/// The kind of a file, which its ending has to match.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Form {
    name: &'static str,
    /// None: any will do.
    endings: &'static [&'static str],
}

pub const PNG: Form = Form { name: "a PNG picture", endings: &["png"] };
/// A PNG picture whose name its reader gives.
pub const ANY_NAME: Form = Form { name: "a PNG picture", endings: &[] };
pub const NPY: Form = Form { name: "a NumPy array", endings: &["npy"] };
pub const JSON: Form = Form { name: "JSON", endings: &["json"] };
pub const CSV: Form = Form { name: "CSV", endings: &["csv"] };
pub const MARKDOWN: Form = Form { name: "Markdown", endings: &["md"] };
pub const SVG: Form = Form { name: "an SVG drawing", endings: &["svg"] };
pub const STEP: Form = Form { name: "a STEP file", endings: &["step", "stp", "p21"] };
pub const NATIVE: Form = Form { name: "a .selvedge file", endings: &["selvedge"] };

/// An output of a call.
#[derive(Clone, Debug)]
pub struct Target {
    pub path: PathBuf,
    pub form: Form,
}

impl Target {
    pub fn new(path: impl Into<PathBuf>, form: Form) -> Self {
        Self { path: path.into(), form }
    }
}

/// The path means standard output, or standard input.
pub fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The path with words at the end of its name, before the ending: `out.png` becomes `out-close.png`.
pub fn with_name(path: &Path, words: &str) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let end = path.extension().map_or(String::new(), |e| format!(".{}", e.to_string_lossy()));
    path.with_file_name(format!("{stem}{words}{end}"))
}

/// Refuses outputs that cannot be written, and outputs that would overwrite another output or an input of the same
/// call.
///
/// Existing files are the same when they are one file to the system, whatever names and links lead to it; new ones, when
/// their names in one folder differ in case at most.
pub fn check(inputs: &[&Path], outputs: &[Target]) -> Result<()> {
    let read: Vec<_> =
        inputs.iter().filter(|path| !is_standard(path)).map(|path| (*path, Identity::of(path))).collect();
    let mut written: Vec<(&Path, Identity)> = Vec::new();
    for Target { path, form } in outputs {
        let shown = path.display();
        let identity = if is_standard(path) {
            Some(Identity::Standard)
        } else {
            form.check(path)?;
            Identity::of(path)
        };
        let Some(identity) = identity else { continue };
        if let Some((input, _)) = read.iter().find(|(_, known)| known.as_ref() == Some(&identity)) {
            bail!("{shown}: the same file as the input {}, which it would replace", input.display());
        }
        if let Some((other, _)) = written.iter().find(|(_, known)| *known == identity) {
            bail!("{shown}: the same place as another output, {}", other.display());
        }
        written.push((path, identity));
    }
    Ok(())
}

impl Form {
    /// Checks that the place can have such a file.
    fn check(self, path: &Path) -> Result<()> {
        let shown = path.display();
        if let Some(ending) = path.extension().filter(|_| !self.endings.is_empty()) {
            let ending = ending.to_string_lossy();
            if !self.endings.iter().any(|known| ending.eq_ignore_ascii_case(known)) {
                let wanted: Vec<_> = self.endings.iter().map(|e| format!(".{e}")).collect();
                bail!("{shown}: what is written here is {}, so its name ends in {}", self.name, wanted.join(" or "));
            }
        }
        let place = resolved(path).with_context(|| format!("cannot write {shown}"))?;
        match fs::metadata(&place) {
            Ok(found) if found.is_dir() => bail!("{shown}: a folder, not a file that can be written"),
            Ok(found) if !found.is_file() => return Ok(()),
            // renaming another file over it would ignore this
            Ok(found) if found.permissions().readonly() => bail!("{shown}: the file is write-protected"),
            _ => {}
        }
        let folder = place.parent().unwrap_or(Path::new("."));
        // a file must be made here before it is renamed
        beside(folder).with_context(|| format!("cannot write {shown}: no file can be made in its folder"))?;
        Ok(())
    }
}

/// Identifies a place.
#[derive(PartialEq, Eq)]
enum Identity {
    /// `-`
    Standard,
    /// A file that exists.
    File(Handle),
    /// One that does not: its folder, and its name in small letters.
    New(PathBuf, String),
}

impl Identity {
    /// `None` for devices, pipes and unreachable paths: writing them twice loses nothing.
    fn of(path: &Path) -> Option<Self> {
        let place = resolved(path).ok()?;
        match fs::metadata(&place) {
            Ok(found) if found.is_file() => Handle::from_path(&place).ok().map(Self::File),
            Ok(_) => None,
            Err(_) => Some(Self::New(place.parent()?.to_owned(), place.file_name()?.to_string_lossy().to_lowercase())),
        }
    }
}

/// The file that a path leads to, whether or not it exists: its folder without links, and the name there.
fn resolved(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(to) => path = path.parent().unwrap_or(Path::new("")).join(to),
            Err(_) => break,
        }
    }
    let name = path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"))?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = folder.canonicalize().map_err(|e| io::Error::new(e.kind(), format!("{}: {e}", folder.display())))?;
    Ok(folder.join(name))
}

/// A file that is removed again unless it is renamed.
fn beside(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".selvedge-");
    #[cfg(unix)]
    {
        // as any new file: the permissions that the user's mask allows
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

/// A new file that waits beside its place; it is removed if it never goes there.
pub struct Waiting {
    temporary: tempfile::TempPath,
    place: PathBuf,
}

impl Waiting {
    /// Renames the file over the old one. Its handle writes on.
    pub fn replace(self) -> Result<()> {
        let Self { temporary, place } = self;
        temporary.persist(&place).with_context(|| format!("cannot write {}", place.display()))
    }
}

/// Begins a file beside its place, with the permissions of the old one. A device or a pipe has `None`: it is written
/// where it is.
pub fn begin(path: &Path) -> Result<(File, Option<Waiting>)> {
    let begin = || -> io::Result<(File, Option<Waiting>)> {
        let place = resolved(path)?;
        let found = fs::metadata(&place).ok();
        if found.as_ref().is_some_and(|found| !found.is_file()) {
            return Ok((OpenOptions::new().write(true).open(&place)?, None));
        }
        let (file, temporary) = beside(place.parent().unwrap_or(Path::new(".")))?.into_parts();
        if let Some(found) = found {
            file.set_permissions(found.permissions())?;
        }
        Ok((file, Some(Waiting { temporary, place })))
    };
    begin().with_context(|| format!("cannot write {}", path.display()))
}

/// Lets `fill` write a file, which appears when it is complete; the error of either names the file.
pub fn write(path: &Path, fill: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    if is_standard(path) {
        let mut bytes = Vec::new();
        fill(&mut bytes)?;
        return standard(&bytes);
    }
    let (file, waiting) = begin(path)?;
    filled(file, fill).map(drop).with_context(|| format!("cannot write {}", path.display()))?;
    waiting.map_or(Ok(()), Waiting::replace)
}

/// The file with what `fill` writes to it.
fn filled(file: File, fill: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<File> {
    let mut to = BufWriter::new(file);
    fill(&mut to)?;
    Ok(to.into_inner().map_err(io::IntoInnerError::into_error)?)
}

/// To standard output. A reader that went away (`selvedge info m.step | head`) is no error.
pub fn standard(bytes: &[u8]) -> Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.context("standard output"),
    }
}

/// As [`check`], for the files that were read beside the model, which are known only afterwards.
pub fn check_read(import: &Import, outputs: &[Target]) -> Result<()> {
    let files: Vec<&Path> = import.report.files_read.iter().map(PathBuf::as_path).collect();
    check(&files, outputs)
}

/// Makes the folder of outputs, and checks their places in it, which it returns.
pub fn folder(inputs: &[&Path], folder: &Path, files: impl IntoIterator<Item = (String, Form)>) -> Result<Vec<Target>> {
    if is_standard(folder) {
        bail!("a folder is wanted for several files, and `-` is standard output");
    }
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let files: Vec<_> = files.into_iter().map(|(name, form)| Target::new(folder.join(name), form)).collect();
    check(inputs, &files)?;
    Ok(files)
}

#[cfg(test)]
mod tests;
