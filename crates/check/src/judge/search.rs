//! The smallest offset from a pixel centre at which the reference shows the drawn face.
//!
//! ```text
//!        · · ·         1. rings of 32 directions, from 1/32 to 2 px, until one answers yes
//!      ·   ·   ·       2. between neighbours of a ring, and between rings, whose answers differ:
//!     ·  · + ·  ·         bisection, which runs into any face too thin for the rings
//!      ·   ·   ·       3. before the rings beyond limit_px: a grid of 1/64 px within it, for faces
//!        · · ·            between equal answers
//!                      4. the offset found is pulled in along its ray, then turned to either side
//! ```
//!
//! The result is an upper bound: the reference was checked at that very offset. One error can be missed, and is then
//! called gross: a gap thinner than 1/64 px with the same face on both sides.
//!
//! Where a face lies within another part's face, the bisections run into the rim of the contact, too.

use super::super::{Probe, Tracer};
use super::{Class, TOUCHING, fold_depth};
use crate::model::Camera;
use glam::{DVec2, DVec3};
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

/// Radii of the rings in pixels.
const RINGS: [f64; 14] = [0.03125, 0.0625, 0.125, 0.1875, 0.25, 0.3125, 0.375, 0.4375, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0];
/// Directions of a ring.
const DIRECTIONS: usize = 32;
/// Bisections between two answers: down to 0.5 px / 2¹² = 1e-4 px.
const SLIVER_STEPS: u32 = 12;
/// Spacing of the grid.
const GRID_PX: f64 = 1.0 / 64.0;
/// A shift is pulled in until it is known to this, pixels.
const RESOLUTION_PX: f64 = 1.0 / 256.0;

/// The face and depth that the reference should show.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    /// Face id, 0 for background.
    pub face: u32,
    /// The drawn depth, if it is known.
    pub depth: Option<f64>,
    /// The face is right, and the depth is wanted.
    pub fold: bool,
}

/// The truth at one offset.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Answer {
    Yes,
    /// The wanted face, behind another by less than a tie.
    Tie,
    /// The wanted face where it touches another instance's face, and neither is hidden.
    Touching,
    /// Another face: face, instance.
    No(u32, usize),
}

/// One pixel's search.
pub(super) struct Search<'s, 'p> {
    pub probe: &'s mut Probe<'p>,
    pub centre: DVec2,
    pub wanted: Wanted,
    pub limit: f64,
    pub slack: f64,
    /// The wanted face touches another part within the limit.
    pub touches: bool,
}

impl Search<'_, '_> {
    /// [`Class::Tie`], [`Class::Shift`] or [`Class::Fold`] with its distance, or [`Class::Gross`] (for
    /// a fold [`Class::WrongDepth`]).
    pub fn run(mut self) -> Class {
        match self.nearest() {
            Class::Shift(s) if s <= self.limit => Class::Shift(s),
            Class::Fold(s) if s <= self.limit => Class::Fold(s),
            _ if self.touches => Class::Tie,
            class => class,
        }
    }

    fn nearest(&mut self) -> Class {
        let fold = self.wanted.fold;
        let shift = |s: f64| if fold { Class::Fold(s) } else { Class::Shift(s) };
        let start = self.ask(DVec2::ZERO);
        if start == Answer::Tie {
            return Class::Tie;
        }
        // a face that begins at the very centre is the nearest hit there or not, by rounding
        if start == Answer::Yes {
            return shift(0.0);
        }
        let mut inner = 0.0;
        let mut before = [start; DIRECTIONS];
        let mut beyond = false;
        for radius in RINGS {
            if self.touches {
                break;
            }
            if radius > self.limit && !beyond {
                beyond = true;
                if let Some(offset) = self.on_grid() {
                    return shift(self.turned(offset).length());
                }
            }
            let offset = |k: usize| DVec2::from_angle(k as f64 * TAU / DIRECTIONS as f64) * radius;
            let answers: [Answer; DIRECTIONS] = std::array::from_fn(|k| self.ask(offset(k)));
            let yes = (0..DIRECTIONS).filter(|&k| answers[k] == Answer::Yes).map(offset);
            if let Some(nearest) = yes.map(|o| self.pulled_in(o, inner)).reduce(nearer) {
                return shift(self.turned(nearest).length());
            }
            if radius <= self.limit && answers.contains(&Answer::Tie) {
                return Class::Tie;
            }
            let mut best: Option<DVec2> = None;
            for k in 0..DIRECTIONS {
                let next = (k + 1) % DIRECTIONS;
                let spoke = offset(k) * (inner / radius);
                for found in [
                    self.between((offset(k), answers[k]), (offset(next), answers[next])),
                    self.between((spoke, before[k]), (offset(k), answers[k])),
                ] {
                    best = [best, found].into_iter().flatten().reduce(nearer);
                }
            }
            if let Some(offset) = best {
                return shift(self.turned(offset).length());
            }
            (inner, before) = (radius, answers);
        }
        if fold { Class::WrongDepth } else { Class::Gross }
    }

