//! The bytes of files and streams: bounded, gzip undone.

use super::{Files, ImportError, Options, Pulse, Stage};
use rayon::prelude::*;
use std::fs::{self, File, Metadata};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Component, Path, PathBuf};

/// A gzip stream may expand by this factor at most. STEP text shrinks 4 to 12 times; deflate itself
/// cannot exceed 1032.
const MAX_EXPANSION: u64 = 100;

/// Expansion that is always allowed, whatever the factor.
const FREE_EXPANSION: u64 = 1 << 20;

/// How much of a stream is read before its format must be recognised: no format begins later.
const BEGINNING: u64 = 1 << 20;

/// Where other files stand that a file names, and how much of one is read.
#[derive(Clone, Copy)]
pub(super) struct OtherFiles<'a> {
    /// The file that names them.
    name: &'a str,
    /// Its folder, if it has one.
    pub folder: Option<&'a Path>,
    /// Searches other folders for files that are not in that one; `None` for a stream, which has no folder.
    finder: Option<&'a dyn Files>,
    /// Bytes of one of them, at most.
    most: u64,
    /// Those of the file that names them.
    options: Options<'a>,
}

impl<'a> OtherFiles<'a> {
    pub fn new(name: &'a str, folder: Option<&'a Path>, options: &Options<'a>) -> Self {
        let finder = options.files.filter(|_| folder.is_some());
        Self { name, folder, finder, most: options.most_bytes(), options: *options }
    }

    /// Of the work on this file's own bytes, so many.
    pub fn parsing(&self, bytes: usize) -> Pulse<'a> {
        Pulse::new(&self.options, Stage::Parse { bytes: bytes as u64 })
    }

    /// Path and bytes of the file that this one calls `name`, at most `most` of them. It lies in the folder or below
    /// it, or where the finder looks: a file that somebody sends opens no other files.
    ///
    /// # Errors
    /// The reason in words.
    pub fn open(&self, name: &str, most: u64) -> Result<(PathBuf, Vec<u8>), String> {
        let folder = self.folder.ok_or("the model was not read from a folder")?;
        let most = most.min(self.most);
        let own = name.replace('\\', "/");
        let inside = |c| matches!(c, Component::Normal(_) | Component::CurDir);
        let is_inside = !own.is_empty() && Path::new(&own).components().all(inside);
        let path = folder.join(&own);
        if is_inside && path.exists() {
            return beside(&path, most).map(|bytes| (path, bytes));
        }
        if let Some(finder) = self.finder
            && let Some(found) = finder.find(name, self.name)
        {
            let bytes = finder.read(&found, most).map_err(|e| e.to_string())?;
            return if bytes.len() as u64 > most { Err(too_long(most)) } else { Ok((found.into(), bytes)) };
        }
        if is_inside { beside(&path, most).map(|bytes| (path, bytes)) } else { Err(OUTSIDE.to_owned()) }
    }
}

/// Why a file is not opened that may exist.
const OUTSIDE: &str = "not beside the model, nor below a folder that is searched";

fn too_long(most: u64) -> String {
    format!("larger than {most} bytes, the most that is read")
}

/// The bytes of a file, gzip undone.
pub(super) fn load(path: &Path, name: &str, options: &Options<'_>) -> Result<Vec<u8>, ImportError> {
    let unreadable = |source| ImportError::Read { file: name.to_owned(), source };
    let found = fs::metadata(path).map_err(unreadable)?;
    if let Some(what) = no_file(path, &found) {
        return Err(ImportError::NoFile { file: name.to_owned(), what });
    }
    let (size, limit) = (found.len(), options.most_bytes());
    if size > limit {
        return Err(ImportError::TooLarge { file: name.to_owned(), limit });
    }
    let tell = || options.tell(Stage::Read { bytes: size });
    tell();
    if found.is_file() && size > 0 {
        return inflated(read_apart(path, size as usize, &tell).map_err(unreadable)?, name, limit, &tell);
    }
    // a pipe that the shell has opened, or a file of a system that states no size
    drain(&mut File::open(path).map_err(unreadable)?, name, limit, |_| true)
}

