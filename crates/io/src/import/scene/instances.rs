//! The scene as a whole: settings, named objects, instances, cameras.
//!
//! ```text
//!   [[instance]]  of = "bolt"  at = [20, 0, 5]          without any, each item that no other item uses
//!                 repeat = 6   step = { rotate = 60 }   is drawn once, unmoved
//! ```

use super::items::{Scene, Section, Thing};
use super::solid::{self, Adding, Form};
use super::text::{Fault, Outcome, Table, Value, shortened};
use super::{VERSION, cameras, cuts, place};
use crate::import::camera::PictureSettings;
use crate::import::solid::Assembly;
use crate::import::{FaceRecord, Import, ImportReport, Options, Warning};
use crate::model::{Colour, Face, Instance, Model, Part, Primitive, Solid, SurfaceTable};
use glam::DAffine3;
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Names listed in a message.
const MOST_LISTED: usize = 20;

/// Millimetres of the units of length.
const UNITS: [(&str, f64); 7] =
    [("mm", 1.0), ("cm", 10.0), ("m", 1000.0), ("um", 1e-3), ("km", 1e6), ("in", 25.4), ("ft", 304.8)];
/// Most copies by one `repeat`.
const MOST_COPIES: usize = 1 << 16;

/// Reads the text.
pub(super) fn read(text: &str, file: &str, folder: Option<&Path>, options: &Options<'_>) -> Outcome<Import> {
    let parsed = DeTable::parse(text).map_err(|e| {
        let at = e.span().map_or(0, |s| s.start);
        Fault::new(at, e.message().trim_end().to_owned())
    })?;
    let span = parsed.span();
    let root = Spanned::new(span, DeValue::Table(parsed.into_inner()));
    let mut table = Value::new("", &root).table()?;
    table.at = 0;
    let mut scene = Scene::new(text, folder, options);
    let mut model = settings(&mut scene, &mut table, file)?;
    scene.list(&mut table)?;
    let (instances, named) = (table.get("instance"), table.get("camera"));
    let picture = table.read("picture", Value::table)?;
    let (trim, sections, clear) = (table.get("trim"), table.get("section"), table.get("xray"));
    table.finish()?;
    for item in scene.items.clone() {
        scene.make(item)?;
    }
    let trim = trim.map(|name| cuts::volume(&mut scene, name)).transpose()?;
    model.unit = UNITS.iter().find(|u| u.1 == scene.unit).map_or("mm", |u| u.0).to_owned();
    let mut builder = Builder { model, ..Builder::default() };
    match instances {
        Some(value) => {
            for value in value.list()? {
                builder.instance(&mut scene, value)?;
            }
        }
        None => builder.unused(&mut scene)?,
    }
    if builder.placed.is_empty() {
        return Err(Fault::new(0, "the scene has nothing to draw"));
    }
    let mut list = Vec::new();
    if let Some(value) = named {
        for (name, at, value) in value.table()?.all() {
            let mut table = value.table()?;
            table.at = *at;
            list.push(cameras::camera(&scene, name, table, |v| builder.bounds(v))?);
        }
    }
    let picture = picture.map_or(Ok(PictureSettings::default()), |t| cameras::picture(t, &list))?;
    if let Some(clear) = clear {
        builder.xray(clear)?;
    }
    let mut import = builder.finish(&scene);
    (import.cameras, import.picture) = (list, picture);
    cuts::cut(&scene, &mut import.model, trim.as_ref(), sections)?;
    Ok(import)
}