    fn ask(&mut self, offset: DVec2) -> Answer {
        let pixel = self.centre + offset;
        let camera = self.probe.camera();
        let touching = TOUCHING * self.slack;
        let hits = self.probe.within(pixel, touching);
        let Some(first) = hits.first() else {
            return if self.wanted.face == 0 { Answer::Yes } else { Answer::No(0, 0) };
        };
        let near = |h: &super::Hit| {
            self.wanted.depth.is_none_or(|d| (d - h.depth).abs() <= fold_depth(camera, h, camera.ray(pixel).1))
        };
        let matches = |h: &&super::Hit| h.face == self.wanted.face && (!self.wanted.fold || near(h));
        if matches(&first) {
            return Answer::Yes;
        }
        let touches = |h: &super::Hit| {
            let beside = |other: &super::Hit| other.instance != h.instance && (other.depth - h.depth).abs() <= touching;
            near(h) && hits.iter().any(beside)
        };
        if hits.iter().filter(matches).any(touches) {
            self.touches |= offset.length() <= self.limit;
            return Answer::Touching;
        }
        let is_tie = hits.iter().filter(matches).any(|h| h.depth <= first.depth + self.slack);
        if is_tie { Answer::Tie } else { Answer::No(first.face, first.instance) }
    }

    /// Between two places with different answers: a third answer that is the wanted one.
    fn between(&mut self, a: (DVec2, Answer), b: (DVec2, Answer)) -> Option<DVec2> {
        let (mut a, mut b) = (a, b);
        if a.1 == b.1 {
            return None;
        }
        for _ in 0..SLIVER_STEPS {
            let middle = (a.0 + b.0) * 0.5;
            match self.ask(middle) {
                Answer::Yes => return Some(middle),
                answer if answer == a.1 => a.0 = middle,
                answer => b = (middle, answer),
            }
        }
        None
    }

    /// Nearest place of the grid that answers yes.
    fn on_grid(&mut self) -> Option<DVec2> {
        let n = (self.limit.min(RINGS[RINGS.len() - 1]) / GRID_PX).floor() as i32;
        let mut places: Vec<(i32, i32)> =
            (-n..=n).flat_map(|j| (-n..=n).map(move |i| (i, j))).filter(|(i, j)| i * i + j * j <= n * n).collect();
        places.sort_by_key(|(i, j)| i * i + j * j);
        let offset = |(i, j): (i32, i32)| DVec2::new(f64::from(i), f64::from(j)) * GRID_PX;
        places.into_iter().map(offset).find(|&o| self.ask(o) == Answer::Yes)
    }

    /// Moved towards the centre, but not inside the radius `inner`, as far as the answer stays yes.
    fn pulled_in(&mut self, offset: DVec2, inner: f64) -> DVec2 {
        let direction = offset.normalize();
        let (mut no, mut yes) = (inner, offset.length());
        while yes - no > RESOLUTION_PX {
            let middle = (no + yes) * 0.5;
            if self.ask(direction * middle) == Answer::Yes { yes = middle } else { no = middle }
        }
        direction * yes
    }

