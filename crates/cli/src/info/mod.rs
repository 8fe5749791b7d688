//! `selvedge info`: the content of a file, as it was read.
//!
//! ```text
//!   Import ──▶ Info ──┬─▶ JSON            everything
//!                     ├─▶ text            counts, surfaces, assembly, repairs and losses
//!                     └─▶ deep (--deep)   every face; the worst of them apart
//! ```

mod deep;
mod solids;
mod text;
mod tiles;

use crate::args::InfoArgs;
use crate::{Outcome, output, reading, remains};
use anyhow::Result;
use selvedge::model::{Bounds, EdgeCounts, Mesh, Model, Part, SurfaceKind};
use selvedge::picture::{SceneSettings, TrimWay};
use selvedge::renderer::trim_way;
use selvedge_io::import::{FaceRecord, Import, ImportReport, Summary};
use selvedge_jobs::Node;
use serde::Serialize;
use solids::SolidRow;
use std::collections::BTreeMap;
use std::time::Instant;
use tiles::Tiles;

/// Counts of a model; *distinct* unless they are called *instances*, which count placed copies.
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
    /// Counts of edges and vertices of the distinct parts; absent where a face's boundary is no curve.
    edges: Option<EdgeCounts>,
    trim_loops: usize,
    trim_curves: usize,
    meshes: MeshCounts,
    surfaces: Vec<SurfaceRow>,
    boolean_solids: Vec<SolidRow>,
    /// For the view of the arguments, else of the whole model; absent without Boolean solids.
    folded_tiles: Option<Tiles>,
    parts: Vec<PartRow<'a>>,
    assembly: Node<'a>,
    /// Millimetres; absent for an empty model.
    bounds: Option<[[f64; 3]; 2]>,
    /// How its faces are trimmed unless `--trim` says otherwise; absent where no face needs it.
    trim: Option<&'static str>,
    warnings: Vec<String>,
    /// The file's items, how many of them are drawn, and why the rest is not.
    summary: Summary,
    report: &'a ImportReport,
    /// Every face of the file: `deviation` and `gap` in millimetres, why it was repaired or left out.
    face_records: &'a [FaceRecord],
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

/// Meshes and triangles.
#[derive(Debug, Serialize)]
struct MeshCounts {
    distinct: usize,
    instances: usize,
    triangles: usize,
    vertices: usize,
}

/// One body.
#[derive(Debug, Serialize)]
struct PartRow<'a> {
    name: &'a str,
    closed: bool,
    faces: usize,
    meshes: usize,
    instances: usize,
}

/// Reads the model and prints its description.
pub fn run(args: &InfoArgs) -> Result<Outcome> {
    let start = Instant::now();
    let import = reading::described(&args.model, &args.read, &args.subdivide)?;
    let (reading, start) = (start.elapsed(), Instant::now());
    let bounds = import.model.bounds();
    let boxed = start.elapsed();
    let share = boxed.as_secs_f64() / reading.as_secs_f64().max(f64::MIN_POSITIVE);
    tracing::info!("box in {:.1?}, {:.2} % of the time of reading", boxed, 100.0 * share);
    let mut info = Info::new(&import, bounds);
    if !import.model.solids.is_empty() && info.bounds.is_some() {
        info.folded_tiles = Tiles::new(&import.model, &args.camera.of(&import)?);
    }
    if args.json {
        output::print(&serde_json::to_string_pretty(&info)?)?;
    } else {
        output::print(&info.text())?;
        if args.deep {
            output::print(&deep::text(info.face_records))?;
        }
    }
    reading::judge(&args.model, &import, &args.read)?;
    remains::judge(&args.model, &import.model)?;
    Ok(Outcome::Good)
}

impl<'a> Info<'a> {
    fn new(import: &'a Import, bounds: Bounds) -> Self {
        let model = &import.model;
        let faces = || model.parts.iter().flat_map(|p| &p.faces);
        let parts = parts(model);
        let count = |closed: bool| parts.iter().filter(|p| p.closed == closed).count();
        let placed = |closed: bool| parts.iter().filter(|p| p.closed == closed).map(|p| p.instances).sum();
        Self {
            name: &model.name,
            unit: &model.unit,
            solids: count(true),
            solid_instances: placed(true),
            open_shells: count(false),
            open_shell_instances: placed(false),
            faces: model.face_count(),
            face_instances: model.face_instance_count(),
            edges: edges(model),
            trim_loops: faces().map(|f| f.loops.len()).sum(),
            trim_curves: faces().flat_map(|f| &f.loops).map(|l| l.curves().len()).sum(),
            meshes: meshes(model, &parts),
            surfaces: surfaces(model),
            boolean_solids: model.solids.iter().map(SolidRow::new).collect(),
            folded_tiles: None,
            assembly: Node::new(model),
            bounds: (!bounds.is_empty()).then(|| [bounds.min.into(), bounds.max.into()]),
            trim: trim_way(model, SceneSettings::default()).map(TrimWay::name),
            warnings: import.warnings.iter().map(ToString::to_string).collect(),
            summary: import.summary(),
            report: &import.report,
            face_records: &import.report.face_records,
            parts,
        }
    }
}

fn parts<'a>(model: &'a Model) -> Vec<PartRow<'a>> {
    let mut instances = vec![0; model.parts.len()];
    model.instances.iter().for_each(|i| instances[i.part] += 1);
    let row = |(p, instances): (&'a Part, usize)| PartRow {
        name: &p.name,
        closed: p.closed,
        faces: p.faces.len(),
        meshes: p.meshes.len(),
        instances,
    };
    model.parts.iter().zip(instances).map(row).collect()
}

fn edges(model: &Model) -> Option<EdgeCounts> {
    model.parts.iter().try_fold(EdgeCounts::default(), |mut sum, part| {
        sum += part.edges().ok()?.counts();
        Some(sum)
    })
}

fn meshes(model: &Model, parts: &[PartRow<'_>]) -> MeshCounts {
    let all = || model.parts.iter().flat_map(|p| &p.meshes);
    MeshCounts {
        distinct: all().count(),
        instances: parts.iter().map(|p| p.meshes * p.instances).sum(),
        triangles: all().map(Mesh::triangles).map(<[_]>::len).sum(),
        vertices: all().map(Mesh::positions).map(<[_]>::len).sum(),
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
