//! The drawn entities: solids and surfaces that no other entity refers to, placed by subfigures.
//!
//! ```text
//!   scope: the file, or a 308                     instances of its parts
//!     186, 162, 164, 430 ▶ one part a solid       408: scale, then move, then the matrix
//!     514, 510 ────▶ one part a shell                  ─▶ the scope of its 308, again
//!     150 to 180 ──▶ one Boolean solid each       412, 414: copies of one entity; 184: items with matrices
//!     143, 144, surfaces ─▶ one open part a group (402) and level
//! ```
//!
//! Blanked entities, annotation and construction are counted and not drawn. The status of an entity that is part of
//! another one does not count for the whole: some writers blank all parts.

use super::array;
use super::csg::Expression;
use super::entity::{Entity, Fault};
use super::geometry::{FACE_LOST, Geometry};
use super::owners::{Unreached, unreached};
use super::solid::Shells;
use super::surface::SURFACES;
use super::trim::Sheet;
use crate::import::guard::{Endless, MAX_INSTANCES};
use crate::import::names;
use crate::model::Colour;
use glam::{DAffine3, DVec3};
use std::collections::{BTreeMap, HashMap, HashSet};

/// A part in the terms of `brep`.
#[derive(Debug, Default)]
pub(super) struct Body {
    pub name: String,
    /// The faces bound a volume.
    pub closed: bool,
    /// Of a solid or shell.
    pub shells: Shells,
    /// Faces with edges of their own.
    pub sheets: Vec<(Sheet, Option<Colour>)>,
    /// A Boolean solid, and no faces: its operands of faces are bodies from this number on.
    pub solid: Option<(Expression, usize)>,
    /// An operand of a Boolean solid.
    pub operand: bool,
}

/// One placed body.
#[derive(Clone, Debug)]
pub(super) struct Placement {
    pub body: usize,
    /// Body coordinates to model coordinates, in millimetres.
    pub transform: DAffine3,
    /// Names of the subfigures from the outermost, joined by `/`.
    pub name: String,
}

/// Deepest subfigures in subfigures.
const MAX_LEVELS: usize = 256;

/// Largest number of subfigures entered.
const MAX_VISITS: usize = 1 << 20;

/// Arrays and assemblies within each other at most.
const MAX_NESTED: usize = 256;

/// The kind of warning that costs a Boolean solid.
pub(super) const SOLID_LOST: &str = "Boolean solid left out";

/// Reads bodies and their places.
pub(super) struct Tree<'g, 'a> {
    geometry: &'g Geometry<'a>,
    pub bodies: Vec<Body>,
    pub placements: Vec<Placement>,
    /// Bodies by the scope that lists them; 0 for the file.
    scopes: HashMap<u32, Vec<usize>>,
    /// The group of an entity.
    groups: HashMap<u32, u32>,
    /// The file has solids, shells.
    owners: [bool; 2],
    trail: Vec<u32>,
    visits: usize,
}

impl<'g, 'a> Tree<'g, 'a> {
    /// Walks the file.
    pub fn read(geometry: &'g Geometry<'a>) -> Self {
        let mut tree = Self {
            geometry,
            bodies: Vec::new(),
            placements: Vec::new(),
            scopes: HashMap::new(),
            groups: HashMap::new(),
            owners: [186, 514].map(|kind| geometry.file.entries.iter().any(|e| e.kind == kind)),
            trail: Vec::new(),
            visits: 0,
        };
        let mut pairs = tree.used();
        let used: HashSet<u32> = pairs.iter().map(|(_, member)| *member).collect();
        let free = geometry.file.entries.iter().filter(|e| !used.contains(&e.id)).map(|e| e.id);
        let free: Vec<u32> = free.collect();
        tree.scope(0, &free, DAffine3::IDENTITY, "");
        if tree.full() {
            let last = free.last().copied().unwrap_or(0);
            geometry.note("subfigure left out", last, format!("all but the first {MAX_INSTANCES} instances"));
        }
        drop(used);
        let of_kind = |kind: u16| geometry.file.entries.iter().filter(move |e| e.kind == kind).map(|e| e.id);
        // a subfigure is drawn where it is placed, so its placements own it
        let subfigures: Vec<u32> = of_kind(308).collect();
        let definition = |id| Some((id, Entity::find(geometry.file, id).ok()?.optional(1).ok()??));
        pairs.extend(of_kind(408).filter_map(definition));
        let roots: Vec<u32> = free.into_iter().filter(|id| subfigures.binary_search(id).is_err()).collect();
        let Unreached { circles, unplaced } = unreached(&roots, pairs, &subfigures);
        for id in circles {
            geometry.note("entity left out", id, Endless::Cycle(id).to_string());
        }
        for id in unplaced {
            geometry.note("subfigure not placed", id, "nothing that is drawn places it");
        }
        tree
    }

