//! The point of an edge that is nearest to a pixel.
//!
//! ```text
//!     control polygon in the picture ─halved─▶ box farther than the best point: dropped
//!                                              box below half a pixel: Gauss and Newton's method from its middle
//!                                              else halved again
//! ```
//!
//! All pieces are searched, so the point is the nearest of the whole edge. Accuracy: the steps converge where the pixel
//! is nearer to the edge than the edge's radius of curvature in the picture; each step shrinks the error by the ratio
//! of the two. Cost: some tens of halvings for each piece that passes within reach.

use crate::model::Edge;
use crate::spline::Bezier;
use glam::{DMat4, DVec2, DVec4, Vec4Swizzles};

/// Boxes below this width are not halved again, pixels.
const SMALL_PX: f64 = 0.5;
/// Shortest part of a piece. Where a curve crosses the plane of the eye, boxes stay infinite however often they are
/// halved.
const SHORT: f64 = 1e-9;
/// Steps of Gauss and Newton's method.
const STEPS: usize = 24;

/// A point of an edge, in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The edge's parameter: number of the piece, and fraction.
    pub parameter: f64,
    /// Position in the picture.
    pub pixel: DVec2,
    /// Distance from the given pixel, pixels.
    pub distance_px: f64,
}

/// The point of `edge` nearest to `pixel`, if it is nearer than `within_px`. Points behind the eye are ignored.
/// `to_pixels` takes the part to homogeneous pixels: it is [`Camera::pixel_matrix`](crate::model::Camera::pixel_matrix)
/// times the part's placement.
pub fn nearest(edge: &Edge, to_pixels: DMat4, pixel: DVec2, within_px: f64) -> Option<Nearest> {
    let mut best: Option<Nearest> = None;
    for (number, span) in edge.curve.iter().enumerate() {
        let whole = Bezier { points: span.piece.points.iter().map(|p| to_pixels * *p).collect() };
        let mut open = vec![(whole.clone(), 0.0, 1.0)];
        while let Some((curve, from, to)) = open.pop() {
            let reach = best.map_or(within_px, |best| best.distance_px);
            let (away, width) = bounds(&curve, pixel);
            if away >= reach {
                continue;
            }
            if width > SMALL_PX && to - from > SHORT {
                let (first, second) = curve.split(0.5);
                let middle = 0.5 * (from + to);
                open.extend([(first, from, middle), (second, middle, to)]);
                continue;
            }
            let found = refined(&whole, pixel, (from, to));
            if let Some((t, at)) = found.filter(|(_, at)| at.distance(pixel) < reach) {
                best = Some(Nearest { parameter: number as f64 + t, pixel: at, distance_px: at.distance(pixel) });
            }
        }
    }
    best
}

/// Distance of the pixel from the box around the control polygon, and width of the box. If the polygon crosses the
/// plane of the eye, they are 0 and infinite; if it lies behind that plane, infinite and 0.
fn bounds(curve: &Bezier<DVec4>, pixel: DVec2) -> (f64, f64) {
    let behind = curve.points.iter().filter(|q| q.w <= 0.0).count();
    if behind == curve.points.len() {
        return (f64::INFINITY, 0.0);
    }
    if behind > 0 {
        return (0.0, f64::INFINITY);
    }
    let places = curve.points.iter().map(|q| q.xy() / q.w);
    let start = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let (low, high) = places.fold(start, |(low, high), p| (low.min(p), high.max(p)));
    ((low - pixel).max(pixel - high).max(DVec2::ZERO).length(), (high - low).max_element())
}

/// The nearest point of a short part of a curve.
fn refined(curve: &Bezier<DVec4>, pixel: DVec2, (from, to): (f64, f64)) -> Option<(f64, DVec2)> {
    let mut best: Option<(f64, DVec2)> = None;
    for start in [from, 0.5 * (from + to), to] {
        let mut t = start;
        for _ in 0..STEPS {
            let (q, d) = curve.jet(t);
            if q.w <= 0.0 {
                break;
            }
            let at = q.xy() / q.w;
            if best.is_none_or(|(_, best)| at.distance(pixel) < best.distance(pixel)) {
                best = Some((t, at));
            }
            let along = (d.xy() - at * d.w) / q.w;
            let step = (pixel - at).dot(along) / along.length_squared();
            let next = (t + step).clamp(from, to);
            if !step.is_finite() || next == t {
                break;
            }
            t = next;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::EdgeKind;
    use crate::spline::Span;

    /// A quarter circle of radius 50 around (100, 100), from right to below, in pixels.
    fn arc() -> Edge {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let p = |x: f64, y: f64, w: f64| DVec4::new(x * w, y * w, 0.0, w);
        let piece = Bezier { points: vec![p(150.0, 100.0, 1.0), p(150.0, 150.0, half), p(100.0, 150.0, 1.0)] };
        let curve = vec![Span { start: 0.0, end: 1.0, piece }];
        Edge { curve, ends: [0, 1], uses: Vec::new(), source: None, kind: EdgeKind::Sharp, turn: 1.0, deviation: 0.0 }
    }

    #[test]
    fn the_nearest_point_of_an_arc_is_on_the_radius() {
        for degrees in [0.0f64, 7.0, 33.0, 45.0, 80.0, 90.0] {
            for radius in [20.0, 49.0, 50.0, 53.0, 59.0] {
                let towards = DVec2::from_angle(degrees.to_radians());
                let pixel = DVec2::splat(100.0) + towards * radius;
                let found = nearest(&arc(), DMat4::IDENTITY, pixel, 40.0).expect("within reach");
                let expected = DVec2::splat(100.0) + towards * 50.0;
                // the distance is flat at its minimum, so the point is less exact than the distance
                assert!(found.pixel.distance(expected) < 1e-5, "{degrees} {radius}: {found:?}");
                assert!((found.distance_px - (radius - 50.0f64).abs()).abs() < 1e-9, "{found:?}");
            }
        }
        // beside its end the end is nearest
        let found = nearest(&arc(), DMat4::IDENTITY, DVec2::new(152.0, 97.0), 9.0).expect("within reach");
        assert_eq!((found.parameter, found.pixel), (0.0, DVec2::new(150.0, 100.0)));
        assert_eq!(nearest(&arc(), DMat4::IDENTITY, DVec2::splat(100.0), 49.9), None);
    }

    /// An edge that runs through the plane of the eye: the part in front is found.
    #[test]
    fn what_is_behind_the_eye_is_not_near() {
        let ends = vec![DVec4::new(10.0, 0.0, 0.0, 1.0), DVec4::new(10.0, 40.0, 0.0, -1.0)];
        let edge = Edge { curve: vec![Span { start: 0.0, end: 1.0, piece: Bezier { points: ends } }], ..arc() };
        // w = 1 - 2 t, x = 10 / w, y = 40 t / w: at t = 0.25 it is at (20, 20)
        let found = nearest(&edge, DMat4::IDENTITY, DVec2::new(21.0, 19.0), 5.0).expect("in front");
        assert!(found.pixel.x > 0.0 && found.distance_px <= 2f64.sqrt(), "{found:?}");
        assert_eq!(nearest(&edge, DMat4::IDENTITY, DVec2::new(-20.0, -20.0), 5.0), None);
    }
}
