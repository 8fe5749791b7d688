//! `[solid.NAME]` and `[part.NAME]`: primitives, closed bodies, Boolean expressions over them, and faces together.
//!
//! ```text
//!   half-space block sphere cylinder cone torus quadric     a primitive, exact
//!   extrude lathe tube gear gear-blank teapot capped        a closed part: trimmed faces
//!   boolean   of = "A-(B+C)"   with = { A = "plate" }       operands by letter; a solid called `A` needs no entry
//! ```

use super::curve::unknown;
use super::items::{File, Scene, Thing};
use super::text::{Fault, Outcome, Table, Value};
use super::{place, shapes, trim};
use crate::construct::{extruded_solid, lathed_solid};
use crate::csg::{self, Expression, Node, Op};
use crate::import::solid::{Assembly, Placed};
use crate::model::{Colour, Face, Mesh, Model, Part, Primitive, Quadric, Shape, ShapeError, Solid, SolidError};
use glam::{DAffine3, DVec3};
use std::sync::Arc;

/// A solid's primitives and expression, or a part.
pub(super) enum Form {
    Primitive(Shape),
    Part(Arc<Part>),
    Boolean(Expression, Vec<Thing>),
}

/// A solid or a part, in millimetres.
pub(super) struct Body {
    pub form: Form,
    /// Of primitives and expressions; a part's faces are where they belong.
    pub transform: DAffine3,
    pub colour: Option<Colour>,
    pub id: u32,
    /// Of each face of a part: deviation in millimetres, notes.
    pub faces: Vec<(f64, Vec<String>)>,
}

/// A solid by its shape.
pub(super) fn solid<'a>(scene: &mut Scene<'a>, name: &str, table: &mut Table<'a>) -> Outcome<Body> {
    let shape = table.need("shape")?;
    scene.count(shape)?;
    let mut deviation = 0.0;
    let form = match shape.text()? {
        "extrude" => {
            let loops = table.need("loops")?;
            let profile = trim::profile(scene, loops)?;
            let along = table.need("along")?.direction()?;
            Form::Part(Arc::new(extruded_solid(&profile, along).map_err(|e| shape.fault(e))?))
        }
        "lathe" => {
            let loops = table.need("loops")?;
            let profile = trim::profile(scene, loops)?;
            let angle = table.number_or("angle", 360.0)?;
            Form::Part(Arc::new(lathed_solid(&profile, angle.to_radians()).map_err(|e| shape.fault(e))?))
        }
        "boolean" => boolean(scene, table)?,
        _ => match shapes::ready(scene, shape, table)? {
            Some((part, off)) => {
                deviation = off * scene.unit;
                Form::Part(Arc::new(part))
            }
            None if table.flag("faces")? => {
                // placed in the file's unit
                let part = shapes::faces(&primitive(shape, table, 1.0)?);
                let part = part.ok_or_else(|| shape.fault("it has no faces that end"))?;
                Form::Part(Arc::new(part.map_err(|e| shape.fault(e))?))
            }
            None => Form::Primitive(primitive(shape, table, scene.unit)?),
        },
    };
    let by = place::placement(table)?;
    let colour = table.read("colour", Value::colour)?;
    match form {
        Form::Part(part) => {
            let mut body = closed(scene, name, (&part, shape), by, colour)?;
            body.faces.iter_mut().for_each(|f| f.0 = deviation);
            Ok(body)
        }
        form => {
            let transform = scene.millimetres(by);
            Ok(Body { form, transform, colour, id: scene.number(), faces: Vec::new() })
        }
    }
}

/// The analytic primitives, checked.
fn primitive(named: Value<'_>, table: &mut Table<'_>, unit: f64) -> Outcome<Shape> {
    let mut size = |key: &'static str| -> Outcome<f64> {
        let value = table.need(key)?;
        let x = value.number()?;
        if x < 0.0 { Err(value.fault(format!("{x} is below 0"))) } else { Ok(x * unit) }
    };
    let shape = match named.text()? {
        "sphere" => Shape::Sphere { radius: size("radius")? },
        "cylinder" => Shape::Cylinder { radius: size("radius")?, height: size("height")? },
        "cone" => Shape::Cone { bottom: size("bottom")?, top: size("top")?, height: size("height")? },
        "torus" => Shape::Torus { major: size("major")?, minor: size("minor")? },
        "block" => block(table, unit)?,
        "half-space" => {
            let (normal, offset) = (table.need("normal")?.direction()?, table.number_or("offset", 0.0)?);
            Shape::HalfSpace { normal, offset: offset * unit }
        }
        "quadric" => {
            let mut vector = |key: &'static str| table.read(key, Value::point).map(|v| v.unwrap_or(DVec3::ZERO));
            // lengths in millimetres: q(x / unit) times the unit's square
            Shape::Quadric(Quadric {
                squares: vector("squares")?,
                products: vector("products")?,
                linear: vector("linear")? * unit,
                constant: table.number_or("constant", 0.0)? * unit * unit,
            })
        }
        _ => return Err(unknown(named, &[SOLIDS, shapes::READY].concat())),
    };
    shape.check().map_err(|e: ShapeError| named.fault(e))?;
    Ok(shape)
}

