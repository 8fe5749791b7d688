//! Deep zoom: cuts the visible part out of a model in `f64`, so that single precision resolves it.
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
//! Control points are single-precision numbers relative to their part's centre; (u, v) is relative to the face's
//! domain. Both resolve 2⁻²⁴ of their range. If a face covers so many pixels that this error shows, *windows* of at
//! most [`WINDOW_PX`] pixels replace it. Each window is a face of a part of its own, with the face's number, colour and
//! sense. Only visible windows are made, so memory follows the view, not the zoom. Windows overlap by a margin:
//! adjacent windows show the same surface, without a crack. All other visible faces stay as they are.
//!
//! The cut is made for the camera of a view cell (`scene/view_cell.rs`), which serves every view in that cell: while
//! the view hardly changes, nothing is made or uploaded. Transparent parts are not cut, because rays are followed
//! through all of them.
//!
//! Cost: a face's patches are cut once and stored; a view costs some 50 µs for each window and each patch near it.

mod edges;
mod loops;

use super::focal_and_slant;
use super::instance::{Shown, stretch};
use super::sub_patches::VIEW_PX;
use super::view_cell::view_cell;
use super::whole_view::Ball;
use crate::abi;
use crate::model::{Bounds, Camera, Face, Instance, Model, Part, Solid, TrimLoop};
use crate::spline::{Patch, PatchGrid};
use crate::trim::{LoopIndex, RectSide};
pub(super) use edges::KnownEdges;
use glam::{DMat4, DVec2, DVec3, DVec4};
use std::ops::Range;

/// A part is cut if half its diagonal is longer than this, in pixels. At this size, rounding moves its points by some 4
/// units of 2⁻²⁴, or 1/128 pixel: a fifth of the tessellation's deviation. A face's 8 v-strips then need half of the
/// scan lines that they can have.
const MOST_PX: f64 = 32_768.0;
/// Largest size of a window: (u, v) in it is stored with 2⁻¹⁶, close enough for Newton's method to start from.
const WINDOW_PX: f64 = 8_192.0;
/// Margin on each side, as a share of a window's width, but at most [`MARGIN_PX`] of its diagonal. Surfaces in margins
/// are drawn twice.
const MARGIN: f64 = 1.0 / 16.0;
const MARGIN_PX: f64 = 64.0;
/// Pixels beyond the picture in which windows are made, too.
const BESIDE_PX: f64 = 4.0;
/// Most windows of a view. The last ones become larger if there would be more; the frame counts a clamp where one is
/// too large.
const MOST_WINDOWS: usize = 4096;
/// Most halvings of a patch: `f64` parameters end at 2⁻⁴⁵, too.
const MOST_DEPTH: u32 = 90;

/// Makes the cuts of one model for its views. Stores the patches of faces that a view has shown close up.
#[derive(Debug)]
pub(crate) struct DeepZoom {
    /// Every face of every part.
    faces: Vec<Vec<Known>>,
    /// Bounds of each part with its meshes, and of the solids.
    bounds: Vec<Bounds>,
    solids: Bounds,
    edges: KnownEdges,
    /// What the last view uploaded; `None` if that upload failed.
    held: Option<Held>,
}

/// What a view needs uploaded.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum DeepZoomUpload {
    /// Nothing: the last upload serves this view, too.
    Same,
    /// The whole model.
    Whole,
    /// This cut in place of the last upload.
    Cut(Box<Cut>),
}

/// The cut of a model for one view cell.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cut {
    /// The visible faces, or windows of them.
    pub(crate) model: Model,
    /// For each of its parts: the extent of a picture [`VIEW_PX`] wide, in units of the part.
    pub(super) extents: Vec<f64>,
    /// For each of its parts: the instance and faces that it comes from.
    pub(super) sources: Vec<Source>,
    /// The camera of the view cell. It sees everything that the cell's views see.
    pub(super) camera: Camera,
    /// The edges of the whole model, found at the first request.
    pub(super) edges: KnownEdges,
}

/// The origin of a part of a cut.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source {
    /// Instance of the whole model.
    pub instance: usize,
    /// Faces of that instance's part.
    pub faces: Vec<usize>,
    /// Sides of each at which a window of it ends, but not the surface: `BORDER_*`.
    pub goes_on: Vec<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Held {
    Whole,
    /// A cut for this camera.
    Cut(Camera),
}

/// A face, its bounds, and its patches once they are cut.
#[derive(Debug)]
struct Known {
    /// Bounds of the control points.
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
    /// The face, in the whole model's part, of a face of one of the cut's parts.
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

    /// Pixels per part unit at the nearest visible point of the box; `None` if the box is not visible.
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

    /// The same for a patch, by its box as in pass `bound`: its convex hull may be farther away.
    fn of_patch(&self, patch: &Patch) -> Option<f64> {
        self.of_box(patch.bounds())
    }
}

/// The visible faces of one placed part, and whether each is too close to be drawn as it is.
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
    /// The window with a margin of this share of its width on each side.
    fn wider(self, share: f64) -> Self {
        let wider = |(a, b): (f64, f64)| (a - (b - a) * share, b + (b - a) * share);
        Self { u: wider(self.u), v: wider(self.v) }
    }
}

impl DeepZoom {
    /// For a model that is uploaded as a whole. Reads only the control points.
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

    /// What to upload for this view of `model`, in place of the last upload. The model must have the parts and loops
    /// that this was made for. It has the same number of instances, drawn as `shown` says.
    ///
    /// Cost if the last upload still serves: some 0.2 µs an instance, and as much a placed face if one may be close.
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

    /// The last upload failed: the next view uploads again.
    pub(crate) fn forget(&mut self) {
        self.held = None;
    }

