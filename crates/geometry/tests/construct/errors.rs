//! Constructions that fail name the fault.

use crate::{line, planar};
use glam::DVec3;
use selvedge_geometry::construct::{Boundary, ConstructError, Network, coons, extrude, gordon, lathe, loft, ruled};
use std::f64::consts::TAU;

#[test]
fn extrusion() {
    let c = line(&[DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)]);
    assert!(matches!(extrude(&c, DVec3::ZERO), Err(ConstructError::ZeroLength { .. })));
    assert!(matches!(extrude(&c, DVec3::new(f64::NAN, 0.0, 1.0)), Err(ConstructError::NotFinite { .. })));
    let along = line(&[DVec3::ZERO, DVec3::X]);
    assert!(matches!(extrude(&along, DVec3::X), Err(ConstructError::ZeroLength { .. })), "no area");
    assert!(extrude(&along, DVec3::Z).is_ok());
}

#[test]
fn lathes() {
    let crossing = planar(&[(1.0, 0.0), (0.5, 1.0), (-1.0, 2.0)]);
    let Err(ConstructError::CrossesAxis { parameter }) = lathe(&crossing, TAU) else { panic!("it crosses") };
    assert!(parameter > 1.0, "{parameter}");
    assert_eq!(lathe(&planar(&[(0.0, 0.0), (0.0, 1.0)]), TAU), Err(ConstructError::OnAxis));
    for angle in [0.0, -1.0, 7.0, f64::NAN] {
        let refused = lathe(&planar(&[(1.0, 0.0), (1.0, 1.0)]), angle);
        assert!(matches!(refused, Err(ConstructError::Range { .. })), "{angle}");
    }
    // a profile that touches the axis from one side has a pole, wherever it touches
    assert!(lathe(&planar(&[(1.0, 0.0), (0.0, 1.0), (1.0, 2.0)]), TAU).is_ok());
}

#[test]
fn sections() {
    let c = |z: f64| line(&[DVec3::new(0.0, 0.0, z), DVec3::new(1.0, 0.0, z)]);
    assert_eq!(ruled(&c(0.0), &c(0.0)), Err(ConstructError::CoincidentSections { first: 0, second: 1 }));
    let same = loft(&[c(0.0), c(1.0), c(1.0), c(2.0)], false);
    assert_eq!(same, Err(ConstructError::CoincidentSections { first: 1, second: 2 }));
    assert_eq!(loft(&[c(0.0)], false), Err(ConstructError::TooFew { what: "sections", got: 1, needed: 2 }));
    assert_eq!(loft(&[c(0.0), c(1.0)], true), Err(ConstructError::TooFew { what: "sections", got: 2, needed: 3 }));
    let again = loft(&[c(0.0), c(1.0), c(2.0), c(0.0)], true);
    assert_eq!(again, Err(ConstructError::CoincidentSections { first: 3, second: 0 }));
}

#[test]
fn boundaries() {
    let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ONE];
    let (bottom, top, left) = (line(&[a, b]), line(&[c, d]), line(&[a, c]));
    let off = line(&[b, d + DVec3::Z]);
    let refused = coons(Boundary { bottom: &bottom, top: &top, left: &left, right: &off }, 1e-6);
    assert_eq!(refused, Err(ConstructError::CornerMismatch { corner: 3, gap: 1.0 }));
}

#[test]
fn networks() {
    let c = [line(&[DVec3::ZERO, DVec3::X]), line(&[DVec3::Y, DVec3::X + DVec3::Y])];
    let d = [line(&[DVec3::ZERO, DVec3::Y]), line(&[DVec3::X, DVec3::X + DVec3::Y])];
    let ends = [0.0, 1.0];
    let whole = Network { u_curves: &c, v_curves: &d, u: &ends, v: &ends };
    assert!(gordon(whole, 1e-9).is_ok());
    let fewer = gordon(Network { u_curves: &c[..1], ..whole }, 1e-9);
    assert!(matches!(fewer, Err(ConstructError::TooFew { got: 1, .. })));
    assert!(matches!(gordon(Network { u: &[0.0, 0.5, 1.0], ..whole }, 1e-9), Err(ConstructError::Count { .. })));
    assert!(matches!(gordon(Network { u: &[1.0, 0.0], ..whole }, 1e-9), Err(ConstructError::Order { index: 1, .. })));
    assert!(matches!(gordon(Network { v: &[0.0, 0.9], ..whole }, 1e-9), Err(ConstructError::Range { .. })));
    assert!(matches!(gordon(Network { v: &[0.0, f64::NAN], ..whole }, 1e-9), Err(ConstructError::Order { .. })));
    let off = [d[0].clone(), line(&[DVec3::X, DVec3::X + DVec3::Y + DVec3::Z])];
    let refused = gordon(Network { v_curves: &off, ..whole }, 1e-9);
    assert_eq!(refused, Err(ConstructError::NetworkMismatch { u_curve: 1, v_curve: 1, gap: 1.0 }));
}
