//! The scanner: bytes to records in one pass. It never gives up on the rest of a file.
//!
//! A record that cannot be read is skipped: the scan resumes behind the next `;` that is followed
//! by a new statement. It is looked for from the *start* of the bad record, because a quote that is
//! never closed swallows good records. Text seen twice that way is bounded by the file's size; past
//! that the scan resumes at the place of the error. Hence linear time on any input.

use super::{File, Part, Record, Slot, Span, line_of};
use crate::import::{ImportError, Options, Place, Pulse, Stage, Warnings};
use std::collections::HashMap;

/// Deepest nesting of lists. Real files need 5.
const MAX_DEPTH: usize = 64;

/// Bad records that are skipped before a file with fewer good ones is refused.
const PATIENCE: usize = 1000;

/// Bytes of text between two reports of progress.
const PROGRESS_BYTES: usize = 1 << 20;

/// What is wrong with a record.
type Bad = &'static str;

struct Scanner<'a, 'w> {
    bytes: &'a [u8],
    at: usize,
    slots: Vec<Slot>,
    parts: Vec<Part>,
    records: Vec<Record>,
    warnings: &'w mut Warnings,
    bad: usize,
    first_bad: usize,
    /// Bytes scanned a second time after bad records.
    rescanned: usize,
}

#[derive(PartialEq)]
enum Section {
    Outside,
    Header,
    Data,
}

/// Reads all sections; `ISO-10303-21` has been seen.
pub(super) fn scan<'a>(
    bytes: &'a [u8],
    name: &str,
    warnings: &mut Warnings,
    options: &Options<'a>,
) -> Result<File<'a>, ImportError> {
    let mut s = Scanner {
        bytes,
        at: 0,
        slots: Vec::new(),
        parts: Vec::new(),
        records: Vec::new(),
        warnings,
        bad: 0,
        first_bad: 0,
        rescanned: 0,
    };
    let mut header = Vec::new();
    let mut section = Section::Outside;
    let (mut has_data, mut complete) = (false, false);
    let mut scopes: Vec<(u32, usize)> = Vec::new(); // `#id = &SCOPE` still open
    let tell = |read: usize| options.tell(Stage::Records { read: read as u64, bytes: bytes.len() as u64 });
    let mut told = 0;
    tell(0);
    loop {
        s.blanks();
        let start = s.at;
        if start >= told + PROGRESS_BYTES {
            told = start;
            tell(told);
        }
        let Some(&first) = bytes.get(start) else { break };
        let result = match first {
            b'#' if section == Section::Data => s.instance(&mut scopes),
            b'A'..=b'Z' | b'a'..=b'z' | b'!' => match s.keyword().to_ascii_uppercase().as_slice() {
                b"HEADER" => {
                    section = Section::Header;
                    s.semicolon()
                }
                b"DATA" => {
                    (section, has_data) = (Section::Data, true);
                    s.blanks();
                    if s.peek() == b'(' { s.statement_end() } else { s.semicolon() }
                }
                b"ENDSEC" => {
                    section = Section::Outside;
                    s.semicolon()
                }
                b"ENDSCOPE" if section == Section::Data => s.end_scope(&mut scopes),
                b"END-ISO-10303-21" => {
                    complete = true;
                    s.after_end();
                    break;
                }
                _ if section == Section::Header => {
                    s.at = start;
                    s.part(0).and_then(|()| {
                        header.extend(s.parts.pop());
                        s.semicolon()
                    })
                }
                _ if section == Section::Outside => s.statement_end(),
                _ => Err("no record starts here"),
            },
            _ if section == Section::Outside => s.statement_end(),
            _ => Err("no record starts here"),
        };
        if let Err(what) = result {
            s.skip(start, what);
            if s.bad > PATIENCE && s.bad > s.records.len() {
                let line = line_of(bytes, s.first_bad);
                return Err(ImportError::Nonsense {
                    file: name.to_owned(),
                    line,
                    bad: s.bad,
                    seen: s.bad + s.records.len(),
                });
            }
        }
    }
    tell(bytes.len());
    if !has_data {
        return Err(ImportError::NoData { file: name.to_owned(), line: line_of(bytes, bytes.len()) });
    }
    if !complete {
        let end = || Place::Line(line_of(bytes, bytes.len()));
        s.warnings.push("truncated", end, || "the file ends without END-ISO-10303-21".into());
    }
    for (id, offset) in scopes {
        let place = || Place::Entity { id, line: line_of(bytes, offset) };
        s.warnings.push("record skipped", place, || "&SCOPE without ENDSCOPE".into());
    }
    let pulse = Pulse::new(options, Stage::Records { read: bytes.len() as u64, bytes: bytes.len() as u64 });
    Ok(File { bytes, slots: s.slots, parts: s.parts, header, records: s.records, kinds: HashMap::new(), pulse })
}

