//! ISO 10303-21 text: numbered entities, reals that read back bit for bit, strings.
//!
//! ```text
//!   #17=CARTESIAN_POINT('',(1.,2.5,-3.E-7));
//! ```

use std::fmt::{self, Arguments, Display};
use std::io::{self, Write};

/// Counts and writes entities.
pub(super) struct Text<'w, W> {
    out: &'w mut W,
    last: u32,
}

impl<'w, W: Write> Text<'w, W> {
    pub fn new(out: &'w mut W) -> Self {
        Self { out, last: 0 }
    }

    pub fn raw(&mut self, text: &str) -> io::Result<()> {
        self.out.write_all(text.as_bytes())
    }

    /// A text of its own that goes on where this one ends, for [`Text::take`] or to be dropped.
    pub fn aside<'b>(&self, out: &'b mut Vec<u8>) -> Text<'b, Vec<u8>> {
        Text { out, last: self.last }
    }

    /// The last number given.
    pub fn last(&self) -> Id {
        Id(self.last)
    }

    /// Writes what was written aside, whose last number was `last`.
    pub fn take(&mut self, aside: &[u8], last: Id) -> io::Result<()> {
        self.last = last.0;
        self.out.write_all(aside)
    }

    /// A number for an entity that comes later.
    pub fn reserve(&mut self) -> Id {
        self.last += 1;
        Id(self.last)
    }

    pub fn put(&mut self, id: Id, body: Arguments) -> io::Result<()> {
        writeln!(self.out, "{id}={body};")
    }

    pub fn add(&mut self, body: Arguments) -> io::Result<Id> {
        let id = self.reserve();
        self.put(id, body)?;
        Ok(id)
    }
}

/// `#n`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Id(u32);

impl Display for Id {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "#{}", self.0)
    }
}

/// A real number: the shortest text that reads back the same.
pub(super) struct Real(pub f64);

impl Display for Real {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let text = format!("{:E}", self.0);
        let (digits, exponent) = text.split_once('E').unwrap_or((&text, "0"));
        let point = if digits.contains('.') { "" } else { "." };
        match exponent {
            "0" => write!(f, "{digits}{point}"),
            _ => write!(f, "{digits}{point}E{exponent}"),
        }
    }
}

/// `(a,b,c)`
pub(super) struct List<'a, T>(pub &'a [T]);

impl<T: Display> Display for List<'_, T> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("(")?;
        for (i, x) in self.0.iter().enumerate() {
            write!(f, "{}{x}", if i > 0 { "," } else { "" })?;
        }
        f.write_str(")")
    }
}

/// Reals as a list.
pub(super) fn reals(x: impl IntoIterator<Item = f64>) -> String {
    List(&x.into_iter().map(Real).collect::<Vec<_>>()).to_string()
}

/// A quoted string; characters other than printable ASCII become `\X2\` or `\X4\` code points.
pub(super) struct Quoted<'a>(pub &'a str);

impl Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("'")?;
        for c in self.0.chars() {
            match c {
                '\'' => f.write_str("''")?,
                '\\' => f.write_str("\\\\")?,
                ' '..='~' => write!(f, "{c}")?,
                _ if (c as u32) < 0x1_0000 => write!(f, "\\X2\\{:04X}\\X0\\", c as u32)?,
                _ => write!(f, "\\X4\\{:08X}\\X0\\", c as u32)?,
            }
        }
        f.write_str("'")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reals_have_a_point() {
        for (x, text) in [(1.0, "1."), (-0.5, "-5.E-1"), (1e-7, "1.E-7"), (1250.0, "1.25E3"), (0.0, "0.")] {
            assert_eq!(Real(x).to_string(), text);
        }
    }

    #[test]
    fn strings_are_escaped() {
        assert_eq!(Quoted("it's \\ Größe 🫖").to_string(), r"'it''s \\ Gr\X2\00F6\X0\\X2\00DF\X0\e \X4\0001FAD6\X0\'");
    }
}