const SOLIDS: &[&str] =
    &["block", "sphere", "cylinder", "cone", "torus", "half-space", "quadric", "extrude", "lathe", "boolean"];

/// By `size` from the origin or about it, or by two corners.
fn block(table: &mut Table<'_>, unit: f64) -> Outcome<Shape> {
    let (min, max) = match (table.get("size"), table.get("from")) {
        (Some(size), None) => {
            let s = size.point()?;
            if s.min_element() <= 0.0 {
                return Err(size.fault("3 numbers above 0 are wanted"));
            }
            if table.flag("centred")? { (s * -0.5, s * 0.5) } else { (DVec3::ZERO, s) }
        }
        (None, Some(from)) => (from.point()?, table.need("to")?.point()?),
        _ => return Err(Fault::new(table.at, "either `size`, or `from` and `to` are wanted")),
    };
    if min.cmpge(max).any() {
        return Err(table.need("to")?.fault("it must lie beyond `from` along each axis"));
    }
    Ok(Shape::Block { min: min * unit, max: max * unit })
}

/// An expression and its operands.
fn boolean<'a>(scene: &mut Scene<'a>, table: &mut Table<'a>) -> Outcome<Form> {
    let value = table.need("of")?;
    let expression = csg::parse(value.text()?)
        .map_err(|e| Fault::new(value.column(scene.text, e.column()), format!("`of`: {e}")))?;
    let operands = table.read("with", Value::table)?;
    let mut things = Vec::new();
    for name in &expression.names {
        let entry = operands.as_ref().and_then(|o| o.all().iter().find(|e| e.0 == name.as_str()));
        let thing = match entry {
            Some((_, _, named)) => scene.thing(*named).and_then(|t| operand(scene, *named, t))?,
            None => scene.thing_called(name, value).and_then(|t| operand(scene, value, t))?,
        };
        things.push(thing);
    }
    for (name, at, _) in operands.iter().flat_map(|o| o.all()) {
        if !expression.names.iter().any(|n| n == name) {
            return Err(Fault::new(*at, format!("`{name}` does not stand in the expression")));
        }
    }
    Ok(Form::Boolean(expression, things))
}

/// Only operands that have an inside.
fn operand<'a>(scene: &Scene<'a>, name: Value<'a>, thing: Thing) -> Outcome<Thing> {
    let open = |part: &Part| !part.closed;
    let why = match &thing {
        Thing::Body(body) => match &body.form {
            Form::Part(part) if open(part) => Some("it is not closed"),
            _ => None,
        },
        Thing::File(file) => match &file.import.model {
            m if m.instances.iter().any(|i| open(&m.parts[i.part])) => Some("it holds bodies that are not closed"),
            m if m.instances.is_empty() && m.solids.is_empty() => Some("it is empty"),
            _ => None,
        },
        other => return Err(scene.other(name, other, "solid")),
    };
    match why {
        Some(why) => Err(name.fault(format!("`{}` has no inside: {why}", name.text()?))),
        None => Ok(thing),
    }
}

impl<'a> Scene<'a> {
    /// The item that an expression calls by its own name.
    fn thing_called(&mut self, name: &str, expression: Value<'a>) -> Outcome<Thing> {
        let Some(item) = self.items.iter().find(|i| i.name == name).copied() else {
            return Err(expression.fault(format!("no solid is called `{name}`, and `with` does not say what it is")));
        };
        self.entered(item, expression)
    }
}

/// `[part.NAME]`: faces together.
pub(super) fn part<'a>(scene: &mut Scene<'a>, name: &str, table: &mut Table<'a>) -> Outcome<Body> {
    let names = table.need("surfaces")?;
    let mut part = Part { closed: table.flag("closed")?, ..Part::default() };
    let mut known = Vec::new();
    for value in names.names()? {
        let made = scene.surface(value)?;
        let id = scene.number();
        scene.spend(1, value)?;
        part.faces.push(made.face(id, 1.0));
        known.push((made.deviation, made.notes.clone()));
    }
    let by = place::placement(table)?;
    let colour = table.read("colour", Value::colour)?;
    let body = closed(scene, name, (&part, names), by, colour)?;
    Ok(Body { faces: known.into_iter().map(|(d, n)| (d * scene.unit, n)).collect(), ..body })
}

