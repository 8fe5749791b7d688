//! The meaning of a pixel of the visibility images, as a point of the model in `f64`.
//!
//! ```text
//!   word, (u, v) of a triangle  ─▶ patch ─▶ face of an instance ──Newton in f64──▶ exact point under the pixel's centre
//!   word, triangle of a mesh    ─▶ mesh of an instance         ──plane──────────▶
//!   word, depth of a solid      ─▶ primitive                   ──ray────────────▶
//! ```
//!
//! Cost: a binary search in the scene's placed faces, and one surface point a step of Newton's method.

use super::data::SceneData;
use super::deep_zoom::KnownEdges;
use crate::abi;
use crate::abi::constants::visible::{GAP_CANDIDATE, SEEN_KIND, SEEN_MESH, SEEN_OPERAND, SEEN_SOLID};
use crate::edges::nearest::nearest;
use crate::model::{Camera, Face, Mesh, Model};
use crate::picture::EdgeSettings;
use glam::{DAffine3, DMat4, DVec2, DVec3, Vec4Swizzles};

/// Most steps of Newton's method. Each doubles the number of correct digits, from a start within about a pixel.
const MOST_STEPS: usize = 32;
/// Length of the last step, in pixels.
const THERE_PX: f64 = 1e-9;
/// Longest step, as a share of the domain.
const LONGEST_STEP: f64 = 0.25;

/// Least cosine between ray and normal. Between adjacent pixels, depth changes by up to one over the cosine; this is a
/// bound.
const LEAST_COSINE: f64 = 0.05;

/// What a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Hit {
    /// Index into [`Model::instances`](crate::model::Model::instances); `None` for Boolean solids.
    pub instance: Option<usize>,
    /// Index into [`Model::parts`](crate::model::Model::parts); `None` for Boolean solids.
    pub part: Option<usize>,
    /// Index into [`Part::faces`](crate::model::Part::faces); `None` for meshes and Boolean solids.
    pub face: Option<usize>,
    /// Index into [`Part::meshes`](crate::model::Part::meshes), and the triangle.
    pub triangle: Option<(usize, usize)>,
    /// Its number in the image of faces: [`Face::id`](crate::model::Face::id), [`Mesh::id`](crate::model::Mesh::id) or
    /// [`Primitive::id`](crate::model::Primitive::id).
    pub id: u32,
    /// Parameters in the face's domain; for a triangle, the weights of its second and third corner; `None` for Boolean
    /// solids.
    pub uv: Option<DVec2>,
    /// The point, in model coordinates.
    pub point: DVec3,
    /// The edge of the face whose line covers the pixel, in scenes with
    /// [`edges`](crate::picture::SceneSettings::edges): an index into [`Edges::edges`](crate::model::Edges::edges) of
    /// the part. `None` if there is none, and on meshes.
    pub edge: Option<usize>,
    /// Unit outward normal of the face or the triangle, in model coordinates; `None` for Boolean solids, and at points
    /// without a normal.
    pub normal: Option<DVec3>,
    /// Distance from the eye along the view axis, model units.
    pub depth: f64,
}

/// The meaning of the scene's numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Picking {
    /// First patch instance of each placed face, its face and its instance in the scene.
    placed: Vec<[u32; 3]>,
    faces: Vec<PickFace>,
    /// Rectangle of each patch in the unit square of its face.
    patches: Vec<[f32; 4]>,
    /// The model's instance, plus 1, of each instance of the scene.
    sources: Vec<u32>,
    /// Number in its part, and first triangle, of each mesh that belongs to a part.
    meshes: Vec<[u32; 2]>,
    /// Mesh and instance of each mesh instance.
    mesh_instances: Vec<[u32; 2]>,
    /// Solids that are drawn as meshes, and their first triangles; these meshes come last.
    isolated: Vec<(Mesh, u32)>,
    /// Number of the primitive of each side, then of each triangle of operands.
    sides: Vec<u32>,
    /// The edges of the model's parts and their settings, in scenes with lines.
    edges: Option<(KnownEdges, EdgeSettings)>,
}

