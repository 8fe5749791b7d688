//! The pre-image of an edge on its support. Points of the curve are inverted in order and unwrapped; the trace is then
//! evaluated at any parameter between them.

use super::border::Border;
use super::edge::EdgeCurve;
use super::support::Support;
use glam::DVec2;
use std::rc::Rc;

/// A function from the fraction `s` of an edge to native `(u, v)`, continuous across seams.
#[derive(Clone, Debug)]
pub(super) struct Trace {
    /// The edge.
    pub edge: Rc<EdgeCurve>,
    /// Fractions and parameters, increasing in `s`.
    pub samples: Vec<(f64, DVec2)>,
    /// The first or last sample is a pole, where one coordinate is a limit.
    pub at_pole: [bool; 2],
    /// Largest distance in mm of a sampled point of the curve from the support.
    pub gap: f64,
    /// Distance in mm from the support up to which a foot found from the neighbour's parameters is taken: no farther
    /// than where a search of the whole surface found nothing nearer.
    accept: f64,
}

/// Share of a trace that ends at a pole within its edge in which no node is a sample: the way there is halved instead.
const BESIDE: f64 = 1e-2;

impl Trace {
    /// Traces the edge over `[from, to]`. `poles`: the support's poles that its ends are, if any;
    /// `hint`: parameters near the start, for surfaces that pass twice through one point.
    pub fn new(
        support: &Support,
        edge: &Rc<EdgeCurve>,
        (from, to): (f64, f64),
        poles: [Option<usize>; 2],
        hint: Option<DVec2>,
    ) -> Self {
        // the angle of a sample beside a pole that the edge passes is inexact, and a sample at the pole has none
        let beside = |end: f64| if end > 0.0 && end < 1.0 { BESIDE * (to - from) } else { 0.0 };
        let inside = [from + beside(from), to - beside(to)];
        let mut nodes: Vec<f64> = edge.nodes().into_iter().filter(|s| *s > inside[0] && *s < inside[1]).collect();
        if nodes.len() < 3 {
            nodes = (1..4).map(|i| from + (to - from) * f64::from(i) / 4.0).collect();
        }
        // poles are approached by halving, so that a turning curve can be unwound
        const HALVINGS: i32 = 8;
        let ladder = |end: f64, first: f64| (1..=HALVINGS).map(move |k| end + (first - end) * 0.5f64.powi(k));
        let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
        match poles[0] {
            Some(_) => nodes.splice(..0, ladder(from, first).collect::<Vec<_>>().into_iter().rev()).for_each(drop),
            None => nodes.insert(0, from),
        }
        match poles[1] {
            Some(_) => nodes.extend(ladder(to, last)),
            None => nodes.push(to),
        }
        let mut this = Self::of_samples(edge, Vec::new(), 0.0);
        this.at_pole = poles.map(|p| p.is_some());
        this.accept = 1e-2 * support.eps;
        let mut hint = hint;
        for s in nodes {
            let ahead = this.ahead(s).filter(|_| support.is_iterative());
            let mut p = this.look(support, s, ahead.or(hint));
            if let (Some(_), Some(near)) = (ahead, hint) {
                p = support.unwrap(p, near);
            }
            this.step(support, s, p, 24);
            hint = Some(p);
        }
        this.add_poles(support, poles, (from, to));
        this
    }

    /// Samples taken elsewhere.
    pub fn of_samples(edge: &Rc<EdgeCurve>, samples: Vec<(f64, DVec2)>, gap: f64) -> Self {
        Self { edge: edge.clone(), samples, at_pole: [false; 2], gap, accept: gap }
    }

    /// The trace of an edge that is a border of its surface.
    pub fn along(support: &Support, edge: &Rc<EdgeCurve>, border: &Border) -> Self {
        // few: between them the pre-image is linear
        const STEPS: u32 = 8;
        let steps = (0..=STEPS).map(|i| f64::from(i) / f64::from(STEPS));
        let samples = steps.map(|s| (s, border.at(edge.parameter(s)))).collect();
        // the distance to the border bounds the distance to the surface; within twice that no search is needed
        let accept = (1e-2 * support.eps).max(2.0 * border.gap);
        Self { accept, ..Self::of_samples(edge, samples, border.gap) }
    }

    /// Inverts the point at `s`, which becomes a sample; learns how far from the support the edge may be.
    fn look(&mut self, support: &Support, s: f64, hint: Option<DVec2>) -> DVec2 {
        let point = self.edge.point(s);
        // a residual above `accept` comes from a search of the whole surface
        let (p, distance) = support.nearest(point, hint, self.accept);
        self.accept = self.accept.max(1.5 * distance);
        self.gap = self.gap.max(distance);
        p
    }

    /// Where the parabola through the last three samples is at `s`: from there Newton's method has less to do than
    /// from the last one. The line through two where the parabola goes far from it; `None` before there are two, and
    /// where the step is much longer than the last one, as behind a pole.
    fn ahead(&self, s: f64) -> Option<DVec2> {
        let [.., (s0, p0), (s1, p1)] = self.samples[..] else { return None };
        if s - s1 > 4.0 * (s1 - s0) {
            return None;
        }
        let slope = (p1 - p0) / (s1 - s0);
        let by = slope * (s - s1);
        let Some(&(s2, p2)) = self.samples.len().checked_sub(3).map(|i| &self.samples[i]) else { return Some(p1 + by) };
        let bend = (slope - (p0 - p2) / (s0 - s2)) / (s1 - s2) * ((s - s1) * (s - s0));
        Some(p1 + if bend.abs().cmple(by.abs()).all() { by + bend } else { by })
    }

