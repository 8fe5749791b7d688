//! Area of a face; volume and centre of mass of a closed part.
//!
//! ```text
//!   ∬ g du dv over the trimmed domain  =  ∮ G dv along its loops,   G(u, v) = ∫ g(s, v) ds from u0 to u     (Green)
//!   area: g = |S_u × S_v|      volume: g = p · n / 3      centre: g = x² n_x / 2, ...      n = ± S_u × S_v  (Gauss)
//! ```
//!
//! Loops run counter-clockwise and holes clockwise, as the model promises, so their sums need no test for inside.

use crate::math::gauss::{HALVINGS, rule, within};
use crate::model::{Face, Part, TrimLoop};
use crate::spline::{Bezier, Control, Surface};
use glam::{DAffine3, DVec3};

/// Tolerance of the integrals along the loops, as a share of what they would be if no part of a sum cancelled another: of
/// a moment that is 0 by symmetry only rounding is left, which no halving makes less.
const TOLERANCE: f64 = 1e-12;

/// An area with the estimate of its error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Area {
    /// Square model units.
    pub area: f64,
    /// The same.
    pub error: f64,
}

/// Of a closed part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mass {
    /// Of all faces.
    pub area: Area,
    /// Cubic model units.
    pub volume: f64,
    /// Estimate of its error.
    pub error: f64,
    /// Centre of the volume, model coordinates.
    pub centre: DVec3,
}

/// Area, volume below the face, and first moments of that.
type Sums = [f64; 5];

/// The loops of a face; of one without, the border of its surface's domain.
fn loops(face: &Face) -> Vec<Vec<Bezier<DVec3>>> {
    if !face.loops.is_empty() {
        return face.loops.iter().map(|l: &TrimLoop| l.curves().collect()).collect();
    }
    let ((u0, u1), (v0, v1)) = face.surface.domain();
    let corners = [(u0, v0), (u1, v0), (u1, v1), (u0, v1)].map(|(u, v)| glam::DVec2::new(u, v));
    vec![(0..4).map(|i| Bezier::line(corners[i], corners[(i + 1) % 4])).collect()]
}

/// The distinct knots of a surface within its domain, along u.
fn breaks(surface: &Surface) -> Vec<f64> {
    let ((u0, u1), _) = surface.domain();
    let mut all: Vec<f64> = surface.knots().0.iter().copied().filter(|k| *k >= u0 && *k <= u1).collect();
    all.dedup();
    all
}

/// The integrals over a face in part coordinates, moved by `origin` so that volumes do not cancel; and their errors.
fn sums(face: &Face, transform: DAffine3, origin: DVec3) -> (Sums, Sums) {
    let surface = &face.surface;
    let breaks = breaks(surface);
    let mirrored = transform.matrix3.determinant() < 0.0;
    let sense = if face.same_sense != mirrored { 1.0 } else { -1.0 };
    let density = |u: f64, v: f64| -> Sums {
        let jet = surface.jet2(u, v);
        let p = transform.transform_point3(jet.point) - origin;
        let cross = transform.transform_vector3(jet.du).cross(transform.transform_vector3(jet.dv));
        let n = cross * sense;
        [cross.length(), p.dot(n) / 3.0, 0.5 * p.x * p.x * n.x, 0.5 * p.y * p.y * n.y, 0.5 * p.z * p.z * n.z]
    };
    // up to u, span by span
    let below = |u: f64, v: f64| {
        let mut sum = [0.0; 5];
        for pair in breaks.windows(2).take_while(|pair| pair[0] < u) {
            let part = rule(&|s| density(s, v), pair[0], pair[1].min(u));
            sum.iter_mut().zip(part).for_each(|(s, x)| *s += x);
        }
        sum
    };
    let points = surface.points().iter().map(|p| transform.transform_point3(p.point()) - origin);
    let reach = points.fold(0.0f64, |most, p| most.max(p.length()));
    let moment = 0.5 * reach * reach;
    let (mut total, mut error) = ([0.0; 5], [0.0; 5]);
    for curve in loops(face).iter().flatten() {
        let along = |t: f64| {
            let (p, d) = curve.jet(t);
            let at = p.truncate() / p.z;
            let speed = (d.y - at.y * d.z) / p.z;
            if speed == 0.0 { [0.0; 5] } else { below(at.x, at.y).map(|x| x * speed) }
        };
        let [area] = rule(&|t| [along(t)[0].abs()], 0.0, 1.0);
        let allowed = [1.0, reach / 3.0, moment, moment, moment].map(|most| TOLERANCE * area * most);
        let (sum, off) = within(&along, (0.0, 1.0), allowed, HALVINGS);
        for i in 0..5 {
            total[i] += sum[i];
            error[i] += off[i];
        }
    }
    (total, error)
}

/// The area of a placed face.
pub fn area(face: &Face, transform: DAffine3) -> Area {
    let (sum, error) = sums(face, transform, DVec3::ZERO);
    Area { area: sum[0], error: error[0] }
}

/// Area, volume and centre of a placed part; the volume is meaningful where the part is closed.
pub fn mass(part: &Part, transform: DAffine3) -> Mass {
    let bounds = part.control_bounds();
    let origin = transform.transform_point3(if bounds.is_empty() { DVec3::ZERO } else { bounds.centre() });
    let (mut total, mut error) = ([0.0; 5], [0.0; 5]);
    for face in &part.faces {
        let (sum, off) = sums(face, transform, origin);
        for i in 0..5 {
            total[i] += sum[i];
            error[i] += off[i];
        }
    }
    let [area, volume, x, y, z] = total;
    let centre = origin + DVec3::new(x, y, z) / volume;
    Mass { area: Area { area, error: error[0] }, volume, error: error[1], centre }
}
