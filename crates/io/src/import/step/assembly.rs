//! The graph of representations: which bodies stand where.
//!
//! ```text
//!   representation ──items──▶ bodies
//!        │  ▲ same place: SHAPE_REPRESENTATION_RELATIONSHIP, several shapes of one product
//!        │
//!        ├─ CONTEXT_DEPENDENT_SHAPE_REPRESENTATION of a NEXT_ASSEMBLY_USAGE_OCCURRENCE   see `place`
//!        └─ MAPPED_ITEM         M(target) · M(origin)⁻¹
//! ```
//!
//! Representations at the same place form one *group*. Groups and placements are a graph that ought to have no cycle;
//! the walk from its roots makes one instance of a body per path. The rule of `once` decides which instances are drawn,
//! and how often.
//!
//! Source: ISO 10303-43 (representation structures), ISO 10303-44 (product structure), and CAx-IF
//! Recommended Practices for assembly structure.

use super::body::{self, Role};
use super::document::Documents;
use super::entity::{Entity, Fault, Fields};
use super::geometry::{Geometry, Ledger};
use super::once;
use super::orphans::Orphans;
use super::part21::{File, Value};
use super::presentation::Presentation;
use super::product::Products;
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

/// The bodies and placements of one group.
#[derive(Debug, Default)]
pub(super) struct Group {
    /// Bodies, and the representation that lists each.
    pub bodies: Vec<(u32, u32)>,
    /// Groups placed in it.
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
    /// Groups that are the shape of a product.
    pub owned: BTreeSet<u32>,
    /// By the body in place of the documents in its group: documents, and the names of their files.
    pub files: BTreeMap<u32, Vec<(u32, Vec<String>)>>,
}

pub(super) struct Reader<'a, 'r> {
    pub file: &'a File<'a>,
    pub ledger: &'r Ledger<'a>,
    presentation: &'r Presentation,
    pub products: Products,
    pub assembly: Assembly,
    /// Parent's representation and placement.
    pub placements: Vec<(u32, Placement)>,
    /// Placements that may belong to an occurrence.
    pub mentions: Vec<(u32, Placement)>,
    /// Groups that list an item of a transformation.
    pub listed: HashMap<u32, Vec<u32>>,
}

/// Names of representations that can hold shape; those of properties cannot.
fn is_shape(kind: &str) -> bool {
    let further = ["WITH_PARAMETERS", "WITH_ACCURACY_PARAMETERS"];
    let base = further.iter().find_map(|f| kind.strip_suffix(f)?.strip_suffix('_')).unwrap_or(kind);
    kind == "REPRESENTATION"
        || (base.ends_with("SHAPE_REPRESENTATION") && base != "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION")
}

/// Names of representations that show shape held by others: drawings and saved views.
fn is_presentation(kind: &str) -> bool {
    ["DRAUGHTING_", "PRESENTATION_", "MECHANICAL_DESIGN_"].iter().any(|begin| kind.starts_with(begin))
}

