//! Free-format parameters: numbers and strings between delimiters.
//!
//! ```text
//!   116,1.,-2.5D+02,,5H;,"x",0,1,97;       number, number, default, string of 5 characters, ...
//!                                  └ record delimiter; comments follow
//! ```
//!
//! Values go to one arena, in which a string is a range of the text: nothing is copied.

/// One parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    /// Nothing between two delimiters: the standard's default.
    Empty,
    /// Integers and reals alike; not finite when the file's number overflows.
    Number(f64),
    /// Start and end in the text.
    Text(u32, u32),
    /// Neither; start and end in the text.
    Bad(u32, u32),
}

/// The delimiters that the global section chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Delimiters {
    pub parameter: u8,
    pub record: u8,
}

impl Default for Delimiters {
    fn default() -> Self {
        Self { parameter: b',', record: b';' }
    }
}

/// Longest number in characters.
const LONGEST: usize = 64;

/// Reads the record in `text[start..end]`; returns where it stopped (behind the record delimiter), or
/// `None` when there is no record delimiter.
pub(super) fn record(
    text: &[u8],
    (start, end): (usize, usize),
    delimiters: Delimiters,
    out: &mut Vec<Value>,
) -> Option<usize> {
    let mut at = start;
    loop {
        while at < end && text[at] == b' ' {
            at += 1;
        }
        let first = at;
        let ends = |b: u8| b == delimiters.parameter || b == delimiters.record;
        let behind = |at: usize| text[at..end].iter().position(|b| ends(*b)).map_or(end, |i| at + i);
        at = behind(at);
        let string = if text[first..at].contains(&b'H') { hollerith(text, first, end, delimiters) } else { None };
        if let Some((from, to)) = string {
            at = behind(to);
            out.push(Value::Text(from as u32, to as u32));
        }
        if string.is_none() {
            let last = text[first..at].iter().rposition(|b| *b != b' ').map_or(first, |i| first + i + 1);
            if at == end && first == last {
                return None; // blanks behind the last delimiter are not a parameter
            }
            out.push(match &text[first..last] {
                [] => Value::Empty,
                token => number(token).map_or(Value::Bad(first as u32, last as u32), Value::Number),
            });
        }
        if at == end {
            return None;
        }
        at += 1;
        if text[at - 1] == delimiters.record {
            return Some(at);
        }
    }
}

/// `nHcharacters`: where the characters start and end. The count is of bytes, or of UTF-8 characters
/// where only that ends at a delimiter.
fn hollerith(text: &[u8], at: usize, end: usize, delimiters: Delimiters) -> Option<(usize, usize)> {
    let digits = text[at..end].iter().take(10).take_while(|b| b.is_ascii_digit()).count();
    if digits == 0 || text.get(at + digits) != Some(&b'H') || at + digits >= end {
        return None;
    }
    let count: usize = std::str::from_utf8(&text[at..at + digits]).ok()?.parse().ok()?;
    let start = at + digits + 1;
    let ends_well = |to: usize| {
        let next = text[to..end].iter().find(|b| **b != b' ');
        next.is_none_or(|b| *b == delimiters.parameter || *b == delimiters.record)
    };
    let bytes = start.saturating_add(count).min(end);
    if ends_well(bytes) {
        return Some((start, bytes));
    }
    let mut starts = (start..end).filter(|&i| text[i] & 0xc0 != 0x80);
    let characters = starts.nth(count).unwrap_or(end);
    Some((start, if ends_well(characters) { characters } else { bytes }))
}

/// A number as FORTRAN writes it: `1`, `1.`, `.5`, `-1.5E-3`, `2.D0`.
pub(super) fn number(token: &[u8]) -> Option<f64> {
    if let Some(short) = short(token) {
        return Some(short);
    }
    if token.len() > LONGEST || !token.iter().all(|b| b.is_ascii_digit() || b"+-.EeDd".contains(b)) {
        return None;
    }
    let mut buffer = [0; LONGEST];
    let buffer = &mut buffer[..token.len()];
    for (to, from) in buffer.iter_mut().zip(token) {
        *to = if matches!(from, b'D' | b'd') { b'E' } else { *from };
    }
    std::str::from_utf8(buffer).ok()?.parse().ok()
}

