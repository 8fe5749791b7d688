//! For the readers' property tests: random damage of a text.

use crate::import::Import;
use proptest::prelude::*;
use std::ops::Range;

/// A kind of damage at a place; places and numbers are taken modulo what there is.
#[derive(Clone, Debug)]
pub(in crate::import) enum Damage {
    /// A byte becomes another one.
    Byte(usize, u8),
    /// The text ends.
    Truncate(usize),
    /// So many bytes go.
    Remove(usize, usize),
    /// So many bytes stand twice.
    Repeat(usize, usize),
    /// The n-th number becomes a word.
    Number(usize, String),
    /// The n-th reference, or number, becomes a reference.
    Reference(usize, u32),
}

impl Damage {
    /// Damages the text.
    pub(in crate::import) fn apply(&self, text: &mut Vec<u8>) {
        let len = text.len().max(1);
        let range = |at: usize, count: usize| -> Range<usize> {
            (at % len).min(text.len())..(at % len + count).min(text.len())
        };
        match *self {
            Self::Byte(at, byte) => {
                if let Some(b) = text.get_mut(at % len) {
                    *b = byte;
                }
            }
            Self::Truncate(at) => text.truncate(at % len),
            Self::Remove(at, count) => drop(text.drain(range(at, count))),
            Self::Repeat(at, count) => {
                let piece = text[range(at, count)].to_vec();
                let start = range(at, 0);
                text.splice(start, piece).for_each(drop);
            }
            Self::Number(n, ref with) => replace(text, n, |b| b.is_ascii_digit() || b"+-.E".contains(&b), with),
            Self::Reference(n, id) => replace(text, n, |b| b.is_ascii_digit() || b == b'#', &format!("#{id}")),
        }
    }
}

/// Replaces the n-th run of bytes that `is` holds for.
fn replace(text: &mut Vec<u8>, n: usize, is: impl Fn(u8) -> bool, with: &str) {
    let starts: Vec<usize> = (1..text.len()).filter(|&i| is(text[i]) && !is(text[i - 1])).collect();
    let Some(&start) = starts.get(n % starts.len().max(1)) else { return };
    let end = text[start..].iter().position(|&b| !is(b)).map_or(text.len(), |p| start + p);
    text.splice(start..end, with.bytes()).for_each(drop);
}

/// Damage of a format: `marks` are the bytes that have a meaning in it, `words` take the place of numbers.
/// References are damaged where there are some: up to the number `references`.
pub(in crate::import) fn damage(
    marks: &'static [u8],
    words: &[&str],
    references: Option<u32>,
) -> impl Strategy<Value = Damage> + use<> {
    let words: Vec<String> = words.iter().map(|w| (*w).to_owned()).collect();
    let number = (any::<usize>(), prop::sample::select(words)).prop_map(|(n, w)| Damage::Number(n, w));
    let reference = match references {
        Some(end) => (any::<usize>(), 1..end).prop_map(|(n, id)| Damage::Reference(n, id)).boxed(),
        None => number.clone().boxed(),
    };
    prop_oneof![
        1 => (any::<usize>(), any::<u8>()).prop_map(|(a, b)| Damage::Byte(a, b)),
        1 => (any::<usize>(), prop::sample::select(marks)).prop_map(|(a, b)| Damage::Byte(a, b)),
        1 => any::<usize>().prop_map(Damage::Truncate),
        1 => (any::<usize>(), 1usize..90).prop_map(|(a, n)| Damage::Remove(a, n)),
        1 => (any::<usize>(), 1usize..200).prop_map(|(a, n)| Damage::Repeat(a, n)),
        1 => number,
        2 => reference,
    ]
}

/// What holds of every import, whatever the text was: instances place parts that exist, each face is drawn or counted as
/// dropped, and warnings do not grow with the damage.
pub(in crate::import) fn assert_sound(import: &Import) {
    let (model, report) = (&import.model, &import.report);
    assert!(model.instances.iter().all(|i| i.part < model.parts.len() && i.transform.is_finite()));
    assert!(import.warnings.len() < 300, "{} warnings", import.warnings.len());
    assert_eq!(report.faces - model.face_count(), report.dropped.total(), "{report:?}");
}
