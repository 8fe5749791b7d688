//! Layers, hidden entities and annotation: a file's statements on how its items are shown.
//!
//! ```text
//!   PRESENTATION_LAYER_ASSIGNMENT('name','',(items))      an item is a styled item, a representation, or
//!                                                         the geometry itself
//!   INVISIBILITY((items))                                 an item is a styled item, a layer, or a
//!                                                         representation: everything on it is hidden; one with a
//!                                                         style for an occurrence: hidden in that alone
//! ```
//!
//! Hidden bodies, shells, faces and placements are not drawn, and counted. Dimensions, tolerances and
//! notes are counted.
//!
//! Source: ISO 10303-46, 4.4 and 4.5; CAx-IF Recommended Practices for Model Styling and Organization.

use super::colour;
use super::entity::{Entity, Fault, Fields};
use super::geometry::Ledger;
use super::part21::File;
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// The items that a file hides, and its layers.
#[derive(Debug, Default)]
pub(super) struct Presentation {
    hidden: HashSet<u32>,
    /// Items that one occurrence hides, behind the occurrence's representation.
    in_occurrence: HashSet<(u32, u32)>,
    /// Number of items on each layer, by its name.
    pub layers: BTreeMap<String, usize>,
}

const LAYER: &str = "PRESENTATION_LAYER_ASSIGNMENT";

impl Presentation {
    /// Reads layers and invisibilities; counts annotation.
    pub fn read(file: &File<'_>, ledger: &Ledger<'_>) -> Self {
        let mut this = Self::default();
        for id in file.of_kind(LAYER) {
            match layer(file, id) {
                Ok((name, items)) => *this.layers.entry(name).or_default() += items.len(),
                Err(fault) => ledger.note("layer ignored", id, fault.to_string()),
            }
        }
        let usages = colour::usages(file);
        for kind in ["INVISIBILITY", "CONTEXT_DEPENDENT_INVISIBILITY"] {
            for id in file.of_kind(kind) {
                if let Err(fault) = this.hide(file, ledger, &usages, id) {
                    ledger.note("invisibility ignored", id, fault.to_string());
                }
            }
        }
        let annotation = |kind: &&str| {
            let note = kind.contains("ANNOTATION") && kind.ends_with("OCCURRENCE");
            note || ["DRAUGHTING_CALLOUT", "DIMENSIONAL_SIZE", "DIMENSIONAL_LOCATION", "GEOMETRIC_TOLERANCE"]
                .contains(kind)
        };
        for kind in file.kinds().filter(annotation) {
            ledger.ignore(kind, file.of_kind(kind).len());
        }
        this
    }

    /// The item is hidden.
    pub fn hides(&self, id: u32) -> bool {
        self.hidden.contains(&id)
    }

    /// The occurrence that a path leads to hides its body: `items` are the body and the list that holds it.
    pub fn hides_in(&self, path: &[u32], items: [u32; 2]) -> bool {
        let hidden = |id: &u32| items.iter().any(|item| self.in_occurrence.contains(&(*id, *item)));
        !self.in_occurrence.is_empty() && path.iter().any(hidden)
    }

    fn hide(&mut self, file: &File<'_>, ledger: &Ledger<'_>, usages: &BTreeSet<u32>, id: u32) -> Result<(), Fault> {
        let entity = Entity::find(file, id)?;
        let fields = entity.fields("INVISIBILITY", 0).unwrap_or_else(|_| entity.all());
        for item in fields.references(0)? {
            let item = item?;
            let found = Entity::find(file, item)?;
            if found.is("CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM") {
                ledger.note("hidden in one occurrence", item, "drawn all the same");
            } else if found.is(LAYER) {
                let (_, items) = layer(file, item)?;
                self.hidden.extend(items.into_iter().map(|i| shown(file, i)));
            } else {
                let shown = shown(file, item);
                match styled(found).and_then(|fields| colour::occurrence(file, fields, usages)) {
                    Some(usage) => _ = self.in_occurrence.insert((usage, shown)),
                    None => _ = self.hidden.insert(shown),
                }
            }
        }
        Ok(())
    }
}

/// Name and items of a layer.
fn layer(file: &File<'_>, id: u32) -> Result<(String, Vec<u32>), Fault> {
    let fields = Entity::find(file, id)?.fields(LAYER, 0)?;
    let items = fields.references(2)?.collect::<Result<_, _>>()?;
    Ok((fields.text(0), items))
}

/// The fields behind the name of a styled item.
fn styled(entity: Entity<'_>) -> Option<Fields<'_>> {
    let own = entity.fields("STYLED_ITEM", 1).ok();
    own.or_else(|| entity.fields("OVER_RIDING_STYLED_ITEM", 1).ok())
}

/// The item that a styled item styles; other items are returned themselves.
fn shown(file: &File<'_>, id: u32) -> u32 {
    Entity::find(file, id).ok().and_then(styled).and_then(|fields| fields.optional(1)).unwrap_or(id)
}
