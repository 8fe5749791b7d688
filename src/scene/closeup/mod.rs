//! Deep zoom: what a view sees of a model, cut out in `f64` so that single precision resolves it.
//!
//! ```text
//!   face, its patches              the view sees          a part each, about its own centre
//!   ┌──────┬──────┬──────┐         ┌─────┬─┬┐
//!   │      │      │      │         │     ├─┼┤  windows:   ┌───┬┐
//!   ├──────┼────◦─┼──────┤  ─────▶ │     ├─◦┤  halved     │   ├┼  surface: the window and a margin, parameters
//!   │      │      │      │         ├─────┴─┴┤  until few  └───┴┘  from 0 to 1; loops: what crosses the window
//!   └──────┴──────┴──────┘         └────────┘  pixels wide
//! ```
//!
//! Control points are single-precision numbers relative to their part's centre, (u, v) to their face's domain: both
//! resolve 2⁻²⁴ of what they span. A face that spans so many pixels that this shows is replaced by *windows* of at most
//! [`WINDOW_PX`] pixels, each a face of a part of its own with the face's number, colour and sense. Only windows that
//! the view sees are made, so memory follows the view, not the zoom. Windows overlap by a margin: next to each other
//! they show the same surface, and no crack between them. Everything else that is seen stays as it is.
//!
//! What is seen through is not cut: a ray is followed through all of it.
//!
//! Cost: a face's patches are cut once and kept; a view costs some 50 µs a window and patch near it.

mod loops;

use super::data::stretch;
use super::focal_and_slant;
use crate::model::{Bounds, Camera, Face, Instance, Model, Part, TrimLoop};
use crate::spline::{Patch, PatchGrid};
use crate::trim::{LoopIndex, RectSide};
use glam::{DMat4, DVec2, DVec3, DVec4};

/// A part of half a diagonal of more pixels than this is cut. Rounding of its points, some 4 units of 2⁻²⁴, is then
/// 1/128 pixel, a fifth of what the tessellation may be off by; and a face's 8 v-strips need half of the scan lines that
/// they can have.
const MOST_PX: f64 = 32_768.0;
/// Windows are this large at most: (u, v) within one is stored with 2⁻¹⁶, from where Newton's method starts.
const WINDOW_PX: f64 = 8_192.0;
/// Of a window's width, on each side.
const MARGIN: f64 = 1.0 / 16.0;
/// Beyond the picture, in pixels.
const BESIDE_PX: f64 = 4.0;
/// A view with more windows gets the last ones larger; the frame then counts clamps where they do not suffice.
const MOST_WINDOWS: usize = 4096;
/// Halvings of a patch; 2⁻⁴⁵ is where `f64` parameters end too.
const MOST_DEPTH: u32 = 90;

/// Cuts what views see out of one model. Keeps the patches of faces that were seen close up.
#[derive(Debug, Default)]
pub struct CloseUp {
    /// Of each part, of each face.
    faces: Vec<Vec<Known>>,
}

/// What is known of a face.
#[derive(Debug)]
struct Known {
    /// Of the control points.
    bounds: (DVec3, DVec3),
    cut: Option<(PatchGrid, LoopIndex)>,
}

/// One instance seen by the camera.
struct Sight {
    to_pixels: DMat4,
    size: DVec2,
    near: f64,
    far: f64,
    perspective: bool,
    /// Pixels per part unit at unit depth, or everywhere in a parallel view.
    pixels: f64,
}