/// A face of the scene.
#[derive(Clone, Copy, Debug, Default)]
struct PickFace {
    /// The face of the model; `None` for faces of operands.
    face: Option<u32>,
    first_patch: u32,
    id: u32,
    /// Origin and size of the uploaded surface's domain.
    domain: [f64; 4],
}

impl SceneData {
    /// The meaning of the scene's numbers. Faces are those of `shown`; `face_of` returns the model's face for a part of
    /// `shown` and a face of it.
    pub(crate) fn picking(&self, shown: &Model, face_of: impl Fn(usize, usize) -> usize) -> Picking {
        let mut faces = vec![PickFace::default(); self.faces.len()];
        for (made, face) in faces.iter_mut().zip(&self.faces) {
            (made.first_patch, made.id) = (face.first_patch, face.id);
        }
        let of_operands = |face: &abi::Face| face.flags & abi::FACE_OPERAND != 0;
        let end = self.faces.iter().position(of_operands).unwrap_or(self.faces.len());
        let ends = self.parts.iter().skip(1).map(|(_, first)| *first).chain([end]);
        for (part, (&(_, first), end)) in self.parts.iter().zip(ends).enumerate() {
            if end - first != shown.parts[part].faces.len() {
                continue; // the part is not placed
            }
            for (nth, face) in shown.parts[part].faces.iter().enumerate() {
                let ((u0, u1), (v0, v1)) = face.surface.domain();
                let made = &mut faces[first + nth];
                (made.face, made.domain) = (Some(face_of(part, nth) as u32), [u0, v0, u1 - u0, v1 - v0]);
            }
        }
        let first_triangles = self.meshes.meshes.iter().map(|mesh| mesh.first_triangle);
        let isolated = self.isolated.iter().cloned().zip(first_triangles.clone().skip(self.meshes.numbers.len()));
        let s = &self.solids;
        let of_leaf = |leaf: u32| s.leaves[leaf as usize].id;
        let of_meshes = s.operand_meshes.iter().zip(&s.operand_draws);
        let triangles =
            of_meshes.flat_map(|(mesh, corners)| std::iter::repeat_n(of_leaf(mesh.leaf), corners.len() / 3));
        Picking {
            placed: self.face_instances.iter().map(|f| [f.first_patch_instance, f.face, f.instance]).collect(),
            faces,
            patches: self.patches.iter().map(|patch| patch.domain).collect(),
            sources: self.sources.iter().map(|source| source[1]).collect(),
            meshes: self.meshes.numbers.iter().zip(first_triangles).map(|(nth, first)| [*nth, first]).collect(),
            mesh_instances: self.meshes.instances.iter().map(|m| [m.mesh, m.instance]).collect(),
            isolated: isolated.collect(),
            edges: self.edges.as_ref().map(|edges| (edges.found.clone(), edges.settings)),
            sides: s.leaf_surfaces.iter().map(|side| of_leaf(side.leaf)).chain(triangles).collect(),
        }
    }
}

impl Picking {
    /// A model joins the scene: `new` has what its arrays stand for, whose numbers count on from the scene's.
    pub(crate) fn join(&mut self, new: Self) {
        self.placed.extend(new.placed);
        self.faces.extend(new.faces);
        self.patches.extend(new.patches);
        self.sources.extend(new.sources);
        self.meshes.extend(new.meshes);
        self.mesh_instances.extend(new.mesh_instances);
    }
}

/// A pixel of a frame.
pub(crate) struct Picked<'a> {
    pub model: &'a Model,
    /// The transforms of the model's instances when the frame was recorded.
    pub transforms: &'a [DAffine3],
    pub camera: &'a Camera,
    /// The pixel's centre.
    pub pixel: DVec2,
}

impl Picking {
    /// The hit of the pixel's two words: that of `visibility`, or, if that is empty, that of meshes and solids.
    pub(crate) fn hit(&self, of: &Picked<'_>, words: [[u32; 2]; 2]) -> Option<Hit> {
        let sees = |word: &[u32; 2]| word[0] & !GAP_CANDIDATE != 0;
        let [seen, second] = words.into_iter().find(sees)?;
        let number = (seen & !(GAP_CANDIDATE | SEEN_KIND)) as usize;
        match seen & SEEN_KIND {
            SEEN_MESH => self.mesh(of, number, second as usize),
            SEEN_SOLID => Some(of.on_solid(*self.sides.get(number)?, second)),
            SEEN_OPERAND => {
                Some(of.on_solid(self.faces[self.placed_patch_instance(number - 1)[1] as usize].id, second))
            }
            _ => {
                let hit = self.patch(of, number - 1, second)?;
                Some(Hit { edge: self.edge(of, &hit), ..hit })
            }
        }
    }

