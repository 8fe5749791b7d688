//! From a point in space to the parameters of the nearest point of the surface.
//!
//! Closed forms for the elementary surfaces; extrusions and revolutions reduce to their profile
//! curve; splines search their patches (see [`SplineForm::invert`](super::spline::SplineForm::invert)).

use super::Frame;
use super::curve::{Curve, best_seeds};
use super::law::nearest;
use super::spline::SplineForm;
use super::support::{Form, Support};
use glam::{DVec2, DVec3};

/// Steps of Newton's method on a profile.
const STEPS: usize = 30;

impl Support {
    /// Native parameters of the point of the surface nearest to `p`.
    ///
    /// `hint`: parameters of a point near by; it chooses the period, the angle at a pole, and the sheet where a surface
    /// passes twice through one point. `accept`: a foot found from the hint is taken if `p` is this near to it, mm;
    /// else all of the surface is searched. Accuracy: rounding for closed forms, Newton to stagnation elsewhere.
    pub fn invert(&self, p: DVec3, hint: Option<DVec2>, accept: f64) -> DVec2 {
        let found = self.principal(p, hint, accept);
        hint.map_or(found, |h| self.unwrap(found, h))
    }

    /// [`Support::invert`], and the distance of that point from `p`.
    pub fn nearest(&self, p: DVec3, hint: Option<DVec2>, accept: f64) -> (DVec2, f64) {
        let Form::Spline(s) = &self.form else {
            let found = self.invert(p, hint, accept);
            return (found, self.point(found).distance(p));
        };
        let (distance, found) = s.invert(p, hint, self.enough(accept), self.steps(SplineForm::STEPS));
        self.spend(s.take_work());
        (hint.map_or(found, |h| self.unwrap(found, h)), distance)
    }

    /// The distance at which the first answer is taken.
    fn enough(&self, accept: f64) -> f64 {
        if self.exhausted() { f64::INFINITY } else { accept }
    }

    fn principal(&self, p: DVec3, hint: Option<DVec2>, accept: f64) -> DVec2 {
        let l = self.frame.local(p);
        let rho = l.x.hypot(l.y);
        // on the axis every angle is right: keep the one of the neighbour
        let angle = match hint {
            Some(h) if rho <= 1e-12 * (l.z.abs() + self.eps) => h.x,
            _ => l.y.atan2(l.x),
        };
        // a meridian point (rho, z) and the one on the far side of the axis, (-rho, z) at u + π:
        // the nearer of the two, the hint's where they are equally near
        let two_sided = |invert: &dyn Fn(f64) -> (f64, f64)| {
            let ((v0, d0), (v1, d1)) = (invert(rho), invert(-rho));
            let beyond = match hint {
                Some(h) if (d0 - d1).abs() <= self.eps => {
                    let away = |v: f64| self.periods[1].map_or(v, |q| nearest(v, h.y, q)) - h.y;
                    away(v1).abs() < away(v0).abs()
                }
                _ => d1 < d0,
            };
            if beyond { DVec2::new(angle + std::f64::consts::PI, v1) } else { DVec2::new(angle, v0) }
        };
        match &self.form {
            Form::Plane => l.truncate(),
            Form::Cylinder { .. } => DVec2::new(angle, l.z),
            Form::Cone { radius, slope } => two_sided(&|rho: f64| {
                // foot on the line (radius + slope v, v)
                let v = ((rho - radius) * slope + l.z) / (1.0 + slope * slope);
                (v, (rho - radius - slope * v).hypot(l.z - v))
            }),
            Form::Sphere { .. } => DVec2::new(angle, l.z.atan2(rho)),
            Form::Torus { major, minor } => {
                let circle = |rho: f64| (l.z.atan2(rho - major), ((rho - major).hypot(l.z) - minor).abs());
                if major > minor { DVec2::new(angle, circle(rho).0) } else { two_sided(&circle) }
            }
            Form::Revolution { profile } => {
                let meridian = |t: f64| {
                    self.spend(1);
                    let (q, d) = profile.jet(t);
                    let (q, d) = (self.frame.local(q), self.frame.local_direction(d));
                    let r = q.x.hypot(q.y);
                    // on the axis the radius grows with the speed across it, either way along the profile;
                    // at a last point only backwards, and rounding there must not turn the slope around
                    let end = profile.domain().and_then(|(a, b)| match t {
                        _ if r > self.eps => None,
                        _ if t <= a => Some(1.0),
                        _ if t >= b => Some(-1.0),
                        _ => None,
                    });
                    let dr = match end {
                        Some(sign) => sign * d.x.hypot(d.y),
                        None if r > 0.0 => (q.x * d.x + q.y * d.y) / r,
                        None => d.x.hypot(d.y),
                    };
                    (DVec3::new(r - rho, q.z - l.z, 0.0), DVec3::new(dr, d.z, 0.0))
                };
                let seeds = || self.turned_seeds(profile, l);
                let limits = (self.enough(accept), self.steps(STEPS));
                let t = foot(profile, seeds, hint.map(|h| h.y), limits, meridian);
                let q = self.frame.local(profile.point(t));
                let on_axis = q.x.hypot(q.y) <= 1e-12 * (q.z.abs() + self.eps);
                let u = if on_axis { hint.map_or(0.0, |h| h.x) } else { angle - q.y.atan2(q.x) };
                DVec2::new(u, t)
            }
            Form::Extrusion { profile, direction } => {
                let unit = direction.normalize();
                let across = |v: DVec3| v - unit * v.dot(unit);
                let shadow = |t: f64| {
                    self.spend(1);
                    let (q, d) = profile.jet(t);
                    (across(q - p), across(d))
                };
                let limits = (self.enough(accept), self.steps(STEPS));
                let t = foot(profile, || seeds(profile), hint.map(|h| h.x), limits, shadow);
                DVec2::new(t, (p - profile.point(t)).dot(unit) / direction.length())
            }
            Form::Spline(s) => {
                let found = s.invert(p, hint, self.enough(accept), self.steps(SplineForm::STEPS)).1;
                self.spend(s.take_work());
                found
            }
        }
    }