impl Sight {
    fn new(camera: &Camera, instance: &Instance) -> Self {
        let (focal, slant) = focal_and_slant(camera);
        Self {
            to_pixels: camera.pixel_matrix() * DMat4::from(instance.transform),
            size: DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1)),
            near: camera.depth_range.0,
            far: camera.depth_range.1,
            perspective: matches!(camera.projection, crate::model::Projection::Perspective { .. }),
            pixels: focal * slant * stretch(instance.transform.matrix3),
        }
    }

    /// Pixels per part unit where the box is seen nearest; `None` where nothing of it is.
    fn of_box(&self, (min, max): (DVec3, DVec3)) -> Option<f64> {
        let (mut outside, mut nearest) = (63u32, f64::INFINITY);
        for corner in (Bounds { min, max }).corners() {
            let q = self.to_pixels * corner.extend(1.0);
            let (low, high) = (DVec2::splat(-BESIDE_PX), self.size + BESIDE_PX);
            let beyond = [
                q.x < low.x * q.w,
                q.x > high.x * q.w,
                q.y < low.y * q.w,
                q.y > high.y * q.w,
                q.z < self.near,
                q.z > self.far,
            ];
            outside &= beyond.iter().enumerate().fold(0, |bits, (i, &b)| bits | u32::from(b) << i);
            nearest = nearest.min(q.z);
        }
        let w = if self.perspective { nearest.max(self.near) } else { 1.0 };
        (outside == 0).then(|| self.pixels / w)
    }

    /// The same by the box around a patch, as pass `bound` sees it: its hull may stay farther away.
    fn of_patch(&self, patch: &Patch) -> Option<f64> {
        self.of_box(patch.bounds())
    }
}

/// A rectangle of a face's parameters.
#[derive(Clone, Copy, Debug)]
struct Window {
    u: (f64, f64),
    v: (f64, f64),
}

impl CloseUp {
    /// Looks at nothing but control points.
    pub fn new(model: &Model) -> Self {
        let known = |face: &Face| Known { bounds: face.surface.bounds(), cut: None };
        Self { faces: model.parts.iter().map(|part| part.faces.iter().map(known).collect()).collect() }
    }

    /// The model to draw in place of `model`, the one that this was made for; `None` where that will do.
    ///
    /// Cost where it will do: some 0.2 µs a placed face.
    pub fn of(&mut self, model: &Model, camera: &Camera) -> Option<Model> {
        let spans: Vec<f64> = self.faces.iter().map(|faces| span(faces)).collect();
        let coarse = |(placed, instance): (usize, &Instance)| {
            let sight = Sight::new(camera, instance);
            let faces = self.faces[instance.part].iter().enumerate();
            let span = spans[instance.part];
            // what is seen through is followed through all of it
            let part = &model.parts[instance.part];
            let whole = part.closed && !instance.is_opaque(part);
            let close = |k: &Known| sight.of_box(k.bounds).map(|pixels| pixels * span > MOST_PX);
            let seen: Vec<_> = match whole {
                true => faces.map(|(f, _)| (f, false)).collect(),
                false => faces.filter_map(|(f, k)| Some((f, close(k)?))).collect(),
            };
            (placed, sight, seen)
        };
        let mut seen: Vec<_> = model.instances.iter().enumerate().map(coarse).collect();
        // a face's box may come nearer than its patches
        for (placed, sight, faces) in &mut seen {
            let part = model.instances[*placed].part;
            for (f, close) in faces.iter_mut().filter(|(_, close)| *close) {
                let (grid, _) = self.faces[part][*f].cut(&model.parts[part].faces[*f]);
                let mut patches = grid.patches.iter().filter_map(|p| sight.of_patch(&p.patch));
                *close = patches.any(|pixels| pixels * spans[part] > MOST_PX);
            }
        }
        if !seen.iter().any(|(_, _, faces)| faces.iter().any(|(_, close)| *close)) {
            return None;
        }
        let mut near = Model {
            name: model.name.clone(),
            unit: model.unit.clone(),
            solids: model.solids.clone(),
            trim: model.trim.clone(),
            coincident: model.coincident,
            ..Model::default()
        };
        for (placed, sight, faces) in &seen {
            let instance = &model.instances[*placed];
            self.add(&mut near, &model.parts[instance.part], instance, sight, faces);
        }
        Some(near)
    }

