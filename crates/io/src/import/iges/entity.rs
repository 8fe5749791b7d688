//! Typed access to entities: every failure names the entity.

use super::directory::Entry;
use super::file::File;
use super::value::Value;
use crate::import::Place;
use crate::import::guard::Endless;
use crate::import::names::short;
use crate::spline::SplineError;

/// Why an entity cannot be used.
#[derive(Clone, Debug, thiserror::Error)]
pub(super) enum Fault {
    #[error("#{0} does not exist")]
    Missing(u32),
    #[error("#{id} is of type {found}, not {wanted}")]
    Kind { id: u32, found: u16, wanted: &'static str },
    #[error("#{id}: parameter {index} is not {wanted}")]
    Parameter { id: u32, index: usize, wanted: &'static str },
    #[error("#{id}: {what}")]
    Value { id: u32, what: &'static str },
    #[error("#{id}: {source}")]
    Spline { id: u32, source: SplineError },
    #[error("type {kind} form {form} is not supported (#{id})")]
    Unsupported { id: u32, kind: u16, form: i32 },
    #[error(transparent)]
    Endless(Endless),
}

/// An entity of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entity<'a> {
    file: &'a File,
    pub entry: &'a Entry,
}

impl<'a> Entity<'a> {
    /// The entity `#id`.
    pub fn find(file: &'a File, id: u32) -> Result<Self, Fault> {
        file.entry(id).map(|entry| Self { file, entry }).ok_or(Fault::Missing(id))
    }

    /// Its number.
    pub fn id(self) -> u32 {
        self.entry.id
    }

    /// Its type.
    pub fn kind(self) -> u16 {
        self.entry.kind
    }

    /// Number and line.
    pub fn place(self) -> Place {
        Place::Entity { id: self.id(), line: self.entry.line as usize }
    }

    /// The fault that it is not of the wanted kind.
    pub fn not(self, wanted: &'static str) -> Fault {
        Fault::Kind { id: self.id(), found: self.kind(), wanted }
    }

    /// The fault that its type is not supported.
    pub fn unsupported(self) -> Fault {
        Fault::Unsupported { id: self.id(), kind: self.kind(), form: self.entry.form }
    }

    /// The entity, if it is of this type.
    pub fn of_kind(self, kind: u16, wanted: &'static str) -> Result<Self, Fault> {
        if self.kind() == kind { Ok(self) } else { Err(self.not(wanted)) }
    }

    /// Parameter `index`, counted from 1 behind the type as the standard does.
    pub fn value(self, index: usize) -> Value {
        self.file.values(self.entry).get(index).copied().unwrap_or(Value::Empty)
    }

    /// Parameters behind the type.
    pub fn len(self) -> usize {
        self.file.values(self.entry).len().saturating_sub(1)
    }

    fn wrong(self, index: usize, wanted: &'static str) -> Fault {
        Fault::Parameter { id: self.id(), index, wanted }
    }

    fn number(self, index: usize) -> Option<f64> {
        match self.value(index) {
            Value::Number(x) => Some(x),
            // a missing number is 0 by the standard; a missing record has no numbers
            Value::Empty if !self.file.values(self.entry).is_empty() => Some(0.0),
            _ => None,
        }
    }

    /// A finite number; 0 when it is left out.
    pub fn real(self, index: usize) -> Result<f64, Fault> {
        self.number(index).filter(|x| x.is_finite()).ok_or_else(|| self.wrong(index, "a finite number"))
    }

    /// Three finite numbers.
    pub fn triple(self, index: usize) -> Result<glam::DVec3, Fault> {
        Ok(glam::DVec3::new(self.real(index)?, self.real(index + 1)?, self.real(index + 2)?))
    }

    /// `count` finite numbers, all of which must be there.
    pub fn reals(self, index: usize, count: usize) -> Result<Vec<f64>, Fault> {
        if index.saturating_add(count) > self.len() + 1 {
            return Err(self.wrong(self.len() + 1, "there, the record is too short"));
        }
        let values = self.file.values(self.entry).get(index..index + count).unwrap_or_default();
        let finite = |(i, value): (usize, &Value)| match value {
            Value::Number(x) if x.is_finite() => Ok(*x),
            _ => self.real(i),
        };
        (index..).zip(values).map(finite).collect()
    }

    /// A number above 0.
    pub fn length(self, index: usize) -> Result<f64, Fault> {
        let found = self.number(index).filter(|x| *x > 0.0 && x.is_finite());
        found.ok_or_else(|| self.wrong(index, "a length above 0"))
    }

    /// An integer; 0 when it is left out.
    pub fn integer(self, index: usize) -> Result<i64, Fault> {
        let found = self.number(index).filter(|x| x.fract() == 0.0 && x.abs() < 1e15);
        found.map(|x| x as i64).ok_or_else(|| self.wrong(index, "an integer"))
    }

    /// A count of items of `each` parameters that follow somewhere in this record.
    pub fn count(self, index: usize, each: usize) -> Result<usize, Fault> {
        let count = usize::try_from(self.integer(index)?).ok();
        let fits = count.filter(|n| n.saturating_mul(each) <= self.len());
        fits.ok_or_else(|| self.wrong(index, "a count that its record can hold"))
    }

    /// The number of another entity, or nothing.
    pub fn optional(self, index: usize) -> Result<Option<u32>, Fault> {
        match self.integer(index)? {
            0 => Ok(None),
            id => u32::try_from(id).map(Some).map_err(|_| self.wrong(index, "a pointer")),
        }
    }

    /// The number of another entity.
    pub fn pointer(self, index: usize) -> Result<u32, Fault> {
        self.optional(index)?.ok_or_else(|| self.wrong(index, "a pointer"))
    }

    /// A string, shortened; empty when there is none.
    pub fn string(self, index: usize) -> String {
        match self.value(index) {
            value @ Value::Text(..) => {
                let bytes = self.file.text(value).unwrap_or_default();
                short(self.file.encoding.decode(bytes).trim().to_owned())
            }
            _ => String::new(),
        }
    }

    /// Pointers to the associations and the properties that stand behind `last`, the entity's own last
    /// parameter.
    pub fn properties(self, last: usize) -> Vec<u32> {
        let mut out = Vec::new();
        let mut at = last + 1;
        for _ in 0..2 {
            let Ok(count) = self.count(at, 1) else { break };
            out.extend((at + 1..=at + count).filter_map(|i| self.optional(i).ok().flatten()));
            at += count + 1;
        }
        out
    }

    /// Its name: a name property, else the label of its directory entry.
    pub fn name(self, last: usize) -> String {
        let named = self.properties(last).into_iter().find_map(|id| {
            let property = Self::find(self.file, id).ok()?;
            (property.kind() == 406 && property.entry.form == 15).then(|| property.string(2))
        });
        named.filter(|n| !n.is_empty()).unwrap_or_else(|| self.entry.label.clone())
    }
}