    /// Seeds of the profile of a surface of revolution for the local point `l`. A line has none of
    /// its own: where it passes the height of `l`, or where it is as far from the axis.
    fn turned_seeds(&self, profile: &Curve, l: DVec3) -> Vec<f64> {
        let Curve::Line { origin, direction } = profile else { return seeds(profile) };
        let (o, d) = (self.frame.local(*origin), direction);
        let d = self.frame.local_direction(*d);
        if d.z.abs() > 1e-9 * d.length() {
            return vec![(l.z - o.z) / d.z];
        }
        let (a, b) = (d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y);
        let c = o.x * o.x + o.y * o.y - l.x * l.x - l.y * l.y;
        let root = (b * b - a * c).max(0.0).sqrt();
        vec![(-b - root) / a, (-b + root) / a]
    }
}

/// Parameters from which Newton's method reaches every part of the curve.
fn seeds(curve: &Curve) -> Vec<f64> {
    match curve {
        Curve::Line { .. } => vec![0.0],
        Curve::Ellipse { .. } => curve.nodes(0.0, super::law::TURN),
        Curve::Pieces(p) => p.seeds(),
        // unbounded conics: even steps near the apex, growing ones along the arms
        Curve::Hyperbola { .. } | Curve::Parabola { .. } => {
            (-24..=24).map(|i| f64::from(i) / 4.0).map(|x| x.sinh() / 4.0).collect()
        }
    }
}

