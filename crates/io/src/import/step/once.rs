//! How often things are drawn: an occurrence of the product structure once, however often it is mentioned.
//!
//! ```text
//!   NEXT_ASSEMBLY_USAGE_OCCURRENCE       stands where the first of these puts it; the others add no copy
//!     1  CONTEXT_DEPENDENT_SHAPE_REPRESENTATION of the occurrence
//!     2  MAPPED_ITEM in the occurrence's own representation
//!     3  MAPPED_ITEM or relationship with a transformation that puts the child's shape into the parent's
//!     4  nothing: the parent's origin, with a warning
//!
//!   drawn    products that no product holds, with everything below them
//!   then     groups outside of products: only bodies that no product has drawn, a body of two roots once
//! ```
//!
//! The placements of 2 and 3 are *mentions*. One belongs to one occurrence: to one that stands at the same place, else
//! to one that has no place yet, of the same name or the next. A mention without an occurrence is a placement by
//! itself. Representations of presentation (saved views) hold no mention. The tessellated representations of a file
//! whose products have a shape are drawn only as that shape.
//!
//! Source: CAx-IF Recommended Practices for assembly structure, and for model styling and organization.

use super::assembly::{Assembly, Placement, Reader, related};
use super::entity::{Entity, Fault};
use super::product::Occurrence;
use glam::DAffine3;
use std::collections::{BTreeSet, HashMap, HashSet, VecDeque};

/// An occurrence, and where it stands.
struct Use {
    usage: u32,
    name: String,
    /// Groups of the parent and the child.
    groups: (u32, u32),
    /// Parent's representation and placement, once one is found.
    at: Option<(u32, Placement)>,
    /// A mention belongs to it.
    mentioned: bool,
}

/// Placements that may be those of occurrences, by the groups of parent and child.
#[derive(Default)]
struct Mentions {
    all: Vec<Option<(u32, Placement)>>,
    by_groups: HashMap<(u32, u32), VecDeque<usize>>,
}

impl Mentions {
    /// Takes out the first mention in these groups that fits; how many were looked at.
    fn take(&mut self, groups: (u32, u32), fits: impl Fn(&Placement) -> bool) -> (Option<(u32, Placement)>, usize) {
        let Some(list) = self.by_groups.get_mut(&groups) else { return (None, 0) };
        let fit = |i: &usize| self.all[*i].as_ref().is_some_and(|(_, placement)| fits(placement));
        match list.iter().position(fit) {
            Some(at) => (list.remove(at).and_then(|i| self.all[i].take()), at + 1),
            None => (None, list.len()),
        }
    }
}

impl Reader<'_, '_> {
    /// Places every occurrence once.
    pub fn occurrences(&mut self) {
        let (mut uses, tried) = self.stated();
        let stated = uses.len();
        for usage in self.file.of_kind("NEXT_ASSEMBLY_USAGE_OCCURRENCE").collect::<Vec<_>>() {
            if tried.contains(&usage) {
                continue;
            }
            let read = |s: &mut Self| {
                let Occurrence { parent, child, name } = Occurrence::read(s.file, usage)?;
                // a product without any shape has nothing to place
                let groups = s.shape(parent).zip(s.shape(child));
                uses.extend(groups.map(|groups| Use { usage, name, groups, at: None, mentioned: false }));
                Ok(())
            };
            self.guarded("occurrence left out", usage, read);
        }
        let mut mentions = Mentions::default();
        for (parent, placement) in std::mem::take(&mut self.mentions) {
            let groups = (self.assembly.group(parent), self.assembly.group(placement.child));
            mentions.by_groups.entry(groups).or_default().push_back(mentions.all.len());
            mentions.all.push(Some((parent, placement)));
        }
        for found in &mut uses {
            let usage = found.usage;
            self.guarded("mapped item ignored", usage, |s| s.own(found, &mut mentions));
        }
        let name = |u: &Use| u.name.clone();
        self.pair(&mut uses[..stated], &mut mentions, |u| {
            let transform = u.at.as_ref().map(|(_, placement)| placement.transform);
            move |p: &Placement| transform.is_some_and(|t| same_place(t, p.transform))
        });
        self.pair(&mut uses[stated..], &mut mentions, |u| {
            let name = name(u);
            move |p: &Placement| !name.is_empty() && p.name == name
        });
        self.pair(&mut uses[stated..], &mut mentions, |_| |_: &Placement| true);
        self.placements.extend(mentions.all.into_iter().flatten());
        for Use { usage, name, groups: (parent, child), at, .. } in uses {
            let origin = || {
                self.ledger.note("occurrence without placement", usage, "placed at the origin of its parent");
                (parent, Placement { child, transform: DAffine3::IDENTITY, name, ids: vec![usage] })
            };
            let (parent, mut placement) = at.unwrap_or_else(origin);
            // a style may name the occurrence's own representation
            placement.ids.extend(self.products.usages.get(&usage).into_iter().flatten());
            self.placements.push((parent, placement));
        }
    }

