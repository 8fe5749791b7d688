//! The contents of a string token as Unicode.
//!
//! ```text
//!   ''            '                      \X\E9            é    ISO 8859-1, two hex digits
//!   \\            \                      \X2\03B1\X0\     α    UTF-16, four hex digits each
//!   \S\i          é    (i + 128)         \X4\0001F600\X0\      UTF-32, eight hex digits each
//!   \PA\          (alphabet: ignored)    newline               ignored, as the standard demands
//! ```
//!
//! Bytes above 127 are no standard but common; `import::text` has made them UTF-8.
//!
//! Source: ISO 10303-21:2016, 6.4.3.

/// Decodes the text between the quotes; unknown escapes stay unchanged.
pub(in crate::import::step) fn decode(raw: &[u8]) -> String {
    let mut bytes: Vec<u8> = Vec::with_capacity(raw.len());
    let push = |bytes: &mut Vec<u8>, c: char| bytes.extend_from_slice(c.encode_utf8(&mut [0; 4]).as_bytes());
    let mut at = 0;
    while let Some(&b) = raw.get(at) {
        let rest = &raw[at..];
        at += match rest {
            [b'\'', b'\'', ..] => {
                bytes.push(b'\'');
                2
            }
            [b'\\', b'\\', ..] => {
                bytes.push(b'\\');
                2
            }
            [b'\\', b'S', b'\\', c, ..] => {
                push(&mut bytes, char::from(c | 0x80));
                4
            }
            [b'\\', b'P', b'A'..=b'I', b'\\', ..] => 4,
            [b'\\', b'X', b'\\', high, low, ..] if hex(&[*high, *low]).is_some() => {
                push(&mut bytes, char::from(hex(&[*high, *low]).unwrap_or(0) as u8));
                5
            }
            [b'\\', b'X', b'2', b'\\', digits @ ..] => {
                let (units, used) = groups(digits, 4);
                let units: Vec<u16> = units.into_iter().map(|u| u as u16).collect();
                bytes.extend_from_slice(String::from_utf16_lossy(&units).as_bytes());
                4 + used
            }
            [b'\\', b'X', b'4', b'\\', digits @ ..] => {
                let (points, used) = groups(digits, 8);
                points.into_iter().for_each(|p| push(&mut bytes, char::from_u32(p).unwrap_or('\u{fffd}')));
                4 + used
            }
            [b'\n' | b'\r', ..] => 1,
            _ => {
                bytes.push(b);
                1
            }
        };
    }
    String::from_utf8(bytes).unwrap_or_else(|e| String::from_utf8_lossy(e.as_bytes()).into_owned())
}

/// Groups of hex digits up to `\X0\`; also how many bytes they took, the end mark included.
fn groups(digits: &[u8], width: usize) -> (Vec<u32>, usize) {
    let mut values = Vec::new();
    let mut at = 0;
    while let Some(value) = digits.get(at..at + width).and_then(hex) {
        values.push(value);
        at += width;
    }
    if digits[at..].starts_with(b"\\X0\\") {
        at += 4;
    }
    (values, at)
}

fn hex(digits: &[u8]) -> Option<u32> {
    digits.iter().try_fold(0u32, |v, &d| Some(v << 4 | char::from(d).to_digit(16)?))
}

#[cfg(test)]
mod tests {
    use super::decode;

    #[test]
    fn every_escape() {
        assert_eq!(decode(b"it''s"), "it's");
        assert_eq!(decode(br"a\\b"), r"a\b");
        assert_eq!(decode(br"caf\X\E9"), "café");
        assert_eq!(decode(br"caf\S\i"), "café");
        assert_eq!(decode(br"\X2\03B103B2\X0\!"), "αβ!");
        assert_eq!(decode(br"\X4\0001F600\X0\"), "😀");
        assert_eq!(decode(br"\PB\x"), "x");
        assert_eq!(decode("line\nbreak ü".as_bytes()), "linebreak ü");
    }

    #[test]
    fn broken_escapes_stay() {
        assert_eq!(decode(br"\X\zz"), r"\X\zz");
        assert_eq!(decode(br"\X2\03"), "03");
        assert_eq!(decode(br"\"), r"\");
        assert_eq!(decode(b"'"), "'");
    }
}
