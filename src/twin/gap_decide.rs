//! Twin of `glsl/include/gap_candidate.glsl` and `gap_decide.glsl`: decides the visible face of a gap candidate, from
//! the pixel's situation and its candidates. Order and names of the rules are those of docs/design/gaps.md.
//!
//! ```text
//!   candidates ──consider, one by one──▶ Evidence ──▶ decide ──▶ word of the visibility buffer
//! ```
//!
//! The choice equals the shader's unless two compared depths differ only by rounding.

use crate::abi::Frame;
use crate::abi::constants::gap_decide::SAME_DEPTH;
use crate::abi::constants::gap_radius::GAP_SLACK;
pub use crate::abi::constants::on_pixel::ON_PIXEL_PX;

/// Farther than every point.
pub const FARTHEST: f32 = 3.0e38;

/// The face at the pixel's centre.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Not there.
    #[default]
    Absent,
    /// A border or silhouette of it is within the gap radius.
    Near,
    /// Its surface passes the centre, inside its trims; for the pixel's own face, the whole gap radius is inside.
    Present,
}

/// The pixel that showed a candidate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum From {
    /// The next pixel.
    #[default]
    Beside,
    /// A pixel beyond other gap candidates.
    Beyond,
    /// The pixel's own face, across a silhouette.
    Fold,
}

/// The end of a face near the pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outline {
    /// The sum of the gap radius's points in the face, pixels; zero if all are.
    pub into: [f32; 2],
    /// In the other direction, the face does not reach half of the gap radius.
    pub ends: bool,
}

/// A face that may be visible there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Whether it is there.
    pub kind: Kind,
    /// The pixel that showed it.
    pub from: From,
    /// Number in the scene, + 1; 0 for meshes and solids.
    pub face: u32,
    /// Number of the instance of its part.
    pub instance: u32,
    /// Its trims contain the centre.
    pub inside: bool,
    /// It is turned away from the viewer.
    pub away: bool,
    /// At the centre; larger is farther.
    pub depth: f32,
    /// Distance from the centre to the nearest point of its surface, in pixels.
    pub miss: f32,
    /// Slope of its depth, per pixel.
    pub slope: [f32; 2],
    /// Its word for the visibility buffer.
    pub word: [u32; 2],
    /// Its end near the pixel.
    pub outline: Outline,
}

impl Default for Candidate {
    fn default() -> Self {
        Self {
            kind: Kind::Absent,
            from: From::Beside,
            face: 0,
            instance: 0,
            inside: false,
            away: false,
            depth: FARTHEST,
            miss: FARTHEST,
            slope: [0.0; 2],
            word: [0; 2],
            outline: Outline::default(),
        }
    }
}

/// The reason why the pixel is a gap candidate, and the pixel's surroundings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Situation {
    /// A border lies before the visible surface, or the eye is within a solid; else a back face is visible.
    pub border: bool,
    /// No border is near: the pixel is empty, between patches on both sides.
    pub isolated: bool,
    /// The pixel shows no patch.
    pub empty: bool,
    /// A neighbour shows the background.
    pub empty_beside: bool,
    /// A neighbour shows a mesh or solid.
    pub other_beside: bool,
    /// Depth of a mesh or solid behind the pixel.
    pub other: Option<f32>,
    /// A volume trims the scene.
    pub cut_open: bool,
    /// The eye is in a solid.
    pub in_solid: bool,
    /// Word of the visibility buffer.
    pub seen: [u32; 2],
    /// The visible face; absent if there is none.
    pub own: Candidate,
}

impl Situation {
    /// A back face whose trims contain the whole gap radius: the pixel shows a solid's inside.
    fn is_interior(&self) -> bool {
        !self.border && self.own.kind == Kind::Present
    }

    fn own_on_pixel(&self) -> bool {
        self.own.kind != Kind::Absent && self.own.miss <= ON_PIXEL_PX
    }

    /// Candidates beyond this depth are ignored.
    fn depth_limit(&self) -> f32 {
        if self.is_interior() { self.own.depth * (1.0 - SAME_DEPTH) } else { FARTHEST }
    }
}

/// The visible face, as a word of the visibility buffer.
pub fn decide(frame: &Frame, situation: &Situation, candidates: &[Candidate]) -> [u32; 2] {
    let mut evidence = Evidence::new(frame, situation);
    candidates.iter().for_each(|c| evidence.consider(c));
    evidence.decide()
}

