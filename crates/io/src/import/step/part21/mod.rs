//! ISO 10303-21: the text syntax of STEP files, without the meaning of entities.
//!
//! ```text
//!   #12 = CIRCLE('',#7,2.5);
//!
//!   records [ id 12, offset of `#12`, parts p..p+1 ]          sorted by id: the id index
//!   parts                       [ name "CIRCLE", slots s..s+3 ]
//!   slots                                      [ Text | Reference 7 | Real 2.5 ]
//!
//!   (1.,(2.,3.),$)    slots  [ List→5 | Real 1 | List→4 | Real 2 | Real 3 | Omitted ]    prefix order
//! ```
//!
//! One flat arena of 16-byte slots in prefix order; a list stores its end. Names and strings are spans of the text.
//! Cost: one pass over the bytes; memory at most 8 bytes a byte of text (`$,$,$`), about 2 in real files.
//!
//! Source: ISO 10303-21:2016, clause 6 (tokens), 10 (data section), annex A; edition 1 for `&SCOPE`.

mod scan;
mod text;
mod value;

pub(super) use text::decode;
pub(super) use value::{Value, Values};

use crate::import::{ImportError, Options, Place, Pulse, Stage, Warnings};
use std::collections::HashMap;

/// A range of the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Span {
    start: u32,
    end: u32,
}

/// One parameter, in prefix order.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Slot {
    Integer(i64),
    Real(f64),
    Text(Span),
    Enumeration(Span),
    Reference(u32),
    /// Its members are the slots up to `end`.
    List {
        end: u32,
    },
    /// `NAME(…)`; its parameters are the slots up to `end`.
    Typed {
        end: u32,
    },
    /// `$`
    Omitted,
    /// `*`
    Derived,
}

const _: () = assert!(size_of::<Slot>() == 16);

/// `NAME(…)` of a record; a complex instance has several.
#[derive(Clone, Copy, Debug)]
struct Part {
    name: Span,
    start: u32,
    end: u32,
}

/// `#id = …;`
#[derive(Clone, Copy, Debug)]
pub(super) struct Record {
    /// The instance number.
    pub id: u32,
    offset: u32,
    first_part: u32,
    part_count: u32,
}

/// A parsed file.
#[derive(Debug)]
pub(super) struct File<'a> {
    bytes: &'a [u8],
    slots: Vec<Slot>,
    parts: Vec<Part>,
    header: Vec<Part>,
    records: Vec<Record>,
    /// Indices of `records` by name of each of their parts.
    kinds: HashMap<&'a str, Vec<u32>>,
    /// Of the work on its records.
    pulse: Pulse<'a>,
}

/// Bytes allowed before `ISO-10303-21`: marks of byte order, mail headers.
const PREAMBLE: usize = 4096;

/// The text starts as a STEP file does.
pub(in crate::import) fn recognise(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(PREAMBLE)];
    head.windows(12).any(|w| w.eq_ignore_ascii_case(b"ISO-10303-21"))
}

impl<'a> File<'a> {
    /// For tests: without progress.
    #[cfg(test)]
    pub fn parse(bytes: &'a [u8], name: &str, warnings: &mut Warnings) -> Result<Self, ImportError> {
        Self::parse_telling(bytes, name, warnings, &Options::default())
    }

    /// Parses the text, and reports progress; bad records are skipped with a warning.
    ///
    /// # Errors
    /// [`ImportError`] when the text is not STEP, has no data, or more bad records than good ones.
    pub fn parse_telling(
        bytes: &'a [u8],
        name: &str,
        warnings: &mut Warnings,
        options: &Options<'a>,
    ) -> Result<Self, ImportError> {
        if u32::try_from(bytes.len()).is_err() {
            return Err(ImportError::TooLarge { file: name.to_owned(), limit: u32::MAX.into() });
        }
        if !recognise(bytes) {
            return Err(ImportError::NotStep { file: name.to_owned() });
        }
        let mut file = scan::scan(bytes, name, warnings, options)?;
        if !file.records.is_sorted_by(|a, b| a.id < b.id) {
            file.records.sort_by_key(|r| r.id);
            let mut repeated = Vec::new();
            file.records.dedup_by(|later, first| {
                let same = later.id == first.id;
                if same {
                    repeated.push((later.id, later.offset));
                }
                same
            });
            for (id, offset) in repeated {
                let place = || Place::Entity { id, line: line_of(bytes, offset as usize) };
                warnings.push("number used twice", place, || "the first record counts".into());
            }
        }
        for (index, record) in file.records.iter().enumerate() {
            file.pulse.work(1);
            for part in &file.parts[record.first_part as usize..][..record.part_count as usize] {
                file.kinds.entry(name_at(bytes, part.name)).or_default().push(index as u32);
            }
        }
        Ok(file)
    }