    /// Occurrences by CONTEXT_DEPENDENT_SHAPE_REPRESENTATION, and all those that have one, readable or not.
    fn stated(&mut self) -> (Vec<Use>, BTreeSet<u32>) {
        let (mut uses, mut tried) = (Vec::<Use>::new(), BTreeSet::new());
        let mut known: HashMap<u32, usize> = HashMap::new();
        for id in self.file.of_kind("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION").collect::<Vec<_>>() {
            self.guarded("occurrence left out", id, |s| {
                let fields = s.entity(id)?.all();
                let relation = s.entity(fields.reference(0)?)?;
                let usage = s.entity(fields.reference(1)?)?.all().reference(2)?;
                tried.insert(usage);
                let occurrence = Occurrence::read(s.file, usage)?;
                let (child, parent) = s.direction(related(relation)?, &occurrence);
                let transform = s.transformation(relation, child, parent)?;
                let ids = vec![id, relation.id(), usage];
                let placement = Placement { child, transform, name: occurrence.name.clone(), ids };
                if let Some(index) = known.get(&usage) {
                    s.again(&mut uses[*index], (parent, placement));
                    return Ok(());
                }
                known.insert(usage, uses.len());
                let groups = (s.assembly.group(parent), s.assembly.group(child));
                let at = Some((parent, placement));
                uses.push(Use { usage, name: occurrence.name, groups, at, mentioned: false });
                Ok(())
            });
        }
        (uses, tried)
    }

    /// The mapped item of the occurrence's own representation.
    fn own(&mut self, found: &mut Use, mentions: &mut Mentions) -> Result<(), Fault> {
        let representations = self.products.usages.get(&found.usage).cloned().unwrap_or_default();
        for representation in representations {
            let items = super::assembly::representation(self.entity(representation)?).list(1)?;
            for item in items.filter_map(super::part21::Value::reference) {
                self.ledger.spend(item, 1)?;
                let Some(entity) = self.entity(item).ok().filter(|e| e.is("MAPPED_ITEM")) else { continue };
                let (listed, looked) = mentions.take(found.groups, |p| p.ids.contains(&item));
                self.ledger.spend(item, looked)?;
                let mention = match listed {
                    Some(mention) => mention,
                    // the parent's representation does not list it
                    None if found.at.is_none() => (found.groups.0, self.mapped(entity, found.groups.0)?),
                    None => continue,
                };
                found.mentioned = true;
                self.again(found, mention);
            }
        }
        Ok(())
    }

    /// Gives each occurrence at most one mention that fits.
    fn pair<F: Fn(&Placement) -> bool>(&self, uses: &mut [Use], mentions: &mut Mentions, fits: impl Fn(&Use) -> F) {
        for found in uses.iter_mut().filter(|u| !u.mentioned) {
            let (mention, looked) = mentions.take(found.groups, fits(found));
            if let Some(mention) = mention {
                found.mentioned = true;
                self.again(found, mention);
            }
            if let Err(fault) = self.ledger.spend(found.usage, looked) {
                self.ledger.note("mapped item drawn by itself", found.usage, fault.to_string());
                return;
            }
        }
    }

