//! Products and their names.
//!
//! ```text
//!   SHAPE_DEFINITION_REPRESENTATION ─▶ PRODUCT_DEFINITION_SHAPE ─▶ PRODUCT_DEFINITION
//!     │                                   PRODUCT_DEFINITION_FORMATION ◀─┘
//!     └─▶ SHAPE_REPRESENTATION            └─▶ PRODUCT('id','name',…)
//! ```
//!
//! Source: ISO 10303-41, product definition schema; ISO 10303-44 for occurrences.

use super::entity::{Entity, Fault};
use super::geometry::Ledger;
use super::part21::File;
use std::collections::{BTreeMap, BTreeSet};

/// The product definition of each representation, and its reverse.
#[derive(Debug, Default)]
pub(super) struct Products {
    /// Representations by product definition, in file order.
    pub shapes: BTreeMap<u32, Vec<u32>>,
    /// Product definition of a representation.
    pub owner: BTreeMap<u32, u32>,
    /// Representations of an assembly occurrence, which state only its place.
    pub usages: BTreeMap<u32, Vec<u32>>,
    /// Representations of an occurrence or an aspect (a hole, a datum, a validation property): they repeat solids and
    /// faces of the product's shape.
    pub aspects: BTreeSet<u32>,
}

/// NEXT_ASSEMBLY_USAGE_OCCURRENCE: `child` is used in `parent`.
#[derive(Clone, Debug)]
pub(super) struct Occurrence {
    pub parent: u32,
    pub child: u32,
    pub name: String,
}

impl Products {
    pub fn read(file: &File<'_>, ledger: &Ledger<'_>) -> Self {
        let mut products = Self::default();
        for id in file.of_kind("SHAPE_DEFINITION_REPRESENTATION") {
            if let Err(fault) = products.shape(file, id) {
                ledger.note("product ignored", id, fault.to_string());
            }
        }
        products
    }

    fn shape(&mut self, file: &File<'_>, id: u32) -> Result<(), Fault> {
        let fields = Entity::find(file, id)?.all();
        let property = Entity::find(file, fields.reference(0)?)?;
        let representation = fields.reference(1)?;
        // else the property belongs to an aspect of the product
        let definition = property.all().optional(2).map(|d| Entity::find(file, d)).transpose()?;
        let usage = definition.filter(|d| d.is("NEXT_ASSEMBLY_USAGE_OCCURRENCE")).map(Entity::id);
        if let Some(definition) = definition.filter(|d| d.kinds().any(|k| k.starts_with("PRODUCT_DEFINITION"))) {
            self.shapes.entry(definition.id()).or_default().push(representation);
            self.owner.entry(representation).or_insert(definition.id());
            self.aspects.remove(&representation);
        } else if !self.owner.contains_key(&representation) {
            self.aspects.insert(representation);
        }
        if let Some(usage) = usage {
            self.usages.entry(usage).or_default().push(representation);
        }
        Ok(())
    }

    /// Representations of assembly occurrences.
    pub fn of_usages(file: &File<'_>) -> BTreeSet<u32> {
        let mut products = Self::default();
        let of = |id| products.shape(file, id);
        // faults are reported where products are read
        file.of_kind("SHAPE_DEFINITION_REPRESENTATION").map(of).for_each(|_| ());
        products.usages.into_values().flatten().collect()
    }

    /// Name of the product of a product definition; its number when the name is empty.
    pub fn name(file: &File<'_>, definition: u32) -> Option<String> {
        let formation = Entity::find(file, definition).ok()?.all().optional(2)?;
        let product = Entity::find(file, formation).ok()?.all().optional(2)?;
        let fields = Entity::find(file, product).ok()?.fields("PRODUCT", 0).ok()?;
        let (number, name) = (fields.text(0), fields.text(1));
        Some(if name.trim().is_empty() { number } else { name }).filter(|n| !n.trim().is_empty())
    }
}

impl Occurrence {
    /// Reads `#id`.
    pub fn read(file: &File<'_>, id: u32) -> Result<Self, Fault> {
        let entity = Entity::find(file, id)?;
        let fields = entity.fields("NEXT_ASSEMBLY_USAGE_OCCURRENCE", 0)?;
        let (parent, child) = (fields.reference(3)?, fields.reference(4)?);
        // writers put the occurrence's name into any of these
        let own = [fields.text(1), fields.text(5), fields.text(0)].into_iter().find(|n| !n.trim().is_empty());
        let name = own.or_else(|| Products::name(file, child)).unwrap_or_default();
        Ok(Self { parent, child, name })
    }
}
