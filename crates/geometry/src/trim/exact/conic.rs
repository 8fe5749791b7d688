//! Monotone pieces of trim curves as arcs of conics.
//!
//! ```text
//!        corner                in barycentric coordinates of low, corner, high:
//!       ╱  ·                       the arc is    corner² = fullness · low · high
//!      ╱ ·    ·                fullness = 4 w², w the weight of the corner where those of the ends are 1
//!     ╱·     ⟍  ·
//!   low ───────── high         below the chord, or where the right side is larger: on the chord's side of the arc
//! ```
//!
//! Circles, ellipses and all other curves of degree two are such arcs exactly. Any other piece gets the conic through
//! its ends with their tangents, and one more point of it. Where this conic leaves the piece by more than
//! [`TOLERANCE`], the piece is halved. Conics follow a smooth piece of length `h` to within `O(h⁵)`, so few halvings
//! are enough, except at inflections, where pieces get smaller by a constant ratio.
//!
//! The distance is proved, not measured: the piece moved by the tolerance away from its chord must be beyond the conic,
//! and moved by as much towards it must be within. The equation of the conic along the moved piece is a polynomial, and
//! all of its Bernstein coefficients must have the right sign.
//!
//! Source: G. Farin, *Curves and Surfaces for CAGD*, 2002, chapter 12 (conics in barycentric coordinates); E. T. Y. Lee,
//! *The rational Bézier representation for conics*, 1987.

use crate::spline::{Bezier, Control, binomial};
use glam::{DVec2, DVec3};

/// How far an arc may be from its trim curve, of the unit domain, or of the largest coordinate beyond it: half the rounding of
/// a coordinate in `f32`.
const TOLERANCE: f64 = 0.5 / 16_777_216.0;
/// Halvings after which a piece counts as straight: it is a point in single precision long before.
const MOST_HALVINGS: u32 = 48;
/// Halvings that find the point of a piece that is as far along the chord as the corner.
const SHOULDER_HALVINGS: u32 = 16;

/// An arc from the end of the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Conic {
    pub end: DVec2,
    /// The meeting point of the end tangents; the start where the arc is straight.
    pub corner: DVec2,
    /// 0 where it is straight.
    pub fullness: f64,
}

/// Appends the arcs of a piece that turns back neither in `u` nor in `v`; its control points have positive weights.
pub(super) fn append_conics(conics: &mut Vec<Conic>, piece: &Bezier<DVec3>) {
    let largest = piece.points.iter().map(|p| p.point().abs().max_element()).fold(1.0, f64::max);
    append(conics, piece, TOLERANCE * largest, MOST_HALVINGS);
}

fn append(conics: &mut Vec<Conic>, piece: &Bezier<DVec3>, tolerance: f64, halvings: u32) {
    let (start, end) = (piece.points[0].point(), piece.points[piece.degree()].point());
    if halvings == 0 || is_straight(piece, start, end, tolerance) {
        conics.push(Conic { end, corner: start, fullness: 0.0 });
    } else if let Some(conic) = followed(piece, start, end, tolerance) {
        conics.push(conic);
    } else {
        let (before, behind) = piece.split(0.5);
        append(conics, &before, tolerance, halvings - 1);
        append(conics, &behind, tolerance, halvings - 1);
    }
}

/// All control points are near the chord: so is the piece, and it runs along it. Also true for pieces too large for a
/// decision: no comparison holds there, and halving would not end.
fn is_straight(piece: &Bezier<DVec3>, start: DVec2, end: DVec2, tolerance: f64) -> bool {
    let chord = end - start;
    let most = tolerance * chord.length();
    let is_off = |p: &DVec3| chord.perp_dot(p.point() - start).abs() > most;
    chord.length() <= tolerance || !piece.points.iter().any(is_off)
}

/// The conic that follows the piece.
fn followed(piece: &Bezier<DVec3>, start: DVec2, end: DVec2, tolerance: f64) -> Option<Conic> {
    let chord = end - start;
    let distinct = 1e-9 * chord.length();
    let way = |from: DVec2| move |p: &DVec3| Some(p.point() - from).filter(|d| d.length() > distinct);
    let first = piece.points.iter().find_map(way(start))?;
    let last = -piece.points.iter().rev().find_map(way(end))?;
    let turn = first.perp_dot(last);
    let (along, back) = (chord.perp_dot(last) / turn, first.perp_dot(chord) / turn);
    if !(along > 0.0 && back > 0.0 && (along * first).is_finite()) {
        return None;
    }
    let corner = (start + along * first).clamp(start.min(end), start.max(end));
    let triangle = Triangle { start, corner, chord };
    let [low, middle, high] = triangle.coordinates(shoulder(piece, &triangle));
    let fullness = middle * middle / (low * high);
    let follows = low > 0.0
        && middle > 0.0
        && high > 0.0
        && fullness.is_finite()
        && triangle.is_followed(piece, fullness, tolerance);
    follows.then_some(Conic { end, corner, fullness })
}

