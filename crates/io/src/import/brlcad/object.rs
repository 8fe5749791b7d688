//! Objects of a database: solids by their fields, combinations by their expressions; both forms of the text lead here.
//!
//! ```text
//!   put rod tgc V {0 0 0} ...   or   S 18 rod ...   ──▶  Record: rod, tgc, V = "0 0 0", ...
//!   put all comb tree {...}     or   C, M lines     ──▶  Combination: postfix items, region, colour
//! ```

use super::tree::Item;
use super::{Fault, tree, words};
use crate::import::colour::linear;
use crate::import::{ImportReport, Place, Warnings};
use crate::model::Colour;
use glam::DVec3;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A solid's kind and fields.
#[derive(Debug)]
pub(super) struct Record<'a> {
    /// Where it begins.
    pub line: usize,
    pub name: &'a str,
    pub kind: &'a str,
    /// Names of fields and what they hold.
    pub fields: Vec<(Cow<'a, str>, Cow<'a, str>)>,
}

impl Record<'_> {
    pub fn value(&self, key: &str) -> Option<&str> {
        self.fields.iter().find(|(k, _)| k == key).map(|(_, v)| &**v)
    }

    pub fn fault(&self, message: impl std::fmt::Display) -> Fault {
        Fault::new(self.line, format!("{} {}: {message}", self.name, self.kind))
    }

    /// All numbers of a field, braces within it left out of account.
    pub fn list(&self, key: &str) -> Result<Vec<f64>, Fault> {
        let value = self.value(key).ok_or_else(|| self.fault(format!("`{key}` is missing")))?;
        let words = value.split(|c: char| c.is_whitespace() || c == '{' || c == '}').filter(|w| !w.is_empty());
        let all: Option<_> = words.map(|w| w.parse().ok().filter(|x: &f64| x.is_finite())).collect();
        all.ok_or_else(|| self.fault(format!("`{key}` is not a list of finite numbers")))
    }

    /// `N` finite numbers.
    pub fn numbers<const N: usize>(&self, key: &str) -> Result<[f64; N], Fault> {
        let missing = self.value(key).is_none();
        let all = self.list(key).and_then(|v| v.try_into().map_err(|_| self.fault("")));
        all.map_err(|fault| if missing { fault } else { self.fault(format!("`{key}` is not {N} finite numbers")) })
    }

    pub fn vector(&self, key: &str) -> Result<DVec3, Fault> {
        self.numbers::<3>(key).map(DVec3::from_array)
    }

    /// A length above zero.
    pub fn positive(&self, key: &str) -> Result<f64, Fault> {
        let [value] = self.numbers(key)?;
        if value > 0.0 { Ok(value) } else { Err(self.fault(format!("`{key}` is {value}, but must be positive"))) }
    }
}

/// What a combination makes of its members.
#[derive(Debug, Default)]
pub(super) struct Combination<'a> {
    /// In postfix order.
    pub items: Vec<Item<'a>>,
    /// One material: colours further down do not matter.
    pub region: bool,
    /// Number of the region, by which the table of colours goes.
    pub number: i64,
    /// Filled with air.
    pub air: bool,
    /// Its colour holds for what is further down, whatever that says.
    pub holds: bool,
}

/// One named thing.
#[derive(Debug)]
pub(super) struct Object<'a> {
    pub record: Record<'a>,
    /// From 1, in the order of the file.
    pub id: u32,
    pub combination: Option<Combination<'a>>,
    pub colour: Option<Colour>,
}

/// All objects by name.
#[derive(Debug, Default)]
pub(super) struct Database<'a> {
    pub objects: BTreeMap<&'a str, Object<'a>>,
    /// Colours of regions by their number: first, last and colour.
    pub table: Vec<(i64, i64, Colour)>,
}

impl<'a> Database<'a> {
    pub fn add(
        &mut self,
        record: Record<'a>,
        combination: Option<Combination<'a>>,
        colour: Option<Colour>,
        report: &mut ImportReport,
        warnings: &mut Warnings,
    ) {
        *report.nodes.entry(record.kind.to_owned()).or_default() += 1;
        let id = self.objects.len() as u32 + 1;
        let (name, line) = (record.name, record.line);
        let object = Object { record, id, combination, colour };
        if let Some(before) = self.objects.insert(name, object) {
            let message = || format!("`{name}` of line {} is replaced", before.record.line);
            warnings.push("name given twice", || Place::Line(line), message);
        }
    }

