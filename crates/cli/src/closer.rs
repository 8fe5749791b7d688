//! Views closer to a detail: those of `--zoom`, and the built-in view `close`.
//!
//! ```text
//!   eye ·──────────────· start     start = detail + (eye - target). The closer eye is on the way from start to the
//!         ╲            │           detail, so the direction of the view stays.
//!            ╲         │ closer
//!               ╲      · eye       All three ways must be free: then the detail is seen from the eye and from the
//!                  ╲   │           closer one, which is in a solid only if the eye is.
//!                     ╲● detail
//! ```
//!
//! Details are the starts of trim curves and the vertices, in the order of their depth; of Boolean solids alone, the
//! nearest of LOOKS x LOOKS rays beside which another face is seen. Where no way to a detail is free, the closer eye is
//! on the way from the eye to what it sees in the direction of the nearest one.
//!
//! Ways are exact rays (`selvedge_check`). Of a large model only the faces and triangles are prepared whose boxes a way
//! meets. Faces that are seen through are in the way, too.

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use selvedge::model::{Bounds, Camera, Face, Instance, Mesh, Model, Part, Projection};
use selvedge_check::{Hit, Tracer};

/// Rays along a side of the picture that look for an edge of Boolean solids.
const LOOKS: usize = 48;
/// Details that are tried, the nearest first.
const MOST_TRIED: usize = 256;
/// A hit so near to a detail, in shares of the model's diagonal, is the detail: files state their edges to so many
/// digits.
const AT: f64 = 1e-5;
/// By how much boxes are wider than their contents, in shares of the largest coordinate: more than rounding.
const PAD: f64 = 1e-9;

/// The way of a view towards the nearest detail that is seen.
pub struct Approach {
    whole: Camera,
    aim: Option<Aim>,
}

impl Approach {
    /// Finds the detail.
    pub fn new(model: &Model, whole: Camera) -> Self {
        Self { whole, aim: Sight::new(model).aim(&whole) }
    }

    /// The view `times` closer; the same one of a model that is not seen.
    pub fn closer(&self, times: f64) -> Camera {
        let mut camera = self.whole;
        let Some(Aim { target, back }) = self.aim else { return camera };
        camera.target = target;
        match &mut camera.projection {
            Projection::Orthographic { height } => (camera.eye, *height) = (target + back, *height / times),
            _ => camera.eye = target + back / times,
        }
        camera
    }
}

/// Starts of trim curves and vertices of the placed parts.
pub fn details(model: &Model) -> impl Iterator<Item = DVec3> + '_ {
    model.placed_parts().flat_map(|(instance, part)| {
        let vertices = part.meshes.iter().flat_map(|m| (0..m.triangles().len()).flat_map(|t| m.corners(t)));
        let points = part.faces.iter().flat_map(boundary_points).chain(vertices);
        points.map(|p| instance.transform.transform_point3(p))
    })
}

/// Where the trim curves of a face start, in part coordinates; the corners of its domain if it has none.
fn boundary_points(face: &Face) -> Vec<DVec3> {
    let grid = face.surface.patches();
    let ((u0, u1), (v0, v1)) = face.surface.domain();
    if face.loops.is_empty() {
        return [(u0, v0), (u1, v0), (u0, v1), (u1, v1)].map(|(u, v)| grid.point(u, v)).to_vec();
    }
    let starts = face.loops.iter().flat_map(|l| l.curves().map(|c| c.point(0.0)).collect::<Vec<_>>());
    starts.map(|uv| grid.point(uv.x, uv.y)).collect()
}

/// The details in the picture that are nearest to the eye, by depth.
fn nearest(model: &Model, camera: &Camera) -> Vec<DVec3> {
    let size = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1));
    let forward = camera.axes().2;
    let order = |a: &(f64, usize, DVec3), b: &(f64, usize, DVec3)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    let mut kept: Vec<(f64, usize, DVec3)> = Vec::new();
    for (number, p) in details(model).enumerate() {
        let depth = (p - camera.eye).dot(forward);
        let place = camera.project(p).map(|(place, _)| place);
        if depth > 0.0 && place.is_some_and(|at| at.cmpge(DVec2::ZERO).all() && at.cmple(size).all()) {
            kept.push((depth, number, p));
        }
        if kept.len() == 2 * MOST_TRIED {
            kept.select_nth_unstable_by(MOST_TRIED, order);
            kept.truncate(MOST_TRIED);
        }
    }
    kept.sort_by(order);
    kept.truncate(MOST_TRIED);
    kept.into_iter().map(|(_, _, p)| p).collect()
}

