//! For the readers' tests: one change of a good text, one message, word for word.

pub(super) mod random;

use super::{Import, ImportError};
use std::fmt::Debug;

/// The kind of damage; the text that is replaced; what stands in its place; the message; what is left of the model.
///
/// Damage of the kind `truncated` ends the file before that text.
pub(super) type Change<'a, Left> = (&'a str, &'a str, &'a str, &'a str, Left);

/// The first warning about which `counts`, or the error; and what is left of the model, by `left`.
pub(super) fn outcome<Left: Default>(
    read: Result<Import, ImportError>,
    counts: impl Fn(&str) -> bool,
    left: impl Fn(&Import) -> Left,
) -> (String, Left) {
    match read {
        Ok(import) => {
            let told = import.warnings.iter().map(ToString::to_string).find(|w| counts(w));
            (told.unwrap_or_default(), left(&import))
        }
        Err(error) => (format!("error: {error}"), Left::default()),
    }
}

/// Faces of the model's parts.
pub(super) fn faces(import: &Import) -> usize {
    import.model.face_count()
}

/// Faces, and triangles of meshes.
pub(super) fn faces_and_triangles(import: &Import) -> (usize, usize) {
    let meshes = import.model.parts.iter().flat_map(|p| &p.meshes);
    (faces(import), meshes.map(|m| m.triangles().len()).sum())
}

/// Primitives of the model's solids.
pub(super) fn primitives(import: &Import) -> usize {
    import.model.solids.iter().map(|s| s.primitives().len()).sum()
}

/// The good text with the first `from` replaced.
#[track_caller]
pub(super) fn replaced(good: &str, from: &str, to: &str) -> String {
    assert!(good.contains(from), "{from}");
    good.replacen(from, to, 1)
}

/// As [`replaced`], for formats in which each column has a meaning: the shorter of both texts ends in blanks.
pub(super) fn replaced_in_columns(good: &str, from: &str, to: &str) -> String {
    let width = from.len().max(to.len());
    let wide = format!("{from:<width$}");
    if good.contains(&wide) { replaced(good, &wide, &format!("{to:<width$}")) } else { replaced(good, from, to) }
}

/// Makes each change by itself, and compares what `read` finds with what stands beside the change. The text without
/// a change must be read without a message.
pub(super) fn one_change_one_message<Left: Debug + PartialEq>(
    good: &str,
    change: impl Fn(&str, &str, &str) -> String,
    read: impl Fn(&str) -> (String, Left),
    changes: &[Change<'_, Left>],
) {
    assert_eq!(read(good).0, "", "the text without a change");
    let mut wrong = Vec::new();
    for (class, from, to, message, left) in changes {
        let text = match *class {
            "truncated" => good[..good.find(from).unwrap_or_else(|| panic!("{from}"))].to_owned(),
            _ => change(good, from, to),
        };
        assert_ne!(text, good, "{class}: {from} -> {to} changes nothing");
        let found = read(&text);
        if (found.0.as_str(), &found.1) != (*message, left) {
            wrong.push(format!("{class}: {from} -> {to}: {found:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

mod tests {
    use super::{one_change_one_message, outcome, replaced, replaced_in_columns};
    use crate::import::{Import, ImportError};

    fn says(text: &str) -> (String, usize) {
        (if text == "good" { String::new() } else { format!("not good: {text}") }, text.len())
    }

    #[test]
    fn right_tables_pass() {
        let changes = [("swapped", "oo", "e", "not good: ged", 3), ("truncated", "d", "", "not good: goo", 3)];
        one_change_one_message("good", replaced, says, &changes);
    }

    #[test]
    #[should_panic(expected = "swapped: oo -> e")]
    fn another_message_is_seen() {
        one_change_one_message("good", replaced, says, &[("swapped", "oo", "e", "not good", 3)]);
    }

    #[test]
    #[should_panic(expected = "swapped: oo -> e")]
    fn another_count_is_seen() {
        one_change_one_message("good", replaced, says, &[("swapped", "oo", "e", "not good: ged", 2)]);
    }

    #[test]
    #[should_panic(expected = "changes nothing")]
    fn a_change_that_is_none_is_seen() {
        one_change_one_message("good", replaced, says, &[("swapped", "oo", "oo", "", 4)]);
    }

    #[test]
    #[should_panic(expected = "the text without a change")]
    fn a_good_text_that_is_not_is_seen() {
        one_change_one_message("bad", replaced, says, &[]);
    }

    #[test]
    fn columns_stay() {
        assert_eq!(replaced_in_columns("1,2;    P1", "2;", "345;"), "1,345;  P1");
        assert_eq!(replaced_in_columns("1,345;  P1", "345;", "2;"), "1,2;    P1");
    }

    #[test]
    fn errors_differ_from_warnings() {
        let error = ImportError::Format { file: "t".into() };
        let message = format!("error: {error}");
        assert_eq!(outcome(Err(error), |_| true, |_| 7), (message, 0));
        assert_eq!(outcome(Ok(Import::default()), |_| true, |_| 7), (String::new(), 7));
    }
}