/// A part in the file's unit, placed, in millimetres, with numbers of its own.
fn closed<'a>(
    scene: &mut Scene<'a>,
    name: &str,
    (part, value): (&Part, Value<'a>),
    by: Option<DAffine3>,
    colour: Option<Colour>,
) -> Outcome<Body> {
    let by = by.unwrap_or(DAffine3::IDENTITY);
    let mirrored = by.matrix3.determinant() < 0.0;
    let all = DAffine3::from_scale(DVec3::splat(scene.unit)) * by;
    let mut faces: Vec<Face> = Vec::new();
    for face in &part.faces {
        scene.spend(face.surface.points().len(), value)?;
        let surface = face.surface.transformed(&all);
        if surface.points().iter().any(|p| !p.is_finite()) {
            return Err(value.fault("its placement leaves the range of numbers"));
        }
        let (id, same_sense) = (scene.number(), face.same_sense ^ mirrored);
        faces.push(Face { id, surface, same_sense, colour: face.colour.or(colour), ..face.clone() });
    }
    let exact = faces.iter().map(|_| (0.0, Vec::new())).collect();
    let part = Part { name: name.to_owned(), faces, meshes: Vec::new(), ..part.clone() };
    let transform = DAffine3::IDENTITY;
    Ok(Body { form: Form::Part(Arc::new(part)), transform, colour, id: scene.number(), faces: exact })
}

/// How things are added to a solid: at a place, in a colour that wins, and one for what has none.
#[derive(Clone, Copy)]
pub(super) struct Adding {
    pub transform: DAffine3,
    pub over: Option<Colour>,
    pub inherited: Option<Colour>,
}

/// Adds a thing to a solid under construction; its node.
pub(super) fn add<'a>(
    scene: &mut Scene<'a>,
    to: &mut Assembly,
    thing: &Thing,
    how: Adding,
    value: Value<'a>,
) -> Outcome<u32> {
    scene.spend(1, value)?;
    let body = match thing {
        Thing::Body(body) => body,
        Thing::File(file) => return add_file(scene, to, file, how, value),
        other => return Err(scene.other(value, other, "solid")),
    };
    let transform = how.transform * body.transform;
    let placed = Placed { transform, colour: how.over.or(body.colour).or(how.inherited), id: body.id };
    Ok(match &body.form {
        Form::Primitive(shape) => to.add(shape.clone(), &placed),
        Form::Part(part) => {
            let part = if how.over.is_some() { Part::uncoloured(part) } else { part.clone() };
            to.add(Shape::Part(part), &placed)
        }
        Form::Boolean(expression, operands) => {
            let how = Adding { transform, inherited: body.colour.or(how.inherited), ..how };
            let leaves = operands.iter().map(|o| add(scene, to, o, how, value)).collect::<Outcome<Vec<_>>>()?;
            graft(to, expression.tree.nodes(), &leaves)
        }
    })
}

/// Copies nodes of a tree whose leaves are there already; the root's.
fn graft(to: &mut Assembly, nodes: &[Node], leaves: &[u32]) -> u32 {
    let mut map: Vec<u32> = Vec::with_capacity(nodes.len());
    for node in nodes {
        map.push(match *node {
            Node::Constant(_) => to.nodes.push(*node),
            Node::Leaf(p) => leaves[p as usize],
            Node::Complement(a) => to.nodes.complement(map[a as usize]),
            Node::Pair(op, a, b) => to.nodes.pair(op, map[a as usize], map[b as usize]),
        });
    }
    map[map.len() - 1]
}

/// All bodies and solids of a file, together.
fn add_file(scene: &mut Scene<'_>, to: &mut Assembly, file: &File, how: Adding, value: Value<'_>) -> Outcome<u32> {
    let model = &file.import.model;
    let all = how.transform * file.transform;
    let over = how.over.or(file.colour);
    let mut nodes = Vec::new();
    let parts = file.shared.get_or_init(|| model.parts.iter().cloned().map(Arc::new).collect());
    for instance in &model.instances {
        scene.spend(1, value)?;
        let part = parts[instance.part].clone();
        let id = part.faces.first().map(|f| f.id).or(part.meshes.first().map(|m| m.id)).unwrap_or(1);
        let over = over.or(instance.colour);
        let part = if over.is_some() { Part::uncoloured(&part) } else { part };
        let colour = over.or(how.inherited);
        nodes.push(to.add(Shape::Part(part), &Placed { transform: all * instance.transform, colour, id }));
    }
    for solid in &model.solids {
        scene.spend(solid.primitives().len(), value)?;
        let place = |p: &Primitive| Placed { transform: all * p.transform, colour: over.or(Some(p.colour)), id: p.id };
        let leaves: Vec<u32> = solid.primitives().iter().map(|p| to.add(p.shape.clone(), &place(p))).collect();
        nodes.push(graft(to, solid.tree().nodes(), &leaves));
    }
    Ok(to.nodes.fold(Op::Union, nodes))
}

/// Adds `first` to every number of faces, meshes and primitives.
pub(super) fn renumber(model: &mut Model, first: u32) -> Result<(), SolidError> {
    for part in &mut model.parts {
        part.faces.iter_mut().for_each(|f: &mut Face| f.id += first);
        part.meshes.iter_mut().for_each(|m: &mut Mesh| m.id += first);
    }
    for solid in &mut model.solids {
        let primitives = solid.primitives().iter().map(|p| Primitive { id: p.id + first, ..p.clone() }).collect();
        *solid = Solid::new(primitives, solid.tree().clone())?;
    }
    Ok(())
}
