//! Area of a face; volume and centre of mass of a closed part.
//!
//! ```text
//!   ∬ g du dv over the trimmed domain  =  ∮ G dv along its loops,   G(u, v) = ∫ g(s, v) ds from u0 to u     (Green)
//!   area: g = |S_u × S_v|      volume: g = p · n / 3      centre: g = x² n_x / 2, ...      n = ± S_u × S_v  (Gauss)
//! ```
//!
//! Loops run counter-clockwise and holes clockwise, as the model promises, so their sums need no test for inside. A
//! loop that crosses itself counts by its winding number. Both integrals are sums of Gauss's rules: `G` takes one rule
//! for each knot span, and the loops' pieces are halved until the rules agree.

use crate::math::gauss::{rule, within};
use crate::model::{Face, Part};
use crate::spline::{Bezier, Control, Jet2};
use glam::{DAffine3, DVec2, DVec3};

/// Tolerance of the integrals along the loops, as a share of what they would be if no part of a sum cancelled another:
/// of a moment that is 0 by symmetry only rounding is left, which no halving makes less.
const TOLERANCE: f64 = 1e-12;
/// Halvings of one piece of a loop at most. A step of `G`, at a knot line where the surface's derivative has one, is
/// then within a millionth of the piece.
const MOST_HALVINGS: u32 = 20;

/// An area and the estimate of its error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Area {
    /// Square model units.
    pub area: f64,
    /// Estimate of its error, square model units.
    pub error: f64,
}

/// Area, volume and centre of a closed part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mass {
    /// Of all faces.
    pub area: Area,
    /// Cubic model units.
    pub volume: f64,
    /// Estimate of its error, cubic model units.
    pub error: f64,
    /// Centre of the volume, model coordinates.
    pub centre: DVec3,
}

/// Area, volume below the face, and first moments of that.
type Sums = [f64; 5];

fn add<const N: usize>(sum: &mut [f64; N], more: [f64; N]) {
    sum.iter_mut().zip(more).for_each(|(s, x)| *s += x);
}

/// The distinct knots within a domain.
fn breaks(knots: &[f64], (low, high): (f64, f64)) -> Vec<f64> {
    let mut all: Vec<f64> = knots.iter().copied().filter(|k| (low..=high).contains(k)).collect();
    all.dedup();
    all
}

/// The pieces of a face's loops. Of a face without loops, the side `u = u1` of its domain, cut at the knots: `G` is 0
/// on the opposite side, and `v` is constant on the two others.
fn pieces(face: &Face) -> Vec<Bezier<DVec3>> {
    if !face.loops.is_empty() {
        return face.loops.iter().flat_map(|l| l.curves()).collect();
    }
    let ((_, u1), along_v) = face.surface.domain();
    let rows = breaks(face.surface.knots().1, along_v);
    rows.windows(2).map(|row| Bezier::line(DVec2::new(u1, row[0]), DVec2::new(u1, row[1]))).collect()
}

/// `∬ density du dv` over the points of the domain that a face keeps, and estimates of the errors. The first density
/// is `|S_u × S_v|`; each other is at most `most` times as large, which the tolerances follow.
fn integral<const N: usize>(face: &Face, density: &impl Fn(&Jet2) -> [f64; N], most: [f64; N]) -> ([f64; N], [f64; N]) {
    let surface = &face.surface;
    let (along_u, (v0, v1)) = surface.domain();
    let spans = breaks(surface.knots().0, along_u);
    // G(u, v)
    let below = |u: f64, v: f64| {
        let mut sum = [0.0; N];
        for pair in spans.windows(2).take_while(|pair| pair[0] < u) {
            add(&mut sum, rule(&|s| density(&surface.jet2(s, v)), pair[0], pair[1].min(u)));
        }
        sum
    };
    let along = |curve: &Bezier<DVec3>, t: f64| {
        let (p, d) = curve.jet(t);
        let at = p.truncate() / p.z;
        let speed = (d.y - at.y * d.z) / p.z;
        let counts = speed != 0.0 && (v0..=v1).contains(&at.y);
        if counts { below(at.x, at.y).map(|x| x * speed) } else { [0.0; N] }
    };
    let curves = pieces(face);
    let sizes: Vec<f64> = curves.iter().map(|c| rule(&|t| [along(c, t)[0].abs()], 0.0, 1.0)[0]).collect();
    // a piece along u has no size but its rounding, which no halving makes less
    let mean = sizes.iter().sum::<f64>() / sizes.len() as f64;
    let (mut total, mut error) = ([0.0; N], [0.0; N]);
    for (curve, size) in curves.iter().zip(sizes) {
        let allowed = most.map(|most| TOLERANCE * size.max(mean) * most);
        let (sum, off) = within(&|t| along(curve, t), (0.0, 1.0), allowed, MOST_HALVINGS);
        add(&mut total, sum);
        add(&mut error, off);
    }
    (total, error)
}

/// `S_u × S_v` of a placed surface.
fn cross(jet: &Jet2, transform: DAffine3) -> DVec3 {
    transform.transform_vector3(jet.du).cross(transform.transform_vector3(jet.dv))
}

/// The integrals over a placed face, moved by `-origin` so that volumes do not cancel; and their errors.
fn sums(face: &Face, transform: DAffine3, origin: DVec3) -> (Sums, Sums) {
    let mirrored = transform.matrix3.determinant() < 0.0;
    let sense = if face.same_sense != mirrored { 1.0 } else { -1.0 };
    let density = |jet: &Jet2| -> Sums {
        let p = transform.transform_point3(jet.point) - origin;
        let cross = cross(jet, transform);
        let n = cross * sense;
        [cross.length(), p.dot(n) / 3.0, 0.5 * p.x * p.x * n.x, 0.5 * p.y * p.y * n.y, 0.5 * p.z * p.z * n.z]
    };
    let points = face.surface.points().iter().map(|p| transform.transform_point3(p.point()) - origin);
    let reach = points.fold(0.0f64, |most, p| most.max(p.length()));
    let moment = 0.5 * reach * reach;
    integral(face, &density, [1.0, reach / 3.0, moment, moment, moment])
}

/// The area of a placed face.
///
/// Accuracy: some 1e-12 of itself where the surface is smooth along the loops, 1e-7 where a derivative has a step.
/// Cost: some hundred evaluations of the surface for each trim curve and each knot span in u.
pub fn area(face: &Face, transform: DAffine3) -> Area {
    let density = |jet: &Jet2| [cross(jet, transform).length()];
    let ([area], [error]) = integral(face, &density, [1.0]);
    Area { area: area.abs(), error }
}

/// Area, volume and centre of a placed part; the volume is meaningful where the part is closed.
pub fn mass(part: &Part, transform: DAffine3) -> Mass {
    let bounds = part.control_bounds();
    let origin = transform.transform_point3(if bounds.is_empty() { DVec3::ZERO } else { bounds.centre() });
    let (mut total, mut error) = ([0.0; 5], [0.0; 5]);
    for face in &part.faces {
        let (sum, off) = sums(face, transform, origin);
        add(&mut total, sum);
        add(&mut error, off);
    }
    let [area, volume, x, y, z] = total;
    let centre = origin + DVec3::new(x, y, z) / volume;
    Mass { area: Area { area, error: error[0] }, volume, error: error[1], centre }
}