/// Version, name, unit and tolerances.
fn settings<'a>(scene: &mut Scene<'a>, table: &mut Table<'a>, file: &str) -> Outcome<Model> {
    let version = table.get("selvedge").ok_or_else(|| {
        Fault::new(0, format!("not a scene: `selvedge = {VERSION}` is missing, the version of its form"))
    })?;
    let found = version.count(0, usize::MAX >> 1)?;
    if found != VERSION {
        return Err(version.fault(format!("version {found} of the scene form; this engine reads version {VERSION}")));
    }
    let name = table.read("name", Value::text)?;
    scene.unit = table.read("unit", |v| v.word(&UNITS))?.unwrap_or(1.0);
    // a thousandth of a millimetre
    scene.tolerance = table.read("tolerance", Value::positive)?.unwrap_or(1e-3 / scene.unit);
    let coincident = table.get("coincident").map(|value| {
        let (share, range) = (value.number()?, SurfaceTable::FINEST..=SurfaceTable::COARSEST);
        let told = || value.fault(format!("a share from {:e} to {:e} is wanted", range.start(), range.end()));
        if range.contains(&share) { Ok(share) } else { Err(told()) }
    });
    let name = name.map_or_else(|| crate::import::stem(file), str::to_owned);
    Ok(Model { name, coincident: coincident.transpose()?, ..Model::default() })
}

/// The model so far.
#[derive(Default)]
struct Builder<'a> {
    model: Model,
    report: ImportReport,
    warnings: Vec<Warning>,
    /// Indices of the model's parts by item.
    parts: HashMap<&'a str, Range<usize>>,
    /// Instances and solids that each placement has added, by item.
    placed: Vec<(&'a str, Range<usize>, Range<usize>)>,
}

/// One placement of an item.
struct Placing<'a> {
    value: Value<'a>,
    transform: DAffine3,
    colour: Option<Colour>,
    name: &'a str,
}

impl<'a> Builder<'a> {
    /// `[[instance]]`.
    fn instance(&mut self, scene: &mut Scene<'a>, value: Value<'a>) -> Outcome<()> {
        let mut table = value.table()?;
        let names = table.need("of")?.names()?;
        let first = place::placement(&mut table)?;
        let colour = table.read("colour", Value::colour)?;
        let name = table.read("name", Value::text)?;
        let copies = table.read("repeat", |v| v.count(1, MOST_COPIES))?.unwrap_or(1);
        let step = table.read("step", |v| {
            let mut step = v.table()?;
            let by = place::placement(&mut step)?;
            step.finish()?;
            by.ok_or_else(|| v.fault("a step goes nowhere without `at`, `rotate`, `scale` or `matrix`"))
        })?;
        match (table.get("repeat"), table.get("step")) {
            (Some(v), None) if copies > 1 => return Err(v.fault("without a `step` all copies are in one place")),
            (None, Some(v)) => return Err(v.fault("without `repeat` there is nothing to step")),
            _ => {}
        }
        table.finish()?;
        let (mut transform, step) = (scene.millimetres(first), scene.millimetres(step));
        for _ in 0..copies {
            if !transform.is_finite() {
                return Err(value.fault("its steps leave the range of numbers"));
            }
            for of in &names {
                let word = of.text()?;
                self.place(scene, Placing { value: *of, transform, colour, name: name.unwrap_or(word) })?;
            }
            transform = step * transform;
        }
        Ok(())
    }

    /// Places every item that no other item uses, once.
    fn unused(&mut self, scene: &mut Scene<'a>) -> Outcome<()> {
        for item in scene.items.clone() {
            if item.section != Section::Curve && !scene.used.contains(item.name) {
                let thing = scene.make(item)?;
                let value = item.value();
                let placing = Placing { value, transform: DAffine3::IDENTITY, colour: None, name: item.name };
                self.put(scene, item.name, &thing, placing)?;
            }
        }
        Ok(())
    }

    fn place(&mut self, scene: &mut Scene<'a>, placing: Placing<'a>) -> Outcome<()> {
        let thing = scene.thing(placing.value)?;
        self.put(scene, placing.value.text()?, &thing, placing)
    }

