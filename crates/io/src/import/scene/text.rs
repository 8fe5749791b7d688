//! Tables and values of the text, each with its place. The reader takes keys one by one; a key that was never taken is
//! an error.
//!
//! ```text
//!   radius = 5          need("radius") ──▶ Value ──number()──▶ 5.0
//!   radus  = 5          finish()       ──▶ "`radus` is not known here", at its place
//! ```

use crate::model::Colour;
use glam::DVec3;
use std::borrow::Cow;
use toml::Spanned;
use toml::de::DeValue;

/// A fault, and the byte of the text at which it is.
#[derive(Debug)]
pub(super) struct Fault {
    pub at: usize,
    pub message: String,
}

impl Fault {
    pub fn new(at: usize, message: impl Into<String>) -> Self {
        Self { at, message: message.into() }
    }
}

pub(super) type Outcome<T> = Result<T, Fault>;

/// A value and the key that it stands under.
#[derive(Clone, Copy, Debug)]
pub(super) struct Value<'a> {
    pub key: &'a str,
    value: &'a Spanned<DeValue<'a>>,
}

/// A table whose keys are taken one by one.
#[derive(Clone, Debug)]
pub(super) struct Table<'a> {
    /// Where its name stands.
    pub at: usize,
    entries: Vec<(&'a str, usize, Value<'a>)>,
    asked: Vec<&'static str>,
}

impl<'a> Value<'a> {
    pub fn new(key: &'a str, value: &'a Spanned<DeValue<'a>>) -> Self {
        Self { key, value }
    }

    /// Where it begins.
    pub fn at(self) -> usize {
        self.value.span().start
    }

    pub fn fault(self, message: impl std::fmt::Display) -> Fault {
        Fault::new(self.at(), format!("`{}`: {message}", self.key))
    }

    fn wrong(self, wanted: &str) -> Fault {
        self.fault(format!("{wanted} is wanted, not {}", kind(self.value.get_ref())))
    }

    /// The byte of a column of a string, both from its beginning; the string's own beginning where it is not written
    /// in one line.
    pub fn column(self, text: &str, column: usize) -> usize {
        let start = self.at();
        let inner = &text[(start + 1).min(text.len())..self.value.span().end.max(start + 1)];
        if inner.starts_with(['"', '\'']) || inner.contains(['\\', '\n']) {
            return start;
        }
        start + 1 + inner.char_indices().nth(column.saturating_sub(1)).map_or(inner.len().saturating_sub(1), |c| c.0)
    }

    /// A finite number.
    pub fn number(self) -> Outcome<f64> {
        let number = match self.value.get_ref() {
            DeValue::Integer(i) => i64::from_str_radix(i.as_str(), i.radix()).ok().map(|i| i as f64),
            DeValue::Float(f) => f.as_str().parse().ok(),
            _ => return Err(self.wrong("a number")),
        };
        number.filter(|x: &f64| x.is_finite()).ok_or_else(|| self.fault("not a finite number"))
    }

    /// A number above zero.
    pub fn positive(self) -> Outcome<f64> {
        let number = self.number()?;
        if number > 0.0 { Ok(number) } else { Err(self.fault(format!("{number} is not above 0"))) }
    }

    /// A whole number from `least` to `most`.
    pub fn count(self, least: usize, most: usize) -> Outcome<usize> {
        let DeValue::Integer(i) = self.value.get_ref() else { return Err(self.wrong("a whole number")) };
        let count = i64::from_str_radix(i.as_str(), i.radix()).ok().and_then(|i| usize::try_from(i).ok());
        let good = count.filter(|n| (least..=most).contains(n));
        good.ok_or_else(|| self.fault(format!("{i} is not between {least} and {most}")))
    }

    pub fn flag(self) -> Outcome<bool> {
        self.value.get_ref().as_bool().ok_or_else(|| self.wrong("true or false"))
    }

