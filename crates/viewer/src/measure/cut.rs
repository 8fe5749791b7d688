//! Section planes that follow from a selected face.
//!
//! | face | plane |
//! |---|---|
//! | plane | just below it |
//! | cylinder, cone, torus | through the axis, across the line from there to the picked point |
//! | sphere | through the centre, across that line |

use crate::session::{Picked, Section, Session};
use selvedge_geometry::measure::surface::{self, SurfaceShape};

/// The section at the face that was selected last; `None` where no face is, or the face has none of these shapes.
pub fn at_selection(session: &Session) -> Option<Section> {
    let Some(Picked::Face { instance, face, uv }) = session.selection.last().copied() else { return None };
    let world = &session.world;
    let part = world.model.instances.get(instance)?.part;
    let face = world.model.parts[part].faces.get(face)?;
    let transform = session.scene.now().placement(instance, world);
    let point = transform.transform_point3(face.surface.point(uv.x, uv.y));
    let shape = surface::shape(face, transform);
    let (normal, through) = match shape {
        SurfaceShape::Plane { normal, .. } => {
            let own = face.surface.normal(uv.x, uv.y)?;
            let outward = transform.transform_vector3(if face.same_sense { own } else { -own });
            let normal = if normal.dot(outward) < 0.0 { -normal } else { normal };
            (normal, point - normal * (Section::BELOW * world.bounds.diagonal()))
        }
        _ => {
            let (middle, axis) = shape.middle()?;
            let out = point - middle;
            (axis.map_or(out, |axis| out.reject_from(axis)).try_normalize()?, middle)
        }
    };
    Some(Section { normal, offset: normal.dot(through), on: true })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::World;
    use glam::{DAffine3, DVec3};
    use selvedge::construct::shapes;
    use selvedge::model::{Instance, Model, Part};
    use std::sync::Arc;

    /// The section at the middle of a face of a part that is moved to `by`.
    fn cut(part: Part, face: usize, by: DVec3) -> Option<Section> {
        let ((u0, u1), (v0, v1)) = part.faces[face].surface.domain();
        let uv = glam::DVec2::new(0.5 * (u0 + u1), 0.5 * (v0 + v1));
        let transform = DAffine3::from_translation(by);
        let placed = Instance { part: 0, transform, colour: None, name: String::new() };
        let mut world = World::default();
        world.model = Model { parts: vec![part], instances: vec![placed], ..Model::default() };
        world.bounds = world.model.bounds();
        let mut session = Session { world: Arc::new(world), ..Session::default() };
        session.select(Some(Picked::Face { instance: 0, face, uv }), false);
        at_selection(&session)
    }

    /// The side of a plane face that stays is the one with the material.
    #[test]
    fn a_block_is_cut_just_below_each_of_its_faces() {
        let (low, high, by) = (DVec3::new(-1.0, 0.0, 2.0), DVec3::new(2.0, 1.0, 7.0), DVec3::new(10.0, 20.0, 30.0));
        let part = shapes::block(low, high).unwrap().part;
        let middle = by + 0.5 * (low + high);
        let diagonal = (high - low).length();
        for face in 0..6 {
            let section = cut(part.clone(), face, by).expect("a plane");
            let half = (section.normal.abs() * (high - low)).element_sum() * 0.5;
            let above = section.offset - section.normal.dot(middle) - half;
            assert!((above + Section::BELOW * diagonal).abs() < 1e-12 * diagonal, "face {face}: {above}");
        }
    }

    #[test]
    fn round_faces_are_cut_through_their_middle() {
        let by = DVec3::new(3.0, -4.0, 5.0);
        for part in [shapes::sphere(2.5).unwrap().part, shapes::torus(4.0, 1.25).unwrap().part] {
            let section = cut(part, 0, by).expect("a middle");
            assert!((section.normal.length() - 1.0).abs() < 1e-12);
            // the middle is found from samples
            assert!((section.offset - section.normal.dot(by)).abs() < 1e-9, "{section:?}");
        }
    }

    #[test]
    fn without_a_face_there_is_no_plane() {
        assert_eq!(at_selection(&Session::default()), None);
    }
}
