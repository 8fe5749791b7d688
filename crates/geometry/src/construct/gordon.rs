//! A surface through a network of curves.
//!
//! ```text
//!   v2 ──┬────┬────┬── c2         L1: loft of the c_k        G = L1 + L2 - T
//!   v1 ──┼────┼────┼── c1         L2: loft of the d_l
//!   v0 ──┴────┴────┴── c0         T:  through the points where they meet
//!       d0   d1   d2
//!       u0   u1   u2
//! ```
//!
//! All three interpolate with the same operators along `u` and along `v`, so on `c_k` the lofts of the `d_l` and the
//! points cancel, and the other way round.
//!
//! Source: W. J. Gordon, *Sculptured surface definition via blending-function methods*, 1982; L. Piegl, W. Tiller,
//! *The NURBS Book*, 1997, section 10.5.

use super::ConstructError;
use super::compat::{apart, compatible, compatible_surfaces, size};
use super::loft::{SAME_SECTION, positive, scaled, skin};
use crate::spline::cubic::{Cubic, Ends, tensor};
use crate::spline::{BSpline, Control, Surface};
use glam::DVec4;

/// Curves that run along `u` at the fractions `v`, and curves along `v` at the fractions `u`.
#[derive(Clone, Copy, Debug)]
pub struct Network<'a> {
    /// Along `u`, from `v = 0` to `v = 1`.
    pub u_curves: &'a [BSpline<DVec4>],
    /// Along `v`, from `u = 0` to `u = 1`.
    pub v_curves: &'a [BSpline<DVec4>],
    /// Where the `v_curves` meet every one of the `u_curves`: fractions of their domains, from 0 to 1.
    pub u: &'a [f64],
    /// Where the `u_curves` meet the `v_curves`: from 0 to 1.
    pub v: &'a [f64],
}

/// The Gordon surface of a network, over the unit square.
///
/// It passes through all curves, to rounding (`1e-12` of the size), where they meet exactly. Else it passes within the
/// gap at the nearest crossings, which is at most `tolerance`, times the interpolation's norm (about 1 for even
/// parameters). C² between the curves, whose own continuity it keeps.
///
/// # Errors
/// * A negative or NaN tolerance.
/// * Fewer than two curves either way; curves of one direction that coincide, with points between them.
/// * Parameters that do not run from 0 to 1; curves that do not meet.
/// * Rational curves whose weights at the crossings no scaling of the curves makes equal.
pub fn gordon(network: Network, tolerance: f64) -> Result<Surface, ConstructError> {
    parameters("curves along u", network.u_curves.len(), "parameters v", network.v)?;
    parameters("curves along v", network.v_curves.len(), "parameters u", network.u)?;
    gap_allowed(tolerance)?;
    let c = compatible(network.u_curves)?;
    let d = compatible(network.v_curves)?;
    for (k, c) in c.iter().enumerate() {
        for (l, d) in d.iter().enumerate() {
            let gap = c.point(network.u[l]).distance(d.point(network.v[k]));
            if gap > tolerance {
                return Err(ConstructError::NetworkMismatch { u_curve: k, v_curve: l, gap });
            }
        }
    }
    let (c, d) = weighted(c, d, network.u, network.v)?;
    boolean_sum(&c, &d, network.u, network.v)
}

/// How far curves may miss each other.
pub(super) fn gap_allowed(tolerance: f64) -> Result<(), ConstructError> {
    if tolerance >= 0.0 && tolerance.is_finite() {
        return Ok(());
    }
    Err(ConstructError::Range { what: "the tolerance", value: tolerance, must: "a distance" })
}

/// All curves of one direction coincide, and those of the other are points: there is no surface between them.
fn no_area(c: &[BSpline<DVec4>], d: &[BSpline<DVec4>]) -> bool {
    let fine = SAME_SECTION * size(c.iter().chain(d));
    c.iter().all(|x| apart(x, &c[0]) <= fine) && d.iter().all(|x| size([x]) <= fine)
}

