//! The part of a rectangle that closed chains of chords surround, cut into halves and finally into trapezoids.
//!
//! ```text
//!   high ┌──────╱──────┐          right half: chords left of it become steps of its left border
//!        │     ╱ ▒▒▒▒▒▒│            ┌──────┐
//!   step ┤▒▒▒▒╱▒▒▒▒▒▒▒▒│   ──────▶  │▒▒▒▒▒▒├ step      slabs between the ends of chords: in each of them
//!        │▒▒▒╱▒▒▒▒▒▒▒▒▒│            │▒▒▒▒▒▒│           what lies between two chords is a trapezoid
//!    low └──╱──────────┘            └──────┘
//! ```
//!
//! A point is surrounded if the numbers of rising and of falling chords to its left differ: the non-zero rule of
//! [`trim`](crate::trim). So chords to the right of a rectangle do not matter. Of chords to its left only the heights
//! at which they rise or fall matter; most of these steps cancel, because the chains are closed.

use glam::DVec2;

/// A rectangle and the chords in it.
#[derive(Clone, Debug)]
pub(super) struct Region {
    low: DVec2,
    high: DVec2,
    /// Winding number at the lowest points of the left border.
    around: i32,
    /// Changes of the winding number along the left border: height and step, ascending, between its ends.
    steps: Vec<(f64, i32)>,
    /// No chord is horizontal.
    chords: Vec<[DVec2; 2]>,
}

/// Corners of a trapezoid: the lower ones, then the upper ones, each from the left.
pub(super) type Trapezoid = [DVec2; 4];

