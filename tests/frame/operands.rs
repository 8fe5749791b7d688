//! Boolean solids with operands of meshes and spline parts, against the exact reference, every pixel.

use crate::shapes::operands;
use crate::solids::right_at;

/// The exact reference takes its time for meshes and splines.
const SIZE: (u32, u32) = (96, 64);

#[test]
fn meshes() {
    right_at(SIZE, operands::meshes(), false);
}

#[test]
fn spline_parts() {
    right_at(SIZE, operands::splines(), false);
}

#[test]
fn unclean_meshes() {
    right_at(SIZE, operands::unclean(), false);
}
