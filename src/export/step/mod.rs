//! STEP files: ISO 10303-21 text with the shape of AP214.
//!
//! ```text
//!   model ─▶ PRODUCT of the assembly ◀─ NEXT_ASSEMBLY_USAGE_OCCURRENCE ─ one an instance
//!                                             │  ITEM_DEFINED_TRANSFORMATION
//!   part  ─▶ PRODUCT ─▶ shape representation ─▶ solids or shells (`shape`, `geometry`), STYLED_ITEMs
//! ```
//!
//! A model of one part that stands at the origin is one product without an assembly. STEP places rigidly: an
//! instance that scales, shears or mirrors, or that has a colour of its own, becomes a product of its own.
//!
//! Source: ISO 10303-21, -42, -43, -44, -214, and CAx-IF Recommended Practices.

mod geometry;
mod shape;
mod text;

use super::primitive;
use super::{ExportError, ExportWarning, Item};
use crate::model::{Colour, Face, Instance, Model, Part, Primitive};
use glam::{DAffine3, DMat3, DVec3};
use std::io::{self, Write};
use text::{Id, List, Quoted, Real, Text, reals};

/// How far a matrix may be from a rotation.
const RIGID: f64 = 1e-12;

/// Writes `model` as ISO 10303-21 text (AP214), millimetres. The same model gives the same bytes.
///
/// Planes are written as such, every other face as its exact rational B-spline. Edges of faces that meet within
/// 1e-5 of the part's diagonal are shared, and within 2e-4 those of a part that says it is closed that would stay alone;
/// their curves in space are exact on planes and along parameter lines, else fitted to 1e-8 of the diagonal. The largest
/// distance met is the file's UNCERTAINTY.
///
/// A solid that is one primitive is written as its exact faces. Boolean expressions, half-spaces, quadrics and meshes,
/// and parts without instances, are not written: a warning names them. So is a part that says it is closed but whose
/// edges do not meet; it becomes an open shell.
///
/// # Errors
/// [`ExportError`] when writing fails or the model's instances are not sound.
pub fn step(model: &Model, out: &mut impl Write) -> Result<Vec<ExportWarning>, ExportError> {
    let mut warnings = Vec::new();
    let text = &mut Text::new(out);
    let name = Quoted(&model.name);
    text.raw("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n")?;
    text.raw(&format!("FILE_NAME({name},'',(''),(''),'','selvedge {}','');\n", env!("CARGO_PKG_VERSION")))?;
    text.raw("FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n")?;
    let context = text.reserve();
    let application =
        text.add(format_args!("APPLICATION_CONTEXT('core data for automotive mechanical design processes')"))?;
    text.add(format_args!(
        "APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,{application})"
    ))?;
    let product = text.add(format_args!("PRODUCT_CONTEXT('',{application},'mechanical')"))?;
    let design = text.add(format_args!("PRODUCT_DEFINITION_CONTEXT('part definition',{application},'design')"))?;
    let origin = text.placement(DVec3::ZERO, DVec3::Z, DVec3::X)?;
    let mut file = Writer { text, context, product, design, origin, uncertainty: 0.0, styled: Vec::new() };
    let placed = products(model, &mut warnings)?;
    let alone = matches!(&placed[..], [p] if matches!(&p.places[..], [(t, _)] if *t == DAffine3::IDENTITY));
    let mut children = Vec::new();
    for p in &placed {
        children.push((file.part(p, &mut warnings)?, &p.places));
    }
    if !alone {
        file.assembly(&model.name, &children)?;
    }
    if !file.styled.is_empty() {
        let items = List(&file.styled);
        file.text.add(format_args!("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',{items},{context})"))?;
    }
    file.text.context(context, file.uncertainty.max(f64::MIN_POSITIVE))?;
    file.text.raw("ENDSEC;\nEND-ISO-10303-21;\n")?;
    Ok(warnings)
}

/// A part as it is written, and where it stands.
struct Product {
    part: Part,
    /// Where it is from.
    item: Item,
    /// Stands for one instance alone, its transform carried out.
    baked: bool,
    colour: Option<Colour>,
    places: Vec<(DAffine3, String)>,
}

