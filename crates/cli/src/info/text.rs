//! The tables of the text output.

use super::{Info, Tiles, solids};
use crate::output;
use std::collections::BTreeMap;

impl Info<'_> {
    /// Everything except the single faces.
    pub fn text(&self) -> String {
        let mut blocks = vec![self.head(), self.counts(), self.surfaces()];
        if !self.boolean_solids.is_empty() {
            blocks.push(solids::text(&self.boolean_solids));
        }
        blocks.extend(self.folded_tiles.as_ref().map(Tiles::text));
        if self.assembly.bodies.len() + self.assembly.children.len() > 0 {
            blocks.push(format!("assembly:\n{}", self.assembly.text()));
        }
        blocks.push(self.found());
        blocks.join("\n")
    }

    fn head(&self) -> String {
        let bounds = self.bounds.map_or("empty".to_string(), |[lo, hi]| {
            let size: [f64; 3] = std::array::from_fn(|i| hi[i] - lo[i]);
            format!("{:.3} x {:.3} x {:.3} mm from {:.3}, {:.3}, {:.3}", size[0], size[1], size[2], lo[0], lo[1], lo[2])
        });
        let report = self.report;
        let mut lines = vec![format!("{}; source unit {}; box {bounds}", self.name, self.unit)];
        let writer = if report.written_by.is_empty() { String::new() } else { format!(", by {}", report.written_by) };
        lines.push(format!("{}{writer}", report.format));
        lines.extend(self.trim.map(|way| format!("trimmed by the way `{way}`")));
        lines.join("\n")
    }

    fn counts(&self) -> String {
        let mut table = output::table(["", "distinct", "placed"]);
        let mut row = |what: &str, distinct: usize, placed: Option<usize>| {
            table.add_row([what.to_string(), distinct.to_string(), placed.map_or(String::new(), |n| n.to_string())]);
        };
        row("solids", self.solids, Some(self.solid_instances));
        row("open shells", self.open_shells, Some(self.open_shell_instances));
        row("faces", self.faces, Some(self.face_instances));
        row("edges, stated", self.report.edges, None);
        if let Some(found) = &self.edges {
            row("sharp edges", found.sharp, None);
            row("smooth edges", found.smooth, None);
            row("seams", found.seams, None);
            row("free borders", found.borders, None);
            row("vertices", found.vertices, None);
        }
        row("trim loops", self.trim_loops, None);
        row("trim curves, derived", self.trim_curves, None);
        row("p-curves, given", self.report.pcurves, None);
        if self.meshes.distinct > 0 {
            row("meshes", self.meshes.distinct, Some(self.meshes.instances));
            row("triangles", self.meshes.triangles, None);
            let found = self.edges.unwrap_or_default();
            row("creases", found.mesh_creases, None);
            row("free borders of meshes", found.mesh_borders, None);
        }
        table.to_string()
    }

    fn surfaces(&self) -> String {
        let mut table = output::table(["surface", "degree", "rational", "faces", "patches"]);
        for row in &self.surfaces {
            let [u, v] = row.degree;
            table.add_row([
                format!("{:?}", row.kind),
                format!("{u} x {v}"),
                if row.rational { "yes" } else { "no" }.into(),
                row.faces.to_string(),
                row.patches.to_string(),
            ]);
        }
        table.to_string()
    }

    /// Accuracy, repairs and losses of reading the file.
    fn found(&self) -> String {
        let report = self.report;
        let mut lines = Vec::new();
        if self.edges.is_none() {
            lines.push("edges: not counted, for the boundary of a face is no curve".to_owned());
        }
        if report.edges > 0 || report.deviation > 0.0 {
            lines.push(format!("trim curves: largest deviation {:.3e} mm from their edges", report.deviation));
        }
        if report.edges > 0 || report.gap > 0.0 {
            lines.push(format!(
                "edges: largest gap {:.3e} mm off their surfaces; {} faces beyond the file's tolerance",
                report.gap, report.sloppy
            ));
        }
        if report.made > 0.0 {
            lines.push(format!("surfaces made: largest distance {:.3e} mm from what they stand for", report.made));
        }
        if report.irregular > 0 {
            lines.push(format!("subdivision: {} irregular vertices", report.irregular));
        }
        let mut list = |what: &str, counts: Vec<(String, usize)>| {
            if !counts.is_empty() {
                let total: usize = counts.iter().map(|(_, n)| n).sum();
                lines.push(format!("{what}: {total}"));
                lines.extend(counts.iter().map(|(name, n)| format!("  {n} x {name}")));
            }
        };
        let named = |counts: &BTreeMap<String, usize>| counts.iter().map(|(name, n)| (name.clone(), *n)).collect();
        list("faces left out", report.dropped.iter().collect());
        for (kind, reasons) in &report.left_out {
            list(kind, reasons.iter().collect());
        }
        list("repaired", report.repaired.iter().collect());
        list("not drawn", named(&report.ignored));
        list("layers, items on them", named(&report.layers));
        list("warnings", named(&report.warnings));
        if !report.external_files.is_empty() {
            lines.push(format!("other files named: {}", report.external_files.join(", ")));
        }
        if !report.missing_files.is_empty() {
            lines.push(format!("other files not read: {}", report.missing_files.join(", ")));
        }
        lines.join("\n")
    }
}
