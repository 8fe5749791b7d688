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
//! What is cut is what a camera sees that serves all views from near by (`scene/view_cell.rs`): while a view hardly changes,
//! nothing is made or uploaded. What is seen through is not cut: a ray is followed through all of it.
//!
//! Cost: a face's patches are cut once and kept; a view costs some 50 µs a window and patch near it.

mod edges;
mod loops;

use super::focal_and_slant;
use super::instance::{Shown, stretch};
use super::sub_patches::VIEW_PX;
use super::view_cell::view_cell;
use super::whole_view::Ball;
use crate::model::{Bounds, Camera, Face, Instance, Model, Part, Solid, TrimLoop};
use crate::spline::{Patch, PatchGrid};
use crate::trim::{LoopIndex, RectSide};
pub(super) use edges::KnownEdges;
use glam::{DMat4, DVec2, DVec3, DVec4};
use std::ops::Range;

/// A part of half a diagonal of more pixels than this is cut. Rounding of its points, some 4 units of 2⁻²⁴, is then
/// 1/128 pixel, a fifth of what the tessellation may be off by; and a face's 8 v-strips need half of the scan lines that
/// they can have.
const MOST_PX: f64 = 32_768.0;
/// Windows are this large at most: (u, v) within one is stored with 2⁻¹⁶, from where Newton's method starts.
const WINDOW_PX: f64 = 8_192.0;
/// Of a window's width, on each side, but no more than [`MARGIN_PX`] of its diagonal: what lies in margins is drawn twice.
const MARGIN: f64 = 1.0 / 16.0;
const MARGIN_PX: f64 = 64.0;
/// Beyond the picture, in pixels.
const BESIDE_PX: f64 = 4.0;
/// A view with more windows gets the last ones larger; the frame then counts clamps where they do not suffice.
const MOST_WINDOWS: usize = 4096;
/// Halvings of a patch; 2⁻⁴⁵ is where `f64` parameters end too.
const MOST_DEPTH: u32 = 90;

/// Cuts what views see out of one model. Keeps the patches of faces that were seen close up.
#[derive(Debug)]
pub(crate) struct DeepZoom {
    /// Of each part, of each face.
    faces: Vec<Vec<Known>>,
    /// Of each part, meshes included; and of the solids.
    bounds: Vec<Bounds>,
    solids: Bounds,
    edges: KnownEdges,
    /// What was told last; `None`: nothing that holds.
    held: Option<Held>,
}

/// What a view wants uploaded.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum DeepZoomUpload {
    /// What was wanted last serves this view, too; at first that is the model as it is.
    Same,
    /// The model as it is.
    Whole,
    /// This in its place.
    Cut(Box<Cut>),
}

/// What views from near by see of a model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cut {
    /// Faces that are seen, or windows of them.
    pub(crate) model: Model,
    /// Of each of its parts: how large is what its views would show, were they [`VIEW_PX`] wide. Units of the part.
    pub(super) extents: Vec<f64>,
    /// Of each of its parts, where it is from.
    pub(super) sources: Vec<Source>,
    /// What all views that it serves see is seen by this camera.
    pub(super) camera: Camera,
    /// The edges of the whole model, once somebody asks.
    pub(super) edges: KnownEdges,
}

/// Where a part of a cut is from.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source {
    /// Of the whole model.
    pub instance: usize,
    /// Its faces, of the instance's part.
    pub faces: Vec<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Held {
    Whole,
    /// What this camera sees.
    Cut(Camera),
}

/// What is known of a face.
#[derive(Debug)]
struct Known {
    /// Of the control points.
    bounds: (DVec3, DVec3),
    cut: Option<(PatchGrid, LoopIndex)>,
}

/// Of each face of a part: nothing but its control points has been looked at.
fn known(part: &Part) -> Vec<Known> {
    part.faces.iter().map(|face| Known { bounds: face.surface.bounds(), cut: None }).collect()
}

