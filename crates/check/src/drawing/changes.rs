//! Where the visible surface of Boolean solids changes between two exact rays, and why.
//!
//! ```text
//!   ●─────────×─────●     halved to CLOSE px; on both sides of the change the way is looked at again
//!
//!   meeting   ╲╱     both surfaces have one depth: sharp, or smooth within a degree
//!   end       ──┐    the nearer one ends at an edge: it makes any angle with the ray
//!   fold      ──╮    it turns away from the eye: its cosine with the ray falls as the root of the distance
//! ```
//!
//! Surfaces are told apart by their numbers, which faces that coincide share. Spline faces of an operand have none:
//! there, a jump of the depth or a turn of the normal between the two rays is halved.
//!
//! Where a face or mesh that is no solid's meets a solid, a line has to be. In other places it is not known
//! ([`Why::Unsure`]):
//!
//! * where such a face hides a solid, for it has lines of its own, or lies flush on one;
//! * where an operand without an equation meets such a face or ends in front of something: it may end there by an edge
//!   of its own, by a cut, or as a facet;
//! * at meshes that are drawn as meshes.
//!
//! A view is looked at once for what is opaque, and once for each number of a face along the rays of what is seen
//! through ([`Look`]). Beside an outline of glass the faces behind it have other numbers; they change nowhere, so no
//! line is theirs.

use super::{DrawingSettings, LineKind};
use crate::model::{Camera, EdgeLimits, Isolated, Model, Primitive, Shape};
use crate::{Hit, Probe, Tracer};
use glam::DVec2;

/// Pixels to which a change is found.
const CLOSE: f64 = 1e-9;
/// Depths that differ by more than this many pixels do not meet.
const JUMP_PX: f64 = 1.0 / 64.0;
/// Between two points of a surface there may be a jump where both tangent planes miss the other by more pixels.
const SUSPECT_PX: f64 = 0.25;
/// Between two points of a spline operand there may be a crease where the normal turns by more, radians.
const SUSPECT_TURN: f64 = 0.17;
/// Pixels from a change at which the nearer surface is looked at again: does it fold?
const INSIDE: f64 = 1e-3;
/// A fold's cosine falls to less than this share over that way: to a thousandth, if it is exact.
const FALLS: f64 = 0.1;
/// The cosine of a fold where its surface is narrower than that way.
const EDGE_ON: f64 = 1e-3;
/// Radians: angles so near to a limit are not told from it.
const UNSURE: f64 = 2e-3;
/// Changes on one way that are looked for, as levels of halving.
const LEVELS: u32 = 8;
/// Pixels by which drawn lines may be farther off: where an operand without an equation may end what hides it, and
/// where caps of two solids meet.
pub(super) const OFF: f64 = 0.5;

/// Which point along a ray counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// The nearest one that is of no solid with layers.
    Opaque,
    /// The layer of this number, from 0 on, and where there are fewer, as `Opaque`: changes of layers.
    Layer(usize),
}

/// The layers at the beginning of a ray's hits: those in front of what is opaque, and of layers.
pub(super) fn layers<'h>(tracer: &Tracer, hits: &'h [Hit]) -> &'h [Hit] {
    let count = hits.iter().take_while(|hit| tracer.is_layer(hit)).count();
    let clear = hits[..count].iter().take_while(|hit| tracer.is_clear(hit)).count();
    &hits[..count.min(clear + 1)]
}

/// A ray through a place of the picture, and the point that counts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub pixel: DVec2,
    pub hit: Option<Hit>,
}

/// Why there may be a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Why {
    Line(LineKind),
    Unsure,
}

/// A place where the surface changes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change {
    pub pixel: DVec2,
    pub why: Why,
    /// Of a section.
    pub is_outline: bool,
    /// Pixels by which a line may be farther off than others.
    pub off: f64,
    /// Index into the primitives of the solids' union.
    pub primitive: usize,
}

/// What bounds a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bound {
    Equations,
    Spline,
    Mesh,
    /// A mesh that is drawn as a mesh.
    Isolated,
}

