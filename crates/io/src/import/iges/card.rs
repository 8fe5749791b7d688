//! Cards: 80 columns, the section's letter in column 73, a number in columns 74 to 80.
//!
//! ```text
//!   1                                                              64  66    72 73 74   80
//!   ┌─────────────────────────────────────────────────────────────────┬───────┬──┬────────┐
//!   │ 144,5,1,0,17;                                                   │     19│P │      49│
//!   └─────────────────────────────────────────────────────────────────┴───────┴──┴────────┘
//!     text; of parameter cards columns 1 to 64 only           entity     S G D P T
//! ```
//!
//! Lines may end in LF, CR LF or CR, may be longer than 80 columns, and need not end at all: then every
//! 80 bytes are a card. Characters outside ASCII count as one column each where that finds the letter.

use crate::import::Pulse;
use rayon::prelude::*;

/// What the letter in column 73 says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Section {
    Start,
    Global,
    Directory,
    Parameter,
    Terminate,
}

/// One card.
#[derive(Clone, Copy, Debug)]
pub(super) struct Card<'a> {
    /// Columns 1 to 72, or 1 to 64 of a parameter card, without the line's end.
    pub text: &'a [u8],
    /// Its section.
    pub section: Section,
    /// Columns 74 to 80, when they are a number.
    pub sequence: Option<u32>,
}

/// The two forms of the standard that are not cards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Fixed,
    Compressed,
    Binary,
}

/// Columns of a card.
const WIDTH: usize = 80;

/// Bytes that one thread reads at a time: a multiple of a card's.
const PART: usize = 80 << 12;

/// Columns of a card's text.
pub(super) const TEXT: usize = 72;

/// Columns of a parameter card that hold parameters.
pub(super) const DATA: usize = 64;

/// Whether the bytes begin like IGES, and in which form.
pub(super) fn recognise(bytes: &[u8]) -> Option<Form> {
    let first = lines(&bytes[..bytes.len().min(4096)]).find(|l| !l.iter().all(u8::is_ascii_whitespace))?;
    let (text, letter, rest) = columns(first)?;
    let numbered = |b: &[u8]| number(b).is_some();
    match letter {
        b'S' | b'G' if numbered(rest) => Some(Form::Fixed),
        b'C' if numbered(rest) && text.iter().all(|b| b.is_ascii()) => Some(Form::Compressed),
        b'B' if numbered(rest) && text.iter().all(|b| b.is_ascii()) => Some(Form::Binary),
        _ => None,
    }
}

/// Whether the lines have ends; else pieces of 80 bytes are lines.
fn have_ends(bytes: &[u8]) -> bool {
    bytes[..bytes.len().min(400)].iter().any(|b| is_end(*b))
}

fn is_end(b: u8) -> bool {
    b == b'\n' || b == b'\r'
}

/// The lines, without their ends; pieces of 80 bytes in a file that has none.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    lines_of(bytes, have_ends(bytes))
}

fn lines_of(bytes: &[u8], ended: bool) -> impl Iterator<Item = &[u8]> {
    let mut rest = bytes;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        if !ended {
            let (line, after) = rest.split_at(rest.len().min(WIDTH));
            rest = after;
            return Some(line);
        }
        let end = match rest.get(..=WIDTH) {
            Some(line) if is_end(line[WIDTH]) && !line[..WIDTH].iter().fold(false, |any, b| any | is_end(*b)) => WIDTH,
            _ => rest.iter().position(|b| is_end(*b)).unwrap_or(rest.len()),
        };
        let line = &rest[..end];
        let skip = match rest[end..] {
            [b'\r', b'\n', ..] => 2,
            [] => 0,
            _ => 1,
        };
        rest = &rest[end + skip..];
        Some(line)
    })
}