    /// Appends a sample; halves the step while the parameters turn by more than an eighth of a
    /// period, which unwrapping could mistake.
    fn step(&mut self, support: &Support, s: f64, p: DVec2, depth: u32) {
        let Some(&(before, q)) = self.samples.last() else {
            self.samples.push((s, p));
            return;
        };
        let far = (0..2).any(|i| support.periods[i].is_some_and(|period| (p[i] - q[i]).abs() > 0.125 * period));
        let p = if far && depth > 0 && !support.exhausted() {
            let middle = 0.5 * (before + s);
            let m = self.look(support, middle, Some(q));
            self.step(support, middle, m, depth - 1);
            let near = self.samples.last().map_or(q, |l| l.1);
            let p = support.unwrap(p, near);
            return self.step(support, s, p, depth - 1);
        } else {
            p
        };
        self.samples.push((s, p));
    }

    /// Ends at poles: the fixed coordinate is the pole's, the other one the limit along the curve,
    /// by Richardson extrapolation from steps h, 2h, 4h.
    fn add_poles(&mut self, support: &Support, poles: [Option<usize>; 2], ends: (f64, f64)) {
        let limit = |near: [DVec2; 3], pole: usize| {
            let pole = support.poles[pole];
            let mut p = (near[0] * 8.0 - near[1] * 6.0 + near[2]) / 3.0;
            let value = pole.value;
            p[pole.axis] =
                support.periods[pole.axis].map_or(value, |q| super::law::nearest(value, near[0][pole.axis], q));
            p
        };
        let n = self.samples.len();
        if n < 3 {
            return;
        }
        let last = [n - 1, n - 2, n - 3].map(|i| self.samples[i].1);
        let first = [0, 1, 2].map(|i| self.samples[i].1);
        if let Some(pole) = poles[1] {
            self.samples.push((ends.1, limit(last, pole)));
        }
        if let Some(pole) = poles[0] {
            self.samples.insert(0, (ends.0, limit(first, pole)));
        }
    }

    /// Native parameters at the fraction `s`.
    pub fn at(&self, support: &Support, s: f64) -> DVec2 {
        let i = self.samples.partition_point(|x| x.0 < s);
        match (i.checked_sub(1).map(|j| self.samples[j]), self.samples.get(i)) {
            (_, Some(&(t, p))) if t == s => p,
            (Some((t0, p0)), Some(&(t1, p1))) => {
                let line = p0.lerp(p1, (s - t0) / (t1 - t0));
                let guess = self.cubic(i, s).filter(|c| (c - line).abs().cmple((p1 - p0).abs()).all()).unwrap_or(line);
                support.invert(self.edge.point(s), Some(guess), self.accept)
            }
            (Some((_, p)), None) => p,
            (None, Some(&(_, p))) => p,
            (None, None) => DVec2::ZERO,
        }
    }

    /// The cubic through the four samples around `s`, which lies between the samples `i - 1` and `i`: a start for
    /// Newton's method that saves it a step or two. `None` where there are not four regular ones.
    fn cubic(&self, i: usize, s: f64) -> Option<DVec2> {
        let four = self.samples.get(i.checked_sub(2)?..i + 2)?;
        let ends = (self.at_pole[0] && i == 2) || (self.at_pole[1] && i + 2 == self.samples.len());
        let weight = |j: usize| {
            let others = four.iter().enumerate().filter(|(k, _)| *k != j);
            others.map(|(_, (t, _))| (s - t) / (four[j].0 - t)).product::<f64>()
        };
        (!ends).then(|| (0..4).map(|j| four[j].1 * weight(j)).sum())
    }

    /// Samples where both coordinates have a meaning.
    pub fn regular(&self) -> &[(f64, DVec2)] {
        let n = self.samples.len();
        &self.samples[usize::from(self.at_pole[0])..n - usize::from(self.at_pole[1])]
    }

    /// The coordinate that changes least along the trace: its axis, its mean, how far in mm any sample would
    /// move to have it exactly, and the largest speed of the surface along it, mm a unit. `None` when neither
    /// coordinate is a number.
    pub fn constant(&self, support: &Support) -> Option<(usize, f64, f64, f64)> {
        let samples: Vec<(DVec2, DVec2)> = self.regular().iter().map(|(_, p)| (*p, support.speed(*p))).collect();
        let spread = |axis: usize| {
            let mass: f64 = samples.iter().map(|(_, speed)| speed[axis].powi(2)).sum();
            let mean = samples.iter().map(|(p, speed)| p[axis] * speed[axis].powi(2)).sum::<f64>() / mass;
            let off = samples.iter().map(|(p, speed)| (p[axis] - mean).abs() * speed[axis]).fold(0.0, f64::max);
            (off, mean)
        };
        let found = [spread(0), spread(1)];
        let axis = usize::from(found[1].0 < found[0].0 || found[0].0.is_nan());
        let fastest = samples.iter().map(|(_, speed)| speed[axis]).fold(0.0, f64::max);
        found[axis].0.is_finite().then_some((axis, found[axis].1, found[axis].0, fastest))
    }
}