    /// Adds a thing to the model.
    fn put(&mut self, scene: &mut Scene<'a>, item: &'a str, thing: &Thing, placing: Placing<'a>) -> Outcome<()> {
        let (instances, solids) = (self.model.instances.len(), self.model.solids.len());
        scene.spend(1, placing.value)?;
        match thing {
            Thing::Curve(_) => return Err(scene.other(placing.value, thing, "surface, solid, part or file")),
            Thing::Surface(made) => {
                let parts = self.parts(item, |b| {
                    let face = made.face(scene.number(), scene.unit);
                    let known = (made.deviation * scene.unit, made.notes.clone());
                    b.part(scene, Part { name: item.to_owned(), ..Part::default() }, vec![(face, known)]);
                });
                self.add(parts.start, &placing, placing.transform);
            }
            Thing::Body(body) => match &body.form {
                Form::Part(part) => {
                    let parts = self.parts(item, |b| {
                        let faces = part.faces.iter().cloned().zip(body.faces.iter().cloned()).collect();
                        b.part(scene, Part { faces: Vec::new(), ..(**part).clone() }, faces);
                    });
                    self.add(parts.start, &placing, placing.transform);
                }
                _ => {
                    let mut assembly = Assembly::default();
                    let how = Adding { transform: placing.transform, over: placing.colour, inherited: None };
                    let root = solid::add(scene, &mut assembly, thing, how, placing.value)?;
                    self.model.solids.push(assembly.finish(root).map_err(|e| placing.value.fault(e))?);
                }
            },
            Thing::File(file) => {
                let model = &file.import.model;
                let transform = placing.transform * file.transform;
                let parts = self.parts(item, |b| b.file(&file.import));
                for instance in &model.instances {
                    scene.spend(1, placing.value)?;
                    let colour = placing.colour.or(file.colour).or(instance.colour);
                    self.model.instances.push(Instance {
                        part: parts.start + instance.part,
                        transform: transform * instance.transform,
                        colour,
                        name: instance.name.clone(),
                    });
                }
                for solid in &model.solids {
                    scene.spend(solid.primitives().len(), placing.value)?;
                    let placed = |p: &Primitive| Primitive {
                        transform: transform * p.transform,
                        colour: placing.colour.or(file.colour).unwrap_or(p.colour),
                        ..p.clone()
                    };
                    let primitives = solid.primitives().iter().map(placed).collect();
                    let solid = Solid::new(primitives, solid.tree().clone()).map_err(|e| placing.value.fault(e))?;
                    self.model.solids.push(solid);
                }
            }
        }
        self.placed.push((item, instances..self.model.instances.len(), solids..self.model.solids.len()));
        Ok(())
    }

    /// The model's parts of an item, made by `make` the first time.
    fn parts(&mut self, item: &'a str, make: impl FnOnce(&mut Self)) -> Range<usize> {
        if let Some(range) = self.parts.get(item) {
            return range.clone();
        }
        let first = self.model.parts.len();
        make(self);
        let range = first..self.model.parts.len();
        self.parts.insert(item, range.clone());
        range
    }

    /// A part and the records of its faces.
    fn part(&mut self, scene: &Scene<'_>, mut part: Part, faces: Vec<(Face, (f64, Vec<String>))>) {
        for (face, known) in faces {
            let tolerance = scene.tolerance * scene.unit;
            let record = FaceRecord { id: face.id, part: self.model.parts.len(), tolerance, ..FaceRecord::default() };
            part.faces.push(self.report.record_made(record, face, known));
        }
        self.report.faces += part.faces.len();
        self.model.parts.push(part);
    }

    /// Adds the parts of another file, and its report.
    fn file(&mut self, import: &Import) {
        let first = self.model.parts.len();
        self.model.parts.extend(import.model.parts.iter().cloned());
        let (own, of) = (&mut self.report, &import.report);
        own.faces += of.faces;
        own.edges += of.edges;
        own.meshes += of.meshes;
        let moved = |r: &FaceRecord| FaceRecord { part: r.part + first, ..r.clone() };
        own.face_records.extend(of.face_records.iter().map(moved));
        self.told(import);
    }