/// The nearest place at which two neighbouring rays over the picture hit different faces, or else the nearest hit of
/// any ray.
fn edge_in_picture(model: &Model, camera: &Camera) -> Option<DVec3> {
    let tracer = Tracer::new(model);
    let step = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1)) / LOOKS as f64;
    let ray = |k: usize| DVec2::new((k % LOOKS) as f64 + 0.5, (k / LOOKS) as f64 + 0.5) * step;
    let mut probe = tracer.probe(camera);
    let hits: Vec<Option<Hit>> = (0..LOOKS * LOOKS).map(|k| probe.first(ray(k))).collect();
    let face = |k: usize| hits.get(k).and_then(|h| h.as_ref()).map(|h| h.face);
    let at_edge = |k: usize| face(k) != face(k + 1) || face(k) != face(k + LOOKS);
    let nearest = |wanted: &dyn Fn(usize) -> bool| {
        let seen = hits.iter().enumerate().filter(|(k, _)| wanted(*k)).filter_map(|(_, h)| h.as_ref());
        seen.min_by(|a, b| a.depth.total_cmp(&b.depth)).map(|h| h.point)
    };
    nearest(&at_edge).or_else(|| nearest(&|_| true))
}

/// The point that a closer view looks at, and the way back from it to the eye of a view as far away as the given one.
#[derive(Clone, Copy)]
struct Aim {
    target: DVec3,
    back: DVec3,
}

/// Boxes of a part, in its coordinates, padded.
struct Boxes {
    /// Of the faces, then of the meshes.
    each: Vec<Bounds>,
    all: Bounds,
}

impl Boxes {
    fn of(part: &Part) -> Self {
        let mut each: Vec<Bounds> = part.faces.par_iter().map(Face::control_bounds).collect();
        each.extend(part.meshes.iter().map(Mesh::bounds));
        let all = each.iter().copied().fold(Bounds::EMPTY, Bounds::union);
        let pad = PAD * all.min.abs().max(all.max.abs()).max_element();
        let padded = |b: Bounds| Bounds { min: b.min - pad, max: b.max + pad };
        Self { each: each.into_iter().map(padded).collect(), all: padded(all) }
    }
}

/// A model, made ready for a few rays.
struct Sight<'a> {
    model: &'a Model,
    boxes: Vec<Boxes>,
    solids: Option<Tracer>,
    /// [`AT`] in model units.
    slack: f64,
}

impl<'a> Sight<'a> {
    fn new(model: &'a Model) -> Self {
        let boxes: Vec<Boxes> = model.parts.par_iter().map(Boxes::of).collect();
        let solids = (!model.solids.is_empty()).then(|| {
            Tracer::new(&Model { solids: model.solids.clone(), coincident: model.coincident, ..Model::default() })
        });
        let placed = model.instances.iter().filter_map(|i| Some((i.transform, boxes.get(i.part)?.all)));
        let corners = placed
            .filter(|(_, all)| !all.is_empty())
            .flat_map(|(transform, all)| all.corners().map(|corner| transform.transform_point3(corner)));
        let bounds = solids.iter().fold(corners.fold(Bounds::EMPTY, Bounds::with), |all, s| all.union(s.bounds()));
        Self { model, boxes, solids, slack: AT * bounds.diagonal() }
    }

    fn aim(&self, camera: &Camera) -> Option<Aim> {
        let mut tried: Vec<DVec3> = Vec::new();
        for detail in nearest(self.model, camera) {
            // neighbouring faces have a detail in common
            if tried.iter().any(|other| other.distance(detail) <= self.slack) {
                continue;
            }
            let aim = self.straight(camera, detail);
            if aim.is_some() {
                return aim;
            }
            tried.push(detail);
        }
        let is_wanted = self.solids.is_some() || tried.is_empty();
        let edge = is_wanted.then(|| edge_in_picture(self.model, camera)).flatten();
        let straight = edge.and_then(|edge| self.straight(camera, edge));
        straight.or_else(|| edge.into_iter().chain(tried).find_map(|detail| self.slanted(camera, detail)))
    }

    /// In the direction of the view, if all three ways are free.
    fn straight(&self, camera: &Camera, detail: DVec3) -> Option<Aim> {
        let back = camera.eye - camera.target;
        let (eye, start) = (ray_start(camera, detail)?, detail + back);
        self.seen(eye, detail)?;
        let target = self.seen(start, detail)?;
        self.first(eye, start).is_none().then_some(Aim { target, back })
    }

    /// To what is seen in the direction of a detail.
    fn slanted(&self, camera: &Camera, detail: DVec3) -> Option<Aim> {
        let eye = ray_start(camera, detail)?;
        let target = self.first(eye, detail).or_else(|| self.seen(eye, detail))?;
        let way = eye - target;
        let length = (camera.eye - camera.target).length().min(way.length());
        (length > 0.0).then(|| Aim { target, back: way.normalize() * length })
    }

