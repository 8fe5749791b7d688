//! The graph of representations: which bodies stand where.
//!
//! ```text
//!   representation ──items──▶ bodies
//!        │  ▲ same place: SHAPE_REPRESENTATION_RELATIONSHIP, several shapes of one product
//!        │
//!        ├─ CONTEXT_DEPENDENT_SHAPE_REPRESENTATION of a NEXT_ASSEMBLY_USAGE_OCCURRENCE
//!        │    child in parent:  M(item in parent) · M(item in child)⁻¹
//!        └─ MAPPED_ITEM         M(target) · M(origin)⁻¹
//! ```
//!
//! Representations at the same place form one *group*. Groups and placements are a graph that ought to
//! have no cycle; the walk from its roots makes one instance of a body per path. Which of the two
//! representations of a placement is the child is decided by the products, not by the order in the
//! file, which writers get wrong.
//!
//! Source: ISO 10303-43 (representation structures), ISO 10303-44 (product structure), and CAx-IF
//! Recommended Practices for assembly structure.

use super::body::{self, Role};
use super::entity::{Entity, Fault, Fields};
use super::geometry::{Geometry, Ledger};
use super::orphans::Orphans;
use super::part21::{File, Value};
use super::presentation::Presentation;
use super::product::{Occurrence, Products};
use super::units::Units;
use glam::DAffine3;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// A placement of one group in another.
#[derive(Clone, Debug)]
pub(super) struct Placement {
    /// Representation that is placed.
    pub child: u32,
    /// Child coordinates to parent coordinates, millimetres.
    pub transform: DAffine3,
    /// Name of the occurrence, or empty.
    pub name: String,
    /// Entities that a style can name to mean this placement.
    pub ids: Vec<u32>,
}

/// Everything of one group.
#[derive(Debug, Default)]
pub(super) struct Group {
    /// Bodies, and the representation that lists each.
    pub bodies: Vec<(u32, u32)>,
    /// What is placed in it.
    pub placements: Vec<Placement>,
    /// Name of its product, or empty.
    pub name: String,
}

/// The groups of a file.
#[derive(Debug, Default)]
pub(super) struct Assembly {
    /// By the smallest number of their representations.
    pub groups: BTreeMap<u32, Group>,
    /// Group of a representation, one step towards the smallest number.
    up: HashMap<u32, u32>,
    /// Units by representation.
    pub units: HashMap<u32, Units>,
    /// Faces that no shell holds: the body named by the first of them.
    pub loose: Vec<u32>,
    children: BTreeSet<u32>,
}

struct Reader<'a, 'r> {
    file: &'a File<'a>,
    ledger: &'r Ledger<'a>,
    presentation: &'r Presentation,
    products: Products,
    assembly: Assembly,
    placements: Vec<(u32, Placement)>,
}

/// Representations that can hold shape; those of presentation and of properties cannot.
fn is_shape(kind: &str) -> bool {
    kind == "REPRESENTATION"
        || kind == "SHAPE_REPRESENTATION_WITH_PARAMETERS"
        || (kind.ends_with("SHAPE_REPRESENTATION") && kind != "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION")
}

/// Name, items and context of a representation.
fn representation(entity: Entity<'_>) -> Fields<'_> {
    entity.fields("REPRESENTATION", 0).unwrap_or_else(|_| entity.all())
}

impl Assembly {
    /// Reads the graph.
    pub fn read(file: &File<'_>, ledger: &Ledger<'_>, presentation: &Presentation) -> Self {
        let products = Products::read(file, ledger);
        let (assembly, placements) = Default::default();
        let mut reader = Reader { file, ledger, presentation, products, assembly, placements };
        let shapes: BTreeSet<u32> = file.kinds().filter(|k| is_shape(k)).flat_map(|k| file.of_kind(k)).collect();
        let shapes = &shapes - &reader.products.aspects;
        reader.contexts(&shapes);
        reader.relationships(&shapes);
        reader.bodies(&shapes);
        reader.occurrences();
        reader.finish()
    }

    /// The group of a representation.
    pub fn group(&self, mut representation: u32) -> u32 {
        while let Some(&up) = self.up.get(&representation) {
            representation = up;
        }
        representation
    }

    /// Groups that nothing places; all of them when there is nothing but cycles.
    pub fn roots(&self) -> Vec<u32> {
        let roots: Vec<u32> = self.groups.keys().copied().filter(|g| !self.children.contains(g)).collect();
        if roots.is_empty() { self.groups.keys().copied().collect() } else { roots }
    }

    /// Units of a representation.
    pub fn units_of(&self, representation: u32) -> Units {
        self.units.get(&representation).cloned().unwrap_or_default()
    }

    /// Joins two groups; the smaller number stays.
    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.flatten(a), self.flatten(b));
        if a != b {
            self.up.insert(a.max(b), a.min(b));
        }
    }

    /// The group of a representation; makes every step on the way there the last one.
    fn flatten(&mut self, representation: u32) -> u32 {
        let group = self.group(representation);
        let mut at = representation;
        while let Some(up) = self.up.get_mut(&at) {
            at = std::mem::replace(up, group);
        }
        group
    }
}

