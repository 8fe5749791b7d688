//! `selvedge info`: what a file holds, as the engine read it.

use crate::args::InfoArgs;
use crate::{Outcome, output, session};
use anyhow::Result;
use selvedge::csg::{Blist, Convention};
use selvedge::import::{Import, ImportReport};
use selvedge::model::{Model, Part, Shape, Solid, SurfaceKind};
use serde::Serialize;
use std::collections::BTreeMap;

/// Counts of a model; *distinct* where nothing else is said, *instances* counts placed copies.
#[derive(Debug, Serialize)]
struct Info<'a> {
    name: &'a str,
    unit: &'a str,
    solids: usize,
    solid_instances: usize,
    open_shells: usize,
    open_shell_instances: usize,
    faces: usize,
    face_instances: usize,
    trim_loops: usize,
    trim_curves: usize,
    meshes: usize,
    mesh_instances: usize,
    triangles: usize,
    triangle_instances: usize,
    surfaces: Vec<SurfaceRow>,
    boolean_solids: Vec<SolidRow>,
    /// Millimetres; absent for an empty model.
    bounds: Option<[[f64; 3]; 2]>,
    warnings: Vec<String>,
    report: &'a ImportReport,
}

/// Surfaces of one kind.
#[derive(Debug, Serialize)]
struct SurfaceRow {
    kind: SurfaceKind,
    degree: [usize; 2],
    rational: bool,
    faces: usize,
    patches: usize,
}

/// One Boolean solid.
#[derive(Debug, Serialize)]
struct SolidRow {
    /// By kind of shape.
    primitives: BTreeMap<&'static str, usize>,
    leaves: usize,
    /// Operations between the root and the deepest leaf.
    depth: u32,
    /// Labels that live at once when the leaves stand in the best order.
    labels: Option<u32>,
}

/// Reads the model and prints what it holds.
pub fn run(args: &InfoArgs) -> Result<Outcome> {
    let import = session::open(&args.model)?;
    let info = Info::new(&import);
    output::print(&if args.json { serde_json::to_string_pretty(&info)? } else { info.text()? })?;
    Ok(Outcome::Good)
}

impl<'a> Info<'a> {
    fn new(import: &'a Import) -> Self {
        let model = &import.model;
        let faces = || model.parts.iter().flat_map(|p| &p.faces);
        let parts = |closed: bool| model.parts.iter().filter(|p| p.closed == closed).count();
        let placed = |closed: bool| model.instances.iter().filter(|i| model.parts[i.part].closed == closed).count();
        let bounds = model.bounds();
        let triangles = |p: &Part| p.meshes.iter().map(|m| m.triangles().len()).sum::<usize>();
        let placed_parts = || model.instances.iter().map(|i| &model.parts[i.part]);
        Self {
            name: &model.name,
            unit: &model.unit,
            solids: parts(true),
            solid_instances: placed(true),
            open_shells: parts(false),
            open_shell_instances: placed(false),
            faces: model.face_count(),
            face_instances: model.face_instance_count(),
            trim_loops: faces().map(|f| f.loops.len()).sum(),
            trim_curves: faces().flat_map(|f| &f.loops).map(|l| l.curves().len()).sum(),
            meshes: model.parts.iter().map(|p| p.meshes.len()).sum(),
            mesh_instances: placed_parts().map(|p| p.meshes.len()).sum(),
            triangles: model.parts.iter().map(triangles).sum(),
            triangle_instances: placed_parts().map(triangles).sum(),
            surfaces: surfaces(model),
            boolean_solids: model.solids.iter().map(SolidRow::new).collect(),
            bounds: (!bounds.is_empty()).then(|| [bounds.min.into(), bounds.max.into()]),
            warnings: import.warnings.iter().map(ToString::to_string).collect(),
            report: &import.report,
        }
    }

    fn text(&self) -> Result<String> {
        let mut counts = output::table(["", "distinct", "placed"]);
        counts.add_row(["solids".to_string(), self.solids.to_string(), self.solid_instances.to_string()]);
        counts.add_row([
            "open shells".to_string(),
            self.open_shells.to_string(),
            self.open_shell_instances.to_string(),
        ]);
        counts.add_row(["faces".to_string(), self.faces.to_string(), self.face_instances.to_string()]);
        counts.add_row(["trim loops".to_string(), self.trim_loops.to_string(), String::new()]);
        counts.add_row(["trim curves".to_string(), self.trim_curves.to_string(), String::new()]);
        counts.add_row(["meshes".to_string(), self.meshes.to_string(), self.mesh_instances.to_string()]);
        counts.add_row(["triangles".to_string(), self.triangles.to_string(), self.triangle_instances.to_string()]);

        let mut surfaces = output::table(["surface", "degree", "rational", "faces", "patches"]);
        for row in &self.surfaces {
            let [u, v] = row.degree;
            surfaces.add_row([
                format!("{:?}", row.kind),
                format!("{u} x {v}"),
                if row.rational { "yes" } else { "no" }.into(),
                row.faces.to_string(),
                row.patches.to_string(),
            ]);
        }

        let mut solids = output::table(["Boolean solid", "primitives", "leaves", "depth", "labels"]);
        for (i, row) in self.boolean_solids.iter().enumerate() {
            let primitives: Vec<String> = row.primitives.iter().map(|(kind, n)| format!("{n} {kind}")).collect();
            solids.add_row([
                i.to_string(),
                primitives.join(", "),
                row.leaves.to_string(),
                row.depth.to_string(),
                row.labels.map_or("unknown".to_string(), |n| n.to_string()),
            ]);
        }

        let bounds = self.bounds.map_or("empty".to_string(), |[lo, hi]| {
            let size: [f64; 3] = std::array::from_fn(|i| hi[i] - lo[i]);
            format!("{:.3} x {:.3} x {:.3} mm from {:.3}, {:.3}, {:.3}", size[0], size[1], size[2], lo[0], lo[1], lo[2])
        });
        let mut lines = vec![format!("{}; source unit {}; box {bounds}", self.name, self.unit)];
        lines.push(format!("{counts}\n{surfaces}"));
        if !self.boolean_solids.is_empty() {
            lines.push(solids.to_string());
        }
        lines.push(format!("import report: {}", serde_json::to_string_pretty(self.report)?));
        Ok(lines.join("\n"))
    }
}

impl SolidRow {
    fn new(solid: &Solid) -> Self {
        let mut primitives = BTreeMap::new();
        for p in solid.primitives() {
            let kind = match p.shape {
                Shape::HalfSpace { .. } => "half-space",
                Shape::Block { .. } => "block",
                Shape::Sphere { .. } => "sphere",
                Shape::Cylinder { .. } => "cylinder",
                Shape::Cone { .. } => "cone",
                Shape::Torus { .. } => "torus",
                Shape::Quadric(_) => "quadric",
                Shape::Mesh(_) => "mesh",
                Shape::Part(_) => "part",
            };
            *primitives.entry(kind).or_default() += 1;
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

fn surfaces(model: &Model) -> Vec<SurfaceRow> {
    let mut rows: BTreeMap<_, SurfaceRow> = BTreeMap::new();
    for face in model.parts.iter().flat_map(|p| &p.faces) {
        let (u, v) = face.surface.degrees();
        let (degree, rational) = ([u, v], !face.surface.is_polynomial());
        let row = rows.entry((face.kind, degree, rational)).or_insert(SurfaceRow {
            kind: face.kind,
            degree,
            rational,
            faces: 0,
            patches: 0,
        });
        row.faces += 1;
        row.patches += face.surface.patches().patches.len();
    }
    rows.into_values().collect()
}
