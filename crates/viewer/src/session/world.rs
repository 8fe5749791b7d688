//! All open files as one model.

use super::{Loaded, Picked};
use glam::{DAffine3, DVec3};
use selvedge::model::{Bounds, Edges, Instance, Model, Part, SurfaceKind};
use selvedge::spline::Surface;
use selvedge_geometry::edges::curve::{self, CurveShape};
use selvedge_io::import::Summary;
use std::collections::HashMap;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

/// The place of a file's items in the model.
#[derive(Clone, Debug, PartialEq)]
pub struct FilePart {
    /// The file.
    pub path: PathBuf,
    /// Its name, as the tree has it.
    pub name: String,
    /// Its instances.
    pub instances: Range<usize>,
    /// Its Boolean solids.
    pub solids: Range<usize>,
    /// Its format, as it names it.
    pub format: String,
    /// One line: the drawn and the missing items.
    pub summary: String,
    /// It is being read, and its finished parts are shown.
    pub partial: bool,
    /// Everything of the file is drawn.
    pub complete: bool,
    /// Items that were left out or repaired, a line each.
    pub warnings: Vec<String>,
}

/// One model of all open files.
#[derive(Debug)]
pub struct World {
    /// Parts and instances of all files, one after another.
    pub model: Model,
    /// The files in the order in which they were opened.
    pub files: Vec<FilePart>,
    /// Box of everything drawn.
    pub bounds: Bounds,
    /// Losses when files were put together.
    pub notices: Vec<String>,
    edges: OnceLock<PartEdges>,
    curvature_range: OnceLock<f64>,
    part_bounds: OnceLock<Vec<Bounds>>,
    /// By part and number.
    faces: OnceLock<HashMap<(usize, u32), usize>>,
    planes: OnceLock<Vec<(DVec3, f64)>>,
}

impl Default for World {
    fn default() -> Self {
        Self {
            model: Model::default(),
            files: Vec::new(),
            bounds: Bounds::EMPTY,
            notices: Vec::new(),
            edges: OnceLock::new(),
            curvature_range: OnceLock::new(),
            part_bounds: OnceLock::new(),
            faces: OnceLock::new(),
            planes: OnceLock::new(),
        }
    }
}

/// The plane of a plane surface.
fn plane(surface: &Surface, transform: DAffine3) -> Option<(DVec3, f64)> {
    let ((u0, u1), (v0, v1)) = surface.domain();
    let jet = surface.jet2(0.5 * (u0 + u1), 0.5 * (v0 + v1));
    let normal = transform.transform_vector3(jet.du).cross(transform.transform_vector3(jet.dv)).try_normalize()?;
    Some((normal, normal.dot(transform.transform_point3(jet.point))))
}

/// The centres of a part's round edges. A placement that makes ellipses of circles keeps their centres.
fn centres(edges: &Edges) -> Vec<(usize, DVec3)> {
    let centre = |edge| match curve::shape(edge, DAffine3::IDENTITY) {
        CurveShape::Circle(circle) => Some(circle.centre),
        CurveShape::Line(_) | CurveShape::Other => None,
    };
    edges.edges.iter().enumerate().filter_map(|(nth, edge)| Some((nth, centre(edge)?))).collect()
}

/// Edges of each part; for a part without curves none, and the reason.
#[derive(Debug, Default)]
struct PartEdges {
    parts: Vec<Edges>,
    /// Round edges of each part with their centres, part coordinates.
    centres: Vec<Vec<(usize, DVec3)>>,
    /// The number of each part's first edge, from 1 on, as in the engine; and one more at the end.
    first: Vec<u32>,
}

impl World {
    /// The end of the scale of curvature, found once.
    pub fn curvature_range(&self) -> f64 {
        *self.curvature_range.get_or_init(|| self.model.curvature_range())
    }

    /// The box of a part's control points, in its own coordinates. The boxes of all parts are found once.
    pub fn part_bounds(&self, part: usize) -> Bounds {
        let all = || self.model.parts.iter().map(Part::control_bounds).collect();
        self.part_bounds.get_or_init(all).get(part).copied().unwrap_or(Bounds::EMPTY)
    }

    /// The face of a part that has this number: the first of several. The faces of all parts are listed once.
    pub fn face(&self, part: usize, id: u32) -> Option<usize> {
        let all = || {
            let mut faces = HashMap::new();
            for (part, of_part) in self.model.parts.iter().enumerate() {
                for (nth, face) in of_part.faces.iter().enumerate() {
                    faces.entry((part, face.id)).or_insert(nth);
                }
            }
            faces
        };
        self.faces.get_or_init(all).get(&(part, id)).copied()
    }

    /// The planes of plane faces where instances have them: unit normals, and offsets along them. They are found once.
    pub fn planes(&self) -> &[(DVec3, f64)] {
        self.planes.get_or_init(|| {
            let of_instance = |placed: &Instance| {
                let flat = self.model.parts[placed.part].faces.iter().filter(|face| face.kind == SurfaceKind::Plane);
                flat.filter_map(|face| plane(&face.surface, placed.transform)).collect::<Vec<_>>()
            };
            self.model.instances.iter().flat_map(of_instance).collect()
        })
    }

    /// Puts files together.
    pub fn new(files: &[Arc<Loaded>]) -> Self {
        Self::telling(files, &|| ())
    }

