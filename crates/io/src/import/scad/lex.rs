//! Words of the flattened text, each with its line.
//!
//! ```text
//!   multmatrix([[1, 0, ...]]) {      Name "multmatrix"  Sign '('  Sign '['  Sign '['  Number 1  Sign ',' ...
//!   # cube(size = 2);  // note       Sign '#'  Name "cube" ...                       comments are no words
//! ```

use super::Fault;

/// One word.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token<'a> {
    /// `cube`, `$fn`, `true`.
    Name(&'a str),
    Number(f64),
    /// The text between the quotes, escapes unresolved.
    Text(&'a str),
    Sign(u8),
    End,
}

/// Cuts text into words.
#[derive(Clone, Debug)]
pub(super) struct Lexer<'a> {
    text: &'a str,
    at: usize,
    /// Line of the next character, from 1.
    line: usize,
    next: Option<(Token<'a>, usize)>,
}

impl<'a> Lexer<'a> {
    pub fn new(text: &'a str) -> Self {
        Self { text, at: 0, line: 1, next: None }
    }

    /// How many bytes have been looked at.
    pub fn place(&self) -> usize {
        self.at
    }

    /// The next word and its line.
    pub fn take(&mut self) -> Result<(Token<'a>, usize), Fault> {
        match self.next.take() {
            Some(word) => Ok(word),
            None => self.read(),
        }
    }

    /// The next word, which stays.
    pub fn peek(&mut self) -> Result<&Token<'a>, Fault> {
        if self.next.is_none() {
            self.next = Some(self.read()?);
        }
        Ok(&self.next.as_ref().expect("just read").0)
    }

    /// Takes the sign if it is next.
    pub fn accept(&mut self, sign: u8) -> Result<bool, Fault> {
        let found = *self.peek()? == Token::Sign(sign);
        if found {
            self.next = None;
        }
        Ok(found)
    }

    /// Takes the sign, which must be next.
    pub fn expect(&mut self, sign: u8) -> Result<(), Fault> {
        match self.take()? {
            (Token::Sign(s), _) if s == sign => Ok(()),
            (found, line) => Err(Fault::new(line, format!("`{}` expected, not {}", sign as char, found.name()))),
        }
    }

    fn blank(&mut self) -> Result<(), Fault> {
        let bytes = self.text.as_bytes();
        while let Some(b) = bytes.get(self.at) {
            match (b, bytes.get(self.at + 1)) {
                (b'\n', _) => {
                    self.line += 1;
                    self.at += 1;
                }
                (b' ' | b'\t' | b'\r', _) => self.at += 1,
                (b'/', Some(b'/')) => self.at += self.text[self.at..].find('\n').unwrap_or(self.text.len() - self.at),
                (b'/', Some(b'*')) => {
                    let rest = &self.text[self.at..];
                    let end = rest.find("*/").ok_or_else(|| Fault::new(self.line, "a comment does not end"))?;
                    self.line += rest[..end].matches('\n').count();
                    self.at += end + 2;
                }
                _ => break,
            }
        }
        Ok(())
    }

    fn read(&mut self) -> Result<(Token<'a>, usize), Fault> {
        self.blank()?;
        let (text, line) = (self.text, self.line);
        let rest = &text[self.at..];
        let Some(first) = rest.bytes().next() else { return Ok((Token::End, line)) };
        let word = |more: fn(char) -> bool| rest.find(|c| !more(c)).unwrap_or(rest.len());
        let (token, length) = match first {
            b'$' | b'_' | b'a'..=b'z' | b'A'..=b'Z' => {
                let length = word(|c| c.is_ascii_alphanumeric() || c == '_' || c == '$');
                (Token::Name(&rest[..length]), length)
            }
            b'-' if rest.starts_with("-inf") => (Token::Number(f64::NEG_INFINITY), 4),
            b'-' if rest.starts_with("-nan") => (Token::Number(f64::NAN), 4),
            b'0'..=b'9' | b'-' | b'+' | b'.' => {
                let length = word(|c| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '+'));
                let number = rest[..length].parse().map_err(|_| {
                    Fault::new(
                        line,
                        format!("`{}` is not a number", rest[..length].chars().take(20).collect::<String>()),
                    )
                })?;
                (Token::Number(number), length)
            }
            b'"' => {
                let (mut length, bytes) = (1, rest.as_bytes());
                while bytes.get(length).is_some_and(|b| *b != b'"') {
                    length += if bytes[length] == b'\\' { 2 } else { 1 };
                }
                let inner = rest.get(1..length).filter(|_| length < rest.len());
                let inner = inner.ok_or_else(|| Fault::new(line, "a text does not end"))?;
                self.line += inner.matches('\n').count();
                (Token::Text(inner), length + 1)
            }
            sign if sign.is_ascii_graphic() => (Token::Sign(sign), 1),
            _ => return Err(Fault::new(line, "a character that has no meaning here")),
        };
        self.at += length;
        Ok((token, line))
    }
}

impl Token<'_> {
    /// For messages.
    pub fn name(&self) -> String {
        match self {
            Self::Name(n) | Self::Text(n) => format!("`{}`", n.chars().take(40).collect::<String>()),
            Self::Number(x) => format!("`{x}`"),
            Self::Sign(s) => format!("`{}`", *s as char),
            Self::End => "the end of the file".to_owned(),
        }
    }
}