    /// The objects that one names: members of a combination, the sketch of an extrusion.
    pub fn named<'o>(object: &'o Object<'a>) -> impl Iterator<Item = &'o str> {
        let items = object.combination.iter().flat_map(|c| &c.items).filter_map(Item::name);
        let extruded = object.record.kind == "extrude";
        items.chain(extruded.then(|| object.record.value("S")).flatten())
    }

    /// The table's colour for a region.
    pub fn of_table(&self, number: i64) -> Option<Colour> {
        self.table.iter().find(|(low, high, _)| (*low..=*high).contains(&number)).map(|(_, _, c)| *c)
    }
}

/// Three parts of 255 to linear light.
pub(super) fn colour_of(rgb: [f64; 3]) -> Colour {
    linear(rgb.map(|c| c / 255.0), 1.0)
}

/// `{255 0 0}` or `255/0/0`.
fn colour(value: &str) -> Option<Colour> {
    let parts: Option<Vec<f64>> = value.split(['/', ' ']).filter(|w| !w.is_empty()).map(|w| w.parse().ok()).collect();
    Some(colour_of(parts?[..].try_into().ok()?))
}

/// The colour, or a warning.
fn colour_or_warning(value: &str, line: usize, warnings: &mut Warnings) -> Option<Colour> {
    let found = colour(value);
    if found.is_none() {
        let shown: String = value.chars().take(40).collect();
        warnings.push("colour left out", || Place::Line(line), || format!("`{shown}` is no red, green and blue"));
    }
    found
}

/// Objects of the form with `put`.
pub(super) fn read<'a>(
    text: &'a str,
    report: &mut ImportReport,
    warnings: &mut Warnings,
) -> Result<Database<'a>, Fault> {
    let mut database = Database::default();
    for statement in words::statements(text)? {
        let (line, words) = (statement.line, statement.words);
        match words[0] {
            "put" if words.len() >= 3 => {
                let pairs = words[3..].chunks_exact(2).map(|p| (Cow::Borrowed(p[0]), Cow::Borrowed(p[1])));
                let record = Record { line, name: words[1], kind: words[2], fields: pairs.collect() };
                let value = |key: &str| words[3..].chunks_exact(2).find(|p| p[0] == key).map(|p| p[1]);
                let combination = if record.kind == "comb" {
                    let items = value("tree").map(|t| tree::parse(t, line)).transpose()?.unwrap_or_default();
                    let mut all = Combination { items, ..Combination::default() };
                    record.fields.iter().for_each(|(k, v)| attribute(&mut all, k, v));
                    Some(all)
                } else {
                    None
                };
                let own = value("rgb").and_then(|rgb| colour_or_warning(rgb, line, warnings));
                database.add(record, combination, own, report, warnings);
            }
            "put" => return Err(Fault::new(line, "`put` without name and kind")),
            "units" => report.units.extend(words.get(1).map(|u| (*u).to_owned())),
            "attr" => {
                let Some(name) = words.get(2) else { continue };
                let Some(object) = database.objects.get_mut(name) else {
                    // names of the database's own begin so
                    if !name.starts_with('_') {
                        warnings.push(
                            "attributes not used",
                            || Place::Line(line),
                            || format!("`{name}` does not exist"),
                        );
                    }
                    continue;
                };
                for pair in words[3..].chunks_exact(2) {
                    if matches!(pair[0], "rgb" | "color") {
                        object.colour = colour_or_warning(pair[1], line, warnings).or(object.colour);
                    }
                    object.combination.iter_mut().for_each(|c| attribute(c, pair[0], pair[1]));
                }
            }
            "color" => {
                let numbers = words[1..].iter().take(5).map(|w| w.parse().ok()).collect::<Option<Vec<f64>>>();
                match numbers.as_deref() {
                    Some(&[low, high, r, g, b]) => {
                        database.table.push((low as i64, high as i64, colour_of([r, g, b])));
                    }
                    _ => warnings.push("colour of regions left out", || Place::Line(line), || words[1..].join(" ")),
                }
            }
            "title" | "find" => {}
            other => {
                let other: String = other.chars().take(40).collect();
                return Err(Fault::new(line, format!("`{other}` is not a statement of such a file")));
            }
        }
    }
    Ok(database)
}

/// What a combination says of itself.
fn attribute(of: &mut Combination<'_>, key: &str, value: &str) {
    let number = || value.parse().unwrap_or(0);
    match key {
        "region" => of.region = matches!(value, "yes" | "R" | "1"),
        "region_id" | "id" => of.number = number(),
        "aircode" | "air" => of.air = number() != 0,
        "inherit" => of.holds = matches!(value, "yes" | "1"),
        _ => {}
    }
}
