//! Files on a disk, by the names that other files give them.
//!
//! ```text
//!   "D:\\proj\\parts\\Bolt.stp"   file:///proj/parts/Bolt%20M4.stp   Bolt
//!      parts/Bolt.stp, Bolt.stp  ─▶ beside the file that says so, then below the folders to search
//! ```
//!
//! A name's own folders are tried, then fewer of them: files are moved together, but seldom with their drive. Names differ
//! in upper and lower case where they come from Windows; the same case wins. `..` and roots are never followed: a
//! file can name only what lies beside it or below, and what the caller has searched.

use super::Files;
use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

/// Files beside the one that names them, and below other folders.
#[derive(Debug, Default)]
pub struct Folders {
    search: Vec<PathBuf>,
    below: OnceLock<Listing>,
    beside: Mutex<HashMap<PathBuf, Listing>>,
}

/// Files by their names in lower case.
type Listing = HashMap<String, Vec<PathBuf>>;

/// What may stand behind a file's name that the name leaves out: compressed files, and STEP files.
const ENDINGS: [&str; 6] = ["", ".gz", "z", ".stp", ".step", ".stpz"];

impl Folders {
    /// Looks beside the file that names another one, then below each of `search`, in this order.
    pub fn new(search: Vec<PathBuf>) -> Self {
        Self { search, ..Self::default() }
    }

    fn beside(&self, folder: &Path, file: &str) -> Option<PathBuf> {
        let mut known = self.beside.lock().unwrap_or_else(PoisonError::into_inner);
        let listing = known.entry(folder.to_owned()).or_insert_with(|| {
            let mut listing = Listing::new();
            list(folder, &mut listing);
            listing
        });
        best(listing, file, |path| path.file_name().is_some_and(|n| n == file))
    }

    fn below(&self, tail: &Path, file: &str) -> Option<PathBuf> {
        let listing = self.below.get_or_init(|| {
            let mut listing = Listing::new();
            let mut open: Vec<PathBuf> = self.search.iter().rev().cloned().collect();
            while let Some(folder) = open.pop() {
                open.extend(list(&folder, &mut listing).into_iter().rev());
            }
            listing
        });
        best(listing, file, |path| path.ends_with(tail))
    }
}

impl Files for Folders {
    fn find(&self, name: &str, from: &str) -> Option<String> {
        let steps = steps(name);
        let (file, folders) = steps.split_last()?;
        let here = Path::new(from).parent().unwrap_or(Path::new(""));
        let here = if here.as_os_str().is_empty() { Path::new(".") } else { here };
        let found = ENDINGS.iter().find_map(|ending| {
            let file = format!("{file}{ending}");
            let beside = (0..=folders.len()).find_map(|skip| {
                let folder = folders[skip..].iter().fold(here.to_owned(), |path, step| path.join(step));
                self.beside(&folder, &file)
            });
            beside.or_else(|| self.below(&folders.iter().collect::<PathBuf>().join(&file), &file))
        })?;
        let own = found.canonicalize().unwrap_or(found);
        Some(own.to_string_lossy().into_owned())
    }

    fn read(&self, found: &str, most: u64) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        File::open(found)?.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
        Ok(bytes)
    }
}

/// The path of the same case, else the first that fits, else the first.
fn best(listing: &Listing, file: &str, fits: impl Fn(&Path) -> bool) -> Option<PathBuf> {
    let all = listing.get(&file.to_lowercase())?;
    let named = |path: &&PathBuf| path.file_name().is_some_and(|n| n == file);
    let first = all.iter().find(|path| fits(path)).or_else(|| all.iter().find(named)).or(all.first());
    first.cloned()
}

/// Adds the files of a folder in the order of their names, and returns its folders; links to folders are not followed.
fn list(folder: &Path, listing: &mut Listing) -> Vec<PathBuf> {
    let mut all: Vec<_> = std::fs::read_dir(folder).into_iter().flatten().flatten().collect();
    all.sort_by_key(std::fs::DirEntry::file_name);
    let mut folders = Vec::new();
    for entry in all {
        let path = entry.path();
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            folders.push(path);
        } else if path.is_file() {
            let name = entry.file_name().to_string_lossy().to_lowercase();
            listing.entry(name).or_default().push(path);
        }
    }
    folders
}

