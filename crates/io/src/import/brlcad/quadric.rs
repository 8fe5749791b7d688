//! Solids between a quadric and planes: the quadric in a unit frame, and the box whose sides are the planes.
//!
//! ```text
//!   epa   x² + y² <= 1 - z                      paraboloid, ellipse at V, tip at V + H
//!   ehy   (1 + 2k) (x² + y²) <= (1+k-z)² - k²   one sheet of a hyperboloid, k = c / |H|, its cone's tip at 1 + k
//!   hyp   x² + y² <= n² + (1 - n²) (2z - 1)²    waisted, n = bnr, ellipses at both ends
//!   rpc   y² <= 1 - x                           parabola along H: rectangle at V, tip at V + B
//!   rhc   (1 + 2k) y² <= (1+k-x)² - k²          hyperbola, k = c / |B|
//! ```

use super::Fault;
use super::body::frame;
use super::object::Record;
use crate::csg::Op;
use crate::import::solid::{Assembly, Placed};
use crate::model::{Quadric, Shape};
use glam::DVec3;

/// Share of the size by which sides of the box that bound nothing stand off.
const MARGIN: f64 = 0.1;

/// A solid as a node.
pub(super) fn node(to: &mut Assembly, object: &Record<'_>, placed: &Placed) -> Result<u32, Fault> {
    let (v, h) = (object.vector("V")?, object.vector("H")?);
    let along = h.try_normalize().ok_or_else(|| object.fault("`H` has no length"))?;
    let across = |a: DVec3| a.reject_from_normalized(along).try_normalize();
    let skew = |key: &str| object.fault(format!("`{key}` has no length across `H`"));
    let wide = 1.0 + MARGIN;
    let (own, quadric, min, max) = match object.kind {
        "rpc" | "rhc" => {
            let (b, r) = (object.vector("B")?, object.positive("r")?);
            let side = across(b).ok_or_else(|| skew("B"))?;
            let (bend, top) = match object.kind {
                "rpc" => (None, wide),
                _ => sheet(object, b.length()).map(|(k, top)| (Some(k), top))?,
            };
            let quadric = match bend {
                None => Quadric { squares: DVec3::Y, linear: DVec3::X, constant: -1.0, ..Quadric::default() },
                Some(k) => Quadric {
                    squares: DVec3::new(-1.0, 1.0 + 2.0 * k, 0.0),
                    linear: DVec3::X * (2.0 * (1.0 + k)),
                    constant: k * k - (1.0 + k) * (1.0 + k),
                    ..Quadric::default()
                },
            };
            let own = frame(b, along.cross(side) * r, h, v);
            (own, quadric, DVec3::new(0.0, -wide, 0.0), DVec3::new(top, wide, 1.0))
        }
        kind => {
            let x = across(object.vector("A")?).ok_or_else(|| skew("A"))?;
            let [first, second] = if kind == "hyp" {
                [object.vector("A")?.length(), object.positive("b")?]
            } else {
                [object.positive("r_1")?, object.positive("r_2")?]
            };
            let own = frame(x * first, along.cross(x) * second, h, v);
            let round = DVec3::new(1.0, 1.0, 0.0);
            let (quadric, top) = match kind {
                "epa" => (Quadric { squares: round, linear: DVec3::Z, constant: -1.0, ..Quadric::default() }, wide),
                "ehy" => {
                    let (k, top) = sheet(object, h.length())?;
                    let quadric = Quadric {
                        squares: round * (1.0 + 2.0 * k) - DVec3::Z,
                        linear: DVec3::Z * (2.0 * (1.0 + k)),
                        constant: k * k - (1.0 + k) * (1.0 + k),
                        ..Quadric::default()
                    };
                    (quadric, top)
                }
                _ => {
                    let neck = object.positive("bnr")?;
                    let n = neck * neck;
                    if neck > 1.0 {
                        return Err(object.fault(format!("`bnr` is {neck}, but must be at most 1")));
                    }
                    let quadric = Quadric {
                        squares: round - DVec3::Z * (4.0 * (1.0 - n)),
                        linear: DVec3::Z * (4.0 * (1.0 - n)),
                        constant: -1.0,
                        ..Quadric::default()
                    };
                    (quadric, 1.0)
                }
            };
            (own, quadric, DVec3::new(-wide, -wide, 0.0), DVec3::new(wide, wide, top))
        }
    };
    let placed = Placed { transform: placed.transform * own, ..*placed };
    let block = to.add(Shape::Block { min, max }, &placed);
    let curved = to.add(Shape::Quadric(quadric), &placed);
    Ok(to.nodes.pair(Op::Intersection, block, curved))
}

/// `k`, and a height between the tips of the two sheets, which stand at 1 and `1 + 2 k`.
fn sheet(object: &Record<'_>, length: f64) -> Result<(f64, f64), Fault> {
    let k = object.positive("c")? / length;
    Ok((k, 1.0 + k.min(MARGIN)))
}
