//! Boolean expressions.
//!
//! ```text
//!   CSG_SOLID('',root)                                    root: BOOLEAN_RESULT or a primitive
//!   BOOLEAN_RESULT('',.UNION.,a,b)                        also .INTERSECTION. and .DIFFERENCE.
//!   SOLID_REPLICA('',solid,operator)                      the same, placed by the operator
//!   BLOCK ... HALF_SPACE_SOLID                            see `primitive`
//!   MANIFOLD_SOLID_BREP, BREP_WITH_VOIDS, FACETED_BREP    faces, or triangles where all are polygons
//!   EXTRUDED_AREA_SOLID and similar                       faces: see `swept`
//! ```
//!
//! References make a graph, which may be deep and may share entities at will. It is walked without recursion, each
//! entity once a placement; its size as a tree is taken from the budget of work. `(a - b) + (b - a)` over the same
//! entities is a symmetric difference.
//!
//! An operand takes its own colour, else that of the nearest operation around it. If an operand cannot be read, the
//! whole solid is left out: without the operand it would be a different solid.
//!
//! Source: ISO 10303-42, 6 (solid model).

use super::body::{self, Body, Looks};
use super::entity::{Entity, Fault};
use super::geometry::Geometry;
use super::part21::Value;
use super::primitive::PRIMITIVES;
use super::swept::SWEPT;
use crate::csg::{Builder, Node, Op, Tree};
use crate::import::guard::Endless;
use crate::model::{Colour, Shape};
use glam::DAffine3;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// Expressions, and entities that place them.
pub(super) const EXPRESSIONS: [&str; 3] = ["CSG_SOLID", "BOOLEAN_RESULT", "SOLID_REPLICA"];

/// The item is a Boolean solid, of one primitive or more.
pub(super) fn is_boolean(entity: Entity<'_>) -> bool {
    entity.kinds().any(|k| EXPRESSIONS.contains(&k) || PRIMITIVES.contains(&k))
}

/// An expression as it stands in the file.
#[derive(Debug)]
pub(super) struct Expression {
    pub id: u32,
    pub tree: Tree,
    /// By the numbers of the tree's leaves.
    pub leaves: Vec<Leaf>,
    /// Solids of faces among the operands.
    pub bodies: Vec<(u32, Body)>,
    /// Entities by type.
    pub kinds: BTreeMap<String, usize>,
}

/// One operand.
#[derive(Debug)]
pub(super) struct Leaf {
    pub id: u32,
    pub operand: Operand,
    pub place: DAffine3,
    pub colour: Option<Colour>,
}

/// The shape of an operand.
#[derive(Debug)]
pub(super) enum Operand {
    Shape(Shape),
    /// One of the expression's bodies.
    Body(usize),
}

/// Reads the expression `#id`; `colour` is inherited from outside.
pub(super) fn read(
    geometry: &Geometry<'_>,
    id: u32,
    looks: Looks<'_>,
    colour: Option<Colour>,
) -> Result<Expression, Fault> {
    let mut walk = Walk::new(geometry, looks);
    let root = walk.run(id, colour)?;
    // shared entities are written out once for each use
    let mut sizes: Vec<u64> = Vec::with_capacity(root as usize + 1);
    for k in 0..=root {
        let of = |child: u32| sizes[child as usize];
        sizes.push(match walk.nodes.node(k) {
            Node::Constant(_) | Node::Leaf(_) => 1,
            Node::Complement(a) => of(a).saturating_add(1),
            Node::Pair(_, a, b) => of(a).saturating_add(of(b)).saturating_add(1),
        });
    }
    geometry.ledger.spend(id, usize::try_from(sizes[root as usize]).unwrap_or(usize::MAX))?;
    let tree = walk.nodes.finish(root).map_err(|_| Fault::Endless(Endless::Exhausted(id)))?;
    Ok(Expression { id, tree, leaves: walk.leaves, bodies: walk.bodies, kinds: walk.kinds })
}

/// A step of the walk.
enum Step {
    /// Read an entity; the scope places it.
    Open { id: u32, scope: usize, colour: Option<Colour> },
    /// Both operands are read.
    Pair { id: u32, scope: usize, op: Op, operands: [u32; 2] },
    /// The only operand is read, in a scope of its own.
    Same { id: u32, scope: usize, of: u32, inner: usize },
}

struct Walk<'g, 'a> {
    geometry: &'g Geometry<'a>,
    looks: Looks<'g>,
    nodes: Builder,
    leaves: Vec<Leaf>,
    bodies: Vec<(u32, Body)>,
    kinds: BTreeMap<String, usize>,
    /// Placements by replicas; the first is none.
    scopes: Vec<DAffine3>,
    /// Nodes of entities in scopes.
    known: HashMap<(u32, usize), u32>,
    /// Entities whose operands are being read.
    open: HashSet<u32>,
    /// Shapes of solids that are operands, which replicas share.
    solids: HashMap<u32, usize>,
    meshes: HashMap<u32, Shape>,
}

impl<'g, 'a> Walk<'g, 'a> {
    fn new(geometry: &'g Geometry<'a>, looks: Looks<'g>) -> Self {
        Self {
            geometry,
            looks,
            nodes: Builder::new(),
            leaves: Vec::new(),
            bodies: Vec::new(),
            kinds: BTreeMap::new(),
            scopes: vec![DAffine3::IDENTITY],
            known: HashMap::new(),
            open: HashSet::new(),
            solids: HashMap::new(),
            meshes: HashMap::new(),
        }
    }

