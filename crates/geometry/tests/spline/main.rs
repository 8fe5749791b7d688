//! The spline core against closed forms, against itself by other routes, and at its edges.

mod curves;
mod differential;
mod errors;
mod patches;
mod refine;
mod surfaces;

use glam::{DVec3, DVec4};
use proptest::prelude::*;
use selvedge_geometry::spline::{BSpline, Control};

/// A knot vector of `degree` over a random domain: clamped or not, interior multiplicities up to the
/// degree.
pub fn knots(degree: usize) -> impl Strategy<Value = Vec<f64>> {
    let interior = prop::collection::vec((0.05f64..1.0, 1..=degree), 0..4);
    let ends = prop::collection::vec(prop_oneof![Just(0.0), 0.05f64..1.0], 2 * degree);
    (-5f64..5.0, interior, ends, any::<bool>()).prop_map(move |(start, interior, ends, clamped)| {
        let step = |i: usize| if clamped { 0.0 } else { ends[i] };
        let mut before = start;
        let mut knots: Vec<f64> = (0..degree)
            .map(|i| {
                before -= step(i);
                before
            })
            .collect();
        knots.reverse();
        knots.push(start);
        let mut at = start;
        for (gap, multiplicity) in interior {
            at += gap;
            knots.extend(std::iter::repeat_n(at, multiplicity));
        }
        at += 0.5;
        knots.push(at);
        for i in 0..degree {
            at += step(degree + i);
            knots.push(at);
        }
        knots
    })
}

/// A homogeneous control point in space with a weight from 0.1 to 10.
pub fn control() -> impl Strategy<Value = DVec4> {
    let weight = prop_oneof![Just(1.0), 0.1f64..10.0];
    (-1f64..1.0, -1f64..1.0, -1f64..1.0, weight).prop_map(|(x, y, z, w)| DVec4::from_point(DVec3::new(x, y, z), w))
}

/// A rational space curve of degree 1 to `max`.
pub fn spline(max: usize) -> impl Strategy<Value = BSpline<DVec4>> {
    (1..=max).prop_flat_map(|degree| (Just(degree), knots(degree))).prop_flat_map(|(degree, knots)| {
        let count = knots.len() - degree - 1;
        prop::collection::vec(control(), count)
            .prop_map(move |points| BSpline::new(degree, knots.clone(), points).expect("valid by construction"))
    })
}

/// Largest coordinate difference.
pub fn gap<P: Control>(a: P, b: P) -> f64 {
    (a - b).max_abs()
}
