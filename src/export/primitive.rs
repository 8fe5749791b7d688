//! Solids that are one primitive, as parts with exact faces.

use crate::construct::shapes::{block, cone, cylinder, sphere, torus};
use crate::csg::Node;
use crate::model::{Part, Primitive, Shape, Solid};

/// The primitive that the solid is, and its faces in the primitive's own coordinates.
///
/// # Errors
/// Why there are none: an expression of several primitives has to be evaluated first, and shapes without an end have
/// no faces that a file could hold.
pub(super) fn faces(solid: &Solid) -> Result<(&Primitive, Part), String> {
    let Some(Node::Leaf(leaf)) = solid.tree().nodes().last() else {
        let count = solid.primitives().len();
        return Err(format!("is a Boolean expression over {count} primitives and was left out"));
    };
    let primitive = &solid.primitives()[*leaf as usize];
    let body = match &primitive.shape {
        Shape::Block { min, max } => block(*min, *max),
        Shape::Sphere { radius } => sphere(*radius),
        Shape::Cylinder { radius, height } => cylinder(*radius, *height),
        Shape::Cone { bottom, top, height } => cone(*bottom, *top, *height),
        Shape::Torus { major, minor } => torus(*major, *minor),
        Shape::Part(part) => return Ok((primitive, Part::clone(part))),
        Shape::HalfSpace { .. } | Shape::Quadric(_) => return Err("has no bounded faces and was left out".into()),
        Shape::Mesh(_) => return Err("is a mesh and was left out".into()),
    };
    match body {
        Ok(body) => Ok((primitive, body.part)),
        Err(e) => Err(format!("was left out: {e}")),
    }
}