/// Powers of ten that are exact.
const TENS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// A number whose digits and power of ten are both exact in `f64`: one operation then rounds right. `None` for other
/// numbers and other text.
///
/// Source: W. D. Clinger, *How to read floating point numbers accurately*, PLDI 1990.
fn short(token: &[u8]) -> Option<f64> {
    const MOST: usize = 19; // digits that do not overflow
    let (negative, rest) = match token {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        rest => (false, rest),
    };
    let (mut digits, mut count, mut behind, mut point) = (0u64, 0, 0i32, false);
    let mut at = 0;
    while let Some(&b) = rest.get(at) {
        match b {
            b'0'..=b'9' if count == MOST => return None,
            b'0'..=b'9' => {
                digits = 10 * digits + u64::from(b - b'0');
                count += 1;
                behind += i32::from(point);
            }
            b'.' if !point => point = true,
            _ => break,
        }
        at += 1;
    }
    let power = match &rest[at..] {
        [] => 0,
        [b'E' | b'e' | b'D' | b'd', exponent @ ..] => {
            let (sign, figures) = match exponent {
                [b'-', figures @ ..] => (-1, figures),
                [b'+', figures @ ..] | figures => (1, figures),
            };
            if !(1..=3).contains(&figures.len()) || !figures.iter().all(u8::is_ascii_digit) {
                return None;
            }
            sign * figures.iter().fold(0, |sum, b| 10 * sum + i32::from(b - b'0'))
        }
        _ => return None,
    };
    if count == 0 || digits > 1 << 53 {
        return None;
    }
    let power = power - behind;
    let tens = *TENS.get(power.unsigned_abs() as usize)?;
    let value = if power < 0 { digits as f64 / tens } else { digits as f64 * tens };
    Some(if negative { -value } else { value })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (Vec<Value>, Option<usize>) {
        let mut out = Vec::new();
        let end = record(text.as_bytes(), (0, text.len()), Delimiters::default(), &mut out);
        (out, end)
    }

    #[test]
    fn every_kind_of_parameter() {
        use Value::{Bad, Empty, Number, Text};
        let (values, end) = read("116, 1.,-2.5D+02 ,,5Ha;b,c, 0H,x1; rest");
        assert_eq!(
            values,
            [Number(116.0), Number(1.0), Number(-250.0), Empty, Text(21, 26), Text(30, 30), Bad(31, 33)]
        );
        assert_eq!(end, Some(34));
    }

    #[test]
    fn unterminated_records() {
        assert_eq!(read("110,1.,  "), (vec![Value::Number(110.0), Value::Number(1.0)], None));
        assert_eq!(read("110,9HSeam"), (vec![Value::Number(110.0), Value::Text(6, 10)], None));
        assert_eq!(read(""), (vec![], None));
    }

    #[test]
    fn a_string_counted_in_characters() {
        assert_eq!(read("1,4Hgrün,2;").0[1..], [Value::Text(4, 9), Value::Number(2.0)]);
    }

    /// Bit for bit as the standard library reads them, on either side of what one operation can do.
    #[test]
    fn numbers_are_rounded_right() {
        for text in ["0.1", "-0.", "9007199254740992", "9007199254740993", "9007199254740993.", "0.30000000000000004"] {
            for power in ["", "E22", "e-22", "E23", "E-23", "E+5", "E-300"] {
                let text = format!("{text}{power}");
                let (found, wanted) = (number(text.as_bytes()).unwrap(), text.parse::<f64>().unwrap());
                assert_eq!(found.to_bits(), wanted.to_bits(), "{text}");
            }
        }
        let long = "123456789012345678901234567890.5";
        assert_eq!(number(long.as_bytes()), long.parse().ok());
    }

    #[test]
    fn numbers_of_fortran_and_nothing_else() {
        for (text, value) in [("1", 1.0), ("+.5", 0.5), ("1.E-3", 1e-3), ("3.0D2", 300.0), ("-7d-1", -0.7)] {
            assert_eq!(number(text.as_bytes()), Some(value), "{text}");
        }
        for text in ["NaN", "inf", "1e", "", ".", "0x1", "1 2", "1E5E5"] {
            assert_eq!(number(text.as_bytes()), None, "{text}");
        }
        assert_eq!(number(b"1E999"), Some(f64::INFINITY));
    }
}
