//! STEP files: ISO 10303-21 text with the shape of AP214.
//!
//! ```text
//!   model ─▶ PRODUCT of the assembly ◀─ NEXT_ASSEMBLY_USAGE_OCCURRENCE ─ one an instance
//!                                             │  ITEM_DEFINED_TRANSFORMATION
//!   part  ─▶ PRODUCT ─▶ shape representation ─▶ solids or shells (`shape`, `geometry`), STYLED_ITEMs
//!   solid ─▶ PRODUCT ─▶ CSG_SHAPE_REPRESENTATION ─▶ an expression over primitives (`csg`, `facets`)
//! ```
//!
//! A model of one part that stands at the origin is one product without an assembly. STEP's placements are rigid: an
//! instance that scales, shears or mirrors, or that has a colour of its own, becomes a product of its own.
//!
//! Source: ISO 10303-21, -42, -43, -44, -214, and CAx-IF Recommended Practices.

mod csg;
mod facets;
mod geometry;
mod shape;
mod text;

use super::operand::{RIGID, faces};
use super::{ExportError, ExportWarning, Item, baked};
use crate::csg::{Node, Tree};
use crate::model::{Colour, Instance, Model, Part, Primitive, Solid, srgb};
use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashMap;
use std::io::{self, Write};
use text::{Id, List, Quoted, Real, Text, reals};

/// Writes `model` as ISO 10303-21 text (AP214), millimetres. The same model gives the same bytes.
///
/// Planes are written as planes, every other face as its exact rational B-spline. Faces that meet within 1e-5 of the
/// part's diagonal share edges. In a part marked as closed, edges that would stay alone are shared within 2e-4. Curves
/// in space are exact on planes and along parameter lines, else fitted to 1e-8 of the diagonal. The largest distance
/// met is the file's UNCERTAINTY.
///
/// A solid that is one bounded primitive is written as its exact faces, or as its mesh. A Boolean expression becomes a
/// CSG_SOLID: a tree of operations over primitives with exact dimensions, half-spaces, and solids of exact faces for
/// stretched primitives and for parts. Not every program reads those, so a warning names each. Expressions over
/// quadrics, empty solids, meshes of parts, and parts without instances are not written: a warning names them. A part
/// marked as closed whose edges do not meet becomes an open shell, with a warning.
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
    let mut file = Writer { text, context, product, design, origin, uncertainty: 0.0, styled: Colours::default() };
    let mut children = Vec::new();
    for p in products(model, &mut warnings)? {
        children.push((file.part(&p, &mut warnings)?, p.places));
    }
    for (k, solid) in model.solids.iter().enumerate() {
        children.extend(file.solid(k, solid, &mut warnings)?);
    }
    let alone = matches!(&children[..], [(_, places)] if matches!(&places[..], [(t, _)] if *t == DAffine3::IDENTITY));
    if !alone {
        file.assembly(&model.name, &children)?;
    }
    if !file.styled.items.is_empty() {
        let items = List(&file.styled.items);
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
    /// A copy for one instance, its transform carried out.
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
            None => all.push(alone(part, i, Item::Part(i.part))),
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
    Ok(all)
}

/// The product of a solid that is one primitive, from its faces in the primitive's own coordinates.
fn placed_solid(p: &Primitive, part: Part, name: String, item: Item) -> Product {
    let part = Part { name, ..part };
    let instance = Instance { part: 0, transform: p.transform, colour: Some(p.colour), name: part.name.clone() };
    if is_rigid(&p.transform.matrix3) {
        let places = vec![(p.transform, instance.name)];
        return Product { part, item, baked: false, colour: instance.colour, places };
    }
    alone(&part, &instance, item)
}

fn is_rigid(m: &DMat3) -> bool {
    let off = *m * m.transpose() - DMat3::IDENTITY;
    off.to_cols_array().iter().all(|x| x.abs() <= RIGID) && m.determinant() > 0.0
}

