//! Which sides of a face's surface meet, and which are points, whatever its trims: pass `border_follow` follows surfaces
//! over seams, and looks again beyond poles.
//!
//! ```text
//!   ●═══════════════●   a point: its control points are one
//!   │               │
//!   ┆ ◀── meets ──▶ ┆   the same control points on both sides: a seam
//! ```

use super::face::{POINT, poles};
use crate::abi;
use crate::spline::{Control, Patch, PatchGrid};

/// Bits of [`abi::Face::flags`] of a surface whose box has a diagonal of `size`.
pub(super) fn side_flags(grid: &PatchGrid, size: f64) -> u32 {
    let (columns, rows) = (grid.count_u, grid.count_v);
    let patch = |column: usize, row: usize| &grid.patches[row * columns + column].patch;
    let (right, top) = (columns - 1, rows - 1);
    let of_column = |column: usize| (0..rows).fold(u32::MAX, |all, row| all & poles(patch(column, row)));
    let of_row = |row: usize| (0..columns).fold(u32::MAX, |all, column| all & poles(patch(column, row)));
    let points = of_column(0) & abi::BORDER_U0
        | of_column(right) & abi::BORDER_U1
        | of_row(0) & abi::BORDER_V0
        | of_row(top) & abi::BORDER_V1;
    let is_none = |bits: u32| points & bits == 0;
    let near = POINT * size;
    let meets_u = is_none(abi::BORDER_U0 | abi::BORDER_U1)
        && (0..rows).all(|row| meet((patch(0, row), patch(right, row)), true, near));
    let meets_v = is_none(abi::BORDER_V0 | abi::BORDER_V1)
        && (0..columns).all(|column| meet((patch(column, 0), patch(column, top)), false, near));
    let flag = |on: bool, bit: u32| if on { bit } else { 0 };
    points << abi::FACE_POINTS | flag(meets_u, abi::FACE_MEETS_U) | flag(meets_v, abi::FACE_MEETS_V)
}

/// Whether the first patch begins along `u`, or `v`, where the last one ends, point by point.
fn meet((first, last): (&Patch, &Patch), along_u: bool, near: f64) -> bool {
    let (n, k) = (first.degree_u, first.degree_v);
    let ends = |at: usize| if along_u { (at * (n + 1), at * (n + 1) + n) } else { (at, k * (n + 1) + at) };
    (0..=if along_u { k } else { n }).all(|at| {
        let (p, q) = (first.points[ends(at).0], last.points[ends(at).1]);
        p.point().distance(q.point()) <= near && (p.w - q.w).abs() <= POINT * p.w.abs()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::construct::shapes;
    use crate::spline::Surface;
    use glam::DVec4;

    fn of(surface: &Surface) -> u32 {
        let (lo, hi) = surface.bounds();
        side_flags(&surface.patches(), (hi - lo).length())
    }

    /// Of the faces of a solid, in their order.
    fn of_faces(faces: &[crate::model::Face]) -> Vec<u32> {
        faces.iter().map(|face| of(&face.surface)).collect()
    }

    #[test]
    fn seams_and_poles_are_found() {
        let (south, north) = (abi::BORDER_V0 << abi::FACE_POINTS, abi::BORDER_V1 << abi::FACE_POINTS);
        let ball = shapes::sphere(2.0).unwrap();
        assert_eq!(of_faces(&ball.part.faces), [abi::FACE_MEETS_U | south | north]);
        let ring = shapes::torus(3.0, 1.0).unwrap();
        assert_eq!(of_faces(&ring.part.faces), [abi::FACE_MEETS_U | abi::FACE_MEETS_V]);
        // bottom, side, top
        let post = shapes::cylinder(1.0, 2.0).unwrap();
        assert_eq!(of_faces(&post.part.faces), [0, abi::FACE_MEETS_U, 0]);
    }

    /// A tip has one point on its side, and a side that nearly meets the other does not meet it.
    #[test]
    fn what_is_nearly_so_is_not() {
        let knots = vec![0.0, 0.0, 1.0, 1.0];
        let corner = |x: f64, y: f64, w: f64| DVec4::new(x * w, y * w, 0.0, w);
        let folded = |gap: f64, weight: f64| {
            let points =
                vec![corner(0.0, 0.0, 1.0), corner(gap, 0.0, 1.0), corner(0.0, 1.0, 1.0), corner(0.0, 1.0, weight)];
            of(&Surface::new((1, 1), knots.clone(), knots.clone(), points).unwrap())
        };
        let both = (abi::BORDER_V0 | abi::BORDER_V1) << abi::FACE_POINTS;
        assert_eq!(folded(0.0, 1.0), abi::FACE_MEETS_U | both);
        assert_eq!(folded(1e-3, 1.0), abi::BORDER_V1 << abi::FACE_POINTS);
        assert_eq!(folded(0.0, 1.5), both);
    }
}
