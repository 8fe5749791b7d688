//! A file as entries and one arena of parameter values.
//!
//! ```text
//!   lines ──▶ cards by section ──▶ global section ─▶ delimiters, units
//!                              ──▶ directory      ─▶ entries, ordered by number
//!                              ──▶ parameters     ─▶ one text, few arenas; entry.values is a range of entry.arena
//! ```
//!
//! Entries that claim one another's parameter cards could make the arena larger than any multiple of
//! the file: reading stops at four times the text.

use super::card::{Card, DATA, Section, TEXT, parts};
use super::directory::{self, Entry};
use super::global::Global;
use super::value::{Value, record};
use crate::import::text::Encoding;
use crate::import::{ImportError, Place, Pulse, Warnings};
use rayon::prelude::*;

/// The file.
#[derive(Debug)]
pub(super) struct File {
    /// Global section.
    pub global: Global,
    /// In increasing order of their numbers.
    pub entries: Vec<Entry>,
    /// Of strings that are not UTF-8; columns and lengths count bytes.
    pub encoding: Encoding,
    text: Vec<u8>,
    /// The values of the entries: each arena those that one thread has read.
    arenas: Vec<Vec<Value>>,
    value_count: usize,
}

/// Where the parameters of an entry stand.
#[derive(Debug)]
struct Span {
    /// Of the entry.
    index: usize,
    /// Of its first parameter card.
    line: u32,
    /// In the text.
    range: (usize, usize),
    /// In its arena.
    values: (usize, usize),
    /// Where the record ended.
    stop: Option<usize>,
}

/// Records that one thread reads at a time.
const RECORDS: usize = 16;

/// Cards whose text one thread copies at a time.
const SHARE: usize = 4096;

/// Bytes of an average parameter, at least: what an arena makes room for.
const BYTES: usize = 6;

/// How often the parameter section may be read on average.
const SHARING: usize = 4;

impl File {
    /// Reads cards. A line is one piece of work, and so is a parameter.
    ///
    /// # Errors
    /// [`ImportError::NoDirectory`] when there is no entity at all, [`ImportError::Nonsense`] when most
    /// lines are not cards.
    pub fn parse(bytes: &[u8], name: &str, warnings: &mut Warnings, pulse: &Pulse<'_>) -> Result<Self, ImportError> {
        let (mut global, mut entries, mut parameters) = (Vec::new(), Vec::new(), Vec::new());
        let (mut terminate, mut bad, mut seen, mut global_line, mut last_line) = (None, 0, 0, 1, 1);
        let parts = parts(bytes, pulse);
        parameters.reserve(parts.iter().map(|p| p.parameters.len()).sum());
        let mut before = 0;
        for mut part in parts {
            for (line, seen_there) in part.bad {
                let (line, seen) = ((before + line) as usize, seen + seen_there);
                bad += 1;
                warnings.push("card skipped", || Place::Line(line), || "no section letter in column 73".into());
                if bad >= 1000 && 2 * bad > seen {
                    return Err(ImportError::Nonsense { file: name.to_owned(), line, bad, seen });
                }
            }
            for (card, line) in part.others {
                let number = before + line;
                if card.section == Section::Terminate {
                    terminate = Some((card.text, number));
                    continue;
                }
                if global.is_empty() {
                    global_line = number;
                }
                global.extend_from_slice(card.text);
                global.resize(global.len() + TEXT.saturating_sub(card.text.len()), b' ');
            }
            entries.extend(part.directory.into_iter().map(|(card, line)| (card, before + line)));
            part.parameters.iter_mut().for_each(|card| card.1 += before);
            parameters.append(&mut part.parameters);
            if part.seen > 0 {
                last_line = before + part.last;
            }
            seen += part.seen;
            before += part.lines;
        }
        if entries.is_empty() {
            return Err(ImportError::NoDirectory { file: name.to_owned(), line: last_line as usize });
        }
        check_counts(terminate, (entries.len(), parameters.len()), last_line, warnings);
        let encoding = Encoding::of(bytes);
        let global = Global::read(&global, encoding, global_line as usize, warnings);
        let entries = directory::read(&entries, encoding, warnings);
        let mut file = Self { global, entries, encoding, text: Vec::new(), arenas: Vec::new(), value_count: 0 };
        file.read_parameters(&parameters, warnings, pulse);
        Ok(file)
    }