    fn run(&mut self, root: u32, colour: Option<Colour>) -> Result<u32, Fault> {
        let mut steps = vec![Step::Open { id: root, scope: 0, colour }];
        while let Some(step) = steps.pop() {
            match step {
                Step::Open { id, scope, colour } => self.visit(id, scope, colour, &mut steps)?,
                Step::Pair { id, scope, op, operands } => {
                    let [a, b] = operands.map(|o| self.known[&(o, scope)]);
                    let node = match (op, self.nodes.node(a), self.nodes.node(b)) {
                        (Op::Union, Node::Pair(Op::Difference, x, y), Node::Pair(Op::Difference, z, w))
                            if (x, y) == (w, z) =>
                        {
                            self.nodes.pair(Op::SymmetricDifference, x, y)
                        }
                        _ => self.nodes.pair(op, a, b),
                    };
                    self.close(id, scope, node);
                }
                Step::Same { id, scope, of, inner } => self.close(id, scope, self.known[&(of, inner)]),
            }
        }
        Ok(self.known[&(root, 0)])
    }

    fn close(&mut self, id: u32, scope: usize, node: u32) {
        self.open.remove(&id);
        self.known.insert((id, scope), node);
    }

    fn visit(&mut self, id: u32, scope: usize, outer: Option<Colour>, steps: &mut Vec<Step>) -> Result<(), Fault> {
        if self.open.contains(&id) {
            return Err(Fault::Endless(Endless::Cycle(id)));
        }
        if self.known.contains_key(&(id, scope)) {
            return Ok(());
        }
        self.geometry.ledger.spend(id, 1)?;
        let entity = self.geometry.entity(id)?;
        *self.kinds.entry(entity.name()).or_default() += 1;
        let colour = self.looks.colours.of_item(id).or(outer);
        if let Ok(fields) = entity.fields("BOOLEAN_RESULT", 1) {
            let op = match fields.value(0) {
                Some(Value::Enumeration("UNION")) => Op::Union,
                Some(Value::Enumeration("INTERSECTION")) => Op::Intersection,
                Some(Value::Enumeration("DIFFERENCE")) => Op::Difference,
                _ => return Err(Fault::Value { id, what: "the operator is no union, intersection or difference" }),
            };
            let operands = [fields.reference(1)?, fields.reference(2)?];
            self.open.insert(id);
            let open = |id| Step::Open { id, scope, colour };
            steps.extend([Step::Pair { id, scope, op, operands }, open(operands[1]), open(operands[0])]);
        } else if let Ok(fields) = entity.fields("CSG_SOLID", 1) {
            let of = fields.reference(0)?;
            self.open.insert(id);
            steps.extend([Step::Same { id, scope, of, inner: scope }, Step::Open { id: of, scope, colour }]);
        } else if let Ok(fields) = entity.fields("SOLID_REPLICA", 1) {
            let of = fields.reference(0)?;
            let place = self.geometry.transform(fields.reference(1)?)?;
            let inner = self.scopes.len();
            self.scopes.push(self.scopes[scope] * place);
            self.open.insert(id);
            steps.extend([Step::Same { id, scope, of, inner }, Step::Open { id: of, scope: inner, colour }]);
        } else {
            let node = self.operand(entity, scope, colour)?;
            self.known.insert((id, scope), node);
        }
        Ok(())
    }

    fn operand(&mut self, entity: Entity<'a>, scope: usize, colour: Option<Colour>) -> Result<u32, Fault> {
        let id = entity.id();
        if !body::SOLIDS.iter().chain(&SWEPT).any(|k| entity.is(k)) {
            if !is_boolean(entity) {
                return Err(entity.not("an operand of a Boolean expression"));
            }
            let exact = self.geometry.primitive(entity)?;
            let place = self.scopes[scope] * exact.place;
            let mut all = Vec::new();
            for shape in exact.shapes {
                all.push(self.leaf(Leaf { id, operand: Operand::Shape(shape), place, colour }));
            }
            let node = self.nodes.fold(Op::Intersection, all);
            return Ok(if exact.all_but { self.nodes.complement(node) } else { node });
        }
        let place = self.scopes[scope];
        let geometry = self.geometry;
        if entity.is("FACETED_BREP") && !self.meshes.contains_key(&id) && !self.solids.contains_key(&id) {
            // a solid that is not all polygons is read as faces, where its faults are reported
            if let Ok(mesh) = geometry.faceted(id) {
                self.meshes.insert(id, Shape::Mesh(Arc::new(mesh)));
            }
        }
        let operand = match self.meshes.get(&id) {
            Some(mesh) => Operand::Shape(mesh.clone()),
            None => {
                let next = self.bodies.len();
                let index = *self.solids.entry(id).or_insert(next);
                if index == next {
                    self.bodies.push((id, body::body(geometry, id, self.looks, &[])));
                }
                Operand::Body(index)
            }
        };
        Ok(self.leaf(Leaf { id, operand, place, colour }))
    }

    fn leaf(&mut self, leaf: Leaf) -> u32 {
        self.leaves.push(leaf);
        self.nodes.leaf(self.leaves.len() as u32 - 1)
    }
}
