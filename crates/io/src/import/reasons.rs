//! Counts of messages by their text: messages that differ in numbers only are counted as one.
//!
//! ```text
//!   #3: edge #7 lies 2.1e-4 mm off   ┐
//!   #9: edge #12 lies 3.0e-2 mm off  ┴─▶  2 x edge … lies … mm off
//!   a radius of 0 or more            ┐
//!   a radius of 0 or more            ┴─▶  2 x a radius of 0 or more
//! ```

use serde::{Serialize, Serializer};
use std::collections::BTreeMap;

/// Replaces numbers that differ.
const OTHERS: &str = "…";

/// Letters of the ending of a file's name, at most.
const LONGEST_ENDING: usize = 8;

/// How often each message was given.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reasons {
    /// By the words with [`OTHERS`] in place of every number: the words that all such messages share, and how many
    /// messages there were.
    said: BTreeMap<String, (Vec<String>, usize)>,
}

impl Reasons {
    /// Counts a message. Its subject, which ends in a number and a colon as in `face #3: `, is ignored.
    pub fn add(&mut self, message: &str) {
        self.add_words(words(message), 1);
    }

    /// Counts all that others have counted.
    pub fn extend(&mut self, others: &Self) {
        others.said.values().for_each(|(words, count)| self.add_words(words.clone(), *count));
    }

    fn add_words(&mut self, words: Vec<String>, more: usize) {
        let key: Vec<&str> = words.iter().map(|word| if is_number(word) { OTHERS } else { word }).collect();
        let (shared, count) = self.said.entry(key.join(" ")).or_insert_with(|| (words.clone(), 0));
        *count += more;
        let differ = shared.iter_mut().zip(&words).filter(|(shared, word)| **shared != **word);
        differ.for_each(|(shared, _)| OTHERS.clone_into(shared));
    }

    /// Each message, with the numbers that are the same in all of its kind, and how often it was given.
    pub fn iter(&self) -> impl Iterator<Item = (String, usize)> + '_ {
        self.said.values().map(|(words, count)| {
            let text = words.join(" ");
            (text.trim_end_matches(['.', ',', ':', ';']).to_owned(), *count)
        })
    }

    /// How many messages there were.
    #[must_use]
    pub fn total(&self) -> usize {
        self.said.values().map(|(_, count)| count).sum()
    }

    /// There was none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.said.is_empty()
    }
}

impl Serialize for Reasons {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_map(self.iter())
    }
}

/// The words after the subject of a message.
fn words(message: &str) -> Vec<String> {
    let mut words = Vec::new();
    for word in message.split_whitespace() {
        if is_number(word) && word.ends_with(':') {
            words.clear();
        } else {
            words.push(word.to_owned());
        }
    }
    words
}

fn is_number(word: &str) -> bool {
    word == OTHERS || (word.contains(|c: char| c.is_ascii_digit()) && !is_file(word))
}

/// Whether a word is a file's name by its ending: such names are kept, whatever digits they have.
fn is_file(word: &str) -> bool {
    let word = word.trim_end_matches(['.', ',', ':', ';']);
    let ending = word.rsplit_once('.').map_or("", |(_, ending)| ending);
    let is_ending = ending.starts_with(|c: char| c.is_ascii_alphabetic())
        && ending.len() <= LONGEST_ENDING
        && ending.chars().all(|c| c.is_ascii_alphanumeric());
    is_ending && word.parse::<f64>().is_err()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(messages: &[&str]) -> Vec<(String, usize)> {
        let mut reasons = Reasons::default();
        messages.iter().for_each(|message| reasons.add(message));
        assert_eq!(reasons.total(), messages.len());
        reasons.iter().collect()
    }

    #[test]
    fn numbers_stay_where_they_are_the_same() {
        let cone = "a cone needs a radius of 0 or more and an angle below 90 degrees";
        assert_eq!(said(&[cone, cone]), [(cone.to_owned(), 2)]);
        assert_eq!(said(&["#12: the radius is 0"]), [("the radius is 0".to_owned(), 1)]);
        let edges = ["face #3: edge #7 lies 2.1e-4 mm off", "face #9: edge #12 lies 3.0e-2 mm off"];
        assert_eq!(said(&edges), [("edge … lies … mm off".to_owned(), 2)]);
        assert_eq!(said(&["2 of 4 sides", "3 of 4 sides", "2 of 4 sides"]), [("… of 4 sides".to_owned(), 3)]);
        assert_eq!(said(&["no loop", "no area"]).len(), 2);
    }

    #[test]
    fn names_of_files_are_kept() {
        let one = "surface: example010.dat: no such file";
        let other = "surface: example011.dat: no such file";
        assert_eq!(said(&[one, other, one]), [(one.to_owned(), 2), (other.to_owned(), 1)]);
        assert_eq!(said(&["a1.stp, at 1.e3 mm", "a1.stp, at 2.5 mm"]), [("a1.stp, at … mm".to_owned(), 2)]);
    }

    #[test]
    fn counts_of_several_files_add_up() {
        let (mut all, mut other) = (Reasons::default(), Reasons::default());
        all.add("off by 1 mm");
        other.add("off by 2 mm");
        other.add("off by 3 mm");
        other.add("empty");
        all.extend(&other);
        assert_eq!(all.iter().collect::<Vec<_>>(), [("empty".to_owned(), 1), ("off by … mm".to_owned(), 3)]);
        assert_eq!(serde_json::to_string(&all).unwrap(), r#"{"empty":1,"off by … mm":3}"#);
    }
}