/// What one thread finds in its part of a file. Lines are counted from the part's first, which is 1.
#[derive(Debug, Default)]
pub(super) struct Part<'a> {
    /// Cards of the directory and of the parameters, with their lines.
    pub directory: Vec<(Card<'a>, u32)>,
    pub parameters: Vec<(Card<'a>, u32)>,
    /// Those of the sections global and terminate.
    pub others: Vec<(Card<'a>, u32)>,
    /// Lines that are no cards, with how many lines that are not blank there were up to them.
    pub bad: Vec<(u32, usize)>,
    /// Lines that are not blank.
    pub seen: usize,
    /// The last of them.
    pub last: u32,
    /// All lines.
    pub lines: u32,
}

/// The parts of a file, in order, each read by itself. A line is one piece of work.
pub(super) fn parts<'b>(bytes: &'b [u8], pulse: &Pulse<'_>) -> Vec<Part<'b>> {
    let ended = have_ends(bytes);
    let mut pieces = Vec::with_capacity(bytes.len() / PART + 1);
    let mut rest = bytes;
    while rest.len() > PART {
        let between = |at: usize| is_end(rest[at - 1]) && !(rest[at - 1] == b'\r' && rest[at] == b'\n');
        let at = if ended { (PART..rest.len()).find(|at| between(*at)) } else { Some(PART) };
        let (piece, after) = rest.split_at(at.unwrap_or(rest.len()));
        pieces.push(piece);
        rest = after;
    }
    pieces.push(rest);
    let read = |piece| {
        let part = Part::read(piece, ended);
        pulse.work(part.lines as usize);
        part
    };
    pieces.into_par_iter().map(read).collect()
}

impl<'a> Part<'a> {
    fn read(bytes: &'a [u8], ended: bool) -> Self {
        let mut part = Self::default();
        part.parameters.reserve(bytes.len() / WIDTH);
        for line in lines_of(bytes, ended) {
            part.lines += 1;
            if line.iter().all(u8::is_ascii_whitespace) {
                continue;
            }
            (part.seen, part.last) = (part.seen + 1, part.lines);
            let Some(card) = Card::of_line(line) else {
                part.bad.push((part.lines, part.seen));
                continue;
            };
            match card.section {
                Section::Start => {}
                Section::Directory => part.directory.push((card, part.lines)),
                Section::Parameter => part.parameters.push((card, part.lines)),
                Section::Global | Section::Terminate => part.others.push((card, part.lines)),
            }
        }
        part
    }
}

impl<'a> Card<'a> {
    /// A line as a card; `None` when no section's letter is in its column.
    pub fn of_line(line: &'a [u8]) -> Option<Self> {
        let (text, letter, rest) = columns(line)?;
        let section = section(letter)?;
        let text = if section == Section::Parameter { &text[..column(text, DATA)] } else { text };
        Some(Self { text, section, sequence: number(rest) })
    }
}

fn section(letter: u8) -> Option<Section> {
    Some(match letter {
        b'S' => Section::Start,
        b'G' => Section::Global,
        b'D' => Section::Directory,
        b'P' => Section::Parameter,
        b'T' => Section::Terminate,
        _ => return None,
    })
}

/// Text, letter, and what follows it.
fn columns(line: &[u8]) -> Option<(&[u8], u8, &[u8])> {
    let sound = |at: usize| {
        let letter = *line.get(at)?;
        let rest = &line[at + 1..(at + 8).min(line.len())];
        let fits = rest.iter().all(|b| b.is_ascii_digit() || *b == b' ');
        (fits && (section(letter).is_some() || matches!(letter, b'C' | b'B'))).then_some((&line[..at], letter, rest))
    };
    sound(TEXT).or_else(|| sound(column(line, TEXT)))
}

/// Byte offset of a column, UTF-8 continuation bytes not counted.
fn column(line: &[u8], column: usize) -> usize {
    if line.get(..column).is_some_and(<[u8]>::is_ascii) {
        return column;
    }
    let mut starts = (0..line.len()).filter(|&i| line[i] & 0xc0 != 0x80);
    starts.nth(column).unwrap_or(line.len())
}

/// A right or left justified number of at most ten digits.
pub(super) fn number(field: &[u8]) -> Option<u32> {
    let digits = field.trim_ascii();
    if digits.is_empty() || digits.len() > 10 || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    u32::try_from(digits.iter().fold(0, |sum, b| 10 * sum + u64::from(b - b'0'))).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::{Options, Stage};

    fn card(text: &str, tail: &str) -> String {
        format!("{text:<72}{tail}")
    }

    #[test]
    fn line_ends_of_every_kind() {
        let all = |text: &str| lines(text.as_bytes()).map(<[u8]>::len).collect::<Vec<_>>();
        assert_eq!(all("ab\r\nc\n\rde"), [2, 1, 0, 2]);
        // two lines that are as long as a card together
        assert_eq!(all(&format!("{}\n{}\n", "a".repeat(39), "b".repeat(40))), [39, 40]);
        let cards = format!("{}{}", card("a", "S      1"), card("b", "G      1"));
        assert_eq!(all(&cards), [80, 80]);
    }

    /// Texts of cards, with their lines.
    type Texts = Vec<(Vec<u8>, u32)>;

    /// What is read in parts is what one thread would read, wherever the parts end.
    #[test]
    fn parts_make_the_whole() {
        let cards = (1..=2 * PART / 80).map(|n| match n % 9 {
            0 => "no card".to_owned(),
            1 => " ".repeat(80),
            2 => card("12, 0", &format!("D{n:>7}")),
            3 => card("", &format!("G{n:>7}")),
            _ => card("116,1.,2.,3.;", &format!("P{n:>7}")),
        });
        let cards: Vec<String> = cards.collect();
        let whole: String = cards.iter().map(|c| format!("{c:<80}")).collect();
        for (text, ended) in
            [(cards.join("\n"), true), (cards.join("\r\n"), true), (cards.join("\r"), true), (whole, false)]
        {
            let pulse = Pulse::new(&Options::default(), Stage::Parse { bytes: 0 });
            let (all, one) = (parts(text.as_bytes(), &pulse), Part::read(text.as_bytes(), ended));
            assert!(all.len() > 1);
            let before = |i: usize| all[..i].iter().map(|p| p.lines).sum::<u32>();
            let joined = |list: fn(&Part<'_>) -> Texts| {
                let own =
                    |(i, p)| list(p).into_iter().map(move |(text, line)| (text, line + before(i))).collect::<Vec<_>>();
                all.iter().enumerate().flat_map(own).collect::<Vec<_>>()
            };
            for list in [
                |p: &Part<'_>| p.directory.iter().map(|(c, line)| (c.text.to_vec(), *line)).collect::<Vec<_>>(),
                |p: &Part<'_>| p.parameters.iter().map(|(c, line)| (c.text.to_vec(), *line)).collect(),
                |p: &Part<'_>| p.others.iter().map(|(c, line)| (c.text.to_vec(), *line)).collect(),
                |p: &Part<'_>| p.bad.iter().map(|(line, _)| (Vec::new(), *line)).collect(),
            ] {
                assert!(list(&one).len() > 100 && joined(list) == list(&one));
            }
            assert_eq!(all.iter().map(|p| p.seen).sum::<usize>(), one.seen);
            assert_eq!(before(all.len()), one.lines);
        }
    }

    #[test]
    fn characters_outside_ascii_are_one_column() {
        let line = card("Stück, größer", "S      7");
        let found = Card::of_line(line.as_bytes()).unwrap();
        assert_eq!((found.section, found.sequence), (Section::Start, Some(7)));
        // Latin-1: one byte a character, so the bytes are the columns
        let mut latin = card("St?ck", "S      7").into_bytes();
        latin[2] = 0xfc;
        assert_eq!(Card::of_line(&latin).unwrap().text.len(), 72);
    }

    #[test]
    fn forms_are_distinguished() {
        assert_eq!(recognise(card("", "S0000001").as_bytes()), Some(Form::Fixed));
        assert_eq!(recognise(card("", "C      1").as_bytes()), Some(Form::Compressed));
        assert_eq!(recognise(card("", "B      1").as_bytes()), Some(Form::Binary));
        assert_eq!(recognise(b"ISO-10303-21;\nHEADER;\n"), None);
        assert_eq!(recognise(b""), None);
        assert_eq!(recognise(card("words that go on and on past the column", "Sailing!").as_bytes()), None);
    }
}