/// `L1 + L2 - T` of compatible curves whose weights agree where they meet.
pub(super) fn boolean_sum(
    c: &[BSpline<DVec4>],
    d: &[BSpline<DVec4>],
    u: &[f64],
    v: &[f64],
) -> Result<Surface, ConstructError> {
    if no_area(c, d) || no_area(d, c) {
        return Err(ConstructError::CoincidentSections { first: 0, second: 1 });
    }
    let (along_u, along_v) = (Cubic::new(u, Ends::NotAKnot)?, Cubic::new(v, Ends::NotAKnot)?);
    let meet = |k: usize, l: usize| (c[k].homogeneous(u[l]) + d[l].homogeneous(v[k])) * 0.5;
    let crossings: Vec<DVec4> =
        (0..v.len()).flat_map(|k| (0..u.len()).map(move |l| (k, l))).map(|(k, l)| meet(k, l)).collect();
    let knots = (along_u.knots().to_vec(), along_v.knots().to_vec());
    let through = tensor(&along_u, &along_v, &crossings);
    positive(&through)?;
    let points = Surface::new((along_u.degree(), along_v.degree()), knots.0, knots.1, through)?;
    let lofts = [skin(c, &along_v)?, skin(d, &along_u)?.transposed(), points];
    let [first, second, third] = &compatible_surfaces(&lofts)?[..] else { unreachable!("three in, three out") };
    let sum = first.points().iter().zip(second.points()).zip(third.points());
    let polynomial = lofts.iter().all(Surface::is_polynomial);
    let blended = |((a, b), t): ((&DVec4, &DVec4), &DVec4)| {
        let p = *a + *b - *t;
        if polynomial { p.with_w(1.0) } else { p }
    };
    let net: Vec<DVec4> = sum.map(blended).collect();
    positive(&net)?;
    Ok(Surface::new(first.degrees(), first.knots().0.to_vec(), first.knots().1.to_vec(), net)?)
}

/// At least two curves, and one parameter each, from 0 to 1.
fn parameters(curves: &'static str, count: usize, what: &'static str, at: &[f64]) -> Result<(), ConstructError> {
    if count < 2 {
        return Err(ConstructError::TooFew { what: curves, got: count, needed: 2 });
    }
    if at.len() != count {
        return Err(ConstructError::Count { what, got: at.len(), needed: count });
    }
    if let Some(index) = (1..count).find(|&i| at[i] <= at[i - 1] || at[i].is_nan()) {
        return Err(ConstructError::Order { what, index });
    }
    for (value, must) in [(at[0], 0.0), (at[count - 1], 1.0)] {
        if value != must {
            return Err(ConstructError::Range { what, value, must: "from 0 to 1" });
        }
    }
    Ok(())
}

/// Each curve scaled so that weights agree at all crossings.
#[allow(clippy::type_complexity)] // two lists of curves
fn weighted(
    c: Vec<BSpline<DVec4>>,
    d: Vec<BSpline<DVec4>>,
    u: &[f64],
    v: &[f64],
) -> Result<(Vec<BSpline<DVec4>>, Vec<BSpline<DVec4>>), ConstructError> {
    /// Weights are products of rounded numbers.
    const SAME_WEIGHT: f64 = 1e-10;
    let scale = |curve: &BSpline<DVec4>, by: f64| {
        BSpline::new(curve.degree(), curve.knots().to_vec(), curve.points().iter().map(|p| *p * by).collect())
    };
    if c.iter().chain(&d).all(BSpline::is_polynomial) {
        let unit = |all: &[BSpline<DVec4>]| all.iter().map(scaled).collect::<Result<Vec<_>, _>>();
        return Ok((unit(&c)?, unit(&d)?));
    }
    let first = scale(&c[0], 1.0 / c[0].homogeneous(0.0).w)?;
    let weight = |curve: &BSpline<DVec4>, at: f64| curve.homogeneous(at).weight();
    let d =
        d.iter().zip(u).map(|(d, u)| scale(d, weight(&first, *u) / weight(d, 0.0))).collect::<Result<Vec<_>, _>>()?;
    let c =
        c.iter().zip(v).map(|(c, v)| scale(c, weight(&d[0], *v) / weight(c, 0.0))).collect::<Result<Vec<_>, _>>()?;
    for (c, v) in c.iter().zip(v) {
        for (d, u) in d.iter().zip(u) {
            let (a, b) = (weight(c, *u), weight(d, *v));
            if (a - b).abs() > SAME_WEIGHT * a {
                return Err(ConstructError::Weights { what: "they do not agree where the curves meet" });
            }
        }
    }
    Ok((c, d))
}
