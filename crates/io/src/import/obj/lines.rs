//! Lines of text: continuations joined, comments taken off, with the number of the first line.

use std::borrow::Cow;

/// The lines of a file that say something, with their numbers, counted from 1.
///
/// A `\` at the end of a line joins the next one to it; `#` begins a comment. Bytes that are not UTF-8
/// become replacement characters.
pub(in crate::import) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut physical = bytes.split(|&b| b == b'\n').enumerate();
    std::iter::from_fn(move || {
        let (number, line) = physical.next()?;
        let mut text = content(line);
        while text.trim_end().ends_with('\\') {
            // appending in place keeps a long chain linear
            let mut joined = text.into_owned();
            joined.truncate(joined.trim_end().len() - 1);
            joined.push(' ');
            let more = physical.next();
            joined.push_str(&more.map_or(Cow::Borrowed(""), |(_, line)| content(line)));
            text = joined.into();
        }
        Some((number + 1, text))
    })
    .filter(|(_, text)| !text.trim().is_empty())
}

fn content(line: &[u8]) -> Cow<'_, str> {
    let end = line.iter().position(|&b| b == b'#').unwrap_or(line.len());
    String::from_utf8_lossy(&line[..end])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<(usize, String)> {
        lines(text.as_bytes()).map(|(n, t)| (n, t.split_whitespace().collect::<Vec<_>>().join(" "))).collect()
    }

    #[test]
    fn continuations_and_comments() {
        let text = "# head\r\nv 1 2 \\\r\n 3\n\n  f 1 2 3 # tail\\\ng a\\";
        let expected = [(2, "v 1 2 3"), (5, "f 1 2 3"), (6, "g a")];
        assert_eq!(all(text), expected.map(|(n, t)| (n, t.to_owned())));
        assert!(all("").is_empty());
    }

    /// Joining is linear in time: half a million continuations of one line.
    #[test]
    fn many_continuations() {
        let text = format!("v {}1", "0 \\\n".repeat(500_000));
        assert_eq!(lines(text.as_bytes()).count(), 1);
    }
}