#[derive(Clone, Copy, Debug)]
struct Traits {
    bound: Bound,
    /// It cuts others open, as a section does.
    is_cut: bool,
    /// Of a solid that is drawn in layers.
    is_layer: bool,
}

/// Finds changes in one view.
#[derive(Debug)]
pub(super) struct Changes<'a> {
    tracer: &'a Tracer,
    camera: &'a Camera,
    look: Look,
    silhouettes: bool,
    /// Of each primitive of the solids' union.
    traits: Vec<Traits>,
    has_layers: bool,
    /// Some primitive has no equations.
    has_operands: bool,
}

impl<'a> Changes<'a> {
    /// `None` in a model without such Boolean solids.
    pub fn new(
        model: &Model,
        tracer: &'a Tracer,
        (camera, look): (&'a Camera, Look),
        settings: &DrawingSettings,
    ) -> Option<Self> {
        let solids = tracer.solids.as_ref()?;
        let primitives = solids.union().primitives();
        // an expression that is too large to be split is drawn as it is
        let isolated = Isolated::of(&model.solids, model.coincidence()).ok().flatten();
        let is_isolated = |p: &Primitive| isolated.iter().flat_map(|i| &i.meshes).any(|mesh| mesh.id == p.id);
        let traits = |(number, p): (usize, &Primitive)| Traits {
            bound: match &p.shape {
                Shape::Part(_) => Bound::Spline,
                Shape::Mesh(_) if is_isolated(p) => Bound::Isolated,
                Shape::Mesh(_) => Bound::Mesh,
                _ => Bound::Equations,
            },
            is_cut: model.cuts.contains(&p.id),
            is_layer: solids.is_of_clear(number),
        };
        let traits: Vec<Traits> = primitives.iter().enumerate().map(traits).collect();
        traits.iter().any(|t| t.is_layer == (look != Look::Opaque)).then(|| Self {
            tracer,
            camera,
            look,
            silhouettes: settings.silhouettes,
            has_layers: traits.iter().any(|t| t.is_layer),
            has_operands: traits.iter().any(|t| t.bound != Bound::Equations),
            traits,
        })
    }

    /// The ray through a place.
    pub fn ray(&self, pixel: DVec2, probe: &mut Probe<'_>) -> Ray {
        let hit = match self.look {
            Look::Opaque if self.has_layers => self.stop(pixel, probe),
            Look::Opaque | Look::Layer(0) => probe.first(pixel),
            Look::Layer(number) => {
                let layer = layers(self.tracer, probe.hits(pixel)).get(number).copied();
                layer.or_else(|| self.stop(pixel, probe))
            }
        };
        Ray { pixel, hit }
    }

    /// The nearest point of what is opaque along the ray through a place.
    fn stop(&self, pixel: DVec2, probe: &mut Probe<'_>) -> Option<Hit> {
        probe.hits(pixel).iter().find(|hit| !self.tracer.is_layer(hit)).copied()
    }

    /// Whether the ray through a place meets this face, too, as any of its layers; `close`: how far apart the depths
    /// may be.
    fn goes_on(&self, face: &Hit, pixel: DVec2, close: f64, probe: &mut Probe<'_>) -> bool {
        let primitive = self.tracer.primitive(face);
        layers(self.tracer, probe.hits(pixel)).iter().any(|hit| {
            let is_same = self.tracer.primitive(hit) == primitive && hit.surface == face.surface;
            is_same && (hit.depth - face.depth).abs() <= close
        })
    }

    /// All changes between two rays.
    pub fn between(&self, a: &Ray, b: &Ray, probe: &mut Probe<'_>) -> Vec<Change> {
        let mut out = Vec::new();
        self.search(a, b, LEVELS, probe, &mut out);
        out
    }

    fn search(&self, a: &Ray, b: &Ray, levels: u32, probe: &mut Probe<'_>, out: &mut Vec<Change>) {
        if levels == 0 {
            return;
        }
        if self.is_one(a, b) {
            if self.is_suspect(a, b) {
                self.search_within(a, b, levels, probe, out);
            }
            return;
        }
        let (mut low, mut high) = (*a, *b);
        while low.pixel.distance(high.pixel) > CLOSE {
            let middle = self.ray(0.5 * (low.pixel + high.pixel), probe);
            if self.is_one(&low, &middle) { low = middle } else { high = middle }
        }
        self.search(a, &low, levels - 1, probe, out);
        out.extend(self.why(&low, &high, probe));
        self.search(&high, b, levels - 1, probe, out);
    }

    /// Two points of one surface: the largest step between them, of the normal or of the depth.
    fn search_within(&self, a: &Ray, b: &Ray, levels: u32, probe: &mut Probe<'_>, out: &mut Vec<Change>) {
        let turns = self.turns(a, b);
        let step = |p: &Ray, q: &Ray| match (&p.hit, &q.hit) {
            (Some(p), Some(q)) if turns => p.normal.distance(q.normal),
            _ => self.gap(p, q).max(0.0), // or it is no number
        };
        let (mut low, mut high) = (*a, *b);
        while low.pixel.distance(high.pixel) > CLOSE {
            let middle = self.ray(0.5 * (low.pixel + high.pixel), probe);
            if !self.is_one(&low, &middle) {
                // another surface lies between
                self.search(&low, &middle, levels - 1, probe, out);
                self.search(&middle, &high, levels - 1, probe, out);
                return;
            }
            if step(&low, &middle) >= step(&middle, &high) { high = middle } else { low = middle }
        }
        out.extend(self.why(&low, &high, probe));
    }

    /// Both rays meet one surface, as far as numbers tell, or none of a Boolean solid.
    fn is_one(&self, a: &Ray, b: &Ray) -> bool {
        let (Some(a), Some(b)) = (&a.hit, &b.hit) else { return a.hit.is_none() && b.hit.is_none() };
        let (p, q) = match (self.tracer.primitive(a), self.tracer.primitive(b)) {
            (Some(p), Some(q)) => (p, q),
            (p, q) => return p == q,
        };
        match (self.traits[p], self.traits[q]) {
            // caps of two solids have a line between them
            (s, t) if s.is_cut && t.is_cut && p != q => false,
            (s, _) if p == q && matches!(s.bound, Bound::Spline | Bound::Isolated) => true,
            // facets of a fine mesh have no lines
            (s, _) if p == q && s.bound == Bound::Mesh => {
                a.surface == b.surface || a.normal.angle_between(b.normal) < EdgeLimits::default().crease - UNSURE
            }
            _ => a.surface.is_some() && a.surface == b.surface,
        }
    }

    /// There may be a jump or a crease between two points of one surface.
    fn is_suspect(&self, a: &Ray, b: &Ray) -> bool {
        let Some(primitive) = a.hit.as_ref().and_then(|hit| self.tracer.primitive(hit)) else { return false };
        match self.traits[primitive].bound {
            Bound::Mesh | Bound::Isolated => false,
            Bound::Equations | Bound::Spline => self.turns(a, b) || self.gap(a, b) > SUSPECT_PX,
        }
    }

    /// The normal of a spline operand turns between two of its points.
    fn turns(&self, a: &Ray, b: &Ray) -> bool {
        let (Some(p), Some(q)) = (&a.hit, &b.hit) else { return false };
        let is_spline = self.tracer.primitive(p).is_some_and(|p| self.traits[p].bound == Bound::Spline);
        is_spline && p.normal.angle_between(q.normal) > SUSPECT_TURN
    }

    /// How far the tangent plane at one of two points misses the other, pixels; the less of both.
    fn gap(&self, a: &Ray, b: &Ray) -> f64 {
        let (Some(p), Some(q)) = (&a.hit, &b.hit) else { return 0.0 };
        let beyond = |from: &Hit, to: &Hit, pixel: DVec2| {
            let (origin, direction) = self.camera.ray(pixel);
            let t = (from.point - origin).dot(from.normal) / direction.dot(from.normal);
            (origin + direction * t).distance(to.point)
        };
        beyond(p, q, b.pixel).min(beyond(q, p, a.pixel)) / self.pixel_across(p.depth.min(q.depth))
    }

    /// Model units across a pixel.
    fn pixel_across(&self, depth: f64) -> f64 {
        (if self.camera.is_perspective() { depth } else { 1.0 }) / self.camera.focal_px().min_element()
    }

    /// The change between two rays that are [`CLOSE`] to each other.
    fn why(&self, low: &Ray, high: &Ray, probe: &mut Probe<'_>) -> Option<Change> {
        let depth = |ray: &Ray| ray.hit.map_or(f64::INFINITY, |hit| hit.depth);
        let (first, other) = if depth(low) <= depth(high) { (low, high) } else { (high, low) };
        let near = first.hit?;
        let [p, q] = [first, other].map(|ray| ray.hit.as_ref().and_then(|hit| self.tracer.primitive(hit)));
        let traits = |p: Option<usize>| p.map(|p| self.traits[p]);
        let either = |test: &dyn Fn(Traits) -> bool| [p, q].into_iter().filter_map(traits).any(test);
        let is_layer = |p: Option<usize>| traits(p).is_some_and(|t| t.is_layer);
        if self.look != Look::Opaque && !is_layer(p) && !is_layer(q) {
            return None;
        }
        let primitive = p.or(q)?;
        let is_outline = either(&|t| t.is_cut);
        let off = if self.has_operands { OFF } else { 0.0 };
        let pixel = 0.5 * (low.pixel + high.pixel);
        let line = |kind: LineKind| Change { pixel, why: Why::Line(kind), is_outline, off, primitive };
        let unsure = Some(Change { why: Why::Unsure, ..line(LineKind::Sharp) });
        if either(&|t| t.bound == Bound::Isolated) {
            return unsure;
        }
        let jump = JUMP_PX * self.pixel_across(near.depth);
        if depth(other) - depth(first) > jump {
            if self.look != Look::Opaque && !is_layer(p) {
                return None; // it is looked at without layers
            }
            if self.look != Look::Opaque && self.goes_on(&near, other.pixel, jump, probe) {
                return None; // as a layer of another number
            }
            // what hides a solid and is none has lines of its own
            let Some(traits) = traits(p) else { return unsure };
            return match (traits.bound, self.folds(first, other, probe)) {
                (Bound::Equations, true) => Some(Change { is_outline: false, ..line(LineKind::Silhouette) }),
                (Bound::Equations, false) => Some(Change { is_outline: traits.is_cut, ..line(LineKind::Sharp) }),
                (_, true) if !self.silhouettes => None,
                _ => unsure,
            };
        }
        let far = other.hit?;
        let limits = EdgeLimits::default();
        let angle = near.normal.angle_between(far.normal);
        let (Some(p), Some(q)) = (p, q) else {
            let is_known = self.traits[primitive].bound == Bound::Equations;
            // normals of faces that are no solid's may point either way
            let meets = angle.min(std::f64::consts::PI - angle) > limits.smooth + UNSURE;
            return if is_known && meets { Some(Change { off: OFF, ..line(LineKind::Sharp) }) } else { unsure };
        };
        let (s, t) = (self.traits[p], self.traits[q]);
        if near.surface.is_some() && near.surface == far.surface {
            let are_two = s.is_cut && t.is_cut && p != q;
            return are_two.then(|| Change { off: OFF, ..line(LineKind::Sharp) });
        }
        let is_operand = p == q && s.bound != Bound::Equations;
        let limit = if is_operand && s.bound == Bound::Mesh { limits.crease } else { limits.smooth };
        match angle - limit {
            over if over > UNSURE => Some(line(LineKind::Sharp)),
            over if over < -UNSURE && is_operand => None,
            over if over < -UNSURE => Some(line(LineKind::Smooth)),
            // or there is no normal
            _ => unsure,
        }
    }

    /// The nearer of two surfaces turns away from the eye.
    fn folds(&self, first: &Ray, other: &Ray, probe: &mut Probe<'_>) -> bool {
        let way = (first.pixel - other.pixel).normalize_or_zero();
        let inside = self.ray(first.pixel + way * INSIDE, probe);
        let cosine = |ray: &Ray| ray.hit.map_or(0.0, |hit| hit.normal.dot(self.camera.ray(ray.pixel).1).abs());
        let most = if self.is_one(first, &inside) { FALLS * cosine(&inside) } else { EDGE_ON };
        cosine(first) < most
    }
}
