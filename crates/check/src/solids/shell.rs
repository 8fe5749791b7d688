//! Closed meshes and spline parts: the intervals of a line inside of them.
//!
//! ```text
//!   mesh   winding number of the triangles crossed: exact signs, a shared edge is crossed once
//!   part   hits of the exact reference: entered at hits that face the line, left at the others
//! ```

use super::{Crossing, Owner};
use crate::bvh::{Bvh, Slabs};
use crate::math::orientation::orientation;
use crate::model::{Bounds, Camera, Instance, Mesh, Model, Projection};
use crate::model::{Primitive, Shape, SurfaceTable};
use crate::{PAD, Tracer};
use glam::{DAffine3, DVec2, DVec3};
use std::sync::Arc;

/// A closed surface made ready for lines.
#[derive(Debug)]
pub(super) enum Shell {
    Mesh { mesh: Arc<Mesh>, tree: Bvh, to_own: DAffine3 },
    Part { tracer: Box<Tracer>, meshes: Vec<Shell> },
}

impl Shell {
    /// `None` for analytic and empty primitives.
    pub fn new(primitive: &Primitive) -> Option<Self> {
        let to_own = primitive.to_own()?;
        match &primitive.shape {
            Shape::Mesh(mesh) => Some(Self::mesh(mesh.clone(), to_own)),
            Shape::Part(part) => {
                let transform = primitive.transform;
                let mut meshes = Vec::new();
                // the faces bound the part, or else its meshes do
                if part.faces.is_empty() {
                    meshes.extend(part.meshes.iter().map(|m| Self::mesh(Arc::new(m.clone()), to_own)));
                }
                let instance = Instance { part: 0, transform, colour: None, name: String::new() };
                // only its faces are needed
                let faces = crate::model::Part { closed: false, ..(**part).clone() };
                let model = Model { parts: vec![faces], instances: vec![instance], ..Model::default() };
                Some(Self::Part { tracer: Box::new(Tracer::new(&model)), meshes })
            }
            _ => None,
        }
    }

    fn mesh(mesh: Arc<Mesh>, to_own: DAffine3) -> Self {
        let boxes: Vec<Bounds> = (0..mesh.triangles().len())
            .map(|t| mesh.corners(t).into_iter().fold(Bounds::EMPTY, Bounds::with))
            .collect();
        let tree = Bvh::new(&boxes, PAD * mesh.bounds().diagonal());
        Self::Mesh { mesh, tree, to_own }
    }

    /// Appends the crossings of the line `o + t d`; returns whether the line is outside at both ends.
    pub fn cross(
        &self,
        primitive: u32,
        table: &SurfaceTable,
        roots: &mut dyn FnMut(u32) -> Option<f64>,
        (o, d): (DVec3, DVec3),
        out: &mut Vec<Crossing>,
    ) -> bool {
        match self {
            Self::Mesh { mesh, tree, to_own } => {
                let line = (to_own.transform_point3(o), to_own.transform_vector3(d));
                let mut hits = Vec::new();
                let all = (f64::NEG_INFINITY, f64::INFINITY);
                tree.visit(&Slabs::new(line.0, line.1), all, |t| {
                    let corners = mesh.corners(t as usize);
                    let turn = winding(corners, line.1, line.0);
                    if turn != 0 {
                        let face = table.faces(primitive).get(t as usize);
                        let exact = face.and_then(|f| roots(f.surface));
                        hits.push((along(corners, line, exact), turn, Owner::Triangle(t)));
                    }
                    f64::INFINITY
                });
                by_winding(primitive, hits, out)
            }
            Self::Part { tracer, meshes } => {
                let mut closed = true;
                if meshes.is_empty() {
                    closed = part(primitive, tracer, (o, d), out);
                }
                for mesh in meshes {
                    closed &= mesh.cross(primitive, table, roots, (o, d), out);
                }
                closed
            }
        }
    }
}

/// +1 when the line leaves through the triangle, -1 when it enters, 0 when it misses it. A line through an
/// edge or a vertex crosses exactly one of the triangles around, or enters and leaves: an edge counts when
/// it passes the line's height, bottom included and top excluded, on the right.
fn winding(corners: [DVec3; 3], d: DVec3, o: DVec3) -> i32 {
    // along the direction's largest axis: the same shear for all triangles, so shared vertices agree
    let a = d.abs();
    let (k, i, j) = if a.x >= a.y && a.x >= a.z {
        (0, 1, 2)
    } else if a.y >= a.z {
        (1, 2, 0)
    } else {
        (2, 0, 1)
    };
    let flat = |p: DVec3| {
        let q = p - o;
        DVec2::new(q[i] - d[i] / d[k] * q[k], q[j] - d[j] / d[k] * q[k])
    };
    let p = corners.map(flat);
    let mut turns = 0;
    for (from, to) in [(p[0], p[1]), (p[1], p[2]), (p[2], p[0])] {
        let up = to.y > from.y;
        let (low, high) = if up { (from, to) } else { (to, from) };
        // always the same way round, so both neighbours of an edge see the same sign
        if low.y <= 0.0 && high.y > 0.0 && orientation(low, high, DVec2::ZERO) > 0.0 {
            turns += if up { 1 } else { -1 };
        }
    }
    // counter-clockwise about the axis: outward normal along it
    if d[k] > 0.0 { turns } else { -turns }
}

/// Parameter of the triangle's plane, within its corners'.
fn along(corners: [DVec3; 3], (o, d): (DVec3, DVec3), exact: Option<f64>) -> f64 {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    let t = exact.unwrap_or_else(|| normal.dot(a - o) / normal.dot(d));
    let reach = corners.map(|p| (p - o).dot(d) / d.length_squared());
    let (low, high) = reach.iter().fold((f64::MAX, f64::MIN), |(l, h), t| (l.min(*t), h.max(*t)));
    // the foot of a corner may lie before or behind the plane, by at most the triangle's own size
    let size = corners.iter().map(|p| p.distance(a)).fold(0.0, f64::max) / d.length();
    if t.is_finite() { t.clamp(low - size, high + size) } else { 0.5 * (low + high) }
}

fn by_winding(primitive: u32, mut hits: Vec<(f64, i32, Owner)>, out: &mut Vec<Crossing>) -> bool {
    hits.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut number = 0;
    let mut rest = &hits[..];
    while let Some(&(t, _, mut owner)) = rest.first() {
        let group = rest.iter().take_while(|h| h.0 == t).count();
        let before = number != 0;
        for (_, turn, which) in &rest[..group] {
            number -= turn;
            // the last that turns the right way
            if (number != 0) != before {
                owner = *which;
            }
        }
        if (number != 0) != before {
            out.push(Crossing { t, primitive, owner });
        }
        rest = &rest[group..];
    }
    number == 0
}

fn part(primitive: u32, tracer: &Tracer, (o, d): (DVec3, DVec3), out: &mut Vec<Crossing>) -> bool {
    let speed = d.length();
    let camera = Camera {
        eye: o,
        target: o + d,
        up: d.any_orthogonal_vector(),
        projection: Projection::Orthographic { height: 1.0 },
        depth_range: (f64::NEG_INFINITY, f64::INFINITY),
        size: (1, 1),
    };
    let mut inside = false;
    for hit in tracer.hits(&camera, DVec2::splat(0.5)) {
        let entering = hit.normal.dot(d) < 0.0;
        // seams answer twice, tangents once: both leave the state as it is
        if entering != inside {
            inside = entering;
            out.push(Crossing { t: hit.depth / speed, primitive, owner: Owner::Normal(hit.normal) });
        }
    }
    !inside
}