    /// The detail, or what is so near before it or behind it that it is the detail, if nothing hides it.
    fn seen(&self, from: DVec3, detail: DVec3) -> Option<DVec3> {
        match self.first(from, detail) {
            Some(point) => (point.distance(detail) <= self.slack).then_some(point),
            // a ray through a corner may pass all faces; what a volume has cut away is not there
            None => self.model.trim.is_none().then_some(detail),
        }
    }

    /// The first point of the model on the way between two points and a little beyond the second.
    fn first(&self, from: DVec3, to: DVec3) -> Option<DVec3> {
        let length = from.distance(to);
        if length == 0.0 {
            return None;
        }
        let (direction, end) = ((to - from) / length, length + self.slack);
        let ray = Camera {
            eye: from,
            target: to,
            up: direction.any_orthonormal_vector(),
            projection: Projection::Perspective { fov_y: 1.0 },
            depth_range: (0.0, end),
            size: (1, 1),
        };
        let middle = DVec2::splat(0.5);
        let met = self.met(from, from + direction * end);
        let of_parts = if met.parts.is_empty() { None } else { Tracer::new(&met).first(&ray, middle) };
        let of_solids = self.solids.as_ref().and_then(|solids| solids.first(&ray, middle));
        let hits = of_parts.into_iter().chain(of_solids);
        hits.min_by(|a, b| a.depth.total_cmp(&b.depth)).map(|hit| hit.point)
    }

    /// The faces and triangles whose boxes the way between two points meets, placed as in the model.
    fn met(&self, from: DVec3, to: DVec3) -> Model {
        let (trim, coincident) = (self.model.trim.clone(), self.model.coincident);
        let mut met = Model { trim, coincident, ..Model::default() };
        for instance in &self.model.instances {
            let to_part = instance.transform.inverse();
            let part = self.model.parts.get(instance.part).zip(self.boxes.get(instance.part));
            let Some((part, boxes)) = part.filter(|_| to_part.is_finite()) else { continue };
            let way = [from, to].map(|p| to_part.transform_point3(p));
            if !meets(way, &boxes.all) {
                continue;
            }
            let (of_faces, of_meshes) = boxes.each.split_at(part.faces.len());
            let faces = part.faces.iter().zip(of_faces).filter(|(_, bounds)| meets(way, bounds));
            let faces: Vec<Face> = faces.map(|(face, _)| face.clone()).collect();
            let meshes = part.meshes.iter().zip(of_meshes).filter(|(_, bounds)| meets(way, bounds));
            let meshes: Vec<Mesh> = meshes.filter_map(|(mesh, _)| triangles(mesh, way)).collect();
            if !(faces.is_empty() && meshes.is_empty()) {
                met.instances.push(Instance { part: met.parts.len(), ..instance.clone() });
                met.parts.push(Part { faces, meshes, ..Part::default() });
            }
        }
        met
    }
}

/// Where the picture's ray through a point begins.
fn ray_start(camera: &Camera, point: DVec3) -> Option<DVec3> {
    camera.project(point).map(|(pixel, _)| camera.ray(pixel).0)
}

/// The triangles of a mesh whose boxes the way meets.
fn triangles(mesh: &Mesh, way: [DVec3; 2]) -> Option<Mesh> {
    let corners = (0..mesh.triangles().len()).map(|t| mesh.corners(t));
    let near = corners.filter(|corners| {
        let bounds = corners.iter().copied().fold(Bounds::EMPTY, Bounds::with);
        let pad = PAD * bounds.min.abs().max(bounds.max.abs()).max_element();
        meets(way, &Bounds { min: bounds.min - pad, max: bounds.max + pad })
    });
    let positions: Vec<DVec3> = near.flatten().collect();
    let each = (0..positions.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    Mesh::new(mesh.id, positions, each, Vec::new()).ok().filter(|mesh| !mesh.triangles().is_empty())
}

/// Whether the way from one point to another meets a box.
fn meets([from, to]: [DVec3; 2], bounds: &Bounds) -> bool {
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for axis in 0..3 {
        let (start, step) = (from[axis], to[axis] - from[axis]);
        let (low, high) = (bounds.min[axis], bounds.max[axis]);
        if step == 0.0 {
            if start < low || start > high {
                return false;
            }
            continue;
        }
        let (a, b) = ((low - start) / step, (high - start) / step);
        (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
    }
    enter <= leave
}

#[cfg(test)]
mod tests;