/// The candidates on which the decision depends.
struct Evidence<'a> {
    frame: &'a Frame,
    s: &'a Situation,
    /// The nearest present one.
    present: Candidate,
    /// The nearest near one.
    near: Candidate,
    /// The nearest near one of another face.
    second: Candidate,
    /// The nearest front that touches the visible back face.
    touching: Candidate,
    /// The one whose surface passes closest to the centre, preferably before the back face.
    closest: Candidate,
    closest_before: bool,
    /// The near ones belong to two faces.
    edge: bool,
    /// The last face that met the own one.
    met: u32,
    /// Two faces meet the own one.
    corner: bool,
}

/// A mesh or solid in the pixel itself.
fn other_candidate(depth: f32) -> Candidate {
    Candidate { kind: Kind::Present, inside: true, depth, miss: 0.0, ..Candidate::default() }
}

/// Whether faces of two parts lie in each other: within rounding, neither is before the other.
fn coincide(a: &Candidate, b: &Candidate) -> bool {
    let two_parts = a.face != 0 && b.face != 0 && a.instance != b.instance;
    two_parts && (a.depth - b.depth).abs() <= 2.0 * SAME_DEPTH * a.depth.max(b.depth)
}

/// Whether `a` is seen rather than `b`. Where parts touch, a front is; of two fronts or two backs, that of the lower
/// instance.
fn precedes(a: &Candidate, b: &Candidate) -> bool {
    if !coincide(a, b) {
        a.depth < b.depth
    } else if a.away != b.away {
        b.away
    } else {
        a.instance < b.instance
    }
}

