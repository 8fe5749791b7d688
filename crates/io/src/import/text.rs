//! Text of any encoding: the only place where bytes become characters.
//!
//! ```text
//!   mark of byte order, or every second byte 0 ─▶ UTF-16
//!   all bytes are UTF-8                        ─▶ unchanged
//!   else ─▶ a guess (GB18030, Shift-JIS, Big5, EUC-KR, windows-125x, …) from the lines that are not, for these lines
//! ```
//!
//! STEP, IGES and OBJ state no encoding; programs write that of their screen. A line that is UTF-8 stays so, since
//! files are put together from several. A warning reports a guess, and bytes that have no character in it.
//!
//! Formats without columns are decoded whole, by [`utf8`]. Where columns and lengths count bytes, as in IGES, strings
//! are decoded one by one, by [`Encoding::decode`].

use super::{Import, Place, Warnings};
use chardetng::EncodingDetector;
use encoding_rs::{UTF_16BE, UTF_16LE};
use std::borrow::Cow;

/// Bytes of lines that a guess is made from, at most.
const SEEN: usize = 1 << 20;

/// The encoding of the lines that are not UTF-8.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Encoding(Option<&'static encoding_rs::Encoding>);

/// A text, and a note on its encoding.
#[derive(Debug, Default)]
pub(super) struct Text<'a> {
    pub text: Cow<'a, str>,
    /// The guess or the loss.
    told: Option<String>,
}

impl Encoding {
    /// The encoding of a text: a guess from the lines that are not UTF-8.
    pub fn of(bytes: &[u8]) -> Self {
        if std::str::from_utf8(bytes).is_ok() {
            return Self(None);
        }
        let mut detector = EncodingDetector::new();
        let mut left = SEEN;
        for line in bytes.split_inclusive(|b| *b == b'\n').filter(|line| std::str::from_utf8(line).is_err()) {
            // a line may end within a character
            let line = line.strip_suffix(b"\n").unwrap_or(line);
            let line = line.strip_suffix(b"\r").unwrap_or(line);
            let line = &line[..line.len().min(left)];
            detector.feed(line, false);
            left -= line.len();
            if left == 0 {
                break;
            }
        }
        detector.feed(&[], true);
        Self(Some(detector.guess(None, false)))
    }

    /// The characters of one string.
    pub fn decode(self, raw: &[u8]) -> Cow<'_, str> {
        match (std::str::from_utf8(raw), self.0) {
            (Ok(text), _) => Cow::Borrowed(text),
            (Err(_), Some(encoding)) => encoding.decode_without_bom_handling(raw).0,
            (Err(_), None) => String::from_utf8_lossy(raw),
        }
    }

    /// The warning about it, if any.
    pub fn told(self) -> Option<String> {
        self.0.map(|encoding| format!("it is not UTF-8: read as {}", encoding.name()))
    }
}

/// The kind of warning about an encoding.
pub(super) const KIND: &str = "text";

impl Text<'_> {
    /// Puts the warning before the others.
    pub fn tell(self, name: &str, import: &mut Import) {
        let Some(message) = self.told else { return };
        let mut warnings = Warnings::new(name);
        warnings.push(KIND, || Place::File, || message);
        let mut list = warnings.finish(&mut import.report);
        list.append(&mut import.warnings);
        import.warnings = list;
    }
}

/// The bytes of UTF-16 as UTF-8, and whether all of them are characters; `None` for other text.
pub(super) fn utf16(bytes: &[u8]) -> Option<(String, bool)> {
    // the marks, and the ASCII that all formats here begin with
    const BEGIN: usize = 16;
    let begin = &bytes[..bytes.len().min(BEGIN)];
    let zero = |odd: usize| begin.len() >= 4 && begin.iter().enumerate().all(|(i, b)| (*b == 0) == (i % 2 == odd));
    let encoding = match begin {
        [0xff, 0xfe, ..] => UTF_16LE,
        [0xfe, 0xff, ..] => UTF_16BE,
        _ if zero(1) => UTF_16LE,
        _ if zero(0) => UTF_16BE,
        _ => return None,
    };
    let (text, lost) = encoding.decode_with_bom_removal(bytes);
    Some((text.into_owned(), !lost))
}

