//! Rays of one view, one thread: the traversal and its working memory.

use super::bvh::Slabs;
use super::leaf::{Meeting, Ray};
use super::solver::Solver;
use super::{Hit, ON, Placed, Tracer};
use crate::model::{Camera, Shape};
use glam::{DVec2, DVec3};
use std::sync::atomic::Ordering;

/// Two hits of one face nearer than this, relative to the model's diagonal, are one: neighbouring
/// leaves both find a root on their common border, and a seam has it at two parameters.
const SAME: f64 = 1e-11;

/// Two hits of one face are also one when nearer than this many times the uncertainty of their places: a tangent point
/// is found in a few neighbouring cells of the solver.
const CLUSTER: f64 = 8.0;

/// Traces many rays of one [`Camera`] through a [`Tracer`] without allocating for each.
#[derive(Debug)]
pub struct Probe<'a> {
    tracer: &'a Tracer,
    camera: &'a Camera,
    forward: DVec3,
    solver: Solver,
    found: Vec<(Hit, f64)>,
    hits: Vec<Hit>,
}

impl<'a> Probe<'a> {
    pub(super) fn new(tracer: &'a Tracer, camera: &'a Camera) -> Self {
        let (_, _, forward) = camera.axes();
        Self { tracer, camera, forward, solver: Solver::default(), found: Vec::new(), hits: Vec::new() }
    }

    /// The view.
    pub fn camera(&self) -> &'a Camera {
        self.camera
    }

    /// Whether the hit is on a Boolean solid, on a face of a spline part that is an operand.
    pub(super) fn on_spline_operand(&self, hit: &Hit) -> bool {
        let solids = self.tracer.solids.iter().filter(|_| hit.part >= self.tracer.parts.len());
        let mut primitives = solids.filter_map(|s| s.union().primitives().get(hit.face_index));
        primitives.any(|p| matches!(p.shape, Shape::Part(_)))
    }

    /// See [`Tracer::hits`].
    pub fn hits(&mut self, pixel: DVec2) -> &[Hit] {
        self.within(pixel, f64::INFINITY)
    }

    /// See [`Tracer::first`].
    pub fn first(&mut self, pixel: DVec2) -> Option<Hit> {
        self.within(pixel, 0.0).first().copied()
    }

    /// The nearest hit and all that are at most `slack` model units of depth behind it, nearest first.
    pub fn within(&mut self, pixel: DVec2, slack: f64) -> &[Hit] {
        let (origin, direction) = self.camera.ray(pixel);
        let cosine = direction.dot(self.forward);
        let (near, far) = self.camera.depth_range;
        let (start, mut end) = (near / cosine, far / cosine);
        let slack = slack / cosine;
        let Self { tracer, camera, forward, solver, found, .. } = self;
        let tracer: &Tracer = tracer;
        found.clear();
        let trim = tracer.trim.as_ref().map(|volume| volume.trace(origin, direction));
        let on = ON * tracer.bounds.diagonal();
        let kept = |t: f64| trim.as_ref().is_none_or(|v| [t - on, t, t + on].iter().any(|t| v.inside(*t)));
        tracer.top.visit(&Slabs::new(origin, direction), (start, end), |item| {
            let placed = &tracer.placed[item as usize];
            let part = &tracer.parts[placed.part];
            let local = (placed.to_part.transform_point3(origin), placed.to_part.transform_vector3(direction));
            let ray = Ray::new(local.0, local.1);
            part.tree.visit(&Slabs::new(local.0, local.1), (start, end), |index| {
                let index = index as usize;
                if let Some(leaf) = part.leaves.get(index) {
                    leaf.meet(&ray, solver, |m| {
                        let face = &part.faces[leaf.face as usize];
                        let in_range = m.t >= start && m.t <= end;
                        if in_range && (leaf.inside || face.loops.contains(m.uv)) && kept(m.t) {
                            let mut hit = placed.hit(&m, camera.eye, *forward);
                            hit.face = face.id;
                            hit.face_index = leaf.face as usize;
                            hit.normal = if face.same_sense { hit.normal } else { -hit.normal };
                            found.push((hit, m.spread));
                            end = end.min(m.t + slack);
                        }
                    });
                } else if let Some((mesh, m)) = part.facets.meet(&ray, index - part.leaves.len())
                    && m.t >= start
                    && m.t <= end
                    && kept(m.t)
                {
                    let mut hit = placed.hit(&m, camera.eye, *forward);
                    hit.face = part.facets.meshes()[mesh].id;
                    hit.face_index = part.faces.len() + mesh;
                    hit.facet = true;
                    found.push((hit, m.spread));
                    end = end.min(m.t + slack);
                }
                end
            });
            end
        });
        let solids = tracer.solids.iter().flat_map(|s| {
            let (layers, opaque) = s.layers(origin, direction, start);
            let shown = layers.into_iter().map(|l| l.boundary).filter(|b| s.primitive(b).colour[3] * 255.0 >= 0.5);
            shown.chain(opaque.boundaries.into_iter().filter(|b| b.entering && b.t >= start)).collect::<Vec<_>>()
        });
        found.extend(solids.filter(|b| b.t <= end).map(|b| {
            let hit = Hit {
                depth: (b.point - camera.eye).dot(*forward),
                face: b.id,
                part: tracer.parts.len(),
                face_index: b.primitive as usize,
                instance: usize::MAX,
                uv: DVec2::NAN,
                point: b.point,
                normal: b.normal,
                facet: true,
                surface: b.surface,
            };
            (hit, 0.0)
        }));
        self.sort_and_merge(slack * cosine);
        &self.hits
    }

    fn sort_and_merge(&mut self, slack: f64) {
        let key = |h: &Hit| (h.instance, h.face_index);
        self.found.sort_by(|(a, _), (b, _)| {
            a.depth.total_cmp(&b.depth).then(key(a).cmp(&key(b))).then(a.uv.x.total_cmp(&b.uv.x))
        });
        self.hits.clear();
        let same = SAME * self.tracer.bounds.diagonal();
        let last = self.found.first().map_or(0.0, |(h, _)| h.depth) + slack;
        let widest = self.found.iter().map(|f| f.1).fold(0.0, f64::max);
        for (i, (hit, spread)) in self.found.iter().enumerate() {
            if hit.depth > last {
                break;
            }
            // found is sorted by depth: only its recent entries can be that near
            let reach = same + CLUSTER * (spread + widest);
            let twin =
                self.found[..i].iter().rev().take_while(|(f, _)| hit.depth - f.depth <= reach).any(|(f, s)| {
                    key(f) == key(hit) && (f.point - hit.point).length() <= same + CLUSTER * (spread + s)
                });
            if !twin {
                self.hits.push(*hit);
            }
        }
    }
}

impl Drop for Probe<'_> {
    fn drop(&mut self) {
        self.tracer.given_up.fetch_add(self.solver.given_up, Ordering::Relaxed);
    }
}

impl Placed {
    /// A meeting in model coordinates; the caller fills in the face.
    fn hit(&self, m: &Meeting, eye: DVec3, forward: DVec3) -> Hit {
        let point = self.to_model.transform_point3(m.point);
        Hit {
            depth: (point - eye).dot(forward),
            face: 0,
            part: self.part,
            face_index: 0,
            instance: self.instance,
            uv: m.uv,
            point,
            normal: (self.normals * m.normal).normalize_or_zero(),
            facet: false,
            surface: None,
        }
    }
}