    fn read_parameters(&mut self, cards: &[(Card<'_>, u32)], warnings: &mut Warnings, pulse: &Pulse<'_>) {
        // number and start of each card; the end of the text behind the last
        let (mut starts, mut end): (Vec<(u32, usize)>, _) = (Vec::with_capacity(cards.len()), 0);
        for (card, _) in cards {
            let number = card.sequence.unwrap_or(starts.last().map_or(1, |s| s.0 + 1));
            starts.push((number, end));
            end += card.text.len().max(DATA);
        }
        self.text = vec![0; end];
        let mut rest = &mut self.text[..];
        let own = |cards: &[(Card<'_>, u32)]| cards.iter().map(|(card, _)| card.text.len().max(DATA)).sum();
        let shares = cards.chunks(SHARE).map(|cards| {
            let (text, behind) = std::mem::take(&mut rest).split_at_mut(own(cards));
            rest = behind;
            (cards, text)
        });
        shares.collect::<Vec<_>>().into_par_iter().for_each(|(cards, mut text)| {
            for (card, _) in cards {
                let (columns, behind) = std::mem::take(&mut text).split_at_mut(card.text.len().max(DATA));
                let (written, blank) = columns.split_at_mut(card.text.len());
                written.copy_from_slice(card.text);
                blank.fill(b' ');
                text = behind;
            }
        });
        if !starts.is_sorted_by(|a, b| a.0 < b.0) {
            let line = cards.first().map_or(0, |c| c.1 as usize);
            warnings.push("parameter cards renumbered", || Place::Line(line), || "their numbers do not rise".into());
            starts.iter_mut().zip(1..).for_each(|(s, n)| s.0 = n);
        }
        let mut spans = self.spans(cards, &starts, warnings);
        // in order and side by side: what a record holds depends on nothing but its cards
        let (text, delimiters) = (&self.text, self.global.delimiters);
        let read = |spans: &mut [Span]| {
            let bytes: usize = spans.iter().map(|s| s.range.1 - s.range.0).sum();
            let mut values = Vec::with_capacity(bytes / BYTES);
            for span in spans {
                span.values.0 = values.len();
                span.stop = record(text, span.range, delimiters, &mut values);
                span.values.1 = values.len();
            }
            pulse.work(values.len());
            values
        };
        let chunks: Vec<Vec<Value>> = spans.par_chunks_mut(RECORDS).map(read).collect();
        for (arena, (spans, values)) in spans.chunks(RECORDS).zip(&chunks).enumerate() {
            for span in spans {
                self.take(span, (arena, &values[span.values.0..span.values.1]), warnings);
            }
        }
        self.arenas = chunks;
    }

    /// Where each entry's parameters stand: no more in all than [`SHARING`] allows.
    fn spans(&self, cards: &[(Card<'_>, u32)], starts: &[(u32, usize)], warnings: &mut Warnings) -> Vec<Span> {
        let mut spans = Vec::with_capacity(self.entries.len());
        for (index, entry) in self.entries.iter().enumerate() {
            let Ok(card) = starts.binary_search_by_key(&entry.first, |s| s.0) else {
                let (first, place) = (entry.first, || Place::Entity { id: entry.id, line: entry.line as usize });
                warnings.push("entity without parameters", place, || format!("card P{first} does not exist"));
                continue;
            };
            let start = starts[card].1;
            let end = match entry.cards as usize {
                0 => self.text.len(),
                n => starts.get(card.saturating_add(n)).map_or(self.text.len(), |s| s.1),
            };
            spans.push(Span { index, line: cards[card].1, range: (start, end), values: (0, 0), stop: None });
        }
        let claimed = spans.iter().fold(0usize, |sum, s| sum.saturating_add(s.range.1 - s.range.0));
        if claimed <= SHARING * self.text.len() {
            return spans;
        }
        // where entries claim each other's cards, the ends of their records count
        let (mut left, mut values) = (SHARING * self.text.len(), Vec::new());
        spans.retain_mut(|span| {
            if left == 0 {
                let place = || Place::Entity { id: self.entries[span.index].id, line: span.line as usize };
                warnings.push("entity without parameters", place, || "cards are shared too often".into());
                return false;
            }
            let (start, end) = span.range;
            span.range.1 = end.min(start.saturating_add(left));
            values.clear();
            let stop = record(&self.text, span.range, self.global.delimiters, &mut values);
            left -= stop.unwrap_or(span.range.1) - start;
            true
        });
        spans
    }

    /// Gives an entry the values of its record, which an arena holds.
    fn take(&mut self, span: &Span, (arena, own): (usize, &[Value]), warnings: &mut Warnings) {
        let entry = &mut self.entries[span.index];
        let (id, line) = (entry.id, span.line as usize);
        let place = || Place::Entity { id, line };
        if span.stop.is_none() {
            warnings.push("record without end", place, || "no record delimiter on its cards".into());
        }
        match own.first() {
            Some(Value::Number(kind)) if *kind == f64::from(entry.kind) => {
                self.value_count += own.len();
                entry.arena = arena as u32;
                entry.values = (span.values.0 as u32, span.values.1 as u32);
                entry.line = span.line;
            }
            other => {
                let (other, kind) = (other.copied(), entry.kind);
                let found = match other {
                    Some(Value::Number(x)) => format!("type {x}"),
                    _ => "no type".into(),
                };
                let message = move || format!("its parameters are of {found}, not of type {kind}");
                warnings.push("entity without parameters", place, message);
            }
        }
    }

    /// The entry `#id`.
    pub fn entry(&self, id: u32) -> Option<&Entry> {
        self.entries.binary_search_by_key(&id, |e| e.id).ok().map(|i| &self.entries[i])
    }

    /// The parameters of an entry, its type first.
    pub fn values(&self, entry: &Entry) -> &[Value] {
        self.arenas.get(entry.arena as usize).map_or(&[], |a| &a[entry.values.0 as usize..entry.values.1 as usize])
    }

    /// The bytes of a string.
    pub fn text(&self, value: Value) -> Option<&[u8]> {
        match value {
            Value::Text(a, b) | Value::Bad(a, b) => self.text.get(a as usize..b as usize),
            _ => None,
        }
    }

    /// All parameter values.
    pub fn value_count(&self) -> usize {
        self.value_count
    }
}

/// Compares the terminate section, `S      1G      4D    530P   4821`, with what was found.
fn check_counts(card: Option<(&[u8], u32)>, found: (usize, usize), last: u32, warnings: &mut Warnings) {
    let Some((text, line)) = card else {
        warnings.push("file cut short", || Place::Line(last as usize), || "there is no terminate section".into());
        return;
    };
    let count = |field: usize, letter: u8| {
        let field = text.get(8 * field..8 * field + 8)?;
        (field[0] == letter).then(|| super::card::number(&field[1..])).flatten()
    };
    for (name, stated, found) in [("directory", count(2, b'D'), found.0), ("parameter", count(3, b'P'), found.1)] {
        if let Some(stated) = stated.filter(|n| *n as usize != found) {
            let message = || format!("{found} of {stated} {name} cards were found");
            warnings.push("cards missing", || Place::Line(line as usize), message);
        }
    }
}