    /// Another place for an occurrence: it counts if it is the first.
    fn again(&self, found: &mut Use, (parent, mut placement): (u32, Placement)) {
        let Some((_, first)) = &mut found.at else {
            placement.ids.push(found.usage);
            placement.name.clone_from(&found.name);
            found.at = Some((parent, placement));
            return;
        };
        if !same_place(first.transform, placement.transform) {
            let where_ = placement.ids.first().copied().unwrap_or(found.usage);
            self.ledger.note("occurrence at a second place", where_, format!("#{} is drawn at its first", found.usage));
        }
        // a style may name either
        first.ids.extend(placement.ids);
    }

    /// The group of a product definition's shape.
    fn shape(&self, definition: u32) -> Option<u32> {
        Some(self.assembly.group(*self.products.shapes.get(&definition)?.first()?))
    }

    /// Groups of parent and child of every occurrence between products of different shape.
    pub fn pairs(&self) -> HashSet<(u32, u32)> {
        let usages = self.file.of_kind("NEXT_ASSEMBLY_USAGE_OCCURRENCE");
        let read = usages.filter_map(|id| Occurrence::read(self.file, id).ok());
        read.filter_map(|o| self.shape(o.parent).zip(self.shape(o.child))).collect()
    }
}

/// Places that no picture distinguishes: axes to 1e-9, origins to that of their own size and 1e-6 mm.
fn same_place(a: DAffine3, b: DAffine3) -> bool {
    let size = a.translation.length().max(b.translation.length());
    a.matrix3.abs_diff_eq(b.matrix3, 1e-9) && (a.translation - b.translation).length() <= 1e-9 * size + 1e-6
}

/// Where the walk begins.
#[derive(Debug, Default)]
pub(super) struct Roots {
    /// Groups of products that no product holds, then all others below products.
    pub products: Vec<u32>,
    /// Groups on which no product depends that nothing places, then all others.
    pub others: Vec<u32>,
}

impl Assembly {
    /// Roots before the groups that they hold: a group that the walk has not reached when its turn comes is part of a
    /// cycle.
    pub fn roots(&self) -> Roots {
        let below = |open: &[u32]| {
            let placements = open.iter().filter_map(|g| self.groups.get(g)).flat_map(|g| &g.placements);
            placements.map(|p| self.group(p.child)).collect::<Vec<u32>>()
        };
        let (mut within, mut held, mut open) = (BTreeSet::new(), BTreeSet::new(), Vec::new());
        open.extend(self.owned.iter().filter(|g| self.groups.contains_key(g)));
        while !open.is_empty() {
            open.retain(|g| within.insert(*g));
            open = below(&open);
            held.extend(open.iter().copied());
        }
        let (held, free): (Vec<u32>, Vec<u32>) = within.iter().copied().partition(|g| held.contains(g));
        let products = free.into_iter().chain(held).collect();
        let beside: Vec<u32> = self.groups.keys().copied().filter(|g| !within.contains(g)).collect();
        let held: BTreeSet<u32> = below(&beside).into_iter().collect();
        let (held, free): (Vec<u32>, Vec<u32>) = beside.into_iter().partition(|g| held.contains(g));
        Roots { products, others: free.into_iter().chain(held).collect() }
    }

    /// Takes out tessellated representations beside products that have a shape; returns how many bodies those list.
    pub fn drop_copies(&mut self, tessellated: impl Fn(u32) -> bool) -> usize {
        let Roots { products, others } = self.roots();
        if !products.iter().any(|g| self.groups.get(g).is_some_and(|group| !group.bodies.is_empty())) {
            return 0;
        }
        let mut count = 0;
        for id in others {
            let Some(group) = self.groups.get_mut(&id) else { continue };
            let before = group.bodies.len();
            group.bodies.retain(|(_, representation)| !tessellated(*representation));
            count += before - group.bodies.len();
        }
        count
    }
}

/// A representation of triangles alone.
pub(super) fn is_tessellated(entity: Entity<'_>) -> bool {
    entity.kinds().any(|k| k.starts_with("TESSELLATED_SHAPE_REPRESENTATION"))
}