/// The folders and the file of a name, without what leads out of a folder.
fn steps(name: &str) -> Vec<String> {
    let name = name.trim();
    let url = name.get(..5).is_some_and(|begin| begin.eq_ignore_ascii_case("file:"));
    let name = if url { unescaped(&name[5..]) } else { name.to_owned() };
    let mut steps: Vec<String> = Vec::new();
    for step in name.split(['/', '\\']).map(str::trim) {
        match step {
            "" | "." => {}
            ".." => steps.clear(),
            drive if drive.len() == 2 && drive.ends_with(':') => steps.clear(),
            step => steps.push(step.to_owned()),
        }
    }
    steps
}

/// `%20` and its like undone.
fn unescaped(url: &str) -> String {
    let bytes = url.as_bytes();
    let (mut out, mut at) = (Vec::new(), 0);
    while let Some(&byte) = bytes.get(at) {
        let escape = bytes.get(at + 1..at + 3).and_then(|digits| std::str::from_utf8(digits).ok());
        match escape.and_then(|digits| u8::from_str_radix(digits, 16).ok()).filter(|_| byte == b'%') {
            Some(value) => (out.push(value), at += 3),
            None => (out.push(byte), at += 1),
        };
    }
    String::from_utf8_lossy(&out).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_every_kind() {
        for (name, path) in [
            ("a.stp", "a.stp"),
            ("parts/a.stp", "parts/a.stp"),
            ("D:\\proj\\a.stp", "proj/a.stp"),
            ("/etc/a.stp", "etc/a.stp"),
            ("../../parts/./a.stp", "parts/a.stp"),
            ("file:///c%3A/my%20parts/a.stp", "my parts/a.stp"),
            ("file:a%zz.stp", "a%zz.stp"),
            ("..", ""),
            ("", ""),
        ] {
            assert_eq!(steps(name).join("/"), path, "{name}");
        }
    }

    #[test]
    fn beside_first_then_below_then_without_folders() {
        let root = std::env::temp_dir().join(format!("selvedge-folders-{}", std::process::id()));
        let put = |path: &str| {
            let path = root.join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, path_bytes()).unwrap();
        };
        fn path_bytes() -> &'static [u8] {
            b"x"
        }
        for path in [
            "here/main.stp",
            "here/Bolt.stp",
            "here/sub/nut.STP",
            "away/x/bolt.stp",
            "away/y/pin.stp.gz",
            "away/z/pin.stp",
            "away/z/rod.stpz",
        ] {
            put(path);
        }
        let folders = Folders::new(vec![root.join("away")]);
        let main = root.join("here/main.stp").display().to_string();
        let found = |name: &str| {
            let own = folders.find(name, &main)?;
            let path = Path::new(&own).strip_prefix(root.canonicalize().unwrap()).unwrap().to_owned();
            Some(path.display().to_string().replace('\\', "/"))
        };
        for (name, path) in [
            ("Bolt.stp", Some("here/Bolt.stp")),
            ("BOLT.STP", Some("here/Bolt.stp")),
            ("x/bolt.stp", Some("here/Bolt.stp")),
            ("sub\\nut.stp", Some("here/sub/nut.STP")),
            ("C:\\old\\sub\\nut.stp", Some("here/sub/nut.STP")),
            ("nut.stp", None),
            ("pin.stp", Some("away/z/pin.stp")),
            ("rod", Some("away/z/rod.stpz")),
            ("rod.stp", Some("away/z/rod.stpz")),
            ("../main.stp", Some("here/main.stp")),
            ("gone.stp", None),
        ] {
            assert_eq!(found(name).as_deref(), path, "{name}");
        }
        // as much as shows that it is too long
        std::fs::write(&main, [7; 100]).unwrap();
        for (most, length) in [(0, 1), (99, 100), (100, 100), (u64::MAX, 100)] {
            assert_eq!(folders.read(&main, most).unwrap(), vec![7; length], "{most}");
        }
        std::fs::remove_dir_all(&root).unwrap();
    }
}
