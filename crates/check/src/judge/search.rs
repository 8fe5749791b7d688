//! The smallest offset from a pixel centre at which the reference shows the drawn face.
//!
//! ```text
//!        · · ·         1. rings of 32 directions, from 1/32 px to 2 px or a larger limit_px, until one answers yes
//!      ·   ·   ·       2. between neighbours of a ring, and between rings, whose answers differ:
//!     ·  · + ·  ·         bisection, which runs into any face too thin for the rings
//!      ·   ·   ·       3. after the rings within limit_px: a grid of 1/64 px, or limit_px / 128, within it, for
//!        · · ·            faces between equal answers
//!                      4. the offset found is pulled in along its ray, then turned to either side
//! ```
//!
//! The result is an upper bound: the reference was checked at that very offset. One error can be missed, and is then
//! called gross: a gap thinner than the grid's spacing with the same face on both sides.
//!
//! Where a face lies within another part's face, the bisections run into the rim of the contact, too.

use super::super::{Probe, Tracer};
use super::{Class, LEAST_REACH_PX, TOUCHING, fold_depth, reach_px};
use crate::model::Camera;
use glam::{DVec2, DVec3};
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

/// Radii of the rings within the least reach, pixels.
const RINGS: [f64; 14] =
    [0.03125, 0.0625, 0.125, 0.1875, 0.25, 0.3125, 0.375, 0.4375, 0.5, 0.75, 1.0, 1.25, 1.5, LEAST_REACH_PX];
/// Each ring beyond these is at most so many times as wide as the one before.
const GROWTH: f64 = 1.25;
/// Directions of a ring.
const DIRECTIONS: usize = 32;
/// Bisections between two answers: down to 0.5 px / 2¹² = 1e-4 px.
const SLIVER_STEPS: u32 = 12;
/// Least spacing of the grid.
const GRID_PX: f64 = 1.0 / 64.0;
/// Most places of the grid along a radius: at larger limits the grid is wider, and its rays cost the same.
const GRID_STEPS: f64 = LEAST_REACH_PX / GRID_PX;
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

