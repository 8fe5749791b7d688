//! Models in several files: parts that stand in other files.
//!
//! ```text
//!   assembly.stp ──mentions──▶ "bolt.stp", places ──Files::find──▶ the file's own name ──Files::read──▶ bytes
//!        │                                                              │
//!        └── parts, instances ◀── each place of each file ◀── read once ┘  mentions of its own, and so on
//! ```
//!
//! The library opens no file by itself: the caller's [`Files`] find and read them, [`Folders`] on a disk. A file that
//! is not found, cannot be read or contains itself is left out with a warning that names it.

use super::guard::MAX_INSTANCES;
use super::{Import, ImportError, Options, Place, Warnings};
use crate::model::{Colour, Instance, Model, Primitive, Solid, SolidError};
use glam::DAffine3;
use std::collections::HashMap;
use std::path::Path;

mod folders;

pub use folders::Folders;

/// Where the files are that other files name.
pub trait Files: Sync {
    /// The file that `from` calls `name`, by a name that is the same for the same file; `None` if there is none.
    fn find(&self, name: &str, from: &str) -> Option<String>;

    /// The bytes of a file that was found; they may be compressed by gzip. A file of more than `most` bytes is refused:
    /// one byte more than `most` suffices.
    ///
    /// # Errors
    /// What the file system says.
    fn read(&self, found: &str, most: u64) -> std::io::Result<Vec<u8>>;
}

/// A part that stands in another file.
#[derive(Debug)]
pub(super) struct Mention {
    /// Where the file names it.
    pub at: Place,
    /// Documents that hold the same shape; of each the names worth trying, the best first.
    pub documents: Vec<Vec<String>>,
    /// Where it stands in this file, which colour it has there, and the names of the occurrences.
    pub stands: Vec<(DAffine3, Option<Colour>, String)>,
}

/// A file's own content, and its mentions of other files.
pub(super) type Read = (Import, Vec<Mention>);

const NOT_FOLLOWED: &str = "external file not followed";
const NOT_READ: &str = "external file not read";
const LEFT_OUT: &str = "external file left out";

/// Deepest nesting of files.
const MAX_LEVELS: usize = 64;

/// One file of the model.
struct Loaded {
    name: String,
    mentions: Vec<Mention>,
    /// For each mention the file that it means.
    files: Vec<Option<usize>>,
    instances: Vec<Instance>,
    solids: Vec<Solid>,
    warnings: Warnings,
}

/// How a file's bytes are read.
pub(super) type Reader<'r> = &'r dyn Fn(Vec<u8>, &str) -> Result<Read, ImportError>;

/// All files of a model.
struct Library<'r> {
    options: Options<'r>,
    read: Reader<'r>,
    all: Vec<Loaded>,
    /// By their own names; none for those that cannot be read.
    known: HashMap<String, Option<usize>>,
    import: Import,
}

/// Reads the files that `first` mentions, and those that they mention, and puts them in their places.
pub(super) fn follow((mut import, mentions): Read, name: &str, options: &Options<'_>, read: Reader<'_>) -> Import {
    if mentions.is_empty() {
        return import;
    }
    let first = Loaded::new(name, &mut import.model, mentions);
    let bare = Path::new(name).file_name().map_or(name.into(), |n| n.to_string_lossy());
    let own = options.files.and_then(|files| files.find(&bare, name));
    let known = own.into_iter().map(|own| (own, Some(0))).collect();
    let mut library = Library { options: *options, read, all: vec![first], known, import };
    let mut next = 0;
    while next < library.all.len() {
        library.load_mentions(next);
        next += 1;
    }
    library.finish()
}

impl Loaded {
    fn new(name: &str, model: &mut Model, mentions: Vec<Mention>) -> Self {
        Self {
            name: name.to_owned(),
            mentions,
            files: Vec::new(),
            instances: std::mem::take(&mut model.instances),
            solids: std::mem::take(&mut model.solids),
            warnings: Warnings::new(name),
        }
    }
}