    /// The same; `tell` is called before each part and each further step, and may unwind.
    pub fn telling(files: &[Arc<Loaded>], tell: &(dyn Fn() + Sync)) -> Self {
        let mut world = Self::default();
        for file in files {
            world.add(file, tell);
        }
        tell();
        world.bounds = world.model.bounds();
        tell();
        // here, so that no first pick waits for it
        world.face(0, 0);
        world
    }

    fn add(&mut self, file: &Loaded, tell: &(dyn Fn() + Sync)) {
        let (model, of_file) = (&mut self.model, &file.import.model);
        let (first_part, first_instance) = (model.parts.len(), model.instances.len());
        let first_solid = model.solids.len();
        model.parts.extend(of_file.parts.iter().inspect(|_| tell()).cloned());
        let placed = |i: &Instance| Instance { part: i.part + first_part, ..i.clone() };
        model.instances.extend(of_file.instances.iter().map(placed));
        model.solids.extend(of_file.solids.iter().cloned());
        model.coincident = model.coincident.or(of_file.coincident);
        if first_instance + first_solid == 0 {
            (model.name, model.unit) = (of_file.name.clone(), of_file.unit.clone());
            model.trim = of_file.trim.clone();
        } else if model.trim.is_some() || of_file.trim.is_some() {
            model.trim = None;
            self.notices.push("Several files are open: the volume that cuts one of them is left out.".to_owned());
        }
        let summary = (!file.partial).then(|| file.import.summary());
        let warning = |w: &selvedge_io::import::Warning| {
            let times = if w.count > 1 { format!(" ({} times)", w.count) } else { String::new() };
            match w.place {
                selvedge_io::import::Place::Line(line) => format!("line {line}: {}{times}", w.message),
                selvedge_io::import::Place::Entity { id, line } => format!("#{id}, line {line}: {}{times}", w.message),
                _ => format!("{}{times}", w.message),
            }
        };
        self.files.push(FilePart {
            path: file.path.clone(),
            name: file.path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default(),
            instances: first_instance..self.model.instances.len(),
            solids: first_solid..self.model.solids.len(),
            format: file.import.report.format.clone(),
            partial: file.partial,
            complete: summary.as_ref().is_some_and(Summary::is_complete),
            summary: summary.map_or_else(|| "being read".to_owned(), |summary| summary.to_string()),
            warnings: file.import.warnings.iter().map(warning).collect(),
        });
    }

    /// A file is not read to its end.
    pub fn is_partial(&self) -> bool {
        self.files.iter().any(|file| file.partial)
    }

    /// Nothing is open, or nothing can be drawn.
    pub fn is_empty(&self) -> bool {
        self.model.instances.is_empty() && self.model.solids.is_empty()
    }

    /// How a placed part is called.
    pub fn instance_name(&self, instance: usize) -> String {
        let Some(placed) = self.model.instances.get(instance) else { return String::new() };
        let part = &self.model.parts[placed.part].name;
        match (placed.name.as_str(), part.as_str()) {
            ("", "") => format!("Part {}", instance + 1),
            ("", part) => part.to_owned(),
            (name, _) => name.to_owned(),
        }
    }

    /// Finds the edges of all parts, which takes a while; later calls do nothing.
    pub fn find_edges(&self) {
        self.find_edges_telling(&|| ());
    }

    /// The same; `tell` is called before each part, and may unwind: then no edges are found.
    pub fn find_edges_telling(&self, tell: &(dyn Fn() + Sync)) {
        self.edges.get_or_init(|| {
            let parts: Vec<Edges> = self
                .model
                .parts
                .iter()
                .inspect(|_| tell())
                .map(|part| {
                    part.edges().unwrap_or_else(|error| {
                        tracing::warn!("edges of {}: {error}", part.name);
                        Edges::default()
                    })
                })
                .collect();
            let mut first = vec![1];
            for edges in &parts {
                first.push(first[first.len() - 1] + (edges.edges.len() + edges.of_meshes.len()) as u32);
            }
            let centres = parts.iter().map(centres).collect();
            PartEdges { parts, centres, first }
        });
    }

    /// The edges of a part, once they are found.
    pub fn edges_of(&self, part: usize) -> Option<&Edges> {
        self.edges.get()?.parts.get(part)
    }

    /// Each edge of a part that is a circle or an arc of one, with its centre in part coordinates, once edges are found.
    pub fn centres_of(&self, part: usize) -> &[(usize, DVec3)] {
        self.edges.get().and_then(|edges| edges.centres.get(part)).map(Vec::as_slice).unwrap_or_default()
    }

    /// The picked vertex or point, model coordinates. `None` for another item, and for one that is not there.
    pub fn point_of(&self, picked: &Picked) -> Option<DVec3> {
        let placed = self.model.instances.get(picked.instance()?)?;
        let own = match *picked {
            Picked::Vertex { vertex, .. } => *self.edges_of(placed.part)?.vertices.get(vertex)?,
            Picked::Point { at, .. } => at,
            _ => return None,
        };
        Some(placed.transform.transform_point3(own))
    }

    /// Part and edge of a number in the engine's image of edges; `None` for sides of facets, and before edges are found.
    pub fn edge(&self, number: u32) -> Option<(usize, usize)> {
        let edges = self.edges.get()?;
        let part = edges.first.partition_point(|first| *first <= number).checked_sub(1)?;
        let edge = (number - edges.first[part]) as usize;
        (edge < edges.parts.get(part)?.edges.len()).then_some((part, edge))
    }
}