/// A point of the piece that is equally far from both tangents.
fn shoulder(piece: &Bezier<DVec3>, triangle: &Triangle) -> DVec3 {
    let (mut a, mut b) = (0.0, 1.0);
    let mut t = 0.5;
    for _ in 0..SHOULDER_HALVINGS {
        let [low, _, high] = triangle.coordinates(piece.homogeneous(t));
        if low == high {
            break;
        }
        if low > high {
            a = t
        } else {
            b = t
        }
        t = 0.5 * (a + b);
    }
    piece.homogeneous(t)
}

/// An arc's ends and its corner.
struct Triangle {
    start: DVec2,
    corner: DVec2,
    chord: DVec2,
}

impl Triangle {
    /// Homogeneous barycentric coordinates of a homogeneous point: of the start, the corner, the end. They add up to its
    /// weight.
    fn coordinates(&self, p: DVec3) -> [f64; 3] {
        let q = p.truncate() - p.z * self.start;
        let corner = self.corner - self.start;
        let area = self.chord.perp_dot(corner);
        let middle = self.chord.perp_dot(q) / area;
        let high = q.perp_dot(corner) / area;
        [p.z - middle - high, middle, high]
    }

    /// Whether a conic is within the tolerance of the whole piece.
    fn is_followed(&self, piece: &Bezier<DVec3>, fullness: f64, tolerance: f64) -> bool {
        let away = self.corner - (self.start + 0.5 * self.chord);
        let step = tolerance / away.length();
        let coordinates: Vec<[f64; 3]> = piece.points.iter().map(|p| self.coordinates(*p)).collect();
        let moved = |by: f64| {
            let weights = piece.points.iter().map(|p| p.z);
            let all = coordinates.iter().zip(weights);
            let moved = all.map(|([low, middle, high], w)| [low - 0.5 * by * w, middle + by * w, high - 0.5 * by * w]);
            equation(&moved.collect::<Vec<_>>(), fullness)
        };
        moved(step).iter().all(|c| *c >= 0.0) && moved(-step).iter().all(|c| *c <= 0.0)
    }
}