fn dot(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

/// Whether `a` hides `b` up to a silhouette in which both end here; derived in `gap_decide.glsl`.
fn covers(a: &Candidate, b: &Candidate) -> bool {
    if a.miss.max(b.miss) > ON_PIXEL_PX {
        return false; // a surface's own silhouette
    }
    let (of_a, of_b) = (a.outline, b.outline);
    let together = dot(of_a.into, of_b.into) > 0.0 && of_a.ends && of_b.ends;
    let slope = [a.slope[0] - b.slope[0], a.slope[1] - b.slope[1]];
    together && a.depth - b.depth + dot(slope, of_a.into) < 0.0
}

impl<'a> Evidence<'a> {
    /// The state before any candidate. If no patch is visible, a mesh or solid in the pixel is present.
    fn new(frame: &'a Frame, s: &'a Situation) -> Self {
        let none = Candidate::default();
        let present = s.other.filter(|_| s.border && s.empty).map_or(none, other_candidate);
        Self {
            frame,
            s,
            present,
            near: none,
            second: none,
            touching: none,
            closest: none,
            closest_before: false,
            edge: false,
            met: 0,
            corner: false,
        }
    }

    /// Change of its depth within the gap radius.
    fn lean(&self, c: &Candidate) -> f32 {
        GAP_SLACK * self.frame.gap_radius_px * dot(c.slope, c.slope).sqrt()
    }

    /// Whether a is before b in all of the gap radius; surfaces that meet within it are not.
    fn wholly_before(&self, a: &Candidate, b: &Candidate) -> bool {
        a.depth + self.lean(a) + self.lean(b) < b.depth
    }

    /// Distance in depth at which a front and a back count as one: the front is moved back by this.
    fn touch(&self, front: &Candidate) -> f32 {
        let px = if self.frame.perspective != 0 { front.depth } else { 1.0 } / self.frame.focal;
        let slope = front.slope[0].abs() + front.slope[1].abs() + px;
        2.0 * self.frame.deviation_px * slope + 2.0 * SAME_DEPTH * front.depth
    }

    fn consider(&mut self, c: &Candidate) {
        // rule "far front"
        if c.from != From::Beside && (c.kind != Kind::Present || c.away) {
            return;
        }
        let before = c.depth <= self.s.depth_limit();
        self.consider_closest(c, before);
        self.consider_touching(c);
        if !before {
            return;
        }
        match c.kind {
            Kind::Present if precedes(c, &self.present) => self.present = *c,
            Kind::Near => self.consider_near(c),
            _ => {}
        }
        self.consider_corner(c);
    }

    /// Rule "closest surface".
    fn consider_closest(&mut self, c: &Candidate, before: bool) {
        let misses = c.miss > ON_PIXEL_PX;
        let closer = before == self.closest_before && c.miss < self.closest.miss;
        if misses && (before && !self.closest_before || closer) {
            (self.closest, self.closest_before) = (*c, before);
        }
    }

    /// Rule "touching front".
    fn consider_touching(&mut self, c: &Candidate) {
        let front = c.from != From::Fold && c.kind == Kind::Present && !c.away;
        let touches = front && (c.depth - self.s.own.depth).abs() <= self.touch(c);
        if touches && c.depth < self.touching.depth {
            self.touching = *c;
        }
    }

    /// Rules "edge" and "common silhouette".
    fn consider_near(&mut self, c: &Candidate) {
        let another = c.face != self.near.face;
        self.edge |= self.near.face != 0 && another;
        if precedes(c, &self.near) {
            if another {
                self.second = self.near;
            }
            self.near = *c;
        } else if another && c.depth < self.second.depth {
            self.second = *c;
        }
    }

    /// Rule "hidden third".
    fn consider_corner(&mut self, c: &Candidate) {
        let own = &self.s.own;
        let meets = c.depth - self.lean(c) - self.lean(own) <= own.depth;
        if c.kind == Kind::Absent || c.face == own.face || !meets {
            return;
        }
        self.corner |= self.met != 0 && self.met != c.face;
        self.met = c.face;
    }

    /// A near face is before all that is present. It is not where it touches another part's face that is present.
    fn near_first(&self) -> bool {
        let (near, present) = (&self.near, &self.present);
        near.kind == Kind::Near && near.depth < present.depth && !coincide(near, present)
    }

    /// Rule "common silhouette", for two near ones.
    fn put_covering_first(&mut self) {
        let meet = self.second.kind == Kind::Near && !self.wholly_before(&self.near, &self.second);
        if meet && covers(&self.second, &self.near) {
            self.near = self.second;
        }
    }

    /// Rule "common silhouette", for the own face.
    fn own_is_covered(&self) -> bool {
        let nearest = if self.near_first() { &self.near } else { &self.present };
        let ends = self.s.border && self.s.own_on_pixel() && self.s.own.kind == Kind::Near;
        ends && nearest.kind != Kind::Absent && nearest.face != self.s.own.face && covers(nearest, &self.s.own)
    }

    /// Rule "grown front".
    fn own_has_grown(&self) -> bool {
        let own = &self.s.own;
        !own.inside && self.wholly_before(own, &self.present) && !self.wholly_before(&self.near, own)
    }

    /// Rule "interior back".
    fn behind_gap(&self) -> [u32; 2] {
        if self.present.kind == Kind::Present && !self.near_first() {
            self.present.word
        } else if self.near.kind == Kind::Near {
            self.near.word
        } else if self.touching.kind == Kind::Present {
            self.touching.word
        } else if self.closest.miss <= GAP_SLACK * self.frame.gap_radius_px {
            self.closest.word
        } else {
            self.s.seen
        }
    }

    fn decide(mut self) -> [u32; 2] {
        let s = self.s;
        self.put_covering_first();
        if s.is_interior() {
            return self.behind_gap();
        }
        let covered = self.own_is_covered();
        let covering_edge = covered && self.near_first();
        let third = s.own.kind == Kind::Near && self.corner;
        let mut grown = false;
        if s.border && s.own_on_pixel() && !covered && !third && precedes(&s.own, &self.present) {
            grown = self.own_has_grown();
            if s.own.inside || grown {
                self.present = Candidate { kind: Kind::Present, ..s.own };
            }
        }
        // rule "other"
        let patches_end = s.empty_beside || s.other_beside || self.present.kind == Kind::Present;
        match s.other {
            Some(depth) if !s.border && patches_end && depth < self.present.depth => {
                self.present = other_candidate(depth);
            }
            _ => {}
        }
        // rule "edge"
        let two = self.edge && self.near_first() && !grown && !s.isolated;
        // rule "outline of the part"
        let cut_open = s.cut_open && s.border && s.own_on_pixel() && s.own.inside && s.own.away;
        let outline = cut_open && self.near.kind == Kind::Near && self.near.depth < s.own.depth;
        if covering_edge || two || outline {
            return self.near.word;
        }
        if self.present.kind == Kind::Present {
            return self.present.word;
        }
        // rule "background"
        let ends = if s.border { s.empty } else { s.empty_beside };
        if ends && !s.in_solid {
            return [0; 2];
        }
        match (self.near.kind, s.other) {
            (Kind::Near, _) => self.near.word,
            (_, Some(_)) if !s.border => [0; 2],
            _ => s.seen,
        }
    }
}

#[cfg(test)]
mod tests;