/// The bytes behind a mark of byte order of UTF-8, if they begin with one.
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// The whole text as UTF-8, without a mark of byte order.
pub(super) fn utf8(bytes: &[u8]) -> Text<'_> {
    if let Some((text, whole)) = utf16(bytes) {
        let told = (!whole).then(|| "it is UTF-16 with units that are no characters".to_owned());
        return Text { text: Cow::Owned(text), told };
    }
    let bytes = without_mark(bytes);
    if let Ok(text) = std::str::from_utf8(bytes) {
        return Text { text: Cow::Borrowed(text), told: None };
    }
    let encoding = Encoding::of(bytes);
    let mut text = String::with_capacity(bytes.len() + bytes.len() / 8);
    let mut lost = 0;
    for line in bytes.split_inclusive(|b| *b == b'\n') {
        let decoded = encoding.decode(line);
        lost += usize::from(matches!(decoded, Cow::Owned(_)) && decoded.contains('\u{fffd}'));
        text.push_str(&decoded);
    }
    let mut told = encoding.told();
    if let Some(told) = told.as_mut().filter(|_| lost > 0) {
        told.push_str(&format!(", which has no character for bytes of {lost} lines"));
    }
    Text { text: Cow::Owned(text), told }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINES: &str = "#1=PRODUCT('p','PLAIN','');\n";

    fn read(bytes: &[u8]) -> (String, String) {
        let Text { text, told } = utf8(bytes);
        (text.into_owned(), told.unwrap_or_default())
    }

    #[test]
    fn encodings_are_guessed_from_the_lines_that_need_it() {
        for (encoding, words) in [
            (encoding_rs::GB18030, "齿轮箱外壳零件总成，右侧支架"),
            (encoding_rs::SHIFT_JIS, "歯車のハウジング、右側ブラケット部品"),
            (encoding_rs::BIG5, "齒輪箱外殼零件總成，右側支架"),
            (encoding_rs::EUC_KR, "기어 하우징 조립품, 오른쪽 브래킷"),
            (encoding_rs::WINDOWS_1252, "Gehäuse für Getriebe, größer"),
            (encoding_rs::WINDOWS_1251, "Корпус редуктора, правая опора"),
        ] {
            let (raw, _, unmapped) = encoding.encode(words);
            assert!(!unmapped, "{words}");
            let bytes = [LINES.as_bytes(), &raw, b"\n", "Ölwanne\n".as_bytes()].concat();
            let name = if encoding == encoding_rs::GB18030 { "GBK" } else { encoding.name() };
            let (text, told) = read(&bytes);
            assert_eq!(text, format!("{LINES}{words}\nÖlwanne\n"));
            assert!(told.ends_with(encoding.name()) || told.ends_with(name), "{told}");
        }
    }

    #[test]
    fn utf16_of_either_order_with_and_without_a_mark() {
        let words = format!("{LINES}齿轮 😀\n");
        for mark in ["\u{feff}", ""] {
            let units: Vec<u16> = format!("{mark}{words}").encode_utf16().collect();
            let little: Vec<u8> = units.iter().flat_map(|u| u.to_le_bytes()).collect();
            let big: Vec<u8> = units.iter().flat_map(|u| u.to_be_bytes()).collect();
            assert_eq!((read(&little), read(&big)), ((words.clone(), String::new()), (words.clone(), String::new())));
        }
        assert_eq!(read(format!("\u{feff}{words}").as_bytes()), (words, String::new()));
    }

    #[test]
    fn invalid_characters_are_reported() {
        let cut = [&b"\xff\xfe#\0a\0"[..], b"\x00\xd8", b"b\0"].concat();
        assert_eq!(read(&cut), ("#a\u{fffd}b".into(), "it is UTF-16 with units that are no characters".into()));
    }

    /// A line break within a character is a line break; the character is lost, with a warning.
    #[test]
    fn lines_stay_lines() {
        let words = "齿轮箱外壳零件总成，右侧支架";
        let (raw, ..) = encoding_rs::GB18030.encode(words);
        let (text, told) = read(&[&raw, &b"\n"[..], &raw[..5], b"\n", &raw[5..], b"\n"].concat());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!((lines.len(), lines[0]), (3, words));
        assert!(lines[1].starts_with("齿轮") && lines[1].ends_with('\u{fffd}'), "{lines:?}");
        assert!(told.contains(", which has no character for bytes of "), "{told}");
    }
}