    /// Tells the next stage of work on the records.
    pub fn tell(&self, stage: Stage) {
        self.pulse.tell(stage);
    }

    /// So much work was done that looked up no record.
    pub fn work(&self, amount: usize) {
        self.pulse.work(amount);
    }

    /// The record `#id`. Whatever a file costs is a multiple of the records that are looked up.
    pub fn record(&self, id: u32) -> Option<&Record> {
        self.pulse.work(1);
        // most files number their records without gaps
        let guess = self.records.first().and_then(|first| id.checked_sub(first.id))? as usize;
        if let Some(record) = self.records.get(guess).filter(|r| r.id == id) {
            return Some(record);
        }
        self.records.binary_search_by_key(&id, |r| r.id).ok().map(|i| &self.records[i])
    }

    /// The names that occur.
    pub fn kinds(&self) -> impl Iterator<Item = &'a str> + '_ {
        self.kinds.keys().copied()
    }

    /// Numbers of the records with a part of this name, ascending.
    pub fn of_kind(&self, kind: &str) -> impl ExactSizeIterator<Item = u32> + '_ {
        self.kinds.get(kind).map_or(&[][..], Vec::as_slice).iter().map(|&i| self.records[i as usize].id)
    }

    /// Names and parameters of a record's parts.
    pub fn parts(&self, record: &Record) -> impl ExactSizeIterator<Item = (&'a str, Values<'_>)> + '_ {
        self.parts[record.first_part as usize..][..record.part_count as usize].iter().map(|p| self.part(p))
    }

    /// Parameters of a header entity.
    pub fn header(&self, name: &str) -> Option<Values<'_>> {
        self.header.iter().map(|p| self.part(p)).find(|(n, _)| *n == name).map(|(_, values)| values)
    }

    /// Line on which a record starts, counted from 1. Cost: one pass over the text before it.
    pub fn line(&self, record: &Record) -> usize {
        line_of(self.bytes, record.offset as usize)
    }

    /// Keeps what places need and frees the rest, most of the memory.
    pub fn into_places(self) -> Places<'a> {
        Places { bytes: self.bytes, records: self.records }
    }

    /// Parameters in the whole file: a measure of its content.
    pub fn slot_count(&self) -> usize {
        self.slots.len()
    }

    fn part(&self, part: &Part) -> (&'a str, Values<'_>) {
        (name_at(self.bytes, part.name), Values::new(self, part.start, part.end))
    }
}

/// Where the records of a file stand.
#[derive(Debug)]
pub(super) struct Places<'a> {
    bytes: &'a [u8],
    records: Vec<Record>,
}

impl Places<'_> {
    /// Number and line of `#id`. Cost: one pass over the text before it.
    pub fn of(&self, id: u32) -> Place {
        let found = self.records.binary_search_by_key(&id, |r| r.id);
        let line = |i: usize| line_of(self.bytes, self.records[i].offset as usize);
        found.map_or(Place::File, |i| Place::Entity { id, line: line(i) })
    }
}

/// Names are ASCII: the scanner accepts nothing else.
fn name_at(bytes: &[u8], span: Span) -> &str {
    std::str::from_utf8(&bytes[span.start as usize..span.end as usize]).unwrap_or_default()
}

/// Line of a byte offset, counted from 1.
fn line_of(bytes: &[u8], offset: usize) -> usize {
    1 + bytes[..offset.min(bytes.len())].iter().filter(|&&b| b == b'\n').count()
}

#[cfg(test)]
mod tests;