impl<'a> Reader<'a, '_> {
    fn entity(&self, id: u32) -> Result<Entity<'a>, Fault> {
        Entity::find(self.file, id)
    }

    /// Runs `f` for `#id`; a fault becomes a note.
    fn guarded<T>(&mut self, kind: &'static str, id: u32, f: impl FnOnce(&mut Self) -> Result<T, Fault>) -> Option<T> {
        let result = f(self);
        result.map_err(|fault| self.ledger.note(kind, id, fault.to_string())).ok()
    }

    /// Units of every representation, each context read once.
    fn contexts(&mut self, shapes: &BTreeSet<u32>) {
        let mut known: HashMap<u32, Units> = HashMap::new();
        for &id in shapes {
            let Some(context) = self.entity(id).ok().and_then(|e| representation(e).optional(2)) else { continue };
            let read = |s: &mut Self| Units::of_context(s.file, context);
            let units = known
                .entry(context)
                .or_insert_with(|| self.guarded("units taken as millimetres", context, read).unwrap_or_default());
            self.assembly.units.insert(id, units.clone());
        }
    }

    /// Representations at the same place, and placements that no product occurrence owns.
    fn relationships(&mut self, shapes: &BTreeSet<u32>) {
        let owned: BTreeSet<u32> = self
            .file
            .of_kind("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION")
            .filter_map(|id| self.entity(id).ok()?.all().optional(0))
            .collect();
        let kinds = ["SHAPE_REPRESENTATION_RELATIONSHIP", "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION"];
        let ids: BTreeSet<u32> = kinds.iter().flat_map(|k| self.file.of_kind(k)).collect();
        for id in ids {
            self.guarded("relationship ignored", id, |s| {
                let entity = s.entity(id)?;
                let (first, second) = related(entity)?;
                if !entity.is("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION") {
                    if shapes.contains(&first) && shapes.contains(&second) {
                        s.assembly.join(first, second);
                    }
                } else if !owned.contains(&id) {
                    let transform = s.transformation(entity, first, second)?;
                    let placement = Placement { child: first, transform, name: String::new(), ids: vec![id] };
                    s.placements.push((second, placement));
                }
                Ok(())
            });
        }
        for shapes in self.products.shapes.values() {
            shapes.windows(2).for_each(|pair| self.assembly.join(pair[0], pair[1]));
        }
        let joined: Vec<u32> = self.assembly.up.keys().copied().collect();
        for id in joined {
            self.assembly.flatten(id);
        }
    }

    /// Bodies and mapped items among the items of each representation.
    fn bodies(&mut self, shapes: &BTreeSet<u32>) {
        let mut listed = BTreeSet::new();
        for &id in shapes {
            self.guarded("representation ignored", id, |s| {
                let items = representation(s.entity(id)?).list(1)?;
                let units = s.assembly.units_of(id);
                let geometry = Geometry { file: s.file, units: &units, ledger: s.ledger };
                for item in items.filter_map(Value::reference) {
                    s.ledger.spend(item, 1)?;
                    let Ok(entity) = s.entity(item) else {
                        s.ledger.note("item left out", item, format!("listed by #{id} but does not exist"));
                        continue;
                    };
                    if entity.is("MAPPED_ITEM") {
                        s.guarded("mapped item ignored", item, |s| s.mapped(entity, id));
                        continue;
                    }
                    let role = body::role(&geometry, entity);
                    match role {
                        Role::Body | Role::Unsupported if s.presentation.hides(item) || s.presentation.hides(id) => {
                            listed.insert(item);
                            s.ledger.ignore("hidden bodies", 1);
                        }
                        Role::Body => {
                            listed.insert(item);
                            s.assembly.groups.entry(id).or_default().bodies.push((item, id));
                        }
                        Role::Unsupported => {
                            s.ledger.note("item left out", item, format!("{} is not supported", entity.name()));
                        }
                        Role::Ignored => s.ledger.ignore(&entity.name(), 1),
                        Role::Other => {}
                    }
                }
                Ok(())
            });
        }
        let context = shapes.iter().find(|id| self.assembly.units.contains_key(id)).copied().unwrap_or(0);
        let orphans = Orphans::find(self.file, &listed);
        for &orphan in &orphans.bodies {
            self.ledger.note("body without representation", orphan, "drawn with the file's first units");
        }
        for &orphan in &orphans.shells {
            self.ledger.note("shell without body", orphan, "drawn with the file's first units");
        }
        let bodies = orphans.bodies.iter().chain(&orphans.shells).chain(orphans.faces.first());
        let bodies: Vec<_> = bodies.map(|id| (*id, context)).collect();
        if !bodies.is_empty() {
            self.assembly.groups.entry(context).or_default().bodies.extend(bodies);
        }
        if let Some(&first) = orphans.faces.first() {
            let count = orphans.faces.len();
            self.ledger.note("face without shell", first, format!("{count} of them are drawn as one open shell"));
        }
        self.assembly.loose = orphans.faces;
    }

    /// MAPPED_ITEM('',#map,target) with #map = REPRESENTATION_MAP(origin,representation).
    fn mapped(&mut self, item: Entity<'a>, parent: u32) -> Result<(), Fault> {
        let fields = item.fields("MAPPED_ITEM", 1)?;
        let map = self.entity(fields.reference(0)?)?.all();
        let child = map.reference(1)?;
        let origin = self.placement_matrix(map.reference(0)?, child)?;
        let target = self.placement_matrix(fields.reference(1)?, parent)?;
        let transform = target * invert(origin, item.id())?;
        let placement = Placement { child, transform, name: item.label(), ids: vec![item.id()] };
        self.placements.push((parent, placement));
        Ok(())
    }

    fn occurrences(&mut self) {
        let mut placed = BTreeSet::new();
        for id in self.file.of_kind("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION").collect::<Vec<_>>() {
            self.guarded("occurrence left out", id, |s| {
                let fields = s.entity(id)?.all();
                let relation = s.entity(fields.reference(0)?)?;
                let usage = s.entity(fields.reference(1)?)?.all().reference(2)?;
                placed.insert(usage);
                let occurrence = Occurrence::read(s.file, usage)?;
                let (first, second) = related(relation)?;
                let (parent, child) = if s.shows(second, occurrence.child) && !s.shows(first, occurrence.child) {
                    (first, second)
                } else {
                    (second, first)
                };
                let transform = s.transformation(relation, child, parent)?;
                let ids = vec![id, relation.id(), usage];
                s.placements.push((parent, Placement { child, transform, name: occurrence.name, ids }));
                Ok(())
            });
        }
        for id in self.file.of_kind("NEXT_ASSEMBLY_USAGE_OCCURRENCE").collect::<Vec<_>>() {
            if placed.contains(&id) {
                continue;
            }
            self.guarded("occurrence left out", id, |s| {
                let occurrence = Occurrence::read(s.file, id)?;
                let shape = |definition: u32| s.products.shapes.get(&definition).and_then(|v| v.first().copied());
                // a product without any shape has nothing to place
                if let (Some(parent), Some(child)) = (shape(occurrence.parent), shape(occurrence.child)) {
                    s.ledger.note("occurrence without placement", id, "placed at the origin of its parent");
                    let (transform, ids) = (DAffine3::IDENTITY, vec![id]);
                    s.placements.push((parent, Placement { child, transform, name: occurrence.name, ids }));
                }
                Ok(())
            });
        }
    }

    /// The representation is a shape of the product definition.
    fn shows(&self, representation: u32, definition: u32) -> bool {
        let group = self.assembly.group(representation);
        let shapes = self.products.shapes.get(&definition);
        shapes.is_some_and(|shapes| shapes.iter().any(|s| self.assembly.group(*s) == group))
    }

    /// Child to parent coordinates of REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION.
    fn transformation(&self, relation: Entity<'a>, child: u32, parent: u32) -> Result<DAffine3, Fault> {
        let Ok(fields) = relation.fields("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION", 4) else {
            return Ok(DAffine3::IDENTITY);
        };
        let operator = self.entity(fields.reference(0)?)?;
        let Ok(items) = operator.fields("ITEM_DEFINED_TRANSFORMATION", 2) else {
            return self.placement_matrix(operator.id(), parent);
        };
        // item 1 belongs to the first representation of the relationship
        let (first, _) = related(relation)?;
        let (in_child, in_parent) = if first == child { (0, 1) } else { (1, 0) };
        let in_child = self.placement_matrix(items.reference(in_child)?, child)?;
        let in_parent = self.placement_matrix(items.reference(in_parent)?, parent)?;
        Ok(in_parent * invert(in_child, relation.id())?)
    }

    /// A placement in the units of its representation.
    fn placement_matrix(&self, id: u32, representation: u32) -> Result<DAffine3, Fault> {
        let units = self.assembly.units_of(representation);
        Geometry { file: self.file, units: &units, ledger: self.ledger }.transform(id)
    }

    /// Gathers bodies and placements by group and drops groups without any body below them.
    fn finish(self) -> Assembly {
        let Self { file, ledger, presentation, products, mut assembly, placements } = self;
        let mut groups: BTreeMap<u32, Group> = BTreeMap::new();
        let mut seen = BTreeSet::new();
        for (id, listed) in std::mem::take(&mut assembly.groups) {
            let id = assembly.group(id);
            // a solid may be listed by several representations of one product
            let new = listed.bodies.into_iter().filter(|b| seen.insert((id, b.0)));
            groups.entry(id).or_default().bodies.extend(new);
        }
        for (parent, placement) in placements {
            if placement.ids.iter().any(|id| presentation.hides(*id)) {
                ledger.ignore("hidden occurrences", 1);
                continue;
            }
            groups.entry(assembly.group(parent)).or_default().placements.push(placement);
        }
        for (representation, definition) in &products.owner {
            if let Some(group) = groups.get_mut(&assembly.group(*representation)).filter(|g| g.name.is_empty()) {
                group.name = Products::name(file, *definition).unwrap_or_default();
            }
        }
        let filled = filled(&assembly, &groups);
        groups.retain(|id, _| filled.contains(id));
        for group in groups.values_mut() {
            group.placements.retain(|p| filled.contains(&assembly.group(p.child)));
        }
        assembly.children = groups.values().flat_map(|g| &g.placements).map(|p| assembly.group(p.child)).collect();
        assembly.groups = groups;
        assembly
    }
}