/// The products of a model: instances that differ in more than their place have their own.
fn products(model: &Model, warnings: &mut Vec<ExportWarning>) -> Result<Vec<Product>, ExportError> {
    let mut all: Vec<Product> = Vec::new();
    for (instance, i) in model.instances.iter().enumerate() {
        let parts = model.parts.len();
        let part = model.parts.get(i.part).ok_or(ExportError::Part { instance, part: i.part, parts })?;
        let determinant = i.transform.matrix3.determinant();
        if !i.transform.is_finite() || determinant == 0.0 || !determinant.is_finite() {
            return Err(ExportError::Transform { instance });
        }
        if part.faces.is_empty() {
            continue;
        }
        let place = (i.transform, i.name.clone());
        let rigid = is_rigid(&i.transform.matrix3);
        let same = |p: &&mut Product| rigid && !p.baked && p.item == Item::Part(i.part) && p.colour == i.colour;
        match all.iter_mut().find(same) {
            Some(product) => product.places.push(place),
            None if rigid => {
                let (item, colour) = (Item::Part(i.part), i.colour);
                all.push(Product { part: part.clone(), item, baked: false, colour, places: vec![place] });
            }
            None => all.push(baked(part, i, Item::Part(i.part))),
        }
    }
    for (part, p) in model.parts.iter().enumerate() {
        if !p.meshes.is_empty() {
            let message = format!("{} meshes were left out", p.meshes.len());
            warnings.push(ExportWarning { item: Item::Part(part), message });
        }
        if !model.instances.iter().any(|i| i.part == part) {
            let message = "has no instance and was left out".into();
            warnings.push(ExportWarning { item: Item::Part(part), message });
        }
    }
    for (k, solid) in model.solids.iter().enumerate() {
        let item = Item::Solid(k);
        let sound = |t: &DAffine3| t.is_finite() && t.matrix3.determinant() != 0.0;
        match primitive::faces(solid) {
            Ok((p, part)) if sound(&p.transform) => all.push(placed_solid(p, part, item)),
            Ok(_) => warnings.push(ExportWarning { item, message: "is flat and was left out".into() }),
            Err(message) => warnings.push(ExportWarning { item, message }),
        }
    }
    Ok(all)
}

/// The product of a solid that is one primitive.
fn placed_solid(p: &Primitive, part: Part, item: Item) -> Product {
    let part = Part { name: format!("solid {}", p.id), ..part };
    let instance = Instance { part: 0, transform: p.transform, colour: Some(p.colour), name: part.name.clone() };
    if is_rigid(&p.transform.matrix3) {
        let places = vec![(p.transform, part.name.clone())];
        return Product { part, item, baked: false, colour: instance.colour, places };
    }
    baked(&part, &instance, item)
}

fn is_rigid(m: &DMat3) -> bool {
    let off = *m * m.transpose() - DMat3::IDENTITY;
    off.to_cols_array().iter().all(|x| x.abs() <= RIGID) && m.determinant() > 0.0
}

/// A part with its transform carried out.
fn baked(part: &Part, i: &Instance, item: Item) -> Product {
    let mirrored = i.transform.matrix3.determinant() < 0.0;
    let face = |f: &Face| Face {
        surface: f.surface.transformed(&i.transform),
        same_sense: f.same_sense != mirrored,
        ..f.clone()
    };
    let part = Part { faces: part.faces.iter().map(face).collect(), meshes: Vec::new(), ..part.clone() };
    let places = vec![(DAffine3::IDENTITY, i.name.clone())];
    Product { part, item, baked: true, colour: i.colour, places }
}

/// The file so far.
struct Writer<'t, 'w, W> {
    text: &'t mut Text<'w, W>,
    context: Id,
    product: Id,
    design: Id,
    origin: Id,
    uncertainty: f64,
    styled: Colours,
}

/// Styled items.
type Colours = Vec<Id>;

/// A product that can be placed.
struct Written {
    definition: Id,
    representation: Id,
}

impl<W: Write> Writer<'_, '_, W> {
    fn part(&mut self, p: &Product, warnings: &mut Vec<ExportWarning>) -> Result<Written, ExportError> {
        let mut part = p.part.clone();
        if p.colour.is_some() {
            part.faces.iter_mut().for_each(|f| f.colour = None);
        }
        let mut shape = shape::shape(self.text, &part, p.item, &mut self.styled, warnings)?;
        self.uncertainty = self.uncertainty.max(shape.deviation);
        if let Some(colour) = p.colour {
            for item in &shape.items {
                style(self.text, &mut self.styled, *item, colour)?;
            }
        }
        shape.items.push(self.origin);
        let kind = if shape.solid { "ADVANCED_BREP" } else { "MANIFOLD_SURFACE" };
        let (items, context) = (List(&shape.items), self.context);
        let representation = self.text.add(format_args!("{kind}_SHAPE_REPRESENTATION('',{items},{context})"))?;
        Ok(self.product(&part.name, representation)?)
    }