    /// What is seen of one placed part: its faces as they are, and windows of those that are `close`.
    fn add(&mut self, near: &mut Model, part: &Part, instance: &Instance, sight: &Sight, faces: &[(usize, bool)]) {
        let whole: Vec<Face> = faces.iter().filter(|(_, close)| !close).map(|(f, _)| part.faces[*f].clone()).collect();
        let mut push = |faces: Vec<Face>, meshes: Vec<crate::model::Mesh>| {
            near.instances.push(Instance { part: near.parts.len(), ..instance.clone() });
            near.parts.push(Part { name: part.name.clone(), faces, meshes, closed: part.closed });
        };
        if !(whole.is_empty() && part.meshes.is_empty()) {
            push(whole, part.meshes.clone());
        }
        for (f, _) in faces.iter().filter(|(_, close)| *close) {
            let face = &part.faces[*f];
            let (grid, index) = self.faces[instance.part][*f].cut(face);
            let mut windows = Vec::new();
            for p in &grid.patches {
                halve(&p.patch, Window { u: p.u, v: p.v }, sight, MOST_DEPTH, &mut windows);
            }
            for face in windows.into_iter().filter_map(|w| window_face(face, grid, index, w)) {
                push(vec![face], Vec::new());
            }
        }
    }
}

/// The largest distance from the middle of the faces' control points.
fn span(faces: &[Known]) -> f64 {
    let all = faces.iter().map(|f| f.bounds).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    all.map_or(0.0, |(lo, hi)| (hi - lo).length() / 2.0)
}

impl Known {
    fn cut(&mut self, face: &Face) -> &(PatchGrid, LoopIndex) {
        self.cut.get_or_insert_with(|| (face.surface.patches(), LoopIndex::new(&face.loops)))
    }
}

/// Halves what is seen of `patch`, which is `window` of its face, until it is small enough.
fn halve(patch: &Patch, window: Window, sight: &Sight, depth: u32, windows: &mut Vec<Window>) {
    let Some(pixels) = sight.of_patch(patch) else { return };
    let (lo, hi) = patch.bounds();
    if pixels * (hi - lo).length() <= WINDOW_PX || depth == 0 || windows.len() >= MOST_WINDOWS {
        return windows.push(window);
    }
    let length = |points: &mut dyn Iterator<Item = DVec3>| {
        let first = points.next();
        points.fold((0.0, first), |(sum, before), p| (sum + before.map_or(0.0, |b| b.distance(p)), Some(p))).0
    };
    let n = patch.degree_u + 1;
    let point = |p: &DVec4| p.truncate() / p.w;
    let rows = patch.points.chunks_exact(n).map(|row| length(&mut row.iter().map(point)));
    let columns = (0..n).map(|i| length(&mut patch.points.iter().skip(i).step_by(n).map(point)));
    let along_u = rows.fold(0.0, f64::max) >= columns.fold(0.0, f64::max);
    let middle = |(a, b): (f64, f64)| a + (b - a) / 2.0;
    let ((a, b), [low, high]) = if along_u {
        let m = middle(window.u);
        (patch.split_u(0.5), [Window { u: (window.u.0, m), ..window }, Window { u: (m, window.u.1), ..window }])
    } else {
        let m = middle(window.v);
        (patch.split_v(0.5), [Window { v: (window.v.0, m), ..window }, Window { v: (m, window.v.1), ..window }])
    };
    halve(&a, low, sight, depth - 1, windows);
    halve(&b, high, sight, depth - 1, windows);
}

/// The face over a window and its margin, `None` where it is trimmed away; all of it where the window is so small that
/// knots no longer differ.
fn window_face(face: &Face, grid: &PatchGrid, index: &LoopIndex, window: Window) -> Option<Face> {
    let ((u0, u1), (v0, v1)) = face.surface.domain();
    let wider = |(a, b): (f64, f64), lo: f64, hi: f64| {
        let margin = (b - a) * MARGIN;
        ((a - margin).max(lo), (b + margin).min(hi))
    };
    let (u, v) = (wider(window.u, u0, u1), wider(window.v, v0, v1));
    let (lo, hi) = (DVec2::new(u.0, v.0), DVec2::new(u.1, v.1));
    let loops: Vec<TrimLoop> = match index.classify(lo, hi) {
        _ if face.loops.is_empty() => Vec::new(),
        RectSide::Outside => return None,
        RectSide::Inside => Vec::new(),
        RectSide::Boundary => face.loops.iter().filter_map(|l| loops::clipped(l, lo, hi)).collect(),
    };
    Some(match grid.within(face.surface.degrees(), u, v) {
        Ok(surface) => Face { surface, loops, ..face.clone() },
        Err(_) => face.clone(),
    })
}

#[cfg(test)]
mod tests;
