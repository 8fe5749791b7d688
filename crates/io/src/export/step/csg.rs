//! Boolean solids as expressions.
//!
//! ```text
//!   CSG_SOLID ▶ BOOLEAN_RESULT('',.DIFFERENCE.,a,b)     a, b: BOOLEAN_RESULT
//!                                                            BLOCK, SPHERE, TORUS, RIGHT_CIRCULAR_CYLINDER, _CONE
//!                                                            HALF_SPACE_SOLID
//!                                                            MANIFOLD_SOLID_BREP, FACETED_BREP
//! ```
//!
//! A primitive that several leaves name is one entity. An apple, a torus whose faces meet on the axis, is the
//! half-space of its surface. A complement is subtracted from all space, which is the union of two half-spaces.
//!
//! Source: ISO 10303-42, 6 (solid model); ISO 10303-515 (constructive solid geometry).

use super::super::expression::{Expression, Term, expression};
use super::super::operand::{Operand, operand};
use super::super::{ExportError, ExportWarning, Item};
use super::facets::faceted;
use super::shape::shape;
use super::text::{Id, Quoted, Real, Text, reals};
use super::{Colours, style};
use crate::csg::{Op, Tree};
use crate::model::{Mesh, Primitive, Solid};
use glam::DVec3;
use std::collections::BTreeMap;
use std::io::{self, Write};

/// What a solid became.
pub(super) struct Written {
    pub item: Id,
    /// It is a solid by itself, not an expression.
    pub plain: bool,
    /// Largest distance of a curve from the one it approximates, mm.
    pub deviation: f64,
}

/// Writes a solid of the primitives that `tree`, without constants, names. `None`, with a warning, for one that the form
/// does not have.
pub(super) fn solid<W: Write>(
    text: &mut Text<W>,
    name: &str,
    (solid, tree): (&Solid, &Tree),
    item: Item,
    colours: &mut Colours,
    warnings: &mut Vec<ExportWarning>,
) -> Result<Option<Written>, ExportError> {
    let mut warn = |message: String| warnings.push(ExportWarning { item, message });
    let expression = expression(tree);
    let mut operands = BTreeMap::new();
    for term in &expression.terms {
        let Term::Leaf(p) = *term else { continue };
        let primitive = &solid.primitives()[p as usize];
        if operands.contains_key(&p) {
            continue;
        }
        match operand(primitive) {
            Ok(found) => operands.insert(p, (primitive, found)),
            Err(why) => {
                warn(format!("was left out: primitive #{} {why}", primitive.id));
                return Ok(None);
            }
        };
    }
    // faces may turn out not to close: they are written aside, so that a solid that fails leaves nothing in the file
    let mut aside = Vec::new();
    let mut apart = text.aside(&mut aside);
    let mut faces = Colours::default();
    let mut ids: BTreeMap<u32, Vec<Id>> = BTreeMap::new();
    let mut deviation: f64 = 0.0;
    let mut left_out = Vec::new();
    for (&p, (primitive, operand)) in &operands {
        let Operand::Faces(part) = operand else { continue };
        let found = shape(&mut apart, part, item, &mut faces, &mut left_out)?;
        if !found.solid || found.items.is_empty() {
            left_out.push(ExportWarning {
                item,
                message: format!("was left out: primitive #{} is not closed", primitive.id),
            });
            warnings.append(&mut left_out);
            return Ok(None);
        }
        deviation = deviation.max(found.deviation);
        ids.insert(p, found.items);
    }
    warnings.append(&mut left_out);
    let last = apart.last();
    text.take(&aside, last)?;
    colours.append(faces);
    let mut normals = 0;
    for (&p, (_, operand)) in &operands {
        if let Operand::Meshes(meshes, place) = operand {
            normals += meshes.iter().filter(|m| !m.normals().is_empty()).count();
            let all = meshes.iter().map(|m: &Mesh| faceted(text, "", m, place));
            ids.insert(p, all.collect::<Result<_, _>>()?);
        } else if !matches!(operand, Operand::Faces(_)) {
            ids.insert(p, vec![primitive(text, operand)?]);
        }
    }
    if normals > 0 {
        let message = format!("normals of {normals} meshes have no place in the form and were left out");
        warnings.push(ExportWarning { item, message });
    }
    // one colour is the solid's, several are their primitives'
    let first = operands.values().next().map(|(p, _)| p.colour);
    let one = operands.values().all(|(p, _)| Some(p.colour) == first);
    let mut joined = BTreeMap::new();
    for (p, parts) in &ids {
        if !one {
            for id in parts {
                style(text, colours, *id, operands[p].0.colour)?;
            }
        }
        // parts of several lumps, or of several meshes
        let mut all = parts.iter().copied();
        let first = all.next().expect("an operand is written as something");
        joined.insert(*p, all.try_fold(first, |a, b| pair(text, Op::Union, a, b))?);
    }
    let (root, plain) = terms(text, &expression, &joined, &operands)?;
    let written = if plain {
        root
    } else {
        let count = operands.len();
        let kind =
            if count == 1 { "a single primitive".into() } else { format!("an expression over {count} primitives") };
        let bounds = solid.bounds();
        let end = if bounds.min.is_finite() && bounds.max.is_finite() { "" } else { "; it may have no end" };
        let message = format!("is {kind}: written as CSG_SOLID, which some readers leave out{end}");
        warnings.push(ExportWarning { item, message });
        text.add(format_args!("CSG_SOLID({},{root})", Quoted(name)))?
    };
    if let Some(colour) = first.filter(|_| one) {
        style(text, colours, written, colour)?;
    }
    Ok(Some(Written { item: written, plain, deviation }))
}

