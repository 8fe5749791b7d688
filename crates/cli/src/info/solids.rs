//! The parts of a Boolean solid.

use crate::output;
use selvedge::csg::{Blist, Convention};
use selvedge::model::{Shape, Solid};
use serde::Serialize;
use std::collections::BTreeMap;

/// One Boolean solid.
#[derive(Debug, Serialize)]
pub struct SolidRow {
    /// By kind of shape.
    primitives: BTreeMap<&'static str, usize>,
    leaves: usize,
    /// Operations between the root and the deepest leaf.
    depth: u32,
    /// Labels that live at once when the leaves stand in the best order; `None` for a tree too large.
    labels: Option<u32>,
}

impl SolidRow {
    pub fn new(solid: &Solid) -> Self {
        let mut primitives = BTreeMap::new();
        for p in solid.primitives() {
            *primitives.entry(kind(&p.shape)).or_default() += 1;
        }
        let best = solid.tree().positive().map(|t| t.with_fewest_labels(Convention::WhenUsed));
        let labels = best.and_then(|t| Blist::new(&t)).map(|list| list.labels(Convention::WhenUsed).count);
        Self {
            primitives,
            leaves: solid.tree().leaves().count(),
            depth: solid.tree().heights().last().copied().unwrap_or_default(),
            labels: labels.ok(),
        }
    }
}

fn kind(shape: &Shape) -> &'static str {
    match shape {
        Shape::HalfSpace { .. } => "half-space",
        Shape::Block { .. } => "block",
        Shape::Sphere { .. } => "sphere",
        Shape::Cylinder { .. } => "cylinder",
        Shape::Cone { .. } => "cone",
        Shape::Torus { .. } => "torus",
        Shape::Quadric(_) => "quadric",
        Shape::Mesh(_) => "mesh",
        Shape::Part(_) => "part",
    }
}

/// A row for each.
pub fn text(solids: &[SolidRow]) -> String {
    let mut table = output::table(["Boolean solid", "primitives", "leaves", "depth", "labels"]);
    for (i, row) in solids.iter().enumerate() {
        let primitives: Vec<String> = row.primitives.iter().map(|(kind, n)| format!("{n} {kind}")).collect();
        table.add_row([
            i.to_string(),
            primitives.join(", "),
            row.leaves.to_string(),
            row.depth.to_string(),
            row.labels.map_or("unknown".to_string(), |n| n.to_string()),
        ]);
    }
    table.to_string()
}
