//! Directory entries: two cards of ten fields, eight columns each.
//!
//! ```text
//!        1        9       17       25       33       41       49       57       65      73
//!   │ type   │ params │ struct │ line   │ level  │ view   │ matrix │ label  │ status │ D  n │
//!   │ type   │ weight │ colour │ cards  │ form   │        │        │ name   │ subscr │ D n+1│
//!                                                       status: blank, subordinate, use, hierarchy
//! ```
//!
//! An entity's number is that of its first card, always odd.

use super::card::Card;
use crate::import::text::Encoding;
use crate::import::{Place, Warnings};

/// One entity's entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Entry {
    /// Number of its first card.
    pub id: u32,
    /// Entity type: 144 is a trimmed surface.
    pub kind: u16,
    /// Form of that type.
    pub form: i32,
    /// Number of its first parameter card.
    pub first: u32,
    /// Its parameter cards; 0 when it does not say.
    pub cards: u32,
    /// Level, or 0.
    pub level: i32,
    /// Transformation matrix, or 0.
    pub matrix: u32,
    /// Not shown.
    pub blank: bool,
    /// Subordinate to another entity, which contains it.
    pub dependent: bool,
    /// What it is for: 0 geometry, 1 annotation, 2 definition, 5 in a parameter plane.
    pub purpose: u8,
    /// A standard colour, or the negative of a colour definition.
    pub colour: i32,
    /// Name and number.
    pub label: String,
    /// Line of its first card.
    pub line: u32,
    /// Which arena holds its parameters.
    pub arena: u32,
    /// Its parameters in that.
    pub values: (u32, u32),
}

/// Pairs up the cards; an unreadable entry is left out, with a warning.
pub(super) fn read(cards: &[(Card<'_>, u32)], encoding: Encoding, warnings: &mut Warnings) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::with_capacity(cards.len() / 2);
    let mut at = 0;
    let mut number = 0;
    while at < cards.len() {
        let (card, line) = &cards[at];
        number = card.sequence.unwrap_or(number + 1);
        let place = || Place::Line(*line as usize);
        if number % 2 == 0 {
            warnings.push("directory entry left out", place, || format!("card {number} has none before it"));
            at += 1;
            continue;
        }
        let second = cards.get(at + 1).filter(|c| c.0.sequence.is_none_or(|n| n == number + 1));
        let Some((second, _)) = second else {
            warnings.push("directory entry left out", place, || format!("#{number} has one card instead of two"));
            at += 1;
            continue;
        };
        at += 2;
        match entry(number, (card.text, second.text), encoding, *line) {
            Ok(entry) if entries.last().is_some_and(|last| last.id >= entry.id) => {
                warnings.push("directory entry left out", place, || format!("#{number} comes again or too late"));
            }
            Ok(entry) => entries.push(entry),
            Err(what) => warnings.push("directory entry left out", place, || format!("#{number}: {what}")),
        }
        number += 1;
    }
    entries
}

fn entry(id: u32, (first, second): (&[u8], &[u8]), encoding: Encoding, line: u32) -> Result<Entry, String> {
    let field = |card: &[u8], index: usize| -> String {
        let (a, b) = (8 * index, 8 * index + 8);
        encoding.decode(&card[a.min(card.len())..b.min(card.len())]).trim().to_owned()
    };
    let integer = |card: &[u8], index: usize, name: &str| match field(card, index).as_str() {
        "" => Ok(0),
        text => text.parse::<i32>().map_err(|_| format!("its {name} {text:?} is not an integer")),
    };
    let positive = |card: &[u8], index: usize, name: &str| {
        u32::try_from(integer(card, index, name)?).map_err(|_| format!("its {name} is negative"))
    };
    let kind = integer(first, 0, "type")?;
    let kind = u16::try_from(kind).ok().filter(|k| *k > 0).ok_or_else(|| format!("type {kind} does not exist"))?;
    // eight digits, blanks for zeros
    let status: Vec<u8> = (0..8).map(|i| first.get(64 + i).map_or(0, |b| b.saturating_sub(b'0').min(9))).collect();
    let number = field(second, 8);
    let label = field(second, 7);
    Ok(Entry {
        id,
        kind,
        form: integer(second, 4, "form")?,
        first: positive(first, 1, "parameter pointer")?,
        cards: positive(second, 3, "number of cards")?,
        level: integer(first, 4, "level")?,
        matrix: positive(first, 6, "matrix pointer")?,
        blank: status[1] == 1,
        dependent: matches!(status[3], 1 | 3),
        purpose: 10 * status[4] + status[5],
        colour: integer(second, 2, "colour")?,
        label: if label.is_empty() || number.is_empty() || number == "0" { label } else { format!("{label}:{number}") },
        line,
        arena: 0,
        values: (0, 0),
    })
}