impl Region {
    /// The part of a rectangle that closed chains surround. The last point of each chain is its first.
    pub fn new<'a>(chains: impl IntoIterator<Item = &'a [DVec2]>, low: DVec2, high: DVec2) -> Self {
        let chords = chains.into_iter().flat_map(|chain| chain.windows(2).map(|w| [w[0], w[1]])).collect();
        let (all, nothing) = (DVec2::INFINITY, Vec::new());
        let everywhere = Self { low: -all, high: all, around: 0, steps: nothing, chords };
        let [_, above] = everywhere.across_v(low.y);
        let [within, _] = above.across_v(high.y);
        let [_, right] = within.across_u(low.x);
        let [inside, _] = right.across_u(high.x);
        inside
    }

    /// Whether all of the rectangle is surrounded, or none of it; `None` if chords cross it.
    pub fn whole(&self) -> Option<bool> {
        (self.chords.is_empty() && self.steps.is_empty()).then_some(self.around != 0)
    }

    pub fn chord_count(&self) -> usize {
        self.chords.len()
    }

    pub fn corners(&self) -> (DVec2, DVec2) {
        (self.low, self.high)
    }

    /// The parts left and right of a line.
    pub fn across_u(&self, u: f64) -> [Self; 2] {
        let mut left = Self { high: DVec2::new(u, self.high.y), chords: Vec::new(), ..self.clone() };
        let mut right = Self { low: DVec2::new(u, self.low.y), chords: Vec::new(), ..self.clone() };
        for &[a, b] in &self.chords {
            if a.x.max(b.x) <= u {
                left.chords.push([a, b]);
                right.pass(a.y, b.y);
            } else if a.x.min(b.x) >= u {
                right.chords.push([a, b]);
            } else {
                let t = (u - a.x) / (b.x - a.x);
                let at = DVec2::new(u, (a.y + (b.y - a.y) * t).clamp(a.y.min(b.y), a.y.max(b.y)));
                let [of_left, of_right] = if a.x < u { [[a, at], [at, b]] } else { [[at, b], [a, at]] };
                left.chords.push(of_left);
                right.pass(of_left[0].y, of_left[1].y);
                right.chords.push(of_right);
            }
        }
        [left.settled(), right.settled()]
    }

    /// The parts below and above a line.
    pub fn across_v(&self, v: f64) -> [Self; 2] {
        let mut below = Self { high: DVec2::new(self.high.x, v), chords: Vec::new(), ..self.clone() };
        let mut above = Self { low: DVec2::new(self.low.x, v), chords: Vec::new(), ..self.clone() };
        for &[a, b] in &self.chords {
            if a.y.max(b.y) <= v {
                below.chords.push([a, b]);
            } else if a.y.min(b.y) >= v {
                above.chords.push([a, b]);
            } else {
                let at = DVec2::new(across(a, b, v), v);
                let [of_below, of_above] = if a.y < v { [[a, at], [at, b]] } else { [[at, b], [a, at]] };
                below.chords.push(of_below);
                above.chords.push(of_above);
            }
        }
        [below.settled(), above.settled()]
    }

    /// Adds a chord that lies left of the border, between two heights.
    fn pass(&mut self, from: f64, to: f64) {
        self.steps.extend(match from < to {
            true => [(from, 1), (to, -1)],
            false => [(to, -1), (from, 1)],
        });
    }

    /// Sorts the steps, merges those at one height, and removes steps at the border's ends and horizontal chords.
    fn settled(mut self) -> Self {
        self.chords.retain(|[a, b]| a.y != b.y);
        self.steps.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut kept: Vec<(f64, i32)> = Vec::new();
        for &(v, by) in &self.steps {
            if v <= self.low.y {
                self.around += by;
                continue;
            }
            match kept.last_mut() {
                _ if v >= self.high.y => break,
                Some(last) if last.0 == v => last.1 += by,
                _ => kept.push((v, by)),
            }
        }
        kept.retain(|step| step.1 != 0);
        self.steps = kept;
        self
    }

    /// The surrounded part as trapezoids whose lower and upper sides are horizontal. Chords that cross within a slab
    /// are sorted by its middle.
    pub fn trapezoids(&self, mut found: impl FnMut(Trapezoid)) {
        let ends = self.chords.iter().flatten().map(|p| p.y).chain(self.steps.iter().map(|s| s.0));
        let mut levels: Vec<f64> = ends.chain([self.low.y, self.high.y]).collect();
        levels.sort_unstable_by(f64::total_cmp);
        levels.dedup();
        let mut spanning: Vec<([f64; 2], i32)> = Vec::new();
        for slab in levels.windows(2) {
            let (low, high) = (slab[0], slab[1]);
            spanning.clear();
            for &[a, b] in &self.chords {
                if a.y.min(b.y) <= low && a.y.max(b.y) >= high {
                    let at = [low, high].map(|v| across(a, b, v).clamp(self.low.x, self.high.x));
                    spanning.push((at, if a.y < b.y { 1 } else { -1 }));
                }
            }
            spanning.sort_unstable_by(|(a, _), (b, _)| (a[0] + a[1]).total_cmp(&(b[0] + b[1])));
            let mut around = self.around + self.steps.iter().filter(|s| s.0 <= low).map(|s| s.1).sum::<i32>();
            let mut from = (around != 0).then_some([self.low.x; 2]);
            let mut between = |left: [f64; 2], right: [f64; 2]| {
                found([(left[0], low), (right[0], low), (left[1], high), (right[1], high)].map(DVec2::from));
            };
            for &(at, by) in &spanning {
                around += by;
                match from {
                    None if around != 0 => from = Some(at),
                    Some(left) if around == 0 => {
                        between(left, at);
                        from = None;
                    }
                    _ => {}
                }
            }
            from.into_iter().for_each(|left| between(left, [self.high.x; 2]));
        }
    }
}

