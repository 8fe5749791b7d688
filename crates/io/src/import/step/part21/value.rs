//! Reading the flat arena: parameters as borrowed values.

use super::{File, Slot, decode, name_at};

/// One parameter.
#[derive(Clone, Copy, Debug)]
pub(in crate::import::step) enum Value<'a> {
    Integer(i64),
    Real(f64),
    /// Undecoded; see [`decode`].
    Text(&'a [u8]),
    /// Without its dots.
    Enumeration(&'a str),
    Reference(u32),
    List(Values<'a>),
    /// `NAME(…)`; no attribute read here needs the name.
    Typed(Values<'a>),
    Omitted,
    Derived,
}

/// The members of a list, or the parameters of an entity.
#[derive(Clone, Copy)]
pub(in crate::import::step) struct Values<'a> {
    file: &'a File<'a>,
    at: u32,
    end: u32,
}

impl std::fmt::Debug for Values<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(*self).finish()
    }
}

impl<'a> Values<'a> {
    pub(super) fn new(file: &'a File<'_>, at: u32, end: u32) -> Self {
        Self { file, at, end }
    }

    /// No members.
    pub fn empty(file: &'a File<'a>) -> Self {
        Self { file, at: 0, end: 0 }
    }

    /// Every reference below, at any depth.
    pub fn references(self) -> impl Iterator<Item = u32> + 'a {
        self.file.slots[self.at as usize..self.end as usize].iter().filter_map(|s| match s {
            Slot::Reference(id) => Some(*id),
            _ => None,
        })
    }
}

impl<'a> Iterator for Values<'a> {
    type Item = Value<'a>;

    fn next(&mut self) -> Option<Value<'a>> {
        if self.at >= self.end {
            return None;
        }
        let file = self.file;
        let first = self.at + 1;
        self.at = first;
        let text = |span: super::Span| &file.bytes[span.start as usize..span.end as usize];
        Some(match file.slots[first as usize - 1] {
            Slot::Integer(i) => Value::Integer(i),
            Slot::Real(x) => Value::Real(x),
            Slot::Text(span) => Value::Text(text(span)),
            Slot::Enumeration(span) => Value::Enumeration(name_at(file.bytes, span)),
            Slot::Reference(id) => Value::Reference(id),
            Slot::List { end } => {
                self.at = end;
                Value::List(Values { file, at: first, end })
            }
            Slot::Typed { end } => {
                self.at = end;
                Value::Typed(Values { file, at: first, end })
            }
            Slot::Omitted => Value::Omitted,
            Slot::Derived => Value::Derived,
        })
    }
}

impl<'a> Value<'a> {
    /// A real or an integer, also inside a type name: `LENGTH_MEASURE(0.5)`.
    pub fn number(self) -> Option<f64> {
        match self {
            Value::Real(x) => Some(x),
            Value::Integer(i) => Some(i as f64),
            Value::Typed(mut inner) => match inner.next()? {
                Value::Real(x) => Some(x),
                Value::Integer(i) => Some(i as f64),
                _ => None,
            },
            _ => None,
        }
    }

    /// A non-negative integer.
    pub fn count(self) -> Option<usize> {
        match self {
            Value::Integer(i) => usize::try_from(i).ok(),
            // some writers put a dot behind every number
            Value::Real(x) if x >= 0.0 && x.fract() == 0.0 && x <= f64::from(u32::MAX) => Some(x as usize),
            _ => None,
        }
    }

    /// A reference.
    pub fn reference(self) -> Option<u32> {
        match self {
            Value::Reference(id) => Some(id),
            _ => None,
        }
    }

    /// The members of a list.
    pub fn list(self) -> Option<Values<'a>> {
        match self {
            Value::List(values) => Some(values),
            _ => None,
        }
    }

    /// A decoded string; empty for `$`.
    pub fn text(self) -> Option<String> {
        match self {
            Value::Text(raw) => Some(decode(raw)),
            Value::Typed(mut inner) => inner.next().and_then(|v| match v {
                Value::Text(raw) => Some(decode(raw)),
                _ => None,
            }),
            Value::Omitted | Value::Derived => Some(String::new()),
            _ => None,
        }
    }

    /// `.T.` or `.F.`
    pub fn flag(self) -> Option<bool> {
        match self {
            Value::Enumeration("T" | "TRUE") => Some(true),
            Value::Enumeration("F" | "FALSE") => Some(false),
            _ => None,
        }
    }
}