/// The answers of a ring.
struct Ring {
    radius: f64,
    answers: [Answer; DIRECTIONS],
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
        let start = self.ask(DVec2::ZERO);
        if start == Answer::Tie {
            return Class::Tie;
        }
        // a face that begins at the very centre is the nearest hit there or not, by rounding
        if start == Answer::Yes {
            return self.right_at(0.0);
        }
        let radii = radii(self.limit);
        let (within, beyond) = radii.split_at(radii.partition_point(|radius| *radius <= self.limit));
        let mut last = Ring { radius: 0.0, answers: [start; DIRECTIONS] };
        self.on_rings(within, &mut last)
            .or_else(|| self.on_grid())
            .or_else(|| self.on_rings(beyond, &mut last))
            .unwrap_or(if self.wanted.fold { Class::WrongDepth } else { Class::Gross })
    }

    /// The class of a pixel that is right at this distance.
    fn right_at(&self, shift: f64) -> Class {
        if self.wanted.fold { Class::Fold(shift) } else { Class::Shift(shift) }
    }

    /// The first class that rings of these radii give, each wider than the last one; none where the face touches
    /// another part.
    fn on_rings(&mut self, radii: &[f64], last: &mut Ring) -> Option<Class> {
        for &radius in radii {
            if self.touches {
                break;
            }
            let offset = |k: usize| DVec2::from_angle(k as f64 * TAU / DIRECTIONS as f64) * radius;
            let answers: [Answer; DIRECTIONS] = std::array::from_fn(|k| self.ask(offset(k)));
            let yes = (0..DIRECTIONS).filter(|&k| answers[k] == Answer::Yes).map(offset);
            if let Some(nearest) = yes.map(|o| self.pulled_in(o, last.radius)).reduce(nearer) {
                let shift = self.turned(nearest).length();
                return Some(self.right_at(shift));
            }
            if radius <= self.limit && answers.contains(&Answer::Tie) {
                return Some(Class::Tie);
            }
            let mut best: Option<DVec2> = None;
            for k in 0..DIRECTIONS {
                let next = (k + 1) % DIRECTIONS;
                let spoke = offset(k) * (last.radius / radius);
                for found in [
                    self.between((offset(k), answers[k]), (offset(next), answers[next])),
                    self.between((spoke, last.answers[k]), (offset(k), answers[k])),
                ] {
                    best = [best, found].into_iter().flatten().reduce(nearer);
                }
            }
            if let Some(offset) = best {
                let shift = self.turned(offset).length();
                return Some(self.right_at(shift));
            }
            *last = Ring { radius, answers };
        }
        None
    }

    fn ask(&mut self, offset: DVec2) -> Answer {
        let pixel = self.centre + offset;
        let (camera, reach) = (self.probe.camera(), reach_px(self.limit));
        let touching = TOUCHING * self.slack;
        let hits = self.probe.within(pixel, touching);
        let Some(first) = hits.first() else {
            return if self.wanted.face == 0 { Answer::Yes } else { Answer::No(0, 0) };
        };
        let near = |h: &super::Hit| {
            self.wanted.depth.is_none_or(|d| (d - h.depth).abs() <= fold_depth(camera, h, camera.ray(pixel).1, reach))
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

    /// The class that the nearest place of the grid that answers yes gives; none where the face touches another part.
    fn on_grid(&mut self) -> Option<Class> {
        if self.touches {
            return None;
        }
        let spacing = GRID_PX.max(self.limit / GRID_STEPS);
        let n = (self.limit / spacing).floor() as i32;
        let mut places: Vec<(i32, i32)> =
            (-n..=n).flat_map(|j| (-n..=n).map(move |i| (i, j))).filter(|(i, j)| i * i + j * j <= n * n).collect();
        places.sort_by_key(|(i, j)| i * i + j * j);
        let offset = |(i, j): (i32, i32)| DVec2::new(f64::from(i), f64::from(j)) * spacing;
        let found = places.into_iter().map(offset).find(|&o| self.ask(o) == Answer::Yes)?;
        let shift = self.turned(found).length();
        Some(self.right_at(shift))
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

/// The radii of the rings, ascending: [`RINGS`], and wider ones up to a larger limit.
fn radii(limit: f64) -> Vec<f64> {
    let reach = reach_px(limit);
    let wider = std::iter::successors(Some(LEAST_REACH_PX), |r| (*r < reach).then(|| (r * GROWTH).min(reach))).skip(1);
    RINGS.into_iter().chain(wider).collect()
}

/// The part of the picture in which the faces can lie at all, with a margin of the search's reach.
pub(super) struct Reach {
    margin: DVec2,
    boxes: HashMap<u32, Vec<(DVec2, DVec2)>>,
}

impl Reach {
    /// Projects the boxes of the leaves, meshes and primitives of `faces`.
    pub fn new(tracer: &Tracer, camera: &Camera, limit: f64, faces: impl Iterator<Item = u32>) -> Self {
        let wanted: HashSet<u32> = faces.collect();
        let mut reach = Self { margin: DVec2::splat(reach_px(limit)), boxes: HashMap::new() };
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
        let corners: Vec<_> = corners.iter().map(|c| camera.project(*c)).collect();
        let everywhere = (DVec2::NEG_INFINITY, DVec2::INFINITY);
        let rectangle = if corners.iter().any(Option::is_none) {
            everywhere // it crosses the plane of the eye
        } else {
            let seen = corners.iter().flatten();
            seen.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), (p, _)| (lo.min(*p), hi.max(*p)))
        };
        self.boxes.entry(id).or_default().push((rectangle.0 - self.margin, rectangle.1 + self.margin));
    }

    /// `face` may be seen within the search's reach of `pixel`. Background can be anywhere.
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