    /// Adds the report of another file, whether or not its parts are placed.
    fn told(&mut self, import: &Import) {
        let (own, of) = (&mut self.report, &import.report);
        own.pcurves += of.pcurves;
        own.sloppy += of.sloppy;
        own.deviation = own.deviation.max(of.deviation);
        own.made = own.made.max(of.made);
        own.irregular += of.irregular;
        own.gap = own.gap.max(of.gap);
        for (own, of) in [
            (&mut own.warnings, &of.warnings),
            (&mut own.ignored, &of.ignored),
            (&mut own.layers, &of.layers),
            (&mut own.nodes, &of.nodes),
        ] {
            of.iter().for_each(|(what, n)| *own.entry(what.clone()).or_default() += n);
        }
        own.files_read.extend(of.files_read.iter().cloned());
        own.dropped.extend(&of.dropped);
        own.repaired.extend(&of.repaired);
        for (kind, why) in &of.left_out {
            own.left_out.entry(kind.clone()).or_default().extend(why);
        }
        own.external_files.extend(of.external_files.iter().cloned());
        own.missing_files.extend(of.missing_files.iter().cloned());
        self.warnings.extend(import.warnings.iter().cloned());
    }

    fn add(&mut self, part: usize, placing: &Placing<'_>, transform: DAffine3) {
        let (colour, name) = (placing.colour, placing.name.to_owned());
        self.model.instances.push(Instance { part, transform, colour, name });
    }

    /// Makes everything placed under some names transparent.
    fn xray(&mut self, clear: Value<'_>) -> Outcome<()> {
        let all = if clear.is_table() { vec![clear] } else { clear.list()? };
        for one in all {
            let mut table = one.table()?;
            let names = table.need("of")?.names()?;
            let opacity = table.need("opacity")?;
            table.finish()?;
            let alpha = opacity.number()?;
            if !(0.0..=1.0).contains(&alpha) {
                return Err(opacity.fault(format!("an opacity is from 0 to 1, not {alpha}")));
            }
            for name in names {
                let word = name.text()?;
                if !self.placed.iter().any(|p| p.0 == word) {
                    let known: BTreeSet<&str> = self.placed.iter().map(|p| p.0).collect();
                    let known: Vec<_> = known.iter().take(MOST_LISTED).map(|n| format!("`{n}`")).collect();
                    let message = format!(
                        "nothing that is called `{}` is placed; there are {}",
                        shortened(word),
                        known.join(", ")
                    );
                    return Err(name.fault(message));
                }
                let of = self.placed.iter().filter(|p| p.0 == word).map(|p| (p.1.clone(), p.2.clone()));
                of.for_each(|(instances, solids)| self.model.xray_placed(instances, solids, alpha as f32));
            }
        }
        Ok(())
    }

    /// Box of everything placed under a name.
    fn bounds(&self, name: Value<'_>) -> Outcome<crate::model::Bounds> {
        let word = name.text()?;
        let of: Vec<_> = self.placed.iter().filter(|p| p.0 == word).collect();
        if of.is_empty() {
            return Err(name.fault(format!("nothing that is called `{}` is placed", shortened(word))));
        }
        let all = of.iter().map(|p| self.model.bounds_of(p.1.clone(), p.2.clone()));
        Ok(all.fold(crate::model::Bounds::EMPTY, crate::model::Bounds::union))
    }

    fn finish(mut self, scene: &Scene<'a>) -> Import {
        // files whose solids are operands only
        for item in scene.items.iter().filter(|item| !self.parts.contains_key(item.name)).collect::<Vec<_>>() {
            if let Some(Thing::File(file)) = scene.made.get(item.name) {
                self.told(&file.import);
            }
        }
        let mut report = self.report;
        report.files_read.extend(scene.files.take());
        report.format = format!("selvedge scene {VERSION}");
        report.units = vec![self.model.unit.clone()];
        report.bodies = self.model.parts.len() + self.model.solids.len();
        report.occurrences = self.model.instances.iter().map(|i| i.name.clone()).collect();
        scene.shapes.iter().for_each(|(shape, n)| *report.nodes.entry(shape.clone()).or_default() += n);
        Import { model: self.model, warnings: self.warnings, report, ..Import::default() }
    }
}