    /// Entities that are parts of other ones, each behind its owner. Fills in the groups, whose members are still drawn
    /// by themselves.
    fn used(&mut self) -> Vec<(u32, u32)> {
        let (mut pairs, mut used) = (Vec::new(), Vec::new());
        for entry in &self.geometry.file.entries {
            self.geometry.work(1);
            let Ok(entity) = Entity::find(self.geometry.file, entry.id) else { continue };
            let listed = |count: usize, first: usize, each: usize| {
                let n = entity.count(count, each).unwrap_or(0);
                (0..n).filter_map(move |i| entity.optional(first + each * i).ok().flatten())
            };
            let one = |index: usize| entity.optional(index).ok().flatten();
            match entry.kind {
                140 => used.extend(one(5)),
                141 => {
                    used.extend(one(3));
                    let mut at = 5;
                    for _ in 0..entity.count(4, 3).unwrap_or(0) {
                        let inside = entity.count(at + 2, 1).unwrap_or(0);
                        used.extend([at].into_iter().chain(at + 3..at + 3 + inside).filter_map(one));
                        at += 3 + inside;
                    }
                }
                118 | 120 => used.extend(one(1).into_iter().chain(one(2))),
                142 => used.extend((2..=4).filter_map(one)),
                143 => used.extend(one(2).into_iter().chain(listed(3, 4, 1))),
                144 => used.extend(one(1).into_iter().chain(one(4)).chain(listed(3, 5, 1))),
                122 | 130 | 162 | 164 | 190 | 192 | 194 | 196 | 198 | 430 | 510 => used.extend(one(1)),
                102 | 184 => used.extend(listed(1, 2, 1)),
                504 => used.extend(listed(1, 2, 5)),
                186 => used.extend(one(1).into_iter().chain(listed(3, 4, 2))),
                308 => used.extend(listed(3, 4, 1)),
                514 => used.extend(listed(1, 2, 2)),
                180 => {
                    let items = (0..entity.count(1, 1).unwrap_or(0)).filter_map(|i| entity.integer(2 + i).ok());
                    used.extend(items.filter_map(|item| u32::try_from(-item).ok()));
                }
                412 | 414 => used.extend(one(1)),
                402 if matches!(entry.form, 1 | 7 | 14 | 15) => {
                    for member in listed(1, 2, 1) {
                        self.groups.entry(member).or_insert(entry.id);
                    }
                }
                _ => {}
            }
            pairs.extend(used.drain(..).map(|member| (entry.id, member)));
        }
        pairs
    }

    fn full(&self) -> bool {
        self.placements.len() >= MAX_INSTANCES || self.visits >= MAX_VISITS
    }

    /// Places what the scope `#id` lists; its bodies are made at the first time.
    fn scope(&mut self, id: u32, members: &[u32], transform: DAffine3, name: &str) {
        self.visits += 1;
        if !self.scopes.contains_key(&id) {
            let bodies = self.bodies_of(members);
            self.scopes.insert(id, bodies);
        }
        for body in self.scopes[&id].clone() {
            if self.full() {
                return;
            }
            self.placements.push(Placement { body, transform, name: name.to_owned() });
        }
        self.trail.push(id);
        for &member in members {
            if self.full() {
                break;
            }
            let Ok(entity) = Entity::find(self.geometry.file, member) else { continue };
            if !matches!(entity.kind(), 184 | 408 | 412 | 414) || !self.is_drawn(entity) {
                continue;
            }
            let placed = match entity.kind() {
                408 => self.subfigure(entity, transform, name).map_err(|fault| ("subfigure left out", fault)),
                184 => self.assembly(entity, transform, name).map_err(|fault| ("assembly left out", fault)),
                _ => self.array(entity, transform, name).map_err(|fault| ("array left out", fault)),
            };
            if let Err((kind, fault)) = placed {
                self.geometry.note(kind, member, fault.to_string());
            }
        }
        self.trail.pop();
    }

    /// 412, 414.
    fn array(&mut self, entity: Entity<'a>, outer: DAffine3, name: &str) -> Result<(), Fault> {
        let base = entity.pointer(1)?;
        let places = array::places(entity, MAX_INSTANCES)?;
        self.geometry.spend(entity.id(), places.len())?;
        let own = self.geometry.placed(entity, &DAffine3::IDENTITY)?;
        for place in places {
            if self.full() {
                break;
            }
            self.copy(entity.id(), base, outer * self.in_millimetres(own * place), name)?;
        }
        Ok(())
    }