impl<'a> Scanner<'a, '_> {
    /// Reports what stands behind the end: a second file, or anything but a signature, white space and DOS's mark of
    /// the end.
    fn after_end(&mut self) {
        loop {
            self.blanks();
            if !matches!(self.peek(), b';' | 0x1a) {
                break;
            }
            self.at += 1;
        }
        let (bytes, at) = (self.bytes, self.at);
        let rest = &bytes[at..];
        if rest.is_empty() || rest.starts_with(b"SIGNATURE") {
            return;
        }
        let place = || Place::Line(line_of(bytes, at));
        if rest.windows(5).any(|w| w == b"DATA;") {
            self.warnings.push("second file left out", place, || "it stands behind END-ISO-10303-21".into());
        } else {
            self.warnings.push("text not used", place, || "it stands behind END-ISO-10303-21".into());
        }
    }

    fn peek(&self) -> u8 {
        self.bytes.get(self.at).copied().unwrap_or(0)
    }

    /// Skips white space and comments; a comment that is never closed runs to the end of the file.
    fn blanks(&mut self) {
        loop {
            match self.peek() {
                b' ' | b'\t' | b'\r' | b'\n' | 0x0b | 0x0c => self.at += 1,
                0 if self.at < self.bytes.len() => self.at += 1,
                b'/' if self.bytes[self.at..].starts_with(b"/*") => match self.comment_end() {
                    Some(end) => self.at = end,
                    None => {
                        // nothing after it can be read: the rest of the file is the comment
                        self.at = self.bytes.len();
                        return;
                    }
                },
                _ => return,
            }
        }
    }

    fn comment_end(&self) -> Option<usize> {
        let body = self.at + 2;
        self.bytes[body..].windows(2).position(|w| w == b"*/").map(|p| body + p + 2)
    }

    fn keyword(&mut self) -> &'a [u8] {
        let start = self.at;
        while matches!(self.peek(), b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'_' | b'-' | b'!') {
            self.at += 1;
        }
        &self.bytes[start..self.at]
    }

    fn expect(&mut self, byte: u8, what: Bad) -> Result<(), Bad> {
        self.blanks();
        if self.peek() != byte || self.at >= self.bytes.len() {
            return Err(what);
        }
        self.at += 1;
        Ok(())
    }

    /// `;`, or the start of the next statement: a forgotten `;` costs no record.
    fn semicolon(&mut self) -> Result<(), Bad> {
        self.blanks();
        let rest = &self.bytes[self.at..];
        match rest {
            [b';', ..] => self.at += 1,
            [b'#', b'0'..=b'9', ..] => self.forgotten(),
            _ if rest.starts_with(b"ENDSEC") => self.forgotten(),
            _ => return Err("`;` expected"),
        }
        Ok(())
    }

    fn forgotten(&mut self) {
        let (bytes, at) = (self.bytes, self.at);
        let place = || Place::Line(line_of(bytes, at));
        self.warnings.push("missing `;`", place, || "the statement before it is taken as complete".into());
    }

    /// Skips to behind the next `;` (statements that are ignored).
    fn statement_end(&mut self) -> Result<(), Bad> {
        let rest = &self.bytes[self.at..];
        self.at = rest.iter().position(|&b| b == b';').map_or(self.bytes.len(), |p| self.at + p + 1);
        Ok(())
    }

    /// Reports a bad record and moves behind it.
    fn skip(&mut self, start: usize, what: Bad) {
        if self.bad == 0 {
            self.first_bad = start;
        }
        self.bad += 1;
        let bytes = self.bytes;
        let id = self.bytes[start..].strip_prefix(b"#").and_then(number_prefix);
        let line = || line_of(bytes, start);
        let ended = self.at >= bytes.len();
        let place = || id.map_or_else(|| Place::Line(line()), |id| Place::Entity { id, line: line() });
        let message = || if ended { format!("{what}, and the file ends") } else { what.to_owned() };
        self.warnings.push("record skipped", place, message);
        let seen = self.at.saturating_sub(start);
        let from = if self.rescanned + seen <= bytes.len() {
            self.rescanned += seen;
            start + 1
        } else {
            self.at.max(start + 1)
        };
        self.at = next_statement(bytes, from);
    }

    /// `#id = …;` or `#id = &SCOPE`.
    fn instance(&mut self, scopes: &mut Vec<(u32, usize)>) -> Result<(), Bad> {
        let start = self.at;
        let id = self.reference()?;
        self.expect(b'=', "`=` expected")?;
        self.blanks();
        if self.bytes[self.at..].starts_with(b"&SCOPE") {
            self.at += 6;
            scopes.push((id, start));
            return Ok(());
        }
        self.body(id, start)
    }

    /// Behind ENDSCOPE: the export list, then the record that the scope belongs to.
    fn end_scope(&mut self, scopes: &mut Vec<(u32, usize)>) -> Result<(), Bad> {
        let (id, start) = scopes.pop().ok_or("ENDSCOPE without &SCOPE")?;
        self.blanks();
        if self.peek() == b'/' {
            let rest = &self.bytes[self.at + 1..];
            self.at += 2 + rest.iter().position(|&b| b == b'/').ok_or("the export list is not closed")?;
            self.blanks();
        }
        self.body(id, start)
    }

    /// A simple instance `NAME(…);` or a complex one `(NAME(…) NAME(…));`.
    fn body(&mut self, id: u32, start: usize) -> Result<(), Bad> {
        let (slots, first_part) = (self.slots.len(), self.parts.len());
        let result = self.record_parts().and_then(|()| self.semicolon());
        if result.is_err() {
            self.slots.truncate(slots);
            self.parts.truncate(first_part);
            return result;
        }
        let part_count = (self.parts.len() - first_part) as u32;
        self.records.push(Record { id, offset: start as u32, first_part: first_part as u32, part_count });
        Ok(())
    }

    fn record_parts(&mut self) -> Result<(), Bad> {
        self.blanks();
        if self.peek() != b'(' {
            return self.part(0);
        }
        self.at += 1;
        loop {
            self.blanks();
            match self.peek() {
                b')' => {
                    self.at += 1;
                    return Ok(());
                }
                _ => self.part(1)?,
            }
        }
    }

    /// `NAME(…)`.
    fn part(&mut self, depth: usize) -> Result<(), Bad> {
        let name = self.name()?;
        self.expect(b'(', "`(` expected")?;
        let start = self.slots.len() as u32;
        self.members(depth + 1)?;
        self.parts.push(Part { name, start, end: self.slots.len() as u32 });
        Ok(())
    }

    fn name(&mut self) -> Result<Span, Bad> {
        let start = self.at as u32;
        if self.keyword().is_empty() { Err("a name expected") } else { Ok(Span { start, end: self.at as u32 }) }
    }

    /// Parameters up to and with the closing `)`; commas may trail, and nothing between two is `$`.
    fn members(&mut self, depth: usize) -> Result<(), Bad> {
        if depth > MAX_DEPTH {
            return Err("lists are nested too deep");
        }
        if self.slots.len() >= u32::MAX as usize {
            return Err("too many parameters");
        }
        loop {
            self.blanks();
            match self.peek() {
                b')' => {
                    self.at += 1;
                    return Ok(());
                }
                b',' => self.slots.push(Slot::Omitted),
                _ => self.value(depth)?,
            }
            self.blanks();
            match self.peek() {
                b',' => self.at += 1,
                b')' => {}
                _ => return Err("`,` or `)` expected"),
            }
        }
    }

    fn value(&mut self, depth: usize) -> Result<(), Bad> {
        let start = self.at;
        let slot = match self.peek() {
            b'#' => Slot::Reference(self.reference()?),
            b'\'' => Slot::Text(self.quoted()?),
            b'"' => {
                self.at += 1;
                let rest = &self.bytes[self.at..];
                let length = rest.iter().position(|&b| b == b'"').ok_or("a binary value is not closed")?;
                self.at += length + 1;
                Slot::Text(Span { start: start as u32 + 1, end: self.at as u32 - 1 })
            }
            b'$' => {
                self.at += 1;
                Slot::Omitted
            }
            b'*' => {
                self.at += 1;
                Slot::Derived
            }
            b'.' if !self.bytes.get(start + 1).is_some_and(u8::is_ascii_digit) => {
                self.at += 1;
                self.keyword();
                let span = Span { start: start as u32 + 1, end: self.at as u32 };
                if self.peek() != b'.' {
                    return Err("an enumeration value is not closed");
                }
                self.at += 1;
                Slot::Enumeration(span)
            }
            b'(' => {
                self.at += 1;
                let slot = self.slots.len();
                self.slots.push(Slot::Omitted);
                self.members(depth + 1)?;
                self.slots[slot] = Slot::List { end: self.slots.len() as u32 };
                return Ok(());
            }
            b'+' | b'-' | b'.' | b'0'..=b'9' => self.number()?,
            b'A'..=b'Z' | b'a'..=b'z' | b'!' => return self.typed(depth),
            _ => return Err("a value expected"),
        };
        self.slots.push(slot);
        Ok(())
    }

    /// `NAME(…)` as a parameter. `NaN` and `inf`, which some writers print, are no numbers here either, but the record
    /// stays readable.
    fn typed(&mut self, depth: usize) -> Result<(), Bad> {
        let name = self.name()?;
        let word = &self.bytes[name.start as usize..name.end as usize];
        if word.eq_ignore_ascii_case(b"NAN") || word.eq_ignore_ascii_case(b"INF") {
            self.slots.push(Slot::Real(f64::NAN));
            return Ok(());
        }
        self.expect(b'(', "`(` expected")?;
        let slot = self.slots.len();
        self.slots.push(Slot::Omitted);
        self.members(depth + 1)?;
        self.slots[slot] = Slot::Typed { end: self.slots.len() as u32 };
        Ok(())
    }

    fn reference(&mut self) -> Result<u32, Bad> {
        self.at += 1;
        let id = number_prefix(&self.bytes[self.at..]).ok_or("an instance number from 1 to 4294967295 expected")?;
        while self.peek().is_ascii_digit() {
            self.at += 1;
        }
        Ok(id)
    }

    /// A string, without its quotes; two quotes inside are one.
    fn quoted(&mut self) -> Result<Span, Bad> {
        let start = self.at + 1;
        let mut at = start;
        loop {
            let rest = self.bytes.get(at..).unwrap_or_default();
            let Some(quote) = rest.iter().position(|&b| b == b'\'') else {
                self.at = self.bytes.len();
                return Err("a string is not closed");
            };
            at += quote + 1;
            if self.bytes.get(at) != Some(&b'\'') {
                self.at = at;
                return Ok(Span { start: start as u32, end: at as u32 - 1 });
            }
            at += 1;
        }
    }

    /// An integer or a real. Reals too large for `f64` become infinite and are refused where they
    /// are used.
    fn number(&mut self) -> Result<Slot, Bad> {
        let start = self.at;
        let mut real = false;
        self.at += 1;
        loop {
            match self.peek() {
                b'0'..=b'9' => {}
                b'.' => real = true,
                b'e' | b'E' | b'd' | b'D' => {
                    real = true;
                    if matches!(self.bytes.get(self.at + 1), Some(b'+' | b'-')) {
                        self.at += 1;
                    }
                }
                _ => break,
            }
            self.at += 1;
        }
        let token = std::str::from_utf8(&self.bytes[start..self.at]).unwrap_or_default();
        if !real && let Ok(i) = token.parse() {
            return Ok(Slot::Integer(i));
        }
        let value = token.parse().or_else(|_| token.replace(['d', 'D'], "E").parse());
        value.map(Slot::Real).map_err(|_| "a number cannot be read")
    }
}

/// The instance number at the start of `bytes`; 0 and numbers above `u32` are none.
fn number_prefix(bytes: &[u8]) -> Option<u32> {
    let digits = bytes.iter().take_while(|b| b.is_ascii_digit()).take(20);
    let value = digits.fold(0u64, |v, d| v.saturating_mul(10).saturating_add(u64::from(d - b'0')));
    u32::try_from(value).ok().filter(|&v| v > 0)
}

/// Behind the next `;` that a new statement follows.
fn next_statement(bytes: &[u8], from: usize) -> usize {
    let mut at = from;
    while let Some(p) = bytes.get(at..).and_then(|rest| rest.iter().position(|&b| b == b';')) {
        at += p + 1;
        let blank = bytes[at..].iter().take_while(|b| b.is_ascii_whitespace()).count();
        let rest = &bytes[at + blank..];
        let starts = [&b"#"[..], b"ENDSEC", b"ENDSCOPE", b"END-ISO", b"DATA", b"/*"];
        if rest.is_empty() || starts.iter().any(|s| rest.starts_with(s)) {
            return at;
        }
        at += blank;
    }
    bytes.len()
}