impl Library<'_> {
    fn load_mentions(&mut self, index: usize) {
        let from = self.all[index].name.clone();
        for nth in 0..self.all[index].mentions.len() {
            self.options.preview(|| self.so_far());
            let Mention { at, documents, .. } = &self.all[index].mentions[nth];
            let (at, documents) = (*at, documents.clone());
            let named = documents.iter().filter_map(|names| names.first());
            self.import.report.external_files.extend(named.clone().cloned());
            let found = self.load(&documents, &from);
            if let Err(why) = &found {
                self.import.report.missing_files.extend(named.cloned());
                for (kind, message) in why {
                    self.all[index].warnings.push(kind, || at, || message.clone());
                }
            }
            self.all[index].files.push(found.ok());
        }
    }

    /// The parts of all files that are read, in their places.
    fn so_far(&self) -> Model {
        let mut model = self.import.model.clone();
        Places::put_all(&self.all, &mut model);
        model
    }

    /// The first of the documents that can be read; else why each cannot.
    fn load(&mut self, documents: &[Vec<String>], from: &str) -> Result<usize, Vec<(&'static str, String)>> {
        let mut why = Vec::new();
        for names in documents {
            let named = names.first().map_or("", String::as_str);
            let Some(finder) = self.options.files else {
                why.push((NOT_FOLLOWED, named.to_owned()));
                continue;
            };
            let Some(own) = names.iter().find_map(|name| finder.find(name, from)) else {
                why.push((NOT_READ, format!("{named} is not found")));
                continue;
            };
            match self.known.get(&own) {
                Some(Some(index)) => return Ok(*index),
                Some(None) => {
                    why.push((NOT_READ, format!("{named} cannot be read")));
                    continue;
                }
                None => {}
            }
            let bytes = finder
                .read(&own, self.options.most_bytes())
                .map_err(|source| ImportError::Read { file: own.clone(), source });
            match bytes.and_then(|bytes| (self.read)(bytes, &own)) {
                Ok(read) => return Ok(self.add(own, read)),
                Err(error) => {
                    why.push((NOT_READ, error.to_string()));
                    self.known.insert(own, None);
                }
            }
        }
        Err(why)
    }

    fn add(&mut self, own: String, (mut other, mentions): Read) -> usize {
        let (index, shift) = (self.all.len(), self.import.model.parts.len());
        other.model.instances.iter_mut().for_each(|i| i.part += shift);
        self.all.push(Loaded::new(&own, &mut other.model, mentions));
        self.import.report.files_read.push(own.clone().into());
        self.known.insert(own, Some(index));
        self.import.model.parts.append(&mut other.model.parts);
        self.import.warnings.append(&mut other.warnings);
        self.import.report.absorb(other.report, shift);
        index
    }

    /// Places every file in those that mention it.
    fn finish(self) -> Import {
        let Self { mut all, mut import, .. } = self;
        for (file, at, message) in Places::put_all(&all, &mut import.model) {
            all[file].warnings.push(LEFT_OUT, || at, || message);
        }
        for file in all {
            import.warnings.append(&mut file.warnings.finish(&mut import.report));
        }
        let names = import.model.instances.iter().map(|i| i.name.clone());
        import.report.occurrences = names.filter(|name| !name.is_empty()).collect();
        import.model.unit = import.report.units.join(", ");
        import
    }
}

/// The walk from file to file.
struct Places<'p> {
    all: &'p [Loaded],
    model: &'p mut Model,
    visits: usize,
    faults: Vec<Misplaced>,
}

/// A file, where in it, and what is wrong there.
type Misplaced = (usize, Place, String);

impl<'p> Places<'p> {
    /// Places all files as the first one says. Files that are not read yet are left out.
    fn put_all(all: &'p [Loaded], model: &'p mut Model) -> Vec<Misplaced> {
        let mut places = Self { all, model, visits: 0, faults: Vec::new() };
        places.put(0, &(DAffine3::IDENTITY, None, String::new()), &mut Vec::new());
        places.faults
    }

    fn full(&self) -> bool {
        self.visits > MAX_INSTANCES || self.model.instances.len() + self.model.solids.len() > MAX_INSTANCES
    }

    fn put(&mut self, file: usize, stand: &(DAffine3, Option<Colour>, String), trail: &mut Vec<usize>) {
        self.visits += 1;
        let (transform, colour, name) = stand;
        let Loaded { instances, solids, mentions, files, .. } = &self.all[file];
        self.model.instances.extend(instances.iter().map(|i| Instance {
            part: i.part,
            transform: *transform * i.transform,
            colour: colour.or(i.colour),
            name: joined(name, &i.name),
        }));
        for solid in solids {
            match moved(solid, *transform, *colour) {
                Ok(solid) => self.model.solids.push(solid),
                Err(error) => self.faults.push((file, Place::File, format!("a Boolean solid: {error}"))),
            }
        }
        trail.push(file);
        for (mention, of) in mentions.iter().zip(files) {
            let Some(of) = *of else { continue };
            let fault = match () {
                () if trail.contains(&of) => format!("{} contains itself", self.all[of].name),
                () if trail.len() >= MAX_LEVELS => format!("{} is nested too deep", self.all[of].name),
                () => String::new(),
            };
            for (place, own, below) in &mention.stands {
                if fault.is_empty() && !self.full() {
                    self.put(of, &(*transform * *place, colour.or(*own), joined(name, below)), trail);
                    continue;
                }
                let told = format!("{} is one of more than {MAX_INSTANCES} instances", self.all[of].name);
                self.faults.push((file, mention.at, if fault.is_empty() { told } else { fault }));
                break;
            }
        }
        trail.pop();
    }
}

fn moved(solid: &Solid, transform: DAffine3, colour: Option<Colour>) -> Result<Solid, SolidError> {
    let moved = |p: &Primitive| Primitive {
        transform: transform * p.transform,
        colour: colour.unwrap_or(p.colour),
        ..p.clone()
    };
    Solid::new(solid.primitives().iter().map(moved).collect(), solid.tree().clone())
}

fn joined(outer: &str, inner: &str) -> String {
    match (outer, inner) {
        ("", name) | (name, "") => name.to_owned(),
        _ => format!("{outer}/{inner}"),
    }
}

#[cfg(test)]
mod tests;