    fn product(&mut self, name: &str, representation: Id) -> io::Result<Written> {
        let (name, text) = (Quoted(name), &mut *self.text);
        let product = text.add(format_args!("PRODUCT({name},{name},'',({}))", self.product))?;
        text.add(format_args!("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,({product}))"))?;
        let formation = text.add(format_args!("PRODUCT_DEFINITION_FORMATION('','',{product})"))?;
        let definition = text.add(format_args!("PRODUCT_DEFINITION('design','',{formation},{})", self.design))?;
        let shape = text.add(format_args!("PRODUCT_DEFINITION_SHAPE('','',{definition})"))?;
        text.add(format_args!("SHAPE_DEFINITION_REPRESENTATION({shape},{representation})"))?;
        Ok(Written { definition, representation })
    }

    fn assembly(&mut self, name: &str, children: &[(Written, &Vec<(DAffine3, String)>)]) -> io::Result<()> {
        let mut items = vec![self.origin];
        for (transform, _) in children.iter().flat_map(|c| c.1) {
            let m = transform.matrix3;
            items.push(self.text.placement(transform.translation, m.z_axis, m.x_axis)?);
        }
        let (list, context) = (List(&items), self.context);
        let representation = self.text.add(format_args!("SHAPE_REPRESENTATION('',{list},{context})"))?;
        let root = self.product(name, representation)?;
        let (text, origin) = (&mut *self.text, self.origin);
        let places = children.iter().flat_map(|(child, places)| places.iter().map(move |(_, name)| (child, name)));
        for (k, ((child, name), item)) in places.zip(&items[1..]).enumerate() {
            let (number, name) = (k + 1, Quoted(name));
            let usage = text.add(format_args!(
                "NEXT_ASSEMBLY_USAGE_OCCURRENCE('{number}',{name},'',{},{},$)",
                root.definition, child.definition
            ))?;
            let shape = text.add(format_args!("PRODUCT_DEFINITION_SHAPE('','',{usage})"))?;
            let motion = text.add(format_args!("ITEM_DEFINED_TRANSFORMATION('','',{origin},{item})"))?;
            let relation = text.add(format_args!(
                "(REPRESENTATION_RELATIONSHIP('','',{},{representation})\
                 REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION({motion})SHAPE_REPRESENTATION_RELATIONSHIP())",
                child.representation
            ))?;
            text.add(format_args!("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION({relation},{shape})"))?;
        }
        Ok(())
    }
}

/// Gives an item its colour; files hold sRGB.
fn style<W: Write>(text: &mut Text<W>, styled: &mut Colours, item: Id, colour: Colour) -> io::Result<()> {
    let [r, g, b, opacity] = colour.map(f64::from);
    let rgb = reals([r, g, b].map(encoded));
    let rgb = text.add(format_args!("COLOUR_RGB('',{})", rgb.trim_matches(['(', ')'])))?;
    let fill = text.add(format_args!("FILL_AREA_STYLE_COLOUR('',{rgb})"))?;
    let fill = text.add(format_args!("FILL_AREA_STYLE('',({fill}))"))?;
    let mut sides = vec![text.add(format_args!("SURFACE_STYLE_FILL_AREA({fill})"))?];
    if opacity < 1.0 {
        let clear = text.add(format_args!("SURFACE_STYLE_TRANSPARENT({})", Real(1.0 - opacity)))?;
        sides
            .push(text.add(format_args!("SURFACE_STYLE_RENDERING_WITH_PROPERTIES(.NORMAL_SHADING.,{rgb},({clear}))"))?);
    }
    let side = text.add(format_args!("SURFACE_SIDE_STYLE('',{})", List(&sides)))?;
    let usage = text.add(format_args!("SURFACE_STYLE_USAGE(.BOTH.,{side})"))?;
    let assigned = text.add(format_args!("PRESENTATION_STYLE_ASSIGNMENT(({usage}))"))?;
    styled.push(text.add(format_args!("STYLED_ITEM('',({assigned}),{item})"))?);
    Ok(())
}

/// Linear light to sRGB (IEC 61966-2-1).
fn encoded(c: f64) -> f64 {
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}