/// The root, and whether it is a solid by itself.
fn terms<W: Write>(
    text: &mut Text<W>,
    expression: &Expression,
    leaves: &BTreeMap<u32, Id>,
    operands: &BTreeMap<u32, (&Primitive, Operand)>,
) -> io::Result<(Id, bool)> {
    let mut ids: Vec<Id> = Vec::with_capacity(expression.terms.len());
    for term in &expression.terms {
        ids.push(match *term {
            Term::Leaf(p) => leaves[&p],
            Term::Pair(op, a, b) => pair(text, op, ids[a], ids[b])?,
        });
    }
    let root = ids[ids.len() - 1];
    if expression.all_but {
        let (inner, outer) = (half_space(text, DVec3::ZERO, DVec3::Z)?, half_space(text, DVec3::ZERO, DVec3::NEG_Z)?);
        let space = pair(text, Op::Union, inner, outer)?;
        return Ok((pair(text, Op::Difference, space, root)?, false));
    }
    match expression.terms[..] {
        [Term::Leaf(p)] => match &operands[&p].1 {
            Operand::Meshes(meshes, _) if meshes.len() == 1 => Ok((root, true)),
            // the root of an expression is a primitive or an operation
            Operand::HalfSpace { .. } | Operand::Torus { .. } => Ok((pair(text, Op::Union, root, root)?, false)),
            _ => Ok((root, false)),
        },
        _ => Ok((root, false)),
    }
}

fn pair<W: Write>(text: &mut Text<W>, op: Op, a: Id, b: Id) -> io::Result<Id> {
    let name = match op {
        Op::Union => "UNION",
        Op::Intersection => "INTERSECTION",
        Op::Difference => "DIFFERENCE",
        Op::SymmetricDifference => unreachable!("an expression has none"),
    };
    text.add(format_args!("BOOLEAN_RESULT('',.{name}.,{a},{b})"))
}

/// The half-space behind the plane whose normal points out.
fn half_space<W: Write>(text: &mut Text<W>, point: DVec3, normal: DVec3) -> io::Result<Id> {
    let at = text.placement(point, normal, normal.any_orthonormal_vector())?;
    let plane = text.add(format_args!("PLANE('',{at})"))?;
    text.add(format_args!("HALF_SPACE_SOLID('',{plane},.T.)"))
}

/// A primitive that keeps its dimensions.
fn primitive<W: Write>(text: &mut Text<W>, operand: &Operand) -> io::Result<Id> {
    match *operand {
        Operand::Block { corner, x, z, size } => {
            let at = text.placement(corner, z, x)?;
            let size = reals(size.to_array());
            text.add(format_args!("BLOCK('',{at},{})", size.trim_matches(['(', ')'])))
        }
        Operand::Sphere { centre, radius } => {
            let centre = text.point(centre)?;
            text.add(format_args!("SPHERE('',{},{centre})", Real(radius)))
        }
        Operand::Cylinder { base, axis, radius, height } => {
            let at = text.axis(base, axis)?;
            text.add(format_args!("RIGHT_CIRCULAR_CYLINDER('',{at},{},{})", Real(height), Real(radius)))
        }
        Operand::Cone { narrow, axis, radius, height, slope } => {
            let at = text.axis(narrow, axis)?;
            let angle = Real(slope.atan());
            text.add(format_args!("RIGHT_CIRCULAR_CONE('',{at},{},{},{angle})", Real(height), Real(radius)))
        }
        Operand::Torus { centre, axis, major, minor } if minor < major => {
            let at = text.axis(centre, axis)?;
            text.add(format_args!("TORUS('',{at},{},{})", Real(major), Real(minor)))
        }
        Operand::Torus { centre, axis, major, minor } => {
            let at = text.placement(centre, axis, axis.any_orthonormal_vector())?;
            let (major, minor) = (Real(major), Real(minor));
            let apple = text.add(format_args!("DEGENERATE_TOROIDAL_SURFACE('',{at},{major},{minor},.T.)"))?;
            text.add(format_args!("HALF_SPACE_SOLID('',{apple},.T.)"))
        }
        Operand::HalfSpace { point, normal } => half_space(text, point, normal),
        Operand::Faces(_) | Operand::Meshes(..) => unreachable!("solids by themselves are written apart"),
    }
}
