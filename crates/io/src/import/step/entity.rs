//! Typed access to records: every failure names the entity.

use super::part21::{File, Record, Value, Values, decode};
use crate::import::Place;
use crate::import::guard::Endless;
use crate::import::names::short;
use crate::spline::SplineError;

/// Why an entity cannot be used.
#[derive(Clone, Debug, thiserror::Error)]
pub(super) enum Fault {
    #[error("#{0} does not exist")]
    Missing(u32),
    #[error("#{id} is {found}, not {wanted}")]
    Kind { id: u32, found: String, wanted: &'static str },
    #[error("#{id}: attribute {index} is not {wanted}")]
    Attribute { id: u32, index: usize, wanted: &'static str },
    #[error("#{id}: {what}")]
    Value { id: u32, what: &'static str },
    #[error("#{id}: {source}")]
    Spline { id: u32, source: SplineError },
    #[error("{kind} is not supported (#{id})")]
    Unsupported { id: u32, kind: String },
    #[error(transparent)]
    Endless(Endless),
}

/// A record of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entity<'a> {
    file: &'a File<'a>,
    record: &'a Record,
}

/// The attributes of one type of an entity, without those it inherits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fields<'a> {
    pub id: u32,
    values: Values<'a>,
    inherited: usize,
}

impl<'a> Entity<'a> {
    /// The entity `#id`.
    pub fn find(file: &'a File<'a>, id: u32) -> Result<Self, Fault> {
        file.record(id).map(|record| Self { file, record }).ok_or(Fault::Missing(id))
    }

    /// Its number.
    pub fn id(self) -> u32 {
        self.record.id
    }

    /// Number and line.
    pub fn place(self) -> Place {
        Place::Entity { id: self.id(), line: self.file.line(self.record) }
    }

    /// The names of its types: one, or several for a complex instance.
    pub fn kinds(self) -> impl Iterator<Item = &'a str> {
        self.file.parts(self.record).map(|(name, _)| name)
    }

    /// One of its types has this name.
    pub fn is(self, kind: &str) -> bool {
        self.kinds().any(|k| k == kind)
    }

    /// Its types, joined for a message.
    pub fn name(self) -> String {
        short(self.kinds().take(12).collect::<Vec<_>>().join("+"))
    }

    /// The fault that it is not of the wanted kind.
    pub fn not(self, wanted: &'static str) -> Fault {
        Fault::Kind { id: self.id(), found: self.name(), wanted }
    }

    /// The attributes that `kind` itself declares.
    ///
    /// A simple instance lists inherited attributes first, `inherited` of them; in a complex instance
    /// each type lists its own.
    pub fn fields(self, kind: &'static str, inherited: usize) -> Result<Fields<'a>, Fault> {
        let mut parts = self.file.parts(self.record);
        let inherited = if parts.len() == 1 { inherited } else { 0 };
        let values = parts.find(|(name, _)| *name == kind).map(|(_, values)| values).ok_or_else(|| self.not(kind))?;
        Ok(Fields { id: self.id(), values, inherited })
    }

    /// The attributes of a simple instance, or of the first part of a complex one, whatever its type.
    pub fn all(self) -> Fields<'a> {
        let values = self.file.parts(self.record).next().map(|(_, values)| values);
        let none = || Values::empty(self.file);
        Fields { id: self.id(), values: values.unwrap_or_else(none), inherited: 0 }
    }

    /// Every reference in any of its parts.
    pub fn references(self) -> impl Iterator<Item = u32> + 'a {
        self.file.parts(self.record).flat_map(|(_, values)| values.references())
    }

    /// The name that REPRESENTATION_ITEM gives it: the first attribute of a simple instance.
    pub fn label(self) -> String {
        let named = self.fields("REPRESENTATION_ITEM", 0).unwrap_or_else(|_| self.all());
        match named.values.into_iter().next() {
            Some(Value::Text(raw)) => short(decode(raw)),
            _ => String::new(),
        }
    }
}

impl<'a> Fields<'a> {
    /// Without the name that every representation item starts with.
    pub fn after_name(self) -> Self {
        Self { inherited: 1, ..self }
    }

    /// Attribute `index`, the first being 0.
    pub fn value(self, index: usize) -> Option<Value<'a>> {
        self.values.into_iter().nth(self.inherited + index)
    }

    fn need<T>(
        self,
        index: usize,
        wanted: &'static str,
        read: impl FnOnce(Value<'a>) -> Option<T>,
    ) -> Result<T, Fault> {
        self.value(index).and_then(read).ok_or(Fault::Attribute { id: self.id, index: index + 1, wanted })
    }

    /// A finite number.
    pub fn real(self, index: usize) -> Result<f64, Fault> {
        self.need(index, "a finite number", |v| v.number().filter(|x| x.is_finite()))
    }

    /// A number above 0 that stays a normal one when it is scaled.
    pub fn length(self, index: usize) -> Result<f64, Fault> {
        self.need(index, "a length above 0", |v| v.number().filter(|x| *x > 0.0 && x.is_finite()))
    }

    /// A length of either sign, but not 0: some writers state radii below 0.
    pub fn radius(self, index: usize) -> Result<f64, Fault> {
        self.need(index, "a length other than 0", |v| v.number().filter(|x| *x != 0.0 && x.is_finite()))
    }

    /// A small count.
    pub fn count(self, index: usize) -> Result<usize, Fault> {
        self.need(index, "a count", Value::count)
    }

    /// `#id`
    pub fn reference(self, index: usize) -> Result<u32, Fault> {
        self.need(index, "a reference", Value::reference)
    }

    /// `#id`, or nothing for `$` and `*`.
    pub fn optional(self, index: usize) -> Option<u32> {
        self.value(index).and_then(Value::reference)
    }

    /// A list of anything.
    pub fn list(self, index: usize) -> Result<Values<'a>, Fault> {
        self.need(index, "a list", Value::list)
    }

    /// A list of references.
    pub fn references(self, index: usize) -> Result<impl Iterator<Item = Result<u32, Fault>> + 'a, Fault> {
        let fault = move || Fault::Attribute { id: self.id, index: index + 1, wanted: "a list of references" };
        Ok(self.list(index)?.map(move |v| v.reference().ok_or_else(fault)))
    }

    /// A list of finite numbers.
    pub fn reals(self, index: usize) -> Result<Vec<f64>, Fault> {
        let fault = Fault::Attribute { id: self.id, index: index + 1, wanted: "a list of finite numbers" };
        self.list(index)?.map(|v| v.number().filter(|x| x.is_finite())).collect::<Option<_>>().ok_or(fault)
    }

    /// `.T.` or `.F.`; anything else counts as true, which is what writers that forget it mean.
    pub fn flag(self, index: usize) -> bool {
        self.value(index).and_then(Value::flag).unwrap_or(true)
    }

    /// A decoded name, shortened; empty when there is none.
    pub fn text(self, index: usize) -> String {
        short(self.value(index).and_then(Value::text).unwrap_or_default())
    }
}