/// Bernstein coefficients of `corner² - fullness · low · high` along a piece whose coordinates have these.
fn equation(coordinates: &[[f64; 3]], fullness: f64) -> Vec<f64> {
    let n = coordinates.len() - 1;
    let mut sums = vec![0.0; 2 * n + 1];
    for (i, a) in coordinates.iter().enumerate() {
        for (j, b) in coordinates.iter().enumerate() {
            let share = binomial(n, i) * binomial(n, j) / binomial(2 * n, i + j);
            sums[i + j] += share * (a[1] * b[1] - fullness * a[0] * b[2]);
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::arc;

    /// `u`, `v` and weight of a control point.
    type Weighted = (f64, f64, f64);

    fn conics(points: &[Weighted]) -> (Bezier<DVec3>, Vec<Conic>) {
        let points = points.iter().map(|&(u, v, w)| DVec3::from_point(DVec2::new(u, v), w)).collect();
        let piece = Bezier { points };
        let mut conics = Vec::new();
        append_conics(&mut conics, &piece);
        (piece, conics)
    }

    /// The largest distance of points of the arcs from the piece, both finely sampled.
    fn worst_distance(piece: &Bezier<DVec3>, conics: &[Conic]) -> f64 {
        const FINE: u32 = 20_000;
        let at: Vec<DVec2> = (0..=FINE).map(|k| piece.point(f64::from(k) / f64::from(FINE))).collect();
        let mut start = piece.points[0].point();
        let mut worst = 0.0f64;
        for conic in conics {
            let w = 0.5 * conic.fullness.sqrt();
            for k in 1..16 {
                let t = f64::from(k) / 16.0;
                let (a, b, c) = ((1.0 - t).powi(2), 2.0 * w * t * (1.0 - t), t * t);
                let p = (a * start + b * conic.corner + c * conic.end) / (a + b + c);
                let near = at.partition_point(|q| q.x < p.x).clamp(1, at.len() - 1);
                let (q, d) = (at[near - 1], at[near] - at[near - 1]);
                worst = worst.max(d.perp_dot(p - q).abs() / d.length());
            }
            start = conic.end;
        }
        worst
    }

    #[test]
    fn curves_of_degree_two_are_one_arc() {
        let w = 0.5f64.sqrt();
        let (_, quarter) = conics(&[(1.0, 0.0, 1.0), (1.0, 1.0, w), (0.0, 1.0, 1.0)]);
        assert_eq!(quarter.len(), 1);
        assert!((quarter[0].fullness - 2.0).abs() < 1e-14 && quarter[0].corner == DVec2::ONE);
        let (_, parabola) = conics(&[(0.0, 0.0, 1.0), (0.5, 0.0, 1.0), (1.0, 1.0, 1.0)]);
        assert!(parabola.len() == 1 && (parabola[0].fullness - 4.0).abs() < 1e-14);
        // as in files: of a higher degree than necessary
        let elevated = conics(&[(1.0, 0.0, 1.0), (1.0, 1.0, w), (0.0, 1.0, 1.0)]).0.elevated().elevated();
        let mut again = Vec::new();
        append_conics(&mut again, &elevated);
        assert!(again.len() == 1 && (again[0].fullness - 2.0).abs() < 1e-9, "{again:?}");
    }

    #[test]
    fn straight_pieces_have_no_corner() {
        let (_, line) = conics(&[(0.0, 0.0, 1.0), (0.2, 0.1, 2.0), (1.0, 0.5, 1.0)]);
        assert_eq!(line, [Conic { end: DVec2::new(1.0, 0.5), corner: DVec2::ZERO, fullness: 0.0 }]);
        // without the bulge of a hundredth of the tolerance
        assert_eq!(conics(&[(0.0, 0.0, 1.0), (0.5, 1e-10, 1.0), (1.0, 0.0, 1.0)]).1[0].fullness, 0.0);
    }

    /// Cubics, with an inflection or a cusp at the end, a quintic, and a rational one of uneven weights: never farther
    /// off than the tolerance, and few arcs, except for some thirty on either side of an inflection. The reference, the
    /// piece by chords, is off by less than 1e-9.
    #[test]
    fn other_curves_are_followed_by_a_few() {
        let cases: [(&[Weighted], usize); 5] = [
            (&[(0.0, 0.0, 1.0), (0.3, 0.0, 1.0), (0.8, 0.3, 1.0), (1.0, 1.0, 1.0)], 16),
            (&[(0.0, 0.0, 1.0), (0.5, 0.0, 1.0), (0.5, 1.0, 1.0), (1.0, 1.0, 1.0)], 72),
            (&[(0.0, 0.0, 1.0), (0.0, 0.0, 1.0), (0.8, 0.3, 1.0), (1.0, 1.0, 1.0)], 64),
            (
                &[(0.0, 0.0, 1.0), (0.2, 0.1, 1.0), (0.4, 0.1, 1.0), (0.6, 0.4, 1.0), (0.9, 0.5, 1.0), (1.0, 1.0, 1.0)],
                64,
            ),
            (&[(0.0, 0.0, 1.0), (0.3, 0.1, 8.0), (0.5, 0.2, 0.5), (1.0, 1.0, 1.0)], 64),
        ];
        for (points, most) in cases {
            let (piece, conics) = conics(points);
            let worst = worst_distance(&piece, &conics);
            println!("{} arcs, {worst:e} off", conics.len());
            assert!(
                worst <= TOLERANCE + 1e-9 && conics.len() <= most,
                "{} arcs, {worst:e} off: {points:?}",
                conics.len()
            );
        }
        // a conic that is not the piece's is refused
        let (piece, _) = conics(cases[0].0);
        let ends = (piece.points[0].point(), piece.points[3].point());
        assert!(followed(&piece, ends.0, ends.1, TOLERANCE).is_none());
    }

    /// A piece far beyond the domain is followed within single precision, and one too large for a decision ends.
    #[test]
    fn huge_pieces_are_a_few_arcs() {
        for size in [1e3, 1e9, 1e30, 1e160, 1e300] {
            let wave = [(0.0, 0.0, 1.0), (0.5 * size, 0.0, 1.0), (0.5 * size, size, 1.0), (size, size, 1.0)];
            let (_, conics) = conics(&wave);
            assert!(conics.len() <= 72, "{} arcs of size {size:e}", conics.len());
        }
    }

    /// A circle that a file gives as one curve of degree five is cut into its quarters before; each is followed.
    #[test]
    fn a_circle_of_degree_five() {
        let quarter = arc::arc(glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y, 0.0, std::f64::consts::FRAC_PI_2);
        let flat: Vec<DVec3> = quarter.points.iter().map(|p| DVec3::new(p.x, p.y, p.w)).collect();
        let piece = Bezier { points: flat }.elevated().elevated().elevated();
        let mut conics = Vec::new();
        append_conics(&mut conics, &piece);
        assert_eq!(conics.len(), 1);
    }
}
