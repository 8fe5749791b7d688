//! From the images around the cursor to the face, edge or vertex under it, or to a point to measure from.
//!
//! ```text
//!   pixels around the cursor
//!      an edge's number nearest to it, within EDGE_PX ─▶ edge ─▶ an end of it within VERTEX_PX on the screen ─▶ vertex
//!      else the face of the cursor's own pixel         ─▶ face, and (u, v) ─Newton─▶ the point under the cursor, in f64
//! ```
//!
//! [`snap`] finds points. [`step`] selects one item after another without a cursor.

pub mod snap;
pub mod step;

use crate::session::{Picked, World};
use glam::{DAffine3, DVec2, DVec3};
use selvedge::model::{Camera, TrimLoop};
use selvedge::spline::{Bezier, Jet2, Surface};
use std::collections::BTreeSet;

/// Pixels from the cursor within which an edge is picked, and not the face under it.
const EDGE_PX: f64 = 3.0;
/// The same of an edge's end.
const VERTEX_PX: f64 = 7.0;

/// Chords of one curve of a loop, when the loop nearest to a point is looked for.
const CHORDS: usize = 16;

/// One pixel of the engine's images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Along the view axis, `+inf` for background.
    pub depth: f32,
    /// [`Face::id`](selvedge::model::Face::id), 0 for background.
    pub face: u32,
    /// In the face's domain.
    pub uv: [f32; 2],
    /// Outward.
    pub normal: [f32; 3],
    /// Number of the edge over all parts, from 1 on; 0 without one.
    pub edge: u32,
    /// Number of the part, from 1 on; 0 for background and Boolean solids.
    pub part: u32,
    /// Number of the instance, from 1 on; 0 for background and Boolean solids.
    pub instance: u32,
}

/// Pixels around the cursor.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// The first one's place in the picture.
    pub corner: (u32, u32),
    /// Of a row.
    pub width: u32,
    /// Row after row.
    pub samples: Vec<Sample>,
}

/// A face of the shown picture, or all faces of an instance, as the composite pass marks them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Mark {
    /// As in [`Sample::instance`].
    pub instance: u32,
    /// As in [`Sample::face`]; 0: every face.
    pub face: u32,
}

/// The kinds of items that may be picked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum PickFilter {
    #[default]
    Any,
    Faces,
    Edges,
    Vertices,
    Parts,
    /// Points to measure from and to.
    Points,
}

impl PickFilter {
    /// All of them, as menus list them.
    pub const ALL: [Self; 6] = [Self::Any, Self::Faces, Self::Edges, Self::Vertices, Self::Parts, Self::Points];

    /// As menus name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Any => "Anything",
            Self::Faces => "Faces",
            Self::Edges => "Edges",
            Self::Vertices => "Vertices",
            Self::Parts => "Parts",
            Self::Points => "Points",
        }
    }
}

/// The item under the cursor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The item; `None` over the background.
    pub picked: Option<Picked>,
    /// The point under the cursor, model coordinates; exact on spline faces.
    pub point: Option<DVec3>,
}

/// The picture that is picked from.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    /// The session's model.
    pub world: &'a World,
    /// Of each of the picture's instances the number in it.
    pub instances: &'a [usize],
    /// Numbers in the world of what is not shown.
    pub hidden: &'a BTreeSet<usize>,
    /// Where the picture has an instance of the world: part coordinates to the picture's.
    pub placement: &'a dyn Fn(usize) -> DAffine3,
    /// Of the picture.
    pub camera: &'a Camera,
}

impl Seen<'_> {
    /// The world's instance of a number in the picture.
    fn instance(&self, number: u32) -> Option<usize> {
        self.instances.get((number as usize).checked_sub(1)?).copied()
    }
}

impl Samples {
    fn at(&self, pixel: (u32, u32)) -> Option<&Sample> {
        let (x, y) = (pixel.0.checked_sub(self.corner.0)?, pixel.1.checked_sub(self.corner.1)?);
        (x < self.width).then(|| self.samples.get((y * self.width + x) as usize)).flatten()
    }

    /// The pixel under the cursor.
    fn under(&self, cursor: DVec2) -> Option<&Sample> {
        self.at((cursor.x.max(0.0) as u32, cursor.y.max(0.0) as u32))
    }

