//! A model's solids, the transparent ones separated: the objects that a ray passes through.
//!
//! ```text
//!   model.solids: (glass block + gear) , nut        closed parts, one of glass
//!        │ operands of unions at the root                │
//!        ├─ opaque ───▶ one solid: gear, nut             ├─ opaque ──▶ drawn as faces
//!        └─ clear  ───▶ one solid a colour: glass block  └─ clear  ──▶ one solid each
//! ```
//!
//! Clear solids are separate objects: each keeps its own surface inside another clear solid, and around an opaque one.

use super::solid::Operands;
use super::{Colour, Instance, Model, Part, Primitive, Shape, Solid, SolidError};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A model's solids, in the order of the list of surfaces along a ray.
#[derive(Clone, Debug, Default)]
pub struct Items {
    /// The opaque solids; the picture shows their union.
    pub opaque: Vec<Solid>,
    /// Opaque closed parts, as solids; empty unless the caller wants all items. Their faces are drawn in any case.
    pub parts: Vec<Solid>,
    /// The transparent solids, closed parts among them.
    pub clear: Vec<Solid>,
    /// For each instance of the model: drawn as faces, not as a transparent solid.
    pub drawn: Vec<bool>,
    /// Transparent instances that are not closed: they have no inside, and are drawn opaque.
    pub open: usize,
}

/// Opacity as it is stored, in 255ths.
fn is_opaque(colour: Colour) -> bool {
    colour[3].clamp(0.0, 1.0) * 255.0 >= 254.5
}

impl Primitive {
    /// Whether no face of it is transparent: opacities within half a 255th of 1 are 1.
    pub fn is_opaque(&self) -> bool {
        match &self.shape {
            Shape::Part(part) => part.colours().all(|c| is_opaque(c.unwrap_or(self.colour))),
            _ => is_opaque(self.colour),
        }
    }
}

impl Part {
    /// The colours of its faces, and of its meshes where they bound it.
    fn colours(&self) -> impl Iterator<Item = Option<Colour>> {
        let meshes = if self.faces.is_empty() { &self.meshes[..] } else { &[] };
        self.faces.iter().map(|f| f.colour).chain(meshes.iter().map(|m| m.colour))
    }
}

impl Solid {
    /// Whether no primitive that its expression names is transparent.
    pub fn is_opaque(&self) -> bool {
        self.tree().leaves().all(|p| self.primitives()[p as usize].is_opaque())
    }

    /// The solid split by transparency: operands of unions at the root that are opaque make the first solid together,
    /// clear ones of one colour one each, other operands one each. Their union is the solid.
    fn apart(&self) -> Result<Vec<Self>, SolidError> {
        let operands = Operands::of(self);
        let mut groups: Vec<(bool, Vec<u32>)> = vec![(true, Vec::new())];
        let mut by_colour: BTreeMap<[u32; 4], usize> = BTreeMap::new();
        for &root in operands.roots() {
            let primitives: Vec<&Primitive> = operands.primitives(root).collect();
            if primitives.iter().all(|p| p.is_opaque()) {
                groups[0].1.push(root);
                continue;
            }
            let bits = |p: &Primitive| p.colour.map(f32::to_bits);
            let first = bits(primitives[0]);
            let same = primitives.iter().all(|p| bits(p) == first && !matches!(p.shape, Shape::Part(_)));
            let next = groups.len();
            match same.then(|| *by_colour.entry(first).or_insert(next)) {
                Some(group) if group < next => groups[group].1.push(root),
                _ => groups.push((false, vec![root])),
            }
        }
        groups.iter().filter(|(_, roots)| !roots.is_empty()).map(|(_, roots)| operands.union(roots)).collect()
    }
}

impl Instance {
    /// Whether no face of the placed part is transparent.
    pub fn is_opaque(&self, part: &Part) -> bool {
        match self.colour {
            Some(colour) => is_opaque(colour),
            None => part.colours().flatten().all(is_opaque),
        }
    }
}

impl Model {
    /// Whether anything is transparent, or would be if it were closed.
    pub fn is_opaque(&self) -> bool {
        self.solids.iter().all(Solid::is_opaque) && self.placed_parts().all(|(instance, part)| instance.is_opaque(part))
    }

    /// The model's solids, transparent ones separated; `all`: opaque closed parts too. In a model that a volume trims,
    /// a part has no inside.
    ///
    /// # Errors
    /// [`SolidError`] when an expression becomes too large.
    pub fn items(&self, all: bool) -> Result<Items, SolidError> {
        let mut items = Items { drawn: vec![true; self.instances.len()], ..Items::default() };
        for solid in &self.solids {
            if solid.is_opaque() {
                items.opaque.push(solid.clone());
                continue;
            }
            for item in solid.apart()? {
                if item.is_opaque() { &mut items.opaque } else { &mut items.clear }.push(item);
            }
        }
        let mut shared: Vec<Option<Arc<Part>>> = vec![None; self.parts.len()];
        for (instance, drawn) in self.instances.iter().zip(&mut items.drawn) {
            let Some(part) = self.parts.get(instance.part) else { continue };
            let (opaque, closed) = (instance.is_opaque(part), part.closed && self.trim.is_none());
            items.open += usize::from(!opaque && !closed);
            if !closed || opaque && !all || part.control_bounds().is_empty() {
                continue;
            }
            let part = shared[instance.part].get_or_insert_with(|| Arc::new(part.clone()));
            let solid = Solid::of(instance.operand(part))?;
            *drawn = opaque;
            if opaque { &mut items.parts } else { &mut items.clear }.push(solid);
        }
        Ok(items)
    }
}
