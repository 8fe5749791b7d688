//! The named objects of a scene, each made once: when another item uses it, or at the end.
//!
//! ```text
//!   thing("bowl") ──made before?──▶ shared
//!        └─ open: items being made now; a name among them is a cycle
//! ```

use super::curve::Curve;
use super::files;
use super::solid::{self, Body};
use super::surface::{self, Made};
use super::text::{Fault, Outcome, Table, Value, shortened};
use crate::construct::subdivide::Scheme;
use crate::import::{Import, Options};
use crate::model::{Colour, Part};
use glam::DAffine3;
use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

/// How deep items may be made of items.
const DEEPEST: usize = 32;
/// Longest name.
const LONGEST: usize = 64;
/// Control points of all curves and surfaces, and placed things: each costs one.
const BUDGET: usize = 1 << 21;

/// Where an item stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Section {
    Curve,
    Surface,
    Solid,
    Part,
    File,
}

impl Section {
    const ALL: [(&'static str, Self); 5] = [
        ("curve", Self::Curve),
        ("surface", Self::Surface),
        ("solid", Self::Solid),
        ("part", Self::Part),
        ("file", Self::File),
    ];

    fn word(self) -> &'static str {
        Self::ALL.iter().find(|s| s.1 == self).map_or("", |s| s.0)
    }
}

/// An item as it is written.
#[derive(Clone, Copy)]
pub(super) struct Item<'a> {
    pub section: Section,
    pub name: &'a str,
    pub at: usize,
    value: Value<'a>,
}

impl<'a> Item<'a> {
    /// Its table.
    pub fn value(&self) -> Value<'a> {
        self.value
    }
}

/// An item as it is made.
#[derive(Clone)]
pub(super) enum Thing {
    Curve(Rc<Curve>),
    Surface(Rc<Made>),
    Body(Rc<Body>),
    File(Rc<File>),
}

/// A model from another file.
pub(super) struct File {
    pub import: Import,
    /// Of the whole, in millimetres.
    pub transform: DAffine3,
    pub colour: Option<Colour>,
    /// Its parts, once they are operands.
    pub shared: OnceCell<Vec<Arc<Part>>>,
}

/// The state of reading a scene.
pub(super) struct Scene<'a> {
    pub text: &'a str,
    pub folder: Option<&'a Path>,
    /// How other files are read: without previews.
    pub options: Options<'a>,
    /// Millimetres of the file's unit.
    pub unit: f64,
    /// Of approximations, in the file's unit.
    pub tolerance: f64,
    /// In the order of the text.
    pub items: Vec<Item<'a>>,
    /// How often each shape was made.
    pub shapes: BTreeMap<String, usize>,
    /// Names that other items use.
    pub used: HashSet<&'a str>,
    places: HashMap<&'a str, usize>,
    /// Other files, as they were read.
    pub files: RefCell<Vec<PathBuf>>,
    /// By name.
    pub made: HashMap<&'a str, Thing>,
    open: Vec<&'a str>,
    budget: usize,
    numbers: u32,
}

impl<'a> Scene<'a> {
    pub fn new(text: &'a str, folder: Option<&'a Path>, options: &Options<'a>) -> Self {
        Self {
            text,
            folder,
            options: Options { preview: None, ..*options },
            unit: 1.0,
            tolerance: 1e-3,
            items: Vec::new(),
            shapes: BTreeMap::new(),
            used: HashSet::new(),
            places: HashMap::new(),
            files: RefCell::default(),
            made: HashMap::new(),
            open: Vec::new(),
            budget: BUDGET,
            numbers: 0,
        }
    }

    /// Takes the items of all sections.
    pub fn list(&mut self, root: &mut Table<'a>) -> Outcome<()> {
        for (key, section) in Section::ALL {
            let Some(value) = root.get(key) else { continue };
            for (name, at, value) in value.table()?.all() {
                self.items.push(Item { section, name, at: *at, value: *value });
            }
        }
        self.items.sort_by_key(|i| i.at);
        for (index, item) in self.items.iter().enumerate() {
            let good = item.name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
            if !good || item.name.is_empty() || item.name.len() > LONGEST {
                let name = shortened(item.name);
                let message = format!("`{name}` is no name: up to {LONGEST} letters, digits, `_` and `-`");
                return Err(Fault::new(item.at, message));
            }
            if let Some(before) = self.places.insert(item.name, index) {
                let section = self.items[before].section.word();
                return Err(Fault::new(item.at, format!("`{}` is the name of a {section} already", item.name)));
            }
        }
        Ok(())
    }

    /// A number for a face or primitive, from 1.
    pub fn number(&mut self) -> u32 {
        self.numbers += 1;
        self.numbers
    }

    /// Takes numbers up to the largest that another file used.
    pub fn numbers(&mut self, largest: u32, value: Value<'_>) -> Outcome<u32> {
        let first = self.numbers;
        let last = first.checked_add(largest).filter(|n| *n < u32::MAX / 2);
        self.numbers = last.ok_or_else(|| value.fault("too many faces for the numbers of one scene"))?;
        Ok(first)
    }