/// Groups with a body in them or below: from the bodies upwards.
fn filled(assembly: &Assembly, groups: &BTreeMap<u32, Group>) -> BTreeSet<u32> {
    let mut parents: HashMap<u32, Vec<u32>> = HashMap::new();
    for (id, group) in groups {
        for placement in &group.placements {
            parents.entry(assembly.group(placement.child)).or_default().push(*id);
        }
    }
    let mut open: Vec<u32> = groups.iter().filter(|(_, g)| !g.bodies.is_empty()).map(|(id, _)| *id).collect();
    let mut filled = BTreeSet::new();
    while let Some(id) = open.pop() {
        if filled.insert(id) {
            open.extend(parents.get(&id).into_iter().flatten());
        }
    }
    filled
}

/// The two representations of a relationship.
fn related(entity: Entity<'_>) -> Result<(u32, u32), Fault> {
    let fields = entity.fields("REPRESENTATION_RELATIONSHIP", 0).unwrap_or_else(|_| entity.all());
    Ok((fields.reference(2)?, fields.reference(3)?))
}

fn invert(transform: DAffine3, id: u32) -> Result<DAffine3, Fault> {
    let inverse = transform.inverse();
    if inverse.is_finite() { Ok(inverse) } else { Err(Fault::Value { id, what: "the placement cannot be inverted" }) }
}