    /// The edge of the hit's face that is nearest to the pixel, at most half a line's width and half a pixel away. Its
    /// point must not lie farther behind the hit than the slope of the face explains.
    fn edge(&self, of: &Picked<'_>, hit: &Hit) -> Option<usize> {
        let (known, settings) = self.edges.as_ref()?;
        let (instance, part, face) = (hit.instance?, hit.part?, hit.face?);
        let edges = &known.get()?[part].edges;
        let transform = &of.transforms[instance];
        let to_pixels = of.camera.pixel_matrix() * DMat4::from(*transform);
        let within = 0.5 + 0.5 * settings.width * f64::from(of.camera.size.1) / EdgeSettings::HEIGHT;
        let (_, ray) = of.camera.ray(of.pixel);
        let cosine = hit.normal.map_or(1.0, |normal| normal.dot(ray).abs()).max(LEAST_COSINE);
        let side = if of.camera.is_perspective() { hit.depth } else { 1.0 } / of.camera.focal_px().min_element();
        let found = edges.iter().enumerate().filter_map(|(number, edge)| {
            let is_own = settings.style(edge.kind).is_some() && edge.uses.iter().any(|u| u.face == face);
            let near = is_own.then(|| nearest(edge, to_pixels, of.pixel, within))??;
            let piece = (near.parameter as usize).min(edge.curve.len() - 1);
            let point = edge.curve[piece].piece.point(near.parameter - piece as f64);
            let behind = of.depth(transform.transform_point3(point)) - hit.depth;
            (behind <= 2.0 * within * side / cosine).then_some((number, near.distance_px))
        });
        found.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(number, _)| number)
    }

    fn placed_patch_instance(&self, patch_instance: usize) -> [u32; 3] {
        let next = self.placed.partition_point(|placed| placed[0] as usize <= patch_instance);
        self.placed[next - 1] // a placed face without patches has the first patch instance of the next one
    }

    fn patch(&self, of: &Picked<'_>, patch_instance: usize, second: u32) -> Option<Hit> {
        let [first_patch_instance, face, instance] = self.placed_patch_instance(patch_instance);
        let made = self.faces[face as usize];
        let instance = (self.sources[instance as usize] as usize).checked_sub(1)?;
        let part = of.model.instances[instance].part;
        let number = made.face? as usize;
        let face = &of.model.parts[part].faces[number];
        let patch =
            self.patches[made.first_patch as usize + patch_instance - first_patch_instance as usize].map(f64::from);
        let within = [second & 0xffff, second >> 16].map(|x| f64::from(x) / 65535.0 * 3.0 - 1.0);
        let at = |k: usize| made.domain[k] + made.domain[2 + k] * (patch[k] + patch[2 + k] * within[k]);
        let (uv, point, normal) = of.refined(face, &of.transforms[instance], DVec2::new(at(0), at(1)));
        Some(Hit {
            instance: Some(instance),
            part: Some(part),
            face: Some(number),
            triangle: None,
            id: made.id,
            edge: None,
            uv: Some(uv),
            point,
            normal,
            depth: of.depth(point),
        })
    }

    fn mesh(&self, of: &Picked<'_>, placed: usize, triangle: usize) -> Option<Hit> {
        let [number, instance] = *self.mesh_instances.get(placed)?;
        if let Some(isolated) = (number as usize).checked_sub(self.meshes.len()) {
            let (mesh, first) = self.isolated.get(isolated)?;
            let (_, point, normal) = of.on_triangle(mesh.corners(triangle - *first as usize), &DAffine3::IDENTITY);
            return Some(Hit { normal, ..of.nowhere(mesh.id, point) });
        }
        let [nth, first] = self.meshes[number as usize];
        let instance = (self.sources[instance as usize] as usize).checked_sub(1)?;
        let part = of.model.instances[instance].part;
        let mesh = &of.model.parts[part].meshes[nth as usize];
        let triangle = triangle - first as usize;
        let (uv, point, normal) = of.on_triangle(mesh.corners(triangle), &of.transforms[instance]);
        Some(Hit {
            instance: Some(instance),
            part: Some(part),
            face: None,
            triangle: Some((nth as usize, triangle)),
            id: mesh.id,
            edge: None,
            uv: Some(uv),
            point,
            normal,
            depth: of.depth(point),
        })
    }
}

