//! Where one representation stands in another.
//!
//! ```text
//!   REPRESENTATION_RELATIONSHIP('','',#r,#s)    the products determine which is the child
//!   ITEM_DEFINED_TRANSFORMATION('','',#a,#b)    each item belongs to the representation that lists it
//!
//!   child in parent:  M(item in parent) · M(item in child)⁻¹
//! ```
//!
//! The standard puts the child and its item first. Writers reverse either pair or both, so neither order determines the
//! other. The order of the relationship counts only for items that both representations list, or neither.
//!
//! Source: ISO 10303-43 (representation structures), ISO 10303-44 (product structure).

use super::assembly::{Placement, Reader, related, representation};
use super::entity::{Entity, Fault};
use super::geometry::Geometry;
use super::part21::Value;
use super::product::Occurrence;
use glam::DAffine3;
use std::collections::{BTreeSet, HashMap};

impl<'a> Reader<'a, '_> {
    /// Child and parent of the two representations of an occurrence's relationship.
    pub fn direction(&self, (first, second): (u32, u32), occurrence: &Occurrence) -> (u32, u32) {
        let fit = |child: u32, parent: u32| {
            u8::from(self.shows(child, occurrence.child)) + u8::from(self.shows(parent, occurrence.parent))
        };
        if fit(second, first) > fit(first, second) { (second, first) } else { (first, second) }
    }

    /// The representation is a shape of the product definition.
    fn shows(&self, representation: u32, definition: u32) -> bool {
        let group = self.assembly.group(representation);
        let shapes = self.products.shapes.get(&definition);
        shapes.is_some_and(|shapes| shapes.iter().any(|s| self.assembly.group(*s) == group))
    }

    /// Relationships with a transformation that no occurrence owns.
    pub fn free_relationships(&mut self, free: Vec<u32>) {
        let pairs = self.pairs();
        for id in free {
            self.guarded("relationship ignored", id, |s| {
                let entity = s.entity(id)?;
                let (first, second) = related(entity)?;
                let [a, b] = [first, second].map(|r| s.assembly.group(r));
                let turned = pairs.contains(&(a, b)) && !pairs.contains(&(b, a));
                let (child, parent) = if turned { (second, first) } else { (first, second) };
                let transform = s.transformation(entity, child, parent)?;
                let placement = Placement { child, transform, name: String::new(), ids: vec![id] };
                s.mentions.push((parent, placement));
                Ok(())
            });
        }
    }

    /// Notes the groups that list the items of transformations.
    pub fn list_items(&mut self, shapes: &BTreeSet<u32>) {
        let operators = self.file.of_kind("ITEM_DEFINED_TRANSFORMATION");
        let items: BTreeSet<u32> =
            operators.filter_map(|id| self.entity(id).ok()).flat_map(Entity::references).collect();
        let mut listed: HashMap<u32, Vec<u32>> = HashMap::new();
        for &id in shapes {
            let list = self.entity(id).and_then(|e| representation(e).list(1));
            for item in list.into_iter().flatten().filter_map(Value::reference).filter(|i| items.contains(i)) {
                listed.entry(item).or_default().push(self.assembly.group(id));
            }
        }
        self.listed = listed;
    }

    /// Child to parent coordinates of REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION.
    pub fn transformation(&self, relation: Entity<'a>, child: u32, parent: u32) -> Result<DAffine3, Fault> {
        let Ok(fields) = relation.fields("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION", 4) else {
            return Ok(DAffine3::IDENTITY);
        };
        let operator = self.entity(fields.reference(0)?)?;
        let Ok(items) = operator.fields("ITEM_DEFINED_TRANSFORMATION", 2) else {
            return self.placement_matrix(operator.id(), parent);
        };
        let [a, b] = [items.reference(0)?, items.reference(1)?];
        let lists = |representation: u32, item: u32| {
            let group = self.assembly.group(representation);
            u8::from(self.listed.get(&item).is_some_and(|groups| groups.contains(&group)))
        };
        let (straight, turned) = (lists(child, a) + lists(parent, b), lists(child, b) + lists(parent, a));
        if straight + turned == 0 {
            let told = "neither representation lists its items: taken in the order of the relationship";
            self.ledger.note("placement guessed", operator.id(), told);
        }
        let (first, _) = related(relation)?;
        let turned = if straight == turned { first != child } else { turned > straight };
        let (in_child, in_parent) = if turned { (b, a) } else { (a, b) };
        let in_child = self.placement_matrix(in_child, child)?;
        let in_parent = self.placement_matrix(in_parent, parent)?;
        Ok(in_parent * invert(in_child, relation.id())?)
    }

    /// MAPPED_ITEM('',#map,target) with #map = REPRESENTATION_MAP(origin,representation), as it stands in `parent`.
    pub fn mapped(&self, item: Entity<'a>, parent: u32) -> Result<Placement, Fault> {
        let fields = item.fields("MAPPED_ITEM", 1)?;
        let map = self.entity(fields.reference(0)?)?.all();
        let child = map.reference(1)?;
        let origin = self.placement_matrix(map.reference(0)?, child)?;
        let target = self.placement_matrix(fields.reference(1)?, parent)?;
        let transform = target * invert(origin, item.id())?;
        Ok(Placement { child, transform, name: item.label(), ids: vec![item.id()] })
    }

    /// A placement in the units of its representation.
    fn placement_matrix(&self, id: u32, representation: u32) -> Result<DAffine3, Fault> {
        let units = self.assembly.units_of(representation);
        Geometry { file: self.file, units: &units, ledger: self.ledger }.transform(id)
    }
}

fn invert(transform: DAffine3, id: u32) -> Result<DAffine3, Fault> {
    let inverse = transform.inverse();
    if inverse.is_finite() { Ok(inverse) } else { Err(Fault::Value { id, what: "the placement cannot be inverted" }) }
}