    /// Turned by ever smaller angles wherever that brings it nearer.
    fn turned(&mut self, mut offset: DVec2) -> DVec2 {
        let mut angle = 0.5 * TAU / DIRECTIONS as f64;
        for _ in 0..4 {
            for turn in [angle, -angle] {
                let shorter = (offset.length() - RESOLUTION_PX * 0.5).max(0.0);
                let candidate = DVec2::from_angle(turn).rotate(offset).normalize_or_zero() * shorter;
                if self.ask(candidate) == Answer::Yes {
                    offset = self.pulled_in(candidate, (shorter * 0.5).min(shorter));
                }
            }
            angle *= 0.5;
        }
        offset
    }
}

fn nearer(a: DVec2, b: DVec2) -> DVec2 {
    if a.length() <= b.length() { a } else { b }
}

/// The part of the picture in which the faces can lie at all, with 2 px of margin.
pub(super) struct Reach {
    boxes: HashMap<u32, Vec<(DVec2, DVec2)>>,
}

impl Reach {
    /// Projects the boxes of the leaves, meshes and primitives of `faces`.
    pub fn new(tracer: &Tracer, camera: &Camera, faces: impl Iterator<Item = u32>) -> Self {
        let wanted: HashSet<u32> = faces.collect();
        let mut reach = Self { boxes: HashMap::new() };
        if wanted.is_empty() {
            return reach;
        }
        for placed in &tracer.placed {
            let part = &tracer.parts[placed.part];
            let leaves = part.leaves.iter().zip(&part.boxes);
            let leaves = leaves.map(|(leaf, bounds)| (part.faces[leaf.face as usize].id, *bounds));
            // the whole of a mesh: searching it in vain costs less than a box a triangle
            let meshes = part.facets.meshes().iter().map(|m| (m.id, m.bounds()));
            for (id, bounds) in leaves.chain(meshes) {
                if bounds.is_empty() || !wanted.contains(&id) {
                    continue;
                }
                reach.add(id, camera, &bounds.corners().map(|c| placed.to_model.transform_point3(c)));
            }
        }
        let primitives = tracer.solids.iter().flat_map(|s| s.union().primitives());
        for p in primitives.filter(|p| wanted.contains(&p.id)) {
            let bounds = p.bounds();
            if bounds.diagonal().is_finite() && !bounds.is_empty() {
                reach.add(p.id, camera, &bounds.corners());
            } else {
                let everywhere = (DVec2::NEG_INFINITY, DVec2::INFINITY);
                reach.boxes.entry(p.id).or_default().push(everywhere);
            }
        }
        reach
    }

    fn add(&mut self, id: u32, camera: &Camera, corners: &[DVec3]) {
        let margin = DVec2::splat(RINGS[RINGS.len() - 1]);
        let corners: Vec<_> = corners.iter().map(|c| camera.project(*c)).collect();
        let everywhere = (DVec2::NEG_INFINITY, DVec2::INFINITY);
        let rectangle = if corners.iter().any(Option::is_none) {
            everywhere // it crosses the plane of the eye
        } else {
            let seen = corners.iter().flatten();
            seen.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), (p, _)| (lo.min(*p), hi.max(*p)))
        };
        self.boxes.entry(id).or_default().push((rectangle.0 - margin, rectangle.1 + margin));
    }

    /// `face` may be seen within 2 px of `pixel`. Background can be anywhere.
    pub fn near(&self, face: u32, pixel: DVec2) -> bool {
        let holds = |(lo, hi): &(DVec2, DVec2)| lo.cmple(pixel).all() && hi.cmpge(pixel).all();
        face == 0 || self.boxes.get(&face).is_some_and(|boxes| boxes.iter().any(holds))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::shapes::*;
    use glam::DAffine3;

    #[test]
    fn what_is_right_at_the_centre_has_no_shift() {
        let sheet = face(1, rectangle(DVec3::new(-0.5, -0.5, 0.0), DVec3::X, DVec3::Y), vec![]);
        let tracer = Tracer::new(&model(vec![sheet], &[DAffine3::IDENTITY]));
        let camera = view(DVec3::new(0.3, 0.2, 3.0));
        let centre = DVec2::new(f64::from(camera.size.0), f64::from(camera.size.1)) * 0.5;
        let wanted = Wanted { face: 1, depth: None, fold: false };
        let probe = &mut tracer.probe(&camera);
        let search = Search { probe, centre, wanted, limit: 0.5, slack: 1e-6, touches: false };
        assert_eq!(search.run(), Class::Shift(0.0));
    }
}