    pub fn text(self) -> Outcome<&'a str> {
        self.value.get_ref().as_str().ok_or_else(|| self.wrong("a string"))
    }

    pub fn is_text(self) -> bool {
        self.value.get_ref().is_str()
    }

    pub fn is_flag(self) -> bool {
        self.value.get_ref().is_bool()
    }

    pub fn is_table(self) -> bool {
        self.value.get_ref().is_table()
    }

    /// One of the words.
    pub fn word<T: Copy>(self, words: &[(&str, T)]) -> Outcome<T> {
        let text = self.text()?;
        let known = || words.iter().map(|w| format!("`{}`", w.0)).collect::<Vec<_>>().join(", ");
        let found = words.iter().find(|w| w.0 == text).map(|w| w.1);
        found.ok_or_else(|| self.fault(format!("`{}` is none of {}", shortened(text), known())))
    }

    pub fn list(self) -> Outcome<Vec<Value<'a>>> {
        let DeValue::Array(all) = self.value.get_ref() else { return Err(self.wrong("a list")) };
        Ok(all.iter().map(|value| Self { key: self.key, value }).collect())
    }

    /// A list with something in it.
    pub fn some(self) -> Outcome<Vec<Value<'a>>> {
        let list = self.list()?;
        if list.is_empty() { Err(self.fault("the list is empty")) } else { Ok(list) }
    }

    pub fn numbers(self) -> Outcome<Vec<f64>> {
        self.list()?.into_iter().map(Value::number).collect()
    }

    /// Two numbers.
    pub fn pair(self) -> Outcome<(f64, f64)> {
        let all = self.numbers()?;
        let [a, b] = all[..] else { return Err(self.fault(format!("2 numbers are wanted, not {}", all.len()))) };
        Ok((a, b))
    }

    /// Two or three numbers; the third is 0 when it is missing.
    pub fn point(self) -> Outcome<DVec3> {
        let all = self.numbers()?;
        match all[..] {
            [x, y] => Ok(DVec3::new(x, y, 0.0)),
            [x, y, z] => Ok(DVec3::new(x, y, z)),
            _ => Err(self.fault(format!("2 or 3 coordinates are wanted, not {}", all.len()))),
        }
    }

    /// Three numbers, not all 0.
    pub fn direction(self) -> Outcome<DVec3> {
        let v = self.point()?;
        if v.abs().max_element() > 0.0 { Ok(v) } else { Err(self.fault("a direction without length")) }
    }

    pub fn points(self) -> Outcome<Vec<DVec3>> {
        self.list()?.into_iter().map(Value::point).collect()
    }

    /// One name, or a list of names: the values that hold them.
    pub fn names(self) -> Outcome<Vec<Value<'a>>> {
        if self.is_text() { Ok(vec![self]) } else { self.some() }
    }

    /// `"#rrggbb"`, `"#rrggbbaa"`, or three or four numbers from 0 to 1; as on a screen (sRGB).
    pub fn colour(self) -> Outcome<Colour> {
        let parts = if self.is_text() {
            let text = self.text()?;
            let digits = text.strip_prefix('#').filter(|d| d.is_ascii() && [6, 8].contains(&d.len()));
            let byte = |d: &str, i: usize| u8::from_str_radix(&d[2 * i..2 * i + 2], 16).ok();
            let bytes: Option<Vec<u8>> = digits.and_then(|d| (0..d.len() / 2).map(|i| byte(d, i)).collect());
            let parts = bytes.map(|b| b.iter().map(|b| f64::from(*b) / 255.0).collect::<Vec<_>>());
            parts.ok_or_else(|| self.fault(format!("`{}` is not a colour like `#c08040`", shortened(text))))?
        } else {
            let parts = self.numbers()?;
            if ![3, 4].contains(&parts.len()) || parts.iter().any(|c| !(0.0..=1.0).contains(c)) {
                return Err(self.fault("a colour is `#rrggbb`, or 3 or 4 numbers from 0 to 1"));
            }
            parts
        };
        Ok(super::super::colour::linear([parts[0], parts[1], parts[2]], parts.get(3).copied().unwrap_or(1.0)))
    }

    pub fn table(self) -> Outcome<Table<'a>> {
        let DeValue::Table(table) = self.value.get_ref() else { return Err(self.wrong("a table")) };
        let entry = |(key, value): (&'a Spanned<Cow<'a, str>>, &'a Spanned<DeValue<'a>>)| {
            let name: &'a str = key.get_ref();
            (name, key.span().start, Value { key: name, value })
        };
        let mut entries: Vec<_> = table.iter().map(entry).collect();
        entries.sort_by_key(|e| e.1);
        Ok(Table { at: self.at(), entries, asked: Vec::new() })
    }
}

impl<'a> Table<'a> {
    /// The value of a key, which is then marked as used.
    pub fn get(&mut self, key: &'static str) -> Option<Value<'a>> {
        if !self.asked.contains(&key) {
            self.asked.push(key);
        }
        self.entries.iter().find(|e| e.0 == key).map(|e| e.2)
    }

    /// # Errors
    /// There is none.
    pub fn need(&mut self, key: &'static str) -> Outcome<Value<'a>> {
        self.get(key).ok_or_else(|| Fault::new(self.at, format!("`{key}` is missing")))
    }

    /// A value, read by `read` where there is one.
    pub fn read<T>(&mut self, key: &'static str, read: impl FnOnce(Value<'a>) -> Outcome<T>) -> Outcome<Option<T>> {
        self.get(key).map(read).transpose()
    }

    pub fn number_or(&mut self, key: &'static str, or: f64) -> Outcome<f64> {
        Ok(self.read(key, Value::number)?.unwrap_or(or))
    }

    pub fn flag(&mut self, key: &'static str) -> Outcome<bool> {
        Ok(self.read(key, Value::flag)?.unwrap_or(false))
    }

    /// All entries in the order of the text, whatever their keys: name, its place, value.
    pub fn all(&self) -> &[(&'a str, usize, Value<'a>)] {
        &self.entries
    }

    /// # Errors
    /// A key that was not used.
    pub fn finish(self) -> Outcome<()> {
        let unknown = self.entries.iter().find(|e| !self.asked.contains(&e.0));
        let Some((key, at, _)) = unknown else { return Ok(()) };
        let known = self.asked.iter().map(|k| format!("`{k}`")).collect::<Vec<_>>().join(", ");
        Err(Fault::new(*at, format!("`{}` is not known here; known are {known}", shortened(key))))
    }
}

/// Words of a file are quoted in messages up to this many characters.
pub(super) fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    let cut: String = text.chars().take(LONGEST).collect();
    if cut.len() < text.len() { cut + "…" } else { cut }
}

fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}
