//! Boolean solids: primitives, trees of primitives, assemblies.
//!
//! ```text
//!   150 block   LX,LY,LZ, corner, x, z              158 sphere     R, centre
//!   152 wedge   LX,LY,LZ,LTX, corner, x, z          160 torus      R1,R2, centre, axis
//!   154 cylinder  H,R, centre, axis                 168 ellipsoid  LX,LY,LZ, centre, x, z
//!   156 cone    H,R1,R2, centre, axis
//!   180 tree    N, postfix: -operand, or 1 union, 2 intersection, 3 difference
//!   184 assembly  N, N items, N matrices            430 instance   a solid, with the matrix of its entry
//! ```
//!
//! A solid of faces (186) or a swept one (162, 164) may be an operand. If an operand cannot be read, the whole solid is
//! left out: without the operand it would be a different solid.
//!
//! Source: US Product Data Association, *IGES 5.3*, 1996.

use super::entity::{Entity, Fault};
use super::geometry::Geometry;
use super::solid::Shells;
use crate::brep::Frame;
use crate::csg::{Builder, Op, Tree};
use crate::import::guard::Endless;
use crate::model::{Colour, GREY, Part, Primitive, Shape, Solid};
use glam::{DAffine3, DMat3, DVec3};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Types that stand for solids by themselves.
pub(super) const PRIMITIVES: [(u16, &str); 7] = [
    (150, "block"),
    (152, "wedge"),
    (154, "cylinder"),
    (156, "cone"),
    (158, "sphere"),
    (160, "torus"),
    (168, "ellipsoid"),
];

/// An expression as it stands in the file.
#[derive(Debug)]
pub(super) struct Expression {
    pub id: u32,
    tree: Tree,
    leaves: Vec<Leaf>,
    /// Solids of faces among the operands.
    pub shells: Vec<Shells>,
    /// Entities by name.
    pub kinds: BTreeMap<&'static str, usize>,
}

#[derive(Debug)]
struct Leaf {
    id: u32,
    operand: Operand,
    place: DAffine3,
    colour: Option<Colour>,
}

#[derive(Debug)]
enum Operand {
    Shape(Shape),
    /// One of the expression's shells.
    Shells(usize),
}

struct Walk {
    nodes: Builder,
    leaves: Vec<Leaf>,
    shells: Vec<Shells>,
    kinds: BTreeMap<&'static str, usize>,
}

impl<'a> Geometry<'a> {
    /// The Boolean solid `#id`; `outer` leads to millimetres.
    pub fn expression(&self, id: u32, outer: &DAffine3) -> Result<Expression, Fault> {
        let mut walk = Walk { nodes: Builder::new(), leaves: Vec::new(), shells: Vec::new(), kinds: BTreeMap::new() };
        let root = self.operand(id, outer, None, &mut walk)?;
        let tree = walk.nodes.finish(root).map_err(|_| Fault::Endless(Endless::Exhausted(id)))?;
        Ok(Expression { id, tree, leaves: walk.leaves, shells: walk.shells, kinds: walk.kinds })
    }

    fn operand(&self, id: u32, outer: &DAffine3, colour: Option<Colour>, walk: &mut Walk) -> Result<u32, Fault> {
        self.nested(id, |entity| {
            let map = self.placed(entity, outer)?;
            let colour = self.colour(entity).or(colour);
            match entity.kind() {
                180 => self.boolean_tree(entity, &map, colour, walk),
                184 => {
                    *walk.kinds.entry("assembly").or_default() += 1;
                    let items = self.assembly(entity, &map)?;
                    let all = items.into_iter().map(|(item, map)| self.operand(item, &map, colour, walk));
                    let all = all.collect::<Result<Vec<_>, _>>()?;
                    Ok(walk.nodes.fold(Op::Union, all))
                }
                430 => self.operand(entity.pointer(1)?, &map, colour, walk),
                kind @ (162 | 164 | 186) => {
                    let name = match kind {
                        162 => "solid of revolution",
                        164 => "solid of extrusion",
                        _ => "solid of faces",
                    };
                    *walk.kinds.entry(name).or_default() += 1;
                    // its own matrix is part of it
                    walk.shells.push(self.faces_of(entity, outer)?);
                    let operand = Operand::Shells(walk.shells.len() - 1);
                    Ok(walk.leaf(Leaf { id, operand, place: DAffine3::IDENTITY, colour }))
                }
                kind => {
                    let name = PRIMITIVES.iter().find(|p| p.0 == kind).ok_or_else(|| entity.unsupported())?.1;
                    *walk.kinds.entry(name).or_default() += 1;
                    let (shapes, own) = primitive(entity)?;
                    let leaf = |shape| Leaf { id, operand: Operand::Shape(shape), place: map * own, colour };
                    let all: Vec<u32> = shapes.into_iter().map(|shape| walk.leaf(leaf(shape))).collect();
                    Ok(walk.nodes.fold(Op::Intersection, all))
                }
            }
        })
    }

