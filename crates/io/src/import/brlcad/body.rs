//! Solids of BRL-CAD: each the affine image of a shape that is known exactly.
//!
//! ```text
//!   ell  ball of (A B C V)        tgc  cylinder or cone of (A B H V), where C = k A and D = k B
//!   tor  about H                  arb8 half-spaces of its faces, corners may coincide       half  n·x <= d
//! ```

use super::Fault;
use super::words::Statement;
use crate::import::scad::planes;
use crate::import::solid::{Assembly, Placed, around};
use crate::model::Shape;
use glam::{DAffine3, DMat3, DVec3};

/// Corners of the six faces, counter-clockwise from outside when 1 to 4 turn left seen from 5 to 8.
const FACES: [[usize; 4]; 6] = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2]];
/// Vectors that are parallel to rounding, relative to their length.
const ROUNDING: f64 = 1e-9;

/// A solid as a node.
pub(super) fn body(to: &mut Assembly, object: &Statement<'_>, placed: &Placed) -> Result<u32, Fault> {
    let vector = |key: &str| object.numbers::<3>(key).map(DVec3::from_array);
    let mut add = |shape: Shape, x: DVec3, y: DVec3, z: DVec3, at: DVec3| {
        let own = DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation: at };
        to.add(shape, &Placed { transform: placed.transform * own, ..*placed })
    };
    match object.words[2] {
        "ell" | "sph" => {
            let radius = 1.0;
            Ok(add(Shape::Sphere { radius }, vector("A")?, vector("B")?, vector("C")?, vector("V")?))
        }
        "tor" => {
            let ([major], [minor]) = (object.numbers::<1>("r_a")?, object.numbers::<1>("r_h")?);
            let axis = vector("H")?.try_normalize().ok_or_else(|| object.fault("`H` has no length"))?;
            if major < 0.0 || minor < 0.0 {
                return Err(object.fault("a radius is negative"));
            }
            let (x, y) = axis.any_orthonormal_pair();
            Ok(add(Shape::Torus { major, minor }, x, y, axis, vector("V")?))
        }
        "tgc" | "rcc" | "rec" | "trc" => {
            let (v, h) = (vector("V")?, vector("H")?);
            let (a, b, c, d) = (vector("A")?, vector("B")?, vector("C")?, vector("D")?);
            if a.length() + b.length() < c.length() + d.length() {
                return cone([c, d, a, b], v + h, -h, object, &mut add);
            }
            cone([a, b, c, d], v, h, object, &mut add)
        }
        "arb8" | "arb7" | "arb6" | "arb5" | "arb4" => {
            let corners: Vec<DVec3> = (1..=8).map(|i| vector(&format!("V{i}"))).collect::<Result<_, _>>()?;
            let first = |i: usize| corners.iter().position(|p| *p == corners[i]).unwrap_or(i) as u32;
            let face = |f: &[usize; 4]| {
                let mut f: Vec<u32> = f.iter().map(|i| first(*i)).collect();
                f.dedup();
                f
            };
            let faces: Vec<Vec<u32>> = FACES.iter().map(face).filter(|f| f.len() >= 3).collect();
            let planes = planes(&corners, &faces);
            let planes =
                planes.ok_or_else(|| object.fault("faces that are not flat, or no convex solid, are not read"))?;
            Ok(to.half_spaces(around(corners.iter().copied()), &planes, placed))
        }
        "half" => {
            let [x, y, z, offset] = object.numbers::<4>("N")?;
            let normal = DVec3::new(x, y, z);
            if normal == DVec3::ZERO {
                return Err(object.fault("`N` has no length"));
            }
            Ok(to.add(Shape::HalfSpace { normal, offset }, placed))
        }
        _ => Err(object.fault("such a solid has no exact counterpart and is not read")),
    }
}

/// From the larger ellipse at `v` to the smaller one at `v + h`.
fn cone(
    [a, b, c, d]: [DVec3; 4],
    v: DVec3,
    h: DVec3,
    object: &Statement<'_>,
    add: &mut impl FnMut(Shape, DVec3, DVec3, DVec3, DVec3) -> u32,
) -> Result<u32, Fault> {
    let top = if a.length() > 0.0 { c.dot(a) / a.length_squared() } else { 0.0 };
    let off = (c - a * top).length() + (d - b * top).length();
    if top < 0.0 || off > ROUNDING * (a.length() + b.length()) {
        return Err(object.fault("ends of different shape are not read"));
    }
    let height = 1.0;
    let same = (top - 1.0).abs() <= ROUNDING;
    let shape = if same { Shape::Cylinder { radius: 1.0, height } } else { Shape::Cone { bottom: 1.0, top, height } };
    Ok(add(shape, a, b, h, v))
}
