//! Names in files of assemblies: cut where they are long, since every instance and many messages have copies.

/// Longest name, in bytes.
const MOST_BYTES: usize = 200;

/// Bytes of a path of names after which deeper levels add no more to it.
const MOST_PATH_BYTES: usize = 512;

/// A name, or its beginning with an ellipsis.
pub(super) fn short(mut name: String) -> String {
    if name.len() > MOST_BYTES {
        let end = (0..=MOST_BYTES).rev().find(|&i| name.is_char_boundary(i)).unwrap_or(0);
        name.truncate(end);
        name.push('…');
    }
    name
}

/// The path of a thing within `outer`: names from the outermost, joined by `/`.
pub(super) fn path(outer: &str, own: &str) -> String {
    match outer {
        "" => own.to_owned(),
        outer if own.is_empty() || outer.len() + own.len() > MOST_PATH_BYTES => outer.to_owned(),
        outer => format!("{outer}/{own}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The two hundredth byte is within a letter of two.
    #[test]
    fn long_names_are_cut_between_characters() {
        let long = format!("{}é", "a".repeat(MOST_BYTES - 1));
        assert_eq!(short(long.clone()), format!("{}…", &long[..MOST_BYTES - 1]));
        assert_eq!(short(long[1..].to_owned()), long[1..]);
    }

    #[test]
    fn paths_grow_up_to_their_limit() {
        let long = "a".repeat(MOST_PATH_BYTES - 1);
        assert_eq!([path("", "b"), path("a", ""), path("a", "b")], ["b", "a", "a/b"]);
        assert_eq!(path(&long, "b"), format!("{long}/b"));
        assert_eq!(path(&long, "bc"), long);
    }
}