/// The parameter that makes `g(t) = (residual, its derivative)` smallest: Gauss-Newton, steps that
/// overshoot halved, at most `steps` of them, from the hint if that ends within `accept` mm, else from the
/// best seeds, the one nearest to the hint among equals.
fn foot(
    curve: &Curve,
    seeds: impl FnOnce() -> Vec<f64>,
    hint: Option<f64>,
    (accept, steps): (f64, usize),
    g: impl Fn(f64) -> (DVec3, DVec3),
) -> f64 {
    let wrap = |t: f64| match curve {
        Curve::Pieces(p) => p.wrap(t),
        _ => t,
    };
    let polish = |start: f64| {
        let mut t = wrap(start);
        let mut distance = g(t).0.length();
        let mut best = (distance, t);
        for _ in 0..steps {
            let (r, d) = g(t);
            let mut by = -r.dot(d) / d.length_squared().max(f64::MIN_POSITIVE);
            let mut next = wrap(t + by);
            // where the curve bends away, or ends, a whole step may lead farther off than it began;
            // a thousandth of it does not, but for rounding
            for _ in 0..10 {
                if g(next).0.length() <= distance {
                    break;
                }
                by *= 0.5;
                next = wrap(t + by);
            }
            let step = (next - t).abs();
            t = next;
            distance = g(t).0.length();
            if distance < best.0 {
                best = (distance, t);
            }
            if step <= 1e-15 * t.abs().max(1e-3) || !t.is_finite() {
                break;
            }
        }
        best
    };
    let near = hint.map(polish);
    if let Some((distance, t)) = near
        && distance <= accept
    {
        return t;
    }
    let seeds = seeds();
    let mut starts = best_seeds(&seeds, |t| g(t).0.length_squared());
    if let Curve::Pieces(p) = curve
        && !p.creases.is_empty()
    {
        // at a corner the derivative belongs to one side; the other side has a seed of its own
        let beside = |t: &f64| {
            let i = seeds.iter().position(|s| s == t)?;
            Some([i.checked_sub(1), Some(i + 1)].into_iter().flatten())
        };
        let more: Vec<usize> = starts.iter().filter_map(beside).flatten().collect();
        starts.extend(more.into_iter().filter_map(|i| seeds.get(i)).copied());
    }
    let found: Vec<(f64, f64)> = starts.into_iter().map(polish).chain(near).collect();
    let least = found.iter().fold(f64::INFINITY, |m, f| m.min(f.0));
    let away = |t: f64| match (hint, curve.period()) {
        (Some(h), Some(period)) => (nearest(t, h, period) - h).abs(),
        (Some(h), None) => (t - h).abs(),
        _ => 0.0,
    };
    let equals = found.iter().filter(|f| f.0 <= 1.5 * least + accept).map(|f| f.1);
    equals.min_by(|a, b| away(*a).total_cmp(&away(*b))).unwrap_or(0.0)
}

/// Parameters at which a profile meets the axis of its frame, within `eps` mm.
pub(super) fn axis_crossings(profile: &Curve, frame: &Frame, eps: f64) -> Vec<f64> {
    let distance = |t: f64| {
        let l = frame.local(profile.point(t));
        l.x.hypot(l.y)
    };
    let mut candidates = match profile {
        Curve::Line { origin, direction } => {
            let across = |v: DVec3| v - frame.z * v.dot(frame.z);
            let (o, d) = (across(origin - frame.origin), across(*direction));
            if d.length_squared() <= 1e-24 * direction.length_squared() {
                return Vec::new();
            }
            vec![-o.dot(d) / d.length_squared()]
        }
        _ => {
            let seeds = seeds(profile);
            let mut found: Vec<f64> = best_seeds(&seeds, distance);
            for t in &mut found {
                let i = seeds.iter().position(|s| s == t).unwrap_or(0);
                let (mut a, mut b) = (seeds[i.saturating_sub(1)], seeds[(i + 1).min(seeds.len() - 1)]);
                // ternary search: the distance to the axis has one valley between neighbour seeds
                for _ in 0..100 {
                    let (c, d) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
                    if distance(c) <= distance(d) { b = d } else { a = c }
                }
                let ends = [*t, a, b, 0.5 * (a + b)];
                *t = ends.into_iter().min_by(|x, y| distance(*x).total_cmp(&distance(*y))).unwrap_or(*t);
            }
            found
        }
    };
    candidates.retain(|t| distance(*t) <= eps);
    candidates.sort_by(f64::total_cmp);
    // both ends of a closed profile are one crossing
    candidates.dedup_by(|b, a| profile.point(*a).distance(profile.point(*b)) <= eps && (*b - *a).abs() < 1e-6);
    candidates
}