    /// 184: items and what leads from their coordinates to millimetres.
    pub fn assembly(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Vec<(u32, DAffine3)>, Fault> {
        let count = entity.count(1, 2)?;
        let item = |i: usize| {
            let place = entity.optional(2 + count + i)?.map_or(Ok(DAffine3::IDENTITY), |m| self.matrix(m))?;
            Ok((entity.pointer(2 + i)?, *map * place))
        };
        (0..count).map(item).collect()
    }

    /// 180.
    fn boolean_tree(
        &self,
        entity: Entity<'a>,
        map: &DAffine3,
        colour: Option<Colour>,
        walk: &mut Walk,
    ) -> Result<u32, Fault> {
        *walk.kinds.entry("Boolean tree").or_default() += 1;
        let fault = |what| Fault::Value { id: entity.id(), what };
        let mut stack: Vec<u32> = Vec::new();
        for index in 2..2 + entity.count(1, 1)? {
            let item = entity.integer(index)?;
            if item < 0 {
                let operand = u32::try_from(-item).map_err(|_| fault("an operand is no entity"))?;
                stack.push(self.operand(operand, map, colour, walk)?);
                continue;
            }
            let op = match item {
                1 => Op::Union,
                2 => Op::Intersection,
                3 => Op::Difference,
                _ => return Err(fault("an operation is no union, intersection or difference")),
            };
            let (Some(b), Some(a)) = (stack.pop(), stack.pop()) else {
                return Err(fault("an operation lacks an operand"));
            };
            stack.push(walk.nodes.pair(op, a, b));
        }
        match stack[..] {
            [root] => Ok(root),
            _ => Err(fault("its operations do not join all operands")),
        }
    }
}

impl Walk {
    fn leaf(&mut self, leaf: Leaf) -> u32 {
        self.leaves.push(leaf);
        self.nodes.leaf(self.leaves.len() as u32 - 1)
    }
}

impl Expression {
    /// The solid placed by `transform`; `operands` are the built parts of its shells.
    ///
    /// # Errors
    /// Why there is none.
    pub fn solid(&self, transform: DAffine3, operands: &[Arc<Part>]) -> Result<Solid, String> {
        let primitive = |leaf: &Leaf| {
            let shape = match &leaf.operand {
                Operand::Shape(shape) => shape.clone(),
                Operand::Shells(index) if operands[*index].faces.is_empty() => {
                    return Err(format!("its operand #{} has no face left", leaf.id));
                }
                Operand::Shells(index) if !operands[*index].closed => {
                    return Err(format!("its operand #{} is not closed, so it has no inside", leaf.id));
                }
                Operand::Shells(index) => Shape::Part(operands[*index].clone()),
            };
            let (transform, colour) = (transform * leaf.place, leaf.colour.unwrap_or(GREY));
            Ok(Primitive { shape, transform, colour, id: leaf.id })
        };
        let primitives = self.leaves.iter().map(primitive).collect::<Result<_, _>>()?;
        Solid::new(primitives, self.tree.clone()).map_err(|e| e.to_string())
    }
}

/// The shapes that a primitive is the intersection of, and their place in its own space, lengths in the file's unit.
fn primitive(entity: Entity<'_>) -> Result<(Vec<Shape>, DAffine3), Fault> {
    let sides = || Ok(DVec3::new(entity.length(1)?, entity.length(2)?, entity.length(3)?));
    // a place that is left out is the origin, an axis z
    let axis = |first: usize| {
        let z = entity.triple(first + 3)?;
        frame(entity, entity.triple(first)?, if z == DVec3::ZERO { DVec3::Z } else { z }, DVec3::ZERO)
    };
    let axes = |first: usize| {
        let (x, z) = (entity.triple(first + 3)?, entity.triple(first + 6)?);
        let z = if z == DVec3::ZERO { DVec3::Z } else { z };
        frame(entity, entity.triple(first)?, z, if x == DVec3::ZERO { DVec3::X } else { x })
    };
    let one = |shape, place: DAffine3| Ok((vec![shape], place));
    match entity.kind() {
        150 => one(Shape::Block { min: DVec3::ZERO, max: sides()? }, axes(4)?),
        152 => {
            let (max, short) = (sides()?, entity.real(4)?);
            if !(0.0..max.x).contains(&short) {
                let what = "a wedge whose smaller side is not below its larger one";
                return Err(Fault::Value { id: entity.id(), what });
            }
            let normal = DVec3::new(max.y, max.x - short, 0.0);
            let lean = Shape::HalfSpace { normal, offset: max.x * max.y };
            Ok((vec![Shape::Block { min: DVec3::ZERO, max }, lean], axes(5)?))
        }
        154 => one(Shape::Cylinder { height: entity.length(1)?, radius: entity.length(2)? }, axis(3)?),
        156 => {
            let (height, bottom, top) = (entity.length(1)?, entity.length(2)?, entity.real(3)?);
            if top < 0.0 {
                return Err(Fault::Value { id: entity.id(), what: "the radius of the cone is negative" });
            }
            one(Shape::Cone { bottom, top, height }, axis(4)?)
        }
        158 => one(Shape::Sphere { radius: entity.length(1)? }, DAffine3::from_translation(entity.triple(2)?)),
        160 => one(Shape::Torus { major: entity.length(1)?, minor: entity.length(2)? }, axis(3)?),
        168 => one(Shape::Sphere { radius: 1.0 }, axes(4)? * DAffine3::from_scale(sides()?)),
        _ => Err(entity.unsupported()),
    }
}

fn frame(entity: Entity<'_>, origin: DVec3, z: DVec3, x: DVec3) -> Result<DAffine3, Fault> {
    let flat = Fault::Value { id: entity.id(), what: "the axis has no direction" };
    let f = Frame::new(origin, z, x).ok_or(flat)?;
    Ok(DAffine3::from_mat3_translation(DMat3::from_cols(f.x, f.y, f.z), f.origin))
}