/// Name, items and context of a representation.
pub(super) fn representation(entity: Entity<'_>) -> Fields<'_> {
    entity.fields("REPRESENTATION", 0).unwrap_or_else(|_| entity.all())
}

impl Assembly {
    /// Reads the graph.
    pub fn read(file: &File<'_>, ledger: &Ledger<'_>, presentation: &Presentation) -> Self {
        let products = Products::read(file, ledger);
        let (assembly, placements, mentions, listed) = Default::default();
        let mut reader = Reader { file, ledger, presentation, products, assembly, placements, mentions, listed };
        let all = |is: fn(&str) -> bool| file.kinds().filter(move |k| is(k)).flat_map(|k| file.of_kind(k));
        let mut shapes: BTreeSet<u32> = all(is_shape).collect();
        all(is_presentation).chain(reader.products.aspects.iter().copied()).for_each(|id| _ = shapes.remove(&id));
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

    /// Gives each group that has no content in this file a body in place of its documents.
    fn follow(&mut self, documents: Documents, groups: &mut BTreeMap<u32, Group>, ledger: &Ledger<'_>) {
        let mut of_group: BTreeMap<u32, (u32, BTreeSet<u32>)> = BTreeMap::new();
        for (shape, found) in documents.of_shape {
            let group = of_group.entry(self.group(shape)).or_insert((shape, BTreeSet::new()));
            group.1.extend(found);
        }
        let filled = filled(self, groups, &of_group.keys().copied().collect::<Vec<_>>());
        let mut used: BTreeSet<u32> = BTreeSet::new();
        for (id, (shape, found)) in of_group {
            let group = groups.entry(id).or_default();
            let below = group.placements.iter().map(|p| self.group(p.child));
            if group.bodies.is_empty() && !below.clone().any(|child| child != id && filled.contains(&child)) {
                group.bodies.push((shape, shape));
                used.extend(&found);
                let named = found.into_iter().filter_map(|d| Some((d, documents.names.get(&d)?.clone())));
                self.files.insert(shape, named.collect());
            }
        }
        let unused = documents.names.keys().filter(|d| !used.contains(d)).count();
        if unused > 0 {
            ledger.ignore("documents of no shape, or of one that stands here", unused);
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
    pub fn entity(&self, id: u32) -> Result<Entity<'a>, Fault> {
        Entity::find(self.file, id)
    }

    /// Runs `f` for `#id`; a fault becomes a note.
    pub fn guarded<T>(
        &mut self,
        kind: &'static str,
        id: u32,
        f: impl FnOnce(&mut Self) -> Result<T, Fault>,
    ) -> Option<T> {
        let result = f(self);
        result.map_err(|fault| self.ledger.note(kind, id, fault.to_string())).ok()
    }

    /// Units of every representation, each context read once.
    fn contexts(&mut self, shapes: &BTreeSet<u32>) {
        let mut known: HashMap<u32, Units> = HashMap::new();
        for &id in shapes {
            let Some(context) = self.entity(id).ok().and_then(|e| representation(e).optional(2)) else { continue };
            let read = || {
                Units::of_context(self.file, context, |what, fault| self.ledger.note(what, context, fault.to_string()))
            };
            let units = known.entry(context).or_insert_with(read);
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
        let mut free = Vec::new();
        for id in ids {
            self.guarded("relationship ignored", id, |s| {
                let entity = s.entity(id)?;
                let (first, second) = related(entity)?;
                if entity.is("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION") {
                    free.extend(Some(id).filter(|id| !owned.contains(id)));
                } else if shapes.contains(&first) && shapes.contains(&second) {
                    s.assembly.join(first, second);
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
        self.list_items(shapes);
        self.free_relationships(free);
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
                        let placement = s.guarded("mapped item ignored", item, |s| s.mapped(entity, id));
                        s.mentions.extend(placement.map(|placement| (id, placement)));
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
                        Role::Ignored | Role::Unknown => s.ledger.ignore(&entity.name(), 1),
                        Role::Beside => {}
                    }
                }
                Ok(())
            });
        }
        self.features(&mut listed);
        let orphans = Orphans::find(self.file, &listed);
        for &orphan in &orphans.bodies {
            self.ledger.note("body without representation", orphan, "drawn with the file's first units");
        }
        for &orphan in &orphans.shells {
            self.ledger.note("shell without body", orphan, "drawn with the file's first units");
        }
        let bodies = orphans.bodies.iter().chain(&orphans.shells).chain(orphans.faces.first());
        // a group of their own, where no placement of a representation moves them
        let bodies: Vec<u32> = bodies.copied().collect();
        if let Some(&group) = bodies.first() {
            let units = shapes.iter().find_map(|id| self.assembly.units.get(id)).cloned();
            self.assembly.units.extend(units.map(|units| (group, units)));
            let listed = bodies.into_iter().map(|id| (id, group)).collect();
            self.assembly.groups.insert(group, Group { bodies: listed, ..Group::default() });
        }
        if let Some(&first) = orphans.faces.first() {
            let count = orphans.faces.len();
            self.ledger.note("face without shell", first, format!("{count} of them are drawn as one open shell"));
        }
        self.assembly.loose = orphans.faces;
    }

    /// Bodies that only aspects of a product list, as the volume that a feature removes: they are no part of the
    /// product's shape, where it has one.
    fn features(&self, listed: &mut BTreeSet<u32>) {
        if self.assembly.groups.values().all(|group| group.bodies.is_empty()) {
            return;
        }
        for &id in &self.products.aspects {
            let items = self.entity(id).and_then(|entity| representation(entity).list(1));
            let units = self.assembly.units_of(id);
            let geometry = Geometry { file: self.file, units: &units, ledger: self.ledger };
            for item in items.into_iter().flatten().filter_map(Value::reference) {
                let is_body = self.entity(item).is_ok_and(|e| matches!(body::role(&geometry, e), Role::Body));
                if is_body && listed.insert(item) {
                    self.ledger.ignore("bodies of features", 1);
                }
            }
        }
    }

    /// Gathers bodies and placements by group and drops groups without any body below them.
    fn finish(self) -> Assembly {
        let Self { file, ledger, presentation, products, mut assembly, placements, .. } = self;
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
        assembly.owned = products.owner.keys().map(|representation| assembly.group(*representation)).collect();
        assembly.groups = groups;
        let tessellated = |id: u32| Entity::find(file, id).is_ok_and(once::is_tessellated);
        let copies = assembly.drop_copies(tessellated);
        if copies > 0 {
            ledger.ignore("tessellated copies beside the products", copies);
        }
        let mut groups = std::mem::take(&mut assembly.groups);
        let documents = Documents::read(file, ledger, &products);
        assembly.follow(documents, &mut groups, ledger);
        let filled = filled(&assembly, &groups, &[]);
        groups.retain(|id, _| filled.contains(id));
        for group in groups.values_mut() {
            group.placements.retain(|p| filled.contains(&assembly.group(p.child)));
        }
        assembly.groups = groups;
        assembly
    }
}

/// Groups with a body in them or below, or one of `more`: from there upwards.
fn filled(assembly: &Assembly, groups: &BTreeMap<u32, Group>, more: &[u32]) -> BTreeSet<u32> {
    let mut parents: HashMap<u32, Vec<u32>> = HashMap::new();
    for (id, group) in groups {
        for placement in &group.placements {
            parents.entry(assembly.group(placement.child)).or_default().push(*id);
        }
    }
    let mut open = more.to_vec();
    open.extend(groups.iter().filter(|(_, g)| !g.bodies.is_empty()).map(|(id, _)| *id));
    let mut filled = BTreeSet::new();
    while let Some(id) = open.pop() {
        if filled.insert(id) {
            open.extend(parents.get(&id).into_iter().flatten());
        }
    }
    filled
}

/// The two representations of a relationship.
pub(super) fn related(entity: Entity<'_>) -> Result<(u32, u32), Fault> {
    let fields = entity.fields("REPRESENTATION_RELATIONSHIP", 0).unwrap_or_else(|_| entity.all());
    Ok((fields.reference(2)?, fields.reference(3)?))
}