    /// Notes a shape.
    pub fn count(&mut self, shape: Value<'a>) -> Outcome<()> {
        *self.shapes.entry(shortened(shape.text()?)).or_default() += 1;
        Ok(())
    }

    /// Takes from the scene's budget.
    pub fn spend(&mut self, amount: usize, value: Value<'_>) -> Outcome<()> {
        let left = self.budget.checked_sub(amount);
        let message = || format!("the scene needs more than {BUDGET} control points and placed things");
        self.budget = left.ok_or_else(|| value.fault(message()))?;
        Ok(())
    }

    /// Millimetres for a placement in the file's unit.
    pub fn millimetres(&self, placement: Option<DAffine3>) -> DAffine3 {
        let by = placement.unwrap_or(DAffine3::IDENTITY);
        DAffine3 { translation: by.translation * self.unit, ..by }
    }

    /// The item of a name.
    pub fn thing(&mut self, name: Value<'a>) -> Outcome<Thing> {
        let word = name.text()?;
        let Some(index) = self.places.get(word).copied() else {
            return Err(name.fault(format!("nothing is called `{}`", shortened(word))));
        };
        let item = self.items[index];
        self.entered(item, name)
    }

    /// Makes an item for another one that uses it.
    pub fn entered(&mut self, item: Item<'a>, name: Value<'a>) -> Outcome<Thing> {
        self.used.insert(item.name);
        if let Some(at) = self.open.iter().position(|n| *n == item.name) {
            let circle: Vec<&str> = self.open[at..].iter().copied().chain([item.name]).collect();
            return Err(name.fault(format!("`{}` is made of itself: {}", item.name, circle.join(" of "))));
        }
        if self.open.len() == DEEPEST {
            return Err(name.fault(format!("items made of items more than {DEEPEST} deep")));
        }
        self.make(item)
    }

    /// Makes an item that was not made before.
    pub fn make(&mut self, item: Item<'a>) -> Outcome<Thing> {
        if let Some(thing) = self.made.get(item.name) {
            return Ok(thing.clone());
        }
        self.open.push(item.name);
        let mut table = item.value.table()?;
        table.at = item.at;
        let thing = match item.section {
            Section::Curve => Thing::Curve(Rc::new(surface::placed_curve(self, &mut table)?)),
            Section::Surface => Thing::Surface(Rc::new(surface::surface(self, &mut table)?)),
            Section::Solid => Thing::Body(Rc::new(solid::solid(self, item.name, &mut table)?)),
            Section::Part => Thing::Body(Rc::new(solid::part(self, item.name, &mut table)?)),
            Section::File => Thing::File(Rc::new(self.file(&mut table)?)),
        };
        table.finish()?;
        self.open.pop();
        self.made.insert(item.name, thing.clone());
        Ok(thing)
    }

    fn file(&mut self, table: &mut Table<'a>) -> Outcome<File> {
        let path = table.need("path")?;
        let scheme =
            table.read("subdivide", |v| v.word(&[("catmull-clark", Scheme::CatmullClark), ("loop", Scheme::Loop)]))?;
        let mut import = match scheme {
            Some(scheme) => {
                let tolerance = table.read("tolerance", Value::positive)?.unwrap_or(self.tolerance);
                files::subdivided(self, path, scheme, tolerance * self.unit)?
            }
            None => files::model(self, path)?,
        };
        let faces = import.model.parts.iter().flat_map(|p| &p.faces).map(|f| f.id);
        let meshes = import.model.parts.iter().flat_map(|p| &p.meshes).map(|m| m.id);
        let leaves = import.model.solids.iter().flat_map(|s| s.primitives()).map(|p| p.id);
        let largest = faces.chain(meshes).chain(leaves).max().unwrap_or(0);
        let first = self.numbers(largest, path)?;
        solid::renumber(&mut import.model, first).map_err(|e| path.fault(e))?;
        let by = super::place::placement(table)?;
        let colour = table.read("colour", Value::colour)?;
        Ok(File { import, transform: self.millimetres(by), colour, shared: OnceCell::new() })
    }

    pub fn curve(&mut self, name: Value<'a>) -> Outcome<Rc<Curve>> {
        match self.thing(name)? {
            Thing::Curve(curve) => Ok(curve),
            other => Err(self.other(name, &other, "curve")),
        }
    }

    pub fn surface(&mut self, name: Value<'a>) -> Outcome<Rc<Made>> {
        match self.thing(name)? {
            Thing::Surface(surface) => Ok(surface),
            other => Err(self.other(name, &other, "surface")),
        }
    }

    /// The fault that a thing is of another kind than wanted.
    pub fn other(&self, name: Value<'_>, thing: &Thing, wanted: &str) -> Fault {
        let found = match thing {
            Thing::Curve(_) => "curve",
            Thing::Surface(_) => "surface",
            Thing::Body(_) => "solid or part",
            Thing::File(_) => "file",
        };
        name.fault(format!("a {wanted} is wanted, and `{}` is a {found}", name.text().unwrap_or_default()))
    }
}