/// Around the Boolean solids that have an end.
fn bounds_of_solids(model: &Model) -> Bounds {
    let solids = model.solids.iter().map(Solid::bounds).filter(|b| b.min.is_finite() && b.max.is_finite());
    solids.fold(Bounds::EMPTY, Bounds::union)
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

impl Cut {
    /// Of a part of it and a face of that: the face of the whole model's part.
    pub(crate) fn face_of(&self, part: usize, face: usize) -> usize {
        self.sources[part].faces[face]
    }
}

impl Sight {
    fn new(camera: &Camera, instance: &Instance) -> Self {
        let (focal, slant) = focal_and_slant(camera);
        Self {
            to_pixels: camera.pixel_matrix() * DMat4::from(instance.transform),
            size: DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1)),
            near: camera.depth_range.0,
            far: camera.depth_range.1,
            perspective: camera.is_perspective(),
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

/// What is seen of one placed part: its faces, and whether each is too close to be drawn as it is.
struct Seen {
    placed: usize,
    sight: Sight,
    faces: Vec<(usize, bool)>,
}

impl Seen {
    fn is_close(&self) -> bool {
        self.faces.iter().any(|(_, close)| *close)
    }
}

/// A rectangle of a face's parameters.
#[derive(Clone, Copy, Debug)]
struct Window {
    u: (f64, f64),
    v: (f64, f64),
}

impl Window {
    /// With a margin of that share of its width on each side.
    fn wider(self, share: f64) -> Self {
        let wider = |(a, b): (f64, f64)| (a - (b - a) * share, b + (b - a) * share);
        Self { u: wider(self.u), v: wider(self.v) }
    }
}

impl DeepZoom {
    /// Of a model that has been uploaded as it is. Looks at nothing but control points.
    pub(crate) fn new(model: &Model) -> Self {
        let faces = model.parts.iter().map(known).collect();
        Self {
            faces,
            bounds: model.parts.iter().map(Part::control_bounds).collect(),
            solids: bounds_of_solids(model),
            edges: KnownEdges::default(),
            held: Some(Held::Whole),
        }
    }

    /// These parts of the model, and its Boolean solids, are others now; or the model's last parts are gone.
    pub(crate) fn change(&mut self, model: &Model, parts: Range<usize>) {
        self.faces.resize_with(model.parts.len(), Vec::new);
        self.bounds.resize(model.parts.len(), Bounds::EMPTY);
        for (number, part) in parts.clone().zip(model.parts.get(parts).into_iter().flatten()) {
            self.faces[number] = known(part);
            self.bounds[number] = part.control_bounds();
        }
        self.solids = bounds_of_solids(model);
        self.edges = KnownEdges::default();
    }

    /// The model is loaded as it is.
    pub(crate) fn hold_whole(&mut self) {
        self.held = Some(Held::Whole);
    }

    /// What to upload for this view of `model`, in place of what was told last. Its parts are those of the model that this
    /// was made for, and so are their loops; its instances are as many, and shown like this.
    ///
    /// Cost where that serves this view, too: some 0.2 µs an instance; and a placed face, where one may be close.
    pub(crate) fn of(&mut self, model: &Model, shown: &[Shown], camera: &Camera) -> DeepZoomUpload {
        let seen = if self.may_be_close(model, shown, camera) { self.seen(model, shown, camera) } else { Vec::new() };
        if !seen.iter().any(Seen::is_close) {
            let held = self.held.replace(Held::Whole);
            return if held == Some(Held::Whole) { DeepZoomUpload::Same } else { DeepZoomUpload::Whole };
        }
        let boxes: Vec<Bounds> = seen.iter().flat_map(|seen| self.boxes(model, seen, camera.eye)).collect();
        let ball = self.ball(model, shown);
        let wider = ball.and_then(|ball| view_cell(camera, BESIDE_PX, &ball, &boxes)).unwrap_or(*camera);
        let held = self.held.replace(Held::Cut(wider));
        if held == self.held {
            return DeepZoomUpload::Same;
        }
        let none = Model {
            name: model.name.clone(),
            unit: model.unit.clone(),
            solids: model.solids.clone(),
            trim: model.trim.clone(),
            coincident: model.coincident,
            ..Model::default()
        };
        let edges = self.edges.clone();
        let mut near = Cut { model: none, extents: Vec::new(), sources: Vec::new(), camera: wider, edges };
        for seen in self.seen(model, shown, &wider) {
            let instance = &model.instances[seen.placed];
            self.add(&mut near, &model.parts[instance.part], instance, &seen);
        }
        DeepZoomUpload::Cut(Box::new(near))
    }

    /// What was told last was not uploaded: the next view is told again.
    pub(crate) fn forget(&mut self) {
        self.held = None;
    }

    /// Around what is shown of the model.
    fn ball(&self, model: &Model, shown: &[Shown]) -> Option<Ball> {
        let visible = model.instances.iter().zip(shown).filter(|(_, shown)| shown.visible);
        let bounds = visible.map(|(instance, _)| (self.bounds[instance.part], instance));
        let placed = bounds.filter(|(bounds, _)| !bounds.is_empty()).map(|(b, i)| placed((b.min, b.max), i));
        Ball::around(placed.fold(self.solids, Bounds::union))
    }

    /// False where no face is: each lies in the box of its part.
    fn may_be_close(&self, model: &Model, shown: &[Shown], camera: &Camera) -> bool {
        model.instances.iter().zip(shown).filter(|(_, shown)| shown.visible).any(|(instance, _)| {
            let bounds = self.bounds[instance.part];
            let pixels = Sight::new(camera, instance).of_box((bounds.min, bounds.max));
            pixels.is_some_and(|pixels| pixels * 0.5 * bounds.diagonal() > MOST_PX)
        })
    }

    /// What a camera sees of each placed part.
    fn seen(&mut self, model: &Model, shown: &[Shown], camera: &Camera) -> Vec<Seen> {
        let spans: Vec<f64> = self.faces.iter().map(|faces| span(faces)).collect();
        let coarse = |(placed, instance): (usize, &Instance)| {
            let sight = Sight::new(camera, instance);
            let faces = self.faces[instance.part].iter().enumerate();
            let span = spans[instance.part];
            // what is seen through is followed through all of it
            let part = &model.parts[instance.part];
            let whole = part.closed && !instance.is_opaque(part);
            let close = |k: &Known| sight.of_box(k.bounds).map(|pixels| pixels * span > MOST_PX);
            let faces: Vec<_> = match whole {
                true => faces.map(|(f, _)| (f, false)).collect(),
                false => faces.filter_map(|(f, k)| Some((f, close(k)?))).collect(),
            };
            Seen { placed, sight, faces }
        };
        let visible = model.instances.iter().enumerate().filter(|(nth, _)| shown[*nth].visible);
        let mut all: Vec<_> = visible.map(coarse).collect();
        // a face's box may come nearer than its patches
        for Seen { placed, sight, faces } in &mut all {
            let part = model.instances[*placed].part;
            for (f, close) in faces.iter_mut().filter(|(_, close)| *close) {
                let (grid, _) = self.faces[part][*f].cut(&model.parts[part].faces[*f]);
                let mut patches = grid.patches.iter().filter_map(|p| sight.of_patch(&p.patch));
                *close = patches.any(|pixels| pixels * spans[part] > MOST_PX);
            }
        }
        all
    }

    /// Boxes that hold what is seen, in the model's coordinates; of what is close, no larger than they are far from the eye.
    fn boxes(&mut self, model: &Model, seen: &Seen, eye: DVec3) -> Vec<Bounds> {
        let instance = &model.instances[seen.placed];
        let mut boxes = Vec::new();
        for &(f, close) in &seen.faces {
            let known = &mut self.faces[instance.part][f];
            if close {
                let (grid, _) = known.cut(&model.parts[instance.part].faces[f]);
                for p in &grid.patches {
                    near_boxes(&p.patch, &seen.sight, (instance, eye), MOST_DEPTH, &mut boxes);
                }
            } else {
                boxes.push(placed(known.bounds, instance));
            }
        }
        boxes
    }

    /// What is seen of one placed part: its faces as they are, and windows of those that are `close`.
    fn add(&mut self, near: &mut Cut, part: &Part, instance: &Instance, seen: &Seen) {
        let Seen { sight, faces, .. } = seen;
        let numbers: Vec<usize> = faces.iter().filter(|(_, close)| !close).map(|(f, _)| *f).collect();
        let whole: Vec<Face> = numbers.iter().map(|f| part.faces[*f].clone()).collect();
        let mut push = |(faces, numbers): (Vec<Face>, Vec<usize>), meshes: Vec<crate::model::Mesh>, pixels: f64| {
            let Cut { model, extents, sources, .. } = &mut *near;
            sources.push(Source { instance: seen.placed, faces: numbers });
            extents.push(VIEW_PX / pixels);
            model.instances.push(Instance { part: model.parts.len(), ..instance.clone() });
            model.parts.push(Part { name: part.name.clone(), faces, meshes, closed: part.closed, ..Part::default() });
        };
        if !(whole.is_empty() && part.meshes.is_empty()) {
            let seen = faces.iter().filter(|(_, close)| !close);
            let pixels = seen.filter_map(|(f, _)| sight.of_box(self.faces[instance.part][*f].bounds));
            push((whole, numbers), part.meshes.clone(), pixels.fold(f64::INFINITY, f64::min));
        }
        for (f, _) in faces.iter().filter(|(_, close)| *close) {
            let face = &part.faces[*f];
            let (grid, index) = self.faces[instance.part][*f].cut(face);
            let mut windows = Vec::new();
            for p in &grid.patches {
                halve(&p.patch, Window { u: p.u, v: p.v }, sight, MOST_DEPTH, &mut windows);
            }
            for (window, pixels) in windows {
                if let Some(face) = window_face(face, grid, index, window) {
                    push((vec![face], vec![*f]), Vec::new(), pixels);
                }
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

/// A box of part coordinates as it is placed.
fn placed((min, max): (DVec3, DVec3), instance: &Instance) -> Bounds {
    let corners = Bounds { min, max }.corners().map(|corner| instance.transform.transform_point3(corner));
    corners.into_iter().fold(Bounds::EMPTY, Bounds::with)
}

/// Boxes around what is seen of a patch, none larger than it is far from the eye.
fn near_boxes(patch: &Patch, sight: &Sight, at: (&Instance, DVec3), depth: u32, boxes: &mut Vec<Bounds>) {
    if sight.of_patch(patch).is_none() {
        return;
    }
    let (instance, eye) = at;
    let bounds = placed(patch.bounds(), instance);
    let distance = (bounds.centre() - eye).abs() - 0.5 * (bounds.max - bounds.min);
    let is_small = bounds.diagonal() <= distance.max(DVec3::ZERO).length();
    if is_small || depth == 0 || boxes.len() >= MOST_WINDOWS {
        return boxes.push(bounds);
    }
    let (a, b) = if is_longer_along_u(patch) { patch.split_u(0.5) } else { patch.split_v(0.5) };
    near_boxes(&a, sight, at, depth - 1, boxes);
    near_boxes(&b, sight, at, depth - 1, boxes);
}

/// By its control net.
fn is_longer_along_u(patch: &Patch) -> bool {
    let length = |points: &mut dyn Iterator<Item = DVec3>| {
        let first = points.next();
        points.fold((0.0, first), |(sum, before), p| (sum + before.map_or(0.0, |b| b.distance(p)), Some(p))).0
    };
    let n = patch.degree_u + 1;
    let point = |p: &DVec4| p.truncate() / p.w;
    let rows = patch.points.chunks_exact(n).map(|row| length(&mut row.iter().map(point)));
    let columns = (0..n).map(|i| length(&mut patch.points.iter().skip(i).step_by(n).map(point)));
    rows.fold(0.0, f64::max) >= columns.fold(0.0, f64::max)
}

/// Halves what is seen of `patch`, which is `window` of its face, until it is small enough. Windows with their margins, and
/// pixels per unit of each.
fn halve(patch: &Patch, window: Window, sight: &Sight, depth: u32, windows: &mut Vec<(Window, f64)>) {
    let Some(pixels) = sight.of_patch(patch) else { return };
    let (lo, hi) = patch.bounds();
    if pixels * (hi - lo).length() <= WINDOW_PX || depth == 0 || windows.len() >= MOST_WINDOWS {
        let margin = MARGIN.min(MARGIN_PX / (pixels * (hi - lo).length()));
        return windows.push((window.wider(margin), pixels));
    }
    let middle = |(a, b): (f64, f64)| a + (b - a) / 2.0;
    let ((a, b), [low, high]) = if is_longer_along_u(patch) {
        let m = middle(window.u);
        (patch.split_u(0.5), [Window { u: (window.u.0, m), ..window }, Window { u: (m, window.u.1), ..window }])
    } else {
        let m = middle(window.v);
        (patch.split_v(0.5), [Window { v: (window.v.0, m), ..window }, Window { v: (m, window.v.1), ..window }])
    };
    halve(&a, low, sight, depth - 1, windows);
    halve(&b, high, sight, depth - 1, windows);
}

/// The face over a window, `None` where it is trimmed away; all of it where the window is so small that knots no longer
/// differ.
fn window_face(face: &Face, grid: &PatchGrid, index: &LoopIndex, window: Window) -> Option<Face> {
    let ((u0, u1), (v0, v1)) = face.surface.domain();
    let u = (window.u.0.max(u0), window.u.1.min(u1));
    let v = (window.v.0.max(v0), window.v.1.min(v1));
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
