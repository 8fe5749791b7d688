//! Names of items on the command line.
//!
//! ```text
//!   face:12      the face #12 of the file       edge:40.3     the third edge of an IGES file's list #40
//!   face:12@2    that of the second placed part
//! ```

use std::fmt;
use std::str::FromStr;

/// The name of an item; its placed part is counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Name {
    Face(Number),
    Edge(Number),
    Part(usize),
}

/// The number of a face or an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Number {
    /// In the file.
    pub number: u32,
    /// Edges of IGES: the place in the list, from 1.
    pub item: Option<u32>,
    /// The placed part; `None` where one alone has it.
    pub placed: Option<usize>,
}

impl Name {
    /// The same in a placed part.
    pub fn of_placed(self, placed: usize) -> Self {
        let within = |number: Number| Number { placed: Some(placed), ..number };
        match self {
            Self::Face(number) => Self::Face(within(number)),
            Self::Edge(number) => Self::Edge(within(number)),
            Self::Part(_) => Self::Part(placed),
        }
    }
}

impl Number {
    fn new(text: &str, has_item: bool) -> Option<Self> {
        let (numbers, placed) = match text.split_once('@') {
            Some((numbers, placed)) => (numbers, Some(counted(placed)?)),
            None => (text, None),
        };
        let (number, item) = match numbers.split_once('.').filter(|_| has_item) {
            Some((number, item)) => (number, Some(counted(item)?)),
            None => (numbers, None),
        };
        Some(Self { number: counted(number)?, item, placed })
    }
}

/// A whole number above 0.
fn counted<T: FromStr + PartialOrd + Default>(text: &str) -> Option<T> {
    text.parse::<T>().ok().filter(|number| *number > T::default())
}

/// `N[@P]`.
pub fn face(text: &str) -> Result<Name, String> {
    let wants = || "wants the number of a face above 0, as in 12 or 12@2".to_owned();
    Number::new(text, false).map(Name::Face).ok_or_else(wants)
}

/// `N[.I][@P]`.
pub fn edge(text: &str) -> Result<Name, String> {
    let wants = || "wants the number of an edge above 0, as in 40, 40@2 or 40.3".to_owned();
    Number::new(text, true).map(Name::Edge).ok_or_else(wants)
}

/// `P`.
pub fn part(text: &str) -> Result<Name, String> {
    counted(text).map(Name::Part).ok_or_else(|| "wants the number of a placed part, from 1".to_owned())
}

/// `face:N[@P]` or `edge:N[.I][@P]`.
pub fn face_or_edge(text: &str) -> Result<Name, String> {
    match text.split_once(':') {
        Some(("face", number)) => face(number),
        Some(("edge", number)) => edge(number),
        _ => Err("wants a face or an edge, as in face:12 or edge:40@2".to_owned()),
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Face(number) => write!(f, "face:{number}"),
            Self::Edge(number) => write!(f, "edge:{number}"),
            Self::Part(placed) => write!(f, "part:{placed}"),
        }
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.number)?;
        self.item.iter().try_for_each(|item| write!(f, ".{item}"))?;
        self.placed.iter().try_for_each(|placed| write!(f, "@{placed}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for text in ["face:12", "face:12@2", "edge:40", "edge:40.3", "edge:40.3@7"] {
            assert_eq!(face_or_edge(text).map(|name| name.to_string()), Ok(text.to_owned()));
        }
        let number = Number { number: 40, item: Some(3), placed: Some(7) };
        assert_eq!(edge("40.3@7"), Ok(Name::Edge(number)));
        assert_eq!(part("3"), Ok(Name::Part(3)));
    }

    #[test]
    fn others_are_no_names() {
        for text in ["12", "part:1", "face:", "face:0", "face:-1", "face:12.3", "face:12@0", "face:12@", "edge:40.0"] {
            assert!(face_or_edge(text).is_err(), "{text}");
        }
        assert!(part("0").is_err() && face("4294967296").is_err());
    }
}