    /// Each pixel with the place of its centre.
    fn pixels(&self) -> impl Iterator<Item = (DVec2, &Sample)> {
        let (width, corner) = (self.width.max(1), self.corner);
        (0..).zip(&self.samples).map(move |(i, sample): (u32, _)| {
            (DVec2::new(f64::from(corner.0 + i % width), f64::from(corner.1 + i / width)) + 0.5, sample)
        })
    }

    /// Each pixel with its distance from a place, in pixels.
    fn around(&self, place: DVec2) -> impl Iterator<Item = (f64, &Sample)> {
        self.pixels().map(move |(pixel, sample)| (pixel.distance(place), sample))
    }

    /// Instance, part and edge of a sample with an edge, at `place`.
    fn edge_at(&self, seen: &Seen<'_>, found: &Sample, place: DVec2) -> Option<(usize, usize, usize)> {
        let (part, edge) = seen.world.edge(found.edge)?;
        // a line beside a silhouette lies over another part, or over none
        let of_part = |s: &Sample| s.part as usize == part + 1;
        let beside = || self.around(place).filter(|(_, s)| of_part(s)).min_by(|a, b| a.0.total_cmp(&b.0));
        let number = if of_part(found) { found.instance } else { beside()?.1.instance };
        Some((seen.instance(number)?, part, edge))
    }

    /// The item under `cursor`, pixels of the picture.
    pub fn pick(&self, seen: &Seen<'_>, cursor: DVec2, filter: PickFilter) -> Hit {
        let Seen { world, placement, camera, .. } = *seen;
        let Some(sample) = self.under(cursor) else {
            return Hit { picked: None, point: None };
        };
        let instance = seen.instance(sample.instance);
        let face = instance.and_then(|i| Some((i, world.face(world.model.instances[i].part, sample.face)?)));
        let under = (sample.face != 0).then(|| {
            let near = near(camera, cursor, sample.depth);
            let uv = DVec2::new(f64::from(sample.uv[0]), f64::from(sample.uv[1]));
            let exact = face.and_then(|(instance, face)| {
                let part = world.model.instances[instance].part;
                let (surface, transform) = (&world.model.parts[part].faces[face].surface, placement(instance));
                let back = transform.inverse();
                let ray = (back.transform_point3(near), back.transform_vector3(camera.ray(cursor).1));
                let (uv, point) = on_surface(surface, ray, uv)?;
                Some((uv, transform.transform_point3(point)))
            });
            exact.unwrap_or((uv, near))
        });
        let point = under.map(|(_, point)| point);
        let edge = || {
            let near = self.around(cursor).filter(|(distance, s)| s.edge != 0 && *distance <= EDGE_PX);
            let (_, found) = near.min_by(|a, b| a.0.total_cmp(&b.0))?;
            self.edge_at(seen, found, cursor)
        };
        let vertex = || {
            let (instance, part, edge) = edge()?;
            let transform = placement(instance);
            let edges = world.edges_of(part)?;
            let on_screen = |vertex: &usize| {
                let p = transform.transform_point3(*edges.vertices.get(*vertex)?);
                Some((camera.project(p)?.0.distance(cursor), *vertex))
            };
            let ends = edges.edges.get(edge)?.ends;
            let nearest = ends.iter().filter_map(on_screen).min_by(|a, b| a.0.total_cmp(&b.0))?;
            (nearest.0 <= VERTEX_PX).then_some(Picked::Vertex { instance, vertex: nearest.1 })
        };
        let as_edge = || edge().map(|(instance, _, edge)| Picked::Edge { instance, edge });
        let as_face = || match face {
            Some((instance, face)) => under.map(|(uv, _)| Picked::Face { instance, face, uv }),
            None => (sample.face != 0).then_some(Picked::Number { instance, id: sample.face }),
        };
        let picked = match filter {
            PickFilter::Any => vertex().or_else(as_edge).or_else(as_face),
            PickFilter::Faces => as_face(),
            PickFilter::Edges => as_edge(),
            PickFilter::Vertices => vertex(),
            PickFilter::Parts => instance.map(Picked::Instance).or_else(as_face),
            PickFilter::Points => self.snap(seen, cursor, face),
        };
        Hit { picked, point }
    }
}