/// The bytes of a stream, gzip undone. `known` decides from the beginning, gzip undone, whether the rest is worth
/// reading.
pub(super) fn drain(
    stream: &mut dyn Read,
    name: &str,
    limit: u64,
    known: impl FnOnce(&[u8]) -> bool,
) -> Result<Vec<u8>, ImportError> {
    let unreadable = |source| ImportError::Read { file: name.to_owned(), source };
    let mut bytes = Vec::new();
    stream.take(BEGINNING.min(limit + 1)).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 == BEGINNING {
        let gzip = is_gzip(&bytes);
        if !gzip && !known(&bytes) {
            return Err(ImportError::Format { file: name.to_owned() });
        }
        stream.take(limit + 1 - BEGINNING.min(limit)).read_to_end(&mut bytes).map_err(unreadable)?;
    }
    inflated(bytes, name, limit, &|| ())
}

/// The bytes of a file beside the model, at most so many.
///
/// # Errors
/// The reason in words.
pub(super) fn beside(path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let found = fs::metadata(path).map_err(|e| e.to_string())?;
    if let Some(what) = no_file(path, &found) {
        return Err(what.to_owned());
    }
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(most + 1).read_to_end(&mut bytes)).map_err(|e| e.to_string())?;
    if bytes.len() as u64 > most { Err(too_long(most)) } else { Ok(bytes) }
}

/// Why a path is no file to read: a folder, a device, a socket, or a named pipe that may have no writer.
fn no_file(path: &Path, found: &Metadata) -> Option<&'static str> {
    if found.is_dir() {
        return Some("a folder, not a file");
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        let kind = found.file_type();
        if kind.is_char_device() || kind.is_block_device() {
            return Some("a device, not a file");
        }
        if kind.is_socket() {
            return Some("a socket, not a file");
        }
        // shells make links of pipes that are being written to
        if kind.is_fifo() && fs::symlink_metadata(path).is_ok_and(|named| named.file_type().is_fifo()) {
            return Some("a named pipe, to which nobody may be writing");
        }
    }
    None
}

/// Bytes that are read or decompressed at a time.
const SHARE: usize = 1 << 20;

/// A file's first `size` bytes, by several threads: the system takes about as long to map the memory as to copy the
/// bytes. `tell` is called before each share but the first, and may unwind.
fn read_apart(path: &Path, size: usize, tell: &(dyn Fn() + Sync)) -> io::Result<Vec<u8>> {
    let mut bytes = vec![0; size];
    bytes.par_chunks_mut(SHARE).enumerate().try_for_each(|(k, share)| {
        if k > 0 {
            tell();
        }
        let mut file = File::open(path)?;
        file.seek(SeekFrom::Start((k * SHARE) as u64))?;
        file.read_exact(share)
    })?;
    Ok(bytes)
}

fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