impl Picked<'_> {
    fn depth(&self, point: DVec3) -> f64 {
        let (_, _, forward) = self.camera.axes();
        (point - self.camera.eye).dot(forward)
    }

    fn on_solid(&self, id: u32, depth: u32) -> Hit {
        let depth = f64::from(f32::from_bits(depth));
        let (origin, direction) = self.camera.ray(self.pixel);
        let (_, _, forward) = self.camera.axes();
        self.nowhere(id, origin + direction * (depth / direction.dot(forward)))
    }

    /// A hit on no part.
    fn nowhere(&self, id: u32, point: DVec3) -> Hit {
        let depth = self.depth(point);
        let (instance, part, face, triangle, edge) = (None, None, None, None, None);
        Hit { instance, part, face, triangle, id, edge, uv: None, point, normal: None, depth }
    }

    /// Where the ray meets the plane of a placed triangle: weights, point, normal.
    fn on_triangle(&self, corners: [DVec3; 3], transform: &DAffine3) -> (DVec2, DVec3, Option<DVec3>) {
        let [a, b, c] = corners.map(|p| transform.transform_point3(p));
        let (ab, ac) = (b - a, c - a);
        let across = ab.cross(ac);
        let (origin, direction) = self.camera.ray(self.pixel);
        let t = (a - origin).dot(across) / direction.dot(across);
        let point = origin + direction * t;
        let ap = point - a;
        let size = across.length_squared();
        let uv = DVec2::new(ap.cross(ac).dot(across), ab.cross(ap).dot(across)) / size;
        let outward = if transform.matrix3.determinant() < 0.0 { -across } else { across };
        (uv, point, outward.try_normalize())
    }

    /// The point of a placed face at the pixel's centre, or the point nearest to it in the picture that Newton's method
    /// finds from `uv`.
    fn refined(&self, face: &Face, transform: &DAffine3, mut uv: DVec2) -> (DVec2, DVec3, Option<DVec3>) {
        let to_pixels = self.camera.pixel_matrix() * DMat4::from(*transform);
        let ((u0, u1), (v0, v1)) = face.surface.domain();
        let (low, high) = (DVec2::new(u0, v0), DVec2::new(u1, v1));
        let mut best = (f64::INFINITY, uv);
        for _ in 0..MOST_STEPS {
            uv = uv.clamp(low, high);
            let jet = face.surface.jet2(uv.x, uv.y);
            let q = to_pixels * jet.point.extend(1.0);
            let at = q.xy() / q.w;
            let miss = self.pixel - at;
            let comes_nearer = miss.length() < best.0;
            if !comes_nearer {
                break;
            }
            best = (miss.length(), uv);
            let along = [jet.du, jet.dv].map(|d| {
                let d = to_pixels * d.extend(0.0);
                (d.xy() - at * d.w) / q.w
            });
            let det = along[0].perp_dot(along[1]);
            let step = DVec2::new(miss.perp_dot(along[1]), along[0].perp_dot(miss)) / det;
            if best.0 < THERE_PX || !step.is_finite() {
                break;
            }
            let long = (step.abs() / (high - low)).max_element() / LONGEST_STEP;
            uv += step / long.max(1.0);
        }
        let (_, uv) = best;
        let jet = face.surface.jet2(uv.x, uv.y);
        let [du, dv] = [jet.du, jet.dv].map(|d| transform.transform_vector3(d));
        let inward = face.same_sense == (transform.matrix3.determinant() < 0.0);
        let normal = du.cross(dv).try_normalize().map(|n| if inward { -n } else { n });
        (uv, transform.transform_point3(jet.point), normal)
    }
}
