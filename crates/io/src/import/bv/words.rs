//! Words of a text with the lines on which they stand.

/// The words that are left.
pub(super) struct Words<'t> {
    text: &'t [u8],
    /// Line of the next byte, counted from 1.
    line: usize,
}

/// Why a word is not of the expected kind; the words after it cannot be read either.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lost {
    pub line: usize,
    pub why: String,
}

impl<'t> Words<'t> {
    pub fn new(text: &'t [u8]) -> Self {
        Self { text, line: 1 }
    }

    /// The line of the next word, or of the end.
    pub fn line(&mut self) -> usize {
        let space = self.text.iter().take_while(|b| b.is_ascii_whitespace()).count();
        self.line += self.text[..space].iter().filter(|&&b| b == b'\n').count();
        self.text = &self.text[space..];
        self.line
    }

    /// The next word.
    pub fn word(&mut self) -> Option<String> {
        self.line();
        let length = self.text.iter().take_while(|b| !b.is_ascii_whitespace()).count();
        let (word, rest) = self.text.split_at(length);
        self.text = rest;
        (length > 0).then(|| String::from_utf8_lossy(word).into_owned())
    }

    /// Passes over the rest of this line.
    pub fn skip_line(&mut self) {
        let length = self.text.iter().take_while(|&&b| b != b'\n').count();
        self.text = &self.text[length..];
    }

    /// The next word as a number of kind `T`; `what` is for the message.
    pub fn number<T: std::str::FromStr>(&mut self, what: &str) -> Result<T, Lost> {
        let line = self.line();
        match self.word() {
            None => Err(Lost { line, why: format!("the file ends where {what} should stand") }),
            Some(word) => word.parse().map_err(|_| {
                let word: String = word.chars().take(20).collect();
                Lost { line, why: format!("{word} is not {what}") }
            }),
        }
    }
}