/// The product of one instance, its transform carried out.
fn alone(part: &Part, i: &Instance, item: Item) -> Product {
    let places = vec![(DAffine3::IDENTITY, i.name.clone())];
    Product { part: baked(part, &i.transform), item, baked: true, colour: i.colour, places }
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

/// Styled items, and the styles that they share.
#[derive(Default)]
struct Colours {
    items: Vec<Id>,
    styles: HashMap<[u32; 4], Id>,
}

impl Colours {
    /// Takes the items of another text.
    fn append(&mut self, other: Self) {
        self.items.extend(other.items);
        self.styles.extend(other.styles);
    }
}

/// Where products stand, by name.
type Places = Vec<(DAffine3, String)>;

/// A product that can be placed.
struct Written {
    definition: Id,
    representation: Id,
}

impl<W: Write> Writer<'_, '_, W> {
    fn part(&mut self, p: &Product, warnings: &mut Vec<ExportWarning>) -> Result<Written, ExportError> {
        let mut part = p.part.clone();
        // an instance's colour is all of its faces', a primitive's that of those without their own
        if p.colour.is_some() && matches!(p.item, Item::Part(_)) {
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

    /// A Boolean solid; a warning names what is not written.
    fn solid(
        &mut self,
        index: usize,
        solid: &Solid,
        warnings: &mut Vec<ExportWarning>,
    ) -> Result<Option<(Written, Places)>, ExportError> {
        let item = Item::Solid(index);
        let name = format!("solid {}", solid.primitives().first().map_or(index as u32 + 1, |p| p.id));
        let empty: Vec<bool> = solid.primitives().iter().map(|p| p.bounds().is_empty()).collect();
        let tree: Tree = solid.tree().fold(|p| empty[p as usize].then_some(false));
        if let Some(all) = tree.as_constant() {
            let what = if all { "all space" } else { "empty" };
            warnings.push(ExportWarning { item, message: format!("is {what} and was left out") });
            return Ok(None);
        }
        if let [Node::Leaf(p)] = *tree.nodes() {
            let p = &solid.primitives()[p as usize];
            if let Ok(part) = faces(&p.shape) {
                let product = placed_solid(p, part, name, item);
                return Ok(Some((self.part(&product, warnings)?, product.places)));
            }
        }
        let written = csg::solid(self.text, &name, (solid, &tree), item, &mut self.styled, warnings)?;
        let Some(csg::Written { item, plain, deviation }) = written else { return Ok(None) };
        self.uncertainty = self.uncertainty.max(deviation);
        let kind = if plain { "FACETED_BREP" } else { "CSG" };
        let (origin, context) = (self.origin, self.context);
        let representation =
            self.text.add(format_args!("{kind}_SHAPE_REPRESENTATION('',({item},{origin}),{context})"))?;
        Ok(Some((self.product(&name, representation)?, vec![(DAffine3::IDENTITY, name)])))
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

    fn assembly(&mut self, name: &str, children: &[(Written, Places)]) -> io::Result<()> {
        let mut items = vec![self.origin];
        for (transform, _) in children.iter().flat_map(|c| &c.1) {
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
fn style<W: Write>(text: &mut Text<W>, colours: &mut Colours, item: Id, colour: Colour) -> io::Result<()> {
    let key = colour.map(f32::to_bits);
    let style = match colours.styles.get(&key) {
        Some(&style) => style,
        None => surface_style(text, colour)?,
    };
    colours.styles.insert(key, style);
    colours.items.push(text.add(format_args!("STYLED_ITEM('',({style}),{item})"))?);
    Ok(())
}

fn surface_style<W: Write>(text: &mut Text<W>, colour: Colour) -> io::Result<Id> {
    let [r, g, b, opacity] = colour.map(f64::from);
    let rgb = reals([r, g, b].map(srgb::encoded));
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
    text.add(format_args!("PRESENTATION_STYLE_ASSIGNMENT(({usage}))"))
}