    /// 184: each item with the matrix that stands beside it.
    fn assembly(&mut self, entity: Entity<'a>, outer: DAffine3, name: &str) -> Result<(), Fault> {
        let own = self.geometry.placed(entity, &DAffine3::IDENTITY)?;
        for (item, place) in self.geometry.assembly(entity, &own)? {
            self.copy(entity.id(), item, outer * self.in_millimetres(place), name)?;
        }
        Ok(())
    }

    fn in_millimetres(&self, mut place: DAffine3) -> DAffine3 {
        place.translation *= self.geometry.file.global.unit;
        place
    }

    /// Places the entity `#base`, or the list of the subfigure of that number, again for `#id`.
    fn copy(&mut self, id: u32, base: u32, transform: DAffine3, name: &str) -> Result<(), Fault> {
        let sound = transform.is_finite() && transform.matrix3.determinant() != 0.0;
        sound.then_some(()).ok_or(Fault::Value { id, what: "the placement cannot be inverted" })?;
        if self.trail.contains(&base) {
            return Err(Fault::Endless(Endless::Cycle(base)));
        }
        let entity = Entity::find(self.geometry.file, base)?;
        if self.trail.len() >= MAX_NESTED {
            return Err(Fault::Endless(Endless::Depth(base, MAX_NESTED)));
        }
        let members = match entity.kind() {
            308 => (4..4 + entity.count(3, 1)?).filter_map(|i| entity.optional(i).ok().flatten()).collect(),
            _ => vec![base],
        };
        // the members of an entity that places others are placed by that entity
        self.scope(base, &members, transform, name);
        Ok(())
    }

    /// 408.
    fn subfigure(&mut self, entity: Entity<'a>, outer: DAffine3, name: &str) -> Result<(), Fault> {
        let id = entity.id();
        let definition = Entity::find(self.geometry.file, entity.pointer(1)?)?;
        let definition = definition.of_kind(308, "308, a subfigure")?;
        if self.trail.contains(&definition.id()) {
            return Err(Fault::Endless(Endless::Cycle(definition.id())));
        }
        if self.trail.len() > MAX_LEVELS {
            return Err(Fault::Endless(Endless::Depth(id, MAX_LEVELS)));
        }
        let unit = self.geometry.file.global.unit;
        let scale = if entity.real(5)? == 0.0 { 1.0 } else { entity.real(5)? };
        let moved = DAffine3::from_translation(entity.triple(2)?) * DAffine3::from_scale(DVec3::splat(scale));
        let mut own = self.geometry.placed(entity, &DAffine3::IDENTITY)? * moved;
        own.translation *= unit;
        let transform = outer * own;
        let sound = transform.is_finite() && transform.matrix3.determinant() != 0.0;
        sound.then_some(()).ok_or(Fault::Value { id, what: "the placement cannot be inverted" })?;
        let count = definition.count(3, 1)?;
        self.geometry.spend(id, 1 + count)?;
        let members: Vec<u32> = (4..4 + count).filter_map(|i| definition.optional(i).ok().flatten()).collect();
        let name = names::path(name, &definition.string(2));
        self.scope(definition.id(), &members, transform, &name);
        Ok(())
    }

    /// Whether an entity is drawn; counts the ones that are not.
    fn is_drawn(&self, entity: Entity<'a>) -> bool {
        // writers mark shells of sheet models as dependent, though no solid owns them
        let orphan = match entity.kind() {
            510 => !self.owners[1],
            514 => !self.owners[0],
            _ => false,
        };
        let lost = entity.entry.dependent && self.trail.is_empty() && !orphan;
        let kind = match (entity.entry.blank, entity.entry.purpose) {
            _ if lost => "entity without its owner not drawn",
            (true, _) => "blanked entity not drawn",
            (_, 1) => "annotation not drawn",
            (_, 5 | 6) => "construction not drawn",
            _ => return true,
        };
        self.geometry.note(kind, entity.id(), format!("type {}", entity.kind()));
        false
    }