    /// A ball around the visible instances.
    fn ball(&self, model: &Model, shown: &[Shown]) -> Option<Ball> {
        let visible = model.instances.iter().zip(shown).filter(|(_, shown)| shown.visible);
        let bounds = visible.map(|(instance, _)| (self.bounds[instance.part], instance));
        let placed = bounds.filter(|(bounds, _)| !bounds.is_empty()).map(|(b, i)| placed((b.min, b.max), i));
        Ball::around(placed.fold(self.solids, Bounds::union))
    }

    /// False if no face is close: each face lies in its part's box.
    fn may_be_close(&self, model: &Model, shown: &[Shown], camera: &Camera) -> bool {
        model.instances.iter().zip(shown).filter(|(_, shown)| shown.visible).any(|(instance, _)| {
            let bounds = self.bounds[instance.part];
            let pixels = Sight::new(camera, instance).of_box((bounds.min, bounds.max));
            pixels.is_some_and(|pixels| pixels * 0.5 * bounds.diagonal() > MOST_PX)
        })
    }

    /// The faces of each placed part that a camera sees.
    fn seen(&mut self, model: &Model, shown: &[Shown], camera: &Camera) -> Vec<Seen> {
        let spans: Vec<f64> = self.faces.iter().map(|faces| span(faces)).collect();
        let coarse = |(placed, instance): (usize, &Instance)| {
            let sight = Sight::new(camera, instance);
            let faces = self.faces[instance.part].iter().enumerate();
            let span = spans[instance.part];
            // rays are followed through all of a transparent part
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

    /// Boxes around the visible faces, in model coordinates. Boxes of close faces are no larger than their distance
    /// from the eye.
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

    /// Adds one placed part to the cut: its faces as they are, and windows of the close ones.
    fn add(&mut self, near: &mut Cut, part: &Part, instance: &Instance, seen: &Seen) {
        let Seen { sight, faces, .. } = seen;
        let numbers: Vec<usize> = faces.iter().filter(|(_, close)| !close).map(|(f, _)| *f).collect();
        let whole: Vec<Face> = numbers.iter().map(|f| part.faces[*f].clone()).collect();
        let mut push = |(faces, numbers, goes_on): (Vec<Face>, Vec<usize>, Vec<u32>),
                        meshes: Vec<crate::model::Mesh>,
                        pixels: f64| {
            let Cut { model, extents, sources, .. } = &mut *near;
            sources.push(Source { instance: seen.placed, faces: numbers, goes_on });
            extents.push(VIEW_PX / pixels);
            model.instances.push(Instance { part: model.parts.len(), ..instance.clone() });
            model.parts.push(Part { name: part.name.clone(), faces, meshes, closed: part.closed, ..Part::default() });
        };
        if !(whole.is_empty() && part.meshes.is_empty()) {
            let seen = faces.iter().filter(|(_, close)| !close);
            let pixels = seen.filter_map(|(f, _)| sight.of_box(self.faces[instance.part][*f].bounds));
            let goes_on = vec![0; numbers.len()];
            push((whole, numbers, goes_on), part.meshes.clone(), pixels.fold(f64::INFINITY, f64::min));
        }
        for (f, _) in faces.iter().filter(|(_, close)| *close) {
            let face = &part.faces[*f];
            let (grid, index) = self.faces[instance.part][*f].cut(face);
            let mut windows = Vec::new();
            for p in &grid.patches {
                halve(&p.patch, Window { u: p.u, v: p.v }, sight, MOST_DEPTH, &mut windows);
            }
            for (window, pixels) in windows {
                if let Some((face, goes_on)) = window_face(face, grid, index, window) {
                    push((vec![face], vec![*f], vec![goes_on]), Vec::new(), pixels);
                }
            }
        }
    }
}

/// Half the diagonal of the box around the faces' control points.
fn span(faces: &[Known]) -> f64 {
    let all = faces.iter().map(|f| f.bounds).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    all.map_or(0.0, |(lo, hi)| (hi - lo).length() / 2.0)
}

impl Known {
    fn cut(&mut self, face: &Face) -> &(PatchGrid, LoopIndex) {
        self.cut.get_or_insert_with(|| (face.surface.patches(), LoopIndex::new(&face.loops)))
    }
}

/// A placed box of part coordinates, in model coordinates.
fn placed((min, max): (DVec3, DVec3), instance: &Instance) -> Bounds {
    let corners = Bounds { min, max }.corners().map(|corner| instance.transform.transform_point3(corner));
    corners.into_iter().fold(Bounds::EMPTY, Bounds::with)
}

/// Boxes around the visible pieces of a patch, none larger than its distance from the eye.
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

/// Whether the control net is longer along u than along v.
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

/// Halves the visible part of `patch`, which covers `window` of its face, until the pieces are small enough. Collects
/// windows with their margins, and the pixels per unit of each.
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

/// The face over a window, and the sides beyond which the surface goes on; `None` if it is trimmed away. The whole face
/// if the window is so small that its knots coincide.
fn window_face(face: &Face, grid: &PatchGrid, index: &LoopIndex, window: Window) -> Option<(Face, u32)> {
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
    let sides = [u.0 > u0, u.1 < u1, v.0 > v0, v.1 < v1];
    let borders = [abi::BORDER_U0, abi::BORDER_U1, abi::BORDER_V0, abi::BORDER_V1];
    let goes_on = sides.iter().zip(borders).filter(|(on, _)| **on).fold(0, |bits, (_, border)| bits | border);
    Some(match grid.within(face.surface.degrees(), u, v) {
        Ok(surface) => (Face { surface, loops, ..face.clone() }, goes_on),
        Err(_) => (face.clone(), 0),
    })
}

#[cfg(test)]
mod tests;
