//! The faces of separate solids along a line, front to back: the reference of drawn layers.
//!
//! ```text
//!   opaque union  ─────────────────┤▒▒▒▒▒▒▒▒     one list of crossings, so that coincident faces of two solids are
//!   glass A       ──┤░░░░░░░░░░░├──────────      met at equal parameters;
//!   glass B       ──────────────┤░░░░├─────      the boundaries of each solid by itself
//!                   A           A B  B           layers: at one place, faces left before faces entered
//! ```
//!
//! An opaque face comes between the two: it hides the faces entered at the same place, and all behind it.

use super::{Boundary, Crossing, SolidTracer, Trace};
use crate::csg::{Tree, TreeError};
use crate::light::{Key, studio};
use crate::model::{Camera, Colour, Items, Primitive, Solid, SolidError};
use glam::{DVec2, DVec3, DVec4};

/// A face of a clear solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Index of the solid among [`Items::clear`].
    pub item: usize,
    /// The face.
    pub boundary: Boundary,
}

/// The solids of a model, made ready for lines.
#[derive(Debug)]
pub struct LayerTracer {
    /// Over all of them; its own tree is their union.
    all: SolidTracer,
    /// The union of those that are opaque.
    opaque: Option<Tree>,
    /// The expression of each clear solid, and its first primitive.
    clear: Vec<(Tree, u32)>,
}

impl LayerTracer {
    /// Prepares the opaque and the clear solids, not the opaque parts; `tolerance` is that of
    /// [`SurfaceTable::new`](crate::model::SurfaceTable::new).
    ///
    /// # Errors
    /// [`SolidError`] when an expression becomes too large.
    pub fn new(items: &Items, tolerance: f64) -> Result<Self, SolidError> {
        let solids = [&items.opaque[..], &items.clear[..]].concat();
        let all = SolidTracer::new(&Solid::union(&solids)?, tolerance).map_err(|e: TreeError| SolidError::Tree(e))?;
        let opaque = match items.opaque.is_empty() {
            true => None,
            false => Some(Solid::union(&items.opaque)?.tree().clone()),
        };
        let mut first = items.opaque.iter().map(|s| s.primitives().len() as u32).sum();
        let mut clear = Vec::with_capacity(items.clear.len());
        for solid in &items.clear {
            clear.push((solid.tree().clone(), first));
            first += solid.primitives().len() as u32;
        }
        Ok(Self { all, opaque, clear })
    }

    /// All solids as one.
    pub fn union(&self) -> &SolidTracer {
        &self.all
    }

    /// Some solid is clear.
    pub fn has_clear(&self) -> bool {
        !self.clear.is_empty()
    }

    /// The primitive, of [`union`](Self::union), is of a clear solid.
    pub fn is_of_clear(&self, primitive: usize) -> bool {
        self.clear.first().is_some_and(|(_, first)| primitive >= *first as usize)
    }

    /// The way through the union of the opaque solids, and through each clear one.
    pub fn traces(&self, origin: DVec3, direction: DVec3) -> (Trace, Vec<Trace>) {
        let speed = direction.length();
        if !(speed > 0.0 && speed.is_finite() && origin.is_finite()) {
            return (Trace::default(), vec![Trace::default(); self.clear.len()]);
        }
        let (crossings, state, leaks) = self.all.sorted_crossings(origin, direction);
        let end = |k: usize| self.clear.get(k).map_or(u32::MAX, |(_, first)| *first);
        let through = |tree: &Tree, first: u32, end: u32| {
            let own: Vec<Crossing> =
                crossings.iter().filter(|c| (first..end).contains(&c.primitive)).copied().collect();
            self.all.through(tree, first, &own, state.clone(), (origin, direction))
        };
        let opaque = self.opaque.as_ref().map_or_else(Trace::default, |tree| through(tree, 0, end(0)));
        let clear = self.clear.iter().enumerate().map(|(k, (tree, first))| through(tree, *first, end(k + 1)));
        (Trace { leaks, ..opaque }, clear.collect())
    }

    /// The faces of clear solids from `start` on that no opaque face hides, front to back, and the way through the
    /// opaque solids.
    pub fn layers(&self, origin: DVec3, direction: DVec3, start: f64) -> (Vec<Layer>, Trace) {
        let (opaque, clear) = self.traces(origin, direction);
        let stop = opaque.first(start);
        let hidden = |b: &Boundary| stop.is_some_and(|s| if b.entering { b.t >= s.t } else { b.t > s.t });
        let faces = clear.iter().enumerate().flat_map(|(item, trace)| {
            trace.boundaries.iter().filter(|b| b.t >= start && !hidden(b)).map(move |b| Layer { item, boundary: *b })
        });
        let mut layers: Vec<Layer> = faces.collect();
        let order = |l: &Layer| (l.boundary.entering, l.item);
        layers.sort_by(|a, b| a.boundary.t.total_cmp(&b.boundary.t).then(order(a).cmp(&order(b))));
        (layers, opaque)
    }

    /// The primitive of a face.
    pub fn primitive(&self, b: &Boundary) -> &Primitive {
        &self.all.primitives()[b.primitive as usize]
    }

    /// The linear colour and opacity at a pixel position before a background, of solids alone; a part among them has
    /// its primitive's colour. Light falls on the visible side. Each face's light is clamped to the range of a target,
    /// and weighted by its opacity in 255ths.
    pub fn colour(&self, camera: &Camera, pixel: DVec2, background: Colour) -> DVec4 {
        let (origin, direction) = camera.ray(pixel);
        let (_, _, forward) = camera.axes();
        let (near, far) = camera.depth_range;
        let cosine = direction.dot(forward);
        let (layers, opaque) = self.layers(origin, direction, near / cosine);
        let stop = opaque.first(near / cosine);
        let lit = |b: &Boundary| {
            let colour = self.primitive(b).colour;
            let stored = |c: f32| f64::from((c.clamp(0.0, 1.0) * 255.0).round()) / 255.0;
            let [r, g, b_, a] = colour.map(stored);
            let n = if b.normal.dot(direction) > 0.0 { -b.normal } else { b.normal };
            (studio(DVec3::new(r, g, b_), n, camera, Key::Lamp), a)
        };
        let within = |b: &Boundary| b.t <= far / cosine;
        let (mut sum, mut rest) = (DVec3::ZERO, 1.0);
        for layer in layers.iter().filter(|l| within(&l.boundary)) {
            let (light, opacity) = lit(&layer.boundary);
            sum += rest * opacity * light;
            rest *= 1.0 - opacity;
        }
        let [r, g, b, a] = background.map(f64::from);
        let (under, opacity) = match stop.filter(within) {
            Some(face) => (lit(&face).0, 1.0),
            None => (DVec3::new(r, g, b), a),
        };
        let all = 1.0 - rest * (1.0 - opacity);
        let colour = if all > 0.0 { (sum + rest * opacity * under) / all } else { under };
        colour.extend(all)
    }
}