    /// The bodies among the members of a scope, which are made here.
    fn bodies_of(&mut self, members: &[u32]) -> Vec<usize> {
        let first = self.bodies.len();
        let mut sheets: BTreeMap<(u32, i32), usize> = BTreeMap::new();
        let mut seen = HashSet::new();
        for &id in members {
            let Ok(entity) = Entity::find(self.geometry.file, id) else {
                self.geometry.note("entity left out", id, "it does not exist");
                continue;
            };
            if entity.len() == 0 || !seen.insert(id) {
                continue;
            }
            match entity.kind() {
                162 | 164 | 186 | 510 | 514 if self.is_drawn(entity) => self.solid(entity),
                430 if self.is_drawn(entity) => match self.instance_of(entity) {
                    Some(150..=160 | 166..=184) => self.boolean(entity),
                    _ => self.solid(entity),
                },
                150..=160 | 166..=180 if self.is_drawn(entity) => self.boolean(entity),
                108 if entity.entry.form == 0 => self.not_drawn(entity, "an unbounded surface"),
                190 | 192 | 194 if !entity.entry.dependent => self.not_drawn(entity, "an unbounded surface"),
                kind if (matches!(kind, 143 | 144) || SURFACES.contains(&kind)) && self.is_drawn(entity) => {
                    let key = (self.groups.get(&id).copied().unwrap_or(0), entity.entry.level);
                    let body = *sheets.entry(key).or_insert_with(|| {
                        let name = self.sheets_name(key);
                        self.bodies.push(Body { name, ..Body::default() });
                        self.bodies.len() - 1
                    });
                    self.sheet(entity, body);
                }
                100..=106 | 110 | 112 | 116 | 126 | 130 | 142 => self.not_drawn(entity, "a curve or a point"),
                182 | 420 => self.geometry.note("entity left out", id, entity.unsupported().to_string()),
                // definitions, annotation, finite elements; what is drawn elsewhere, or blanked
                0 | 100..=148 | 150..=230 | 302..=322 | 402..=430 | 502..=514 => {}
                kind => self.geometry.note("entity of an unknown type not drawn", id, format!("type {kind}")),
            }
        }
        (first..self.bodies.len()).filter(|i| !self.bodies[*i].operand).collect()
    }

    /// The type of the entity that a 430 places.
    fn instance_of(&self, entity: Entity<'a>) -> Option<u16> {
        let of = Entity::find(self.geometry.file, entity.optional(1).ok()??).ok()?;
        Some(of.kind())
    }

    /// A primitive, a tree, or an instance of one.
    fn boolean(&mut self, entity: Entity<'a>) {
        let unit = DAffine3::from_scale(DVec3::splat(self.geometry.file.global.unit));
        match self.geometry.expression(entity.id(), &unit) {
            Ok(mut expression) => {
                let first = self.bodies.len();
                let operand = |shells| Body { closed: true, operand: true, shells, ..Body::default() };
                self.bodies.extend(std::mem::take(&mut expression.shells).into_iter().map(operand));
                let solid = Some((expression, first));
                self.bodies.push(Body { solid, ..Body::default() });
            }
            Err(fault) => self.geometry.note(SOLID_LOST, entity.id(), fault.to_string()),
        }
    }

    fn not_drawn(&self, entity: Entity<'a>, what: &'static str) {
        if entity.entry.dependent {
            return;
        }
        self.geometry.note("no surface, not drawn", entity.id(), format!("type {}, {what}", entity.kind()));
    }

    /// The group's name, the level's, or nothing.
    fn sheets_name(&self, (group, level): (u32, i32)) -> String {
        let group = Entity::find(self.geometry.file, group).ok();
        let named = group.and_then(|g| Some(g.name(1 + g.count(1, 1).ok()?))).filter(|n| !n.is_empty());
        named.unwrap_or_else(|| if level > 0 { format!("level {level}") } else { String::new() })
    }

    fn sheet(&mut self, entity: Entity<'a>, body: usize) {
        let unit = DAffine3::from_scale(DVec3::splat(self.geometry.file.global.unit));
        match self.geometry.sheet(entity.id(), &unit) {
            Ok(sheet) => {
                let colour = self.geometry.colour(entity);
                self.bodies[body].sheets.push((sheet, colour));
            }
            Err(fault) => {
                self.geometry.note(FACE_LOST, entity.id(), fault.to_string());
                self.bodies[body].shells.lost.push((entity.id(), fault.to_string()));
            }
        }
    }

    fn solid(&mut self, entity: Entity<'a>) {
        let unit = DAffine3::from_scale(DVec3::splat(self.geometry.file.global.unit));
        let shells = match entity.kind() {
            430 => self.geometry.nested(entity.id(), |e| {
                let map = self.geometry.placed(e, &unit)?;
                self.geometry.shells(e.pointer(1)?, &map)
            }),
            _ => self.geometry.shells(entity.id(), &unit),
        };
        match shells {
            Ok(shells) => {
                let items = |index: usize, each: usize| each * entity.count(index, each).unwrap_or(0);
                let last = match entity.kind() {
                    162 => 8,
                    164 => 5,
                    186 => 3 + items(3, 2),
                    510 => 3 + items(2, 1),
                    514 => 1 + items(1, 2),
                    _ => 1,
                };
                let closed = match entity.kind() {
                    510 => false,
                    514 => entity.entry.form == 1,
                    _ => true,
                };
                let name = entity.name(last);
                self.bodies.push(Body { name, closed, shells, ..Body::default() });
            }
            Err(fault) => self.geometry.note("body left out", entity.id(), fault.to_string()),
        }
    }
}