/// The point at a pixel of the picture, as deep as the picture says, model coordinates.
fn near(camera: &Camera, cursor: DVec2, depth: f32) -> DVec3 {
    let (origin, direction) = camera.ray(cursor);
    let (_, _, forward) = camera.axes();
    origin + direction * (f64::from(depth) / direction.dot(forward))
}

/// The parameters and the point where a ray meets a surface, near `uv`. `None` where it does not, as beside the
/// borders.
///
/// Accuracy: some roundings of the surface's coordinates.
pub fn on_surface(surface: &Surface, ray: (DVec3, DVec3), uv: DVec2) -> Option<(DVec2, DVec3)> {
    let (uv, point, distance) = towards(surface, ray, uv)?;
    let (low, high) = surface.bounds();
    // a point off the ray is no meeting
    (distance <= 1e-9 * (high - low).length()).then_some((uv, point))
}

/// The parameters within the domain at which Newton's method gets no nearer to a ray, with the point there and its
/// distance from the ray. It solves for two planes through the ray, with steps that are halved until they lead nearer.
pub fn towards(surface: &Surface, (origin, direction): (DVec3, DVec3), uv: DVec2) -> Option<(DVec2, DVec3, f64)> {
    const STEPS: usize = 40;
    const HALVINGS: i32 = 8;
    let (a, b) = direction.normalize().any_orthonormal_pair();
    let ((u0, u1), (v0, v1)) = surface.domain();
    let (low, high) = (DVec2::new(u0, v0), DVec2::new(u1, v1));
    let off = |jet: &Jet2| DVec2::new((jet.point - origin).dot(a), (jet.point - origin).dot(b));
    let mut at = uv.clamp(low, high);
    let mut jet = surface.jet2(at.x, at.y);
    let mut apart = off(&jet);
    for _ in 0..STEPS {
        let (fu, fv, gu, gv) = (jet.du.dot(a), jet.dv.dot(a), jet.du.dot(b), jet.dv.dot(b));
        let det = fu * gv - fv * gu;
        let step = DVec2::new(apart.x * gv - apart.y * fv, apart.y * fu - apart.x * gu) / det;
        if !step.is_finite() {
            break;
        }
        let nearer = (0..HALVINGS).find_map(|halvings| {
            let next = (at - step * 0.5_f64.powi(halvings)).clamp(low, high);
            let there = surface.jet2(next.x, next.y);
            (off(&there).length() < apart.length()).then_some((next, there))
        });
        let Some((next, there)) = nearer else { break };
        (at, jet) = (next, there);
        apart = off(&jet);
    }
    apart.is_finite().then(|| (at, jet.point, apart.length()))
}

/// The loop on a surface that passes nearest to the point at `uv`, by distances in space; the first of several. `None`
/// without loops.
///
/// Accuracy: each curve is followed by sixteen chords.
pub fn nearest_loop<'a>(surface: &Surface, loops: impl IntoIterator<Item = &'a TrimLoop>, uv: DVec2) -> Option<usize> {
    let from = surface.point(uv.x, uv.y);
    let on_curve = |curve: Bezier<DVec3>| (0..CHORDS).map(move |i| curve.point(i as f64 / CHORDS as f64));
    let distance = |trim_loop: &TrimLoop| {
        let places = trim_loop.curves().flat_map(on_curve).map(|at| surface.point(at.x, at.y));
        let places: Vec<DVec3> = places.collect();
        let next = places.iter().cycle().skip(1);
        places.iter().zip(next).map(|(a, b)| to_chord(from, *a, *b)).fold(f64::INFINITY, f64::min)
    };
    let all = loops.into_iter().map(distance).enumerate();
    all.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(nth, _)| nth)
}

/// The distance of a point from a chord.
fn to_chord(from: DVec3, a: DVec3, b: DVec3) -> f64 {
    let (along, squared) = (b - a, a.distance_squared(b));
    let share = if squared > 0.0 { ((from - a).dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
    from.distance(a + along * share)
}

#[cfg(test)]
mod tests;