/// Undoes gzip, if the bytes are compressed. `limit` bounds the bytes before and after, [`MAX_EXPANSION`] their
/// expansion. `tell` is called after each share, and may unwind.
pub(super) fn inflated(
    bytes: Vec<u8>,
    name: &str,
    limit: u64,
    tell: &(dyn Fn() + Sync),
) -> Result<Vec<u8>, ImportError> {
    if bytes.len() as u64 > limit {
        return Err(ImportError::TooLarge { file: name.to_owned(), limit });
    }
    if !is_gzip(&bytes) {
        return Ok(bytes);
    }
    let limit = (bytes.len() as u64 * MAX_EXPANSION + FREE_EXPANSION).min(limit);
    let mut text = Vec::new();
    let mut stream = flate2::read::MultiGzDecoder::new(bytes.as_slice()).take(limit + 1);
    loop {
        let more = stream.by_ref().take(SHARE as u64).read_to_end(&mut text);
        let damaged = |e: io::Error| io::Error::new(e.kind(), format!("gzip data that are cut off or damaged: {e}"));
        if more.map_err(damaged).map_err(|source| ImportError::Read { file: name.to_owned(), source })? == 0 {
            break;
        }
        tell();
    }
    if text.len() as u64 > limit {
        return Err(ImportError::Expansion { file: name.to_owned(), limit });
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;
    use std::sync::atomic::{AtomicUsize, Ordering};

    const ALL: u64 = u32::MAX as u64;

    fn gzip(text: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        encoder.write_all(text).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn gzip_round_trip() {
        let text = b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n";
        assert_eq!(inflated(gzip(text), "a.stpz", ALL, &|| ()).unwrap(), text);
    }

    #[test]
    fn gzip_bomb_is_an_error() {
        let bomb = gzip(&vec![b' '; 1 << 24]);
        let inflated = |bytes, limit| inflated(bytes, "b.gz", limit, &|| ());
        assert!(matches!(inflated(bomb, ALL), Err(ImportError::Expansion { .. })));
        assert!(matches!(inflated(vec![b' '; 11], 10), Err(ImportError::TooLarge { limit: 10, .. })));
        let whole = gzip(b"ISO-10303-21;");
        let cut = inflated(whole[..whole.len() - 10].to_vec(), ALL).unwrap_err().to_string();
        assert!(cut.starts_with("b.gz: gzip data that are cut off or damaged: "), "{cut}");
        // less than a bomb, but more than the limit
        assert!(matches!(inflated(gzip(&[b' '; 5000]), 4000), Err(ImportError::Expansion { limit: 4000, .. })));
    }

    /// Noise, which does not shrink.
    #[test]
    fn a_share_is_decompressed_between_two_calls() {
        let noise =
            (0..3 * SHARE as u32 / 4 + 5).flat_map(|i| i.wrapping_mul(0x9e37_79b9).rotate_left(i % 31).to_le_bytes());
        let text: Vec<u8> = noise.collect();
        let told = AtomicUsize::new(0);
        let count = || _ = told.fetch_add(1, Ordering::Relaxed);
        assert!(inflated(gzip(&text), "n.gz", ALL, &count).unwrap() == text);
        assert_eq!(told.into_inner(), 4, "three whole shares and the rest");
    }

    /// Files of no share, of one, and of several that do not fill the last.
    #[test]
    fn files_are_read_whole() {
        let path = std::env::temp_dir().join(format!("selvedge-read-{}", std::process::id()));
        for size in [0usize, 1, 1 << 20, (3 << 20) + 17] {
            let written: Vec<u8> = (0..size).map(|i| (i ^ i >> 8 ^ i >> 16) as u8).collect();
            fs::write(&path, &written).unwrap();
            let told = AtomicUsize::new(0);
            let count = |_: Stage| _ = told.fetch_add(1, Ordering::Relaxed);
            let read = load(&path, "read", &Options { progress: Some(&count), ..Options::default() }).unwrap();
            assert_eq!(told.into_inner(), size.div_ceil(SHARE).max(1), "{size} bytes");
            assert!(read == written, "{size} bytes");
            let drained = drain(&mut written.as_slice(), "read", ALL, |_| true).unwrap();
            assert!(drained == written, "{size} bytes");
            let less = Options { most_bytes: Some(size as u64 / 2), ..Options::default() };
            assert_eq!(load(&path, "read", &less).is_err(), size > 0, "{size} bytes");
            assert_eq!(beside(&path, size as u64 / 2).is_err(), size > 0, "{size} bytes");
        }
        fs::remove_file(&path).unwrap();
    }

    /// A stream without an end: no format is recognised in it, or it exceeds the limit.
    #[test]
    fn endless_streams_end() {
        let endless = || io::repeat(b' ');
        assert!(matches!(drain(&mut endless(), "-", ALL, |_| false), Err(ImportError::Format { .. })));
        let most = (2 << 20) + 1;
        for limit in [0, 100, BEGINNING - 1, BEGINNING, BEGINNING + 1, most] {
            let error = drain(&mut endless(), "-", limit, |_| true).unwrap_err();
            assert!(matches!(error, ImportError::TooLarge { limit: told, .. } if told == limit), "{error}");
            let whole = drain(&mut endless().take(limit), "-", limit, |_| true).unwrap();
            assert_eq!(whole.len() as u64, limit);
        }
    }

    #[test]
    fn folders_and_devices_are_no_files() {
        let told = |path: &str| load(Path::new(path), path, &Options::default()).unwrap_err().to_string();
        assert_eq!(told("."), ".: a folder, not a file");
        assert_eq!(beside(Path::new("."), 1), Err("a folder, not a file".to_owned()));
        #[cfg(target_os = "linux")]
        assert_eq!(told("/dev/zero"), "/dev/zero: a device, not a file");
    }
}