/// The chord's place at a height between its ends; the same for both directions of the chord.
fn across(a: DVec2, b: DVec2, v: f64) -> f64 {
    let (a, b) = if a.y < b.y { (a, b) } else { (b, a) };
    if v == b.y {
        return b.x;
    }
    let t = (v - a.y) / (b.y - a.y);
    (a.x + (b.x - a.x) * t).clamp(a.x.min(b.x), a.x.max(b.x))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The surrounded area, by halving `levels` times, and the number of trapezoids.
    fn area(region: &Region, levels: u32) -> (f64, usize) {
        if levels > 0 && region.whole().is_none() {
            let (low, high) = region.corners();
            // not the middle, so that the halves differ
            let at = low.lerp(high, 0.37);
            let halves = if levels.is_multiple_of(2) { region.across_u(at.x) } else { region.across_v(at.y) };
            return halves.iter().map(|half| area(half, levels - 1)).fold((0.0, 0), |(a, n), (b, m)| (a + b, n + m));
        }
        let (mut sum, mut count) = (0.0, 0);
        region.trapezoids(|[a, b, c, d]| {
            // chains on top of each other are cut at places that differ by rounding
            let ordered = a.x <= b.x + 1e-12 && c.x <= d.x + 1e-12;
            assert!(a.y == b.y && c.y == d.y && a.y < c.y && ordered, "{a} {b} {c} {d}");
            sum += 0.5 * (b.x - a.x + d.x - c.x) * (c.y - a.y);
            count += 1;
        });
        (sum, count)
    }

    fn ring(middle: DVec2, radius: f64, n: u32, way: f64) -> Vec<DVec2> {
        let at =
            |k: u32| middle + radius * DVec2::from_angle(way * std::f64::consts::TAU * f64::from(k % n) / f64::from(n));
        (0..=n).map(at).collect()
    }

    /// Area of a regular polygon on a circle.
    fn polygon(radius: f64, n: u32) -> f64 {
        0.5 * f64::from(n) * radius * radius * (std::f64::consts::TAU / f64::from(n)).sin()
    }

    #[test]
    fn areas_are_those_of_polygons_however_they_are_cut() {
        let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]].map(DVec2::from);
        let (hole, other) = (ring(DVec2::new(1.5, 1.5), 1.0, 37, -1.0), ring(DVec2::new(3.0, 1.0), 0.4, 5, -1.0));
        let truth = 12.0 - polygon(1.0, 37) - polygon(0.4, 5);
        let chains: [&[DVec2]; 3] = [&square, &hole, &other];
        // the domain, a smaller rectangle, a larger one
        for (low, high, truth) in [
            (DVec2::ZERO, DVec2::new(4.0, 3.0), truth),
            (DVec2::splat(-1.0), DVec2::splat(9.0), truth),
            (DVec2::new(1.5, 0.0), DVec2::new(4.0, 3.0), 7.5 - 0.5 * polygon(1.0, 37) - polygon(0.4, 5)),
        ] {
            let region = Region::new(chains, low, high);
            for levels in 0..12 {
                let (found, count) = area(&region, levels);
                // halving an odd polygon at its middle is only nearly exact
                let slack = if low.x == 1.5 { 0.01 } else { 1e-12 };
                assert!((found - truth).abs() < slack, "{found} for {truth} after {levels} halvings");
                assert!(count > 10, "{count}");
            }
        }
    }

    /// Two turns count as one, and a turn back and forth as none.
    #[test]
    fn the_rule_is_non_zero() {
        let ring = |way| ring(DVec2::ONE, 1.0, 24, way);
        let (low, high) = (DVec2::ZERO, DVec2::splat(2.0));
        let (there, back) = (ring(1.0), ring(-1.0));
        for (chains, truth) in [([&there, &there], polygon(1.0, 24)), ([&there, &back], 0.0)] {
            let region = Region::new(chains.map(|c| c.as_slice()), low, high);
            for levels in [0, 3, 8] {
                let found = area(&region, levels).0;
                assert!((found - truth).abs() < 1e-12, "{found} for {truth}");
            }
        }
        assert_eq!(Region::new([], low, high).whole(), Some(false));
        let beyond = Region::new([there.as_slice()], DVec2::splat(0.9), DVec2::splat(1.1));
        assert_eq!(beyond.whole(), Some(true));
    }
}
