//! Models cut open: by a plane, with caps, or by any volume, without.
//!
//! ```text
//!   section   closed parts and solids the plane passes through      ┌──────┐ n
//!             become Boolean: part * block on the kept side         │ part ├──▶      normal · p <= offset stays
//!             what lies wholly on that side stays, the rest goes    └──────┘
//!   trim_by   surfaces are kept inside the volume               open shells; solids: their volume within it
//! ```

use super::{Bounds, Colour, GREY, Instance, Model, Part, Primitive, Shape, Solid, SolidError};
use glam::{DAffine3, DMat3, DVec3};
use std::sync::Arc;

/// The block on the kept side reaches this far beyond the part that it cuts, relative to its size: no other side of the
/// block cuts anything.
const MARGIN: f64 = 0.1;

/// `normal · p <= offset` with a unit normal.
#[derive(Clone, Copy)]
struct Plane {
    normal: DVec3,
    offset: f64,
}

/// The side of a box.
enum Place {
    Kept,
    Gone,
    Cut,
}

impl Plane {
    fn new(normal: DVec3, offset: f64) -> Self {
        let length = normal.length();
        Self { normal: normal / length, offset: offset / length }
    }

    fn place(self, corners: &[DVec3]) -> Place {
        let heights = corners.iter().map(|c| self.normal.dot(*c) - self.offset);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        match () {
            () if high <= 0.0 => Place::Kept,
            () if low >= 0.0 => Place::Gone,
            () => Place::Cut,
        }
    }

    /// A block below the plane, around the part of the corners' box there; only its top cuts.
    fn block(self, corners: &[DVec3], colour: Colour, id: u32) -> Primitive {
        let (u, v) = self.normal.any_orthonormal_pair();
        let axes = DMat3::from_cols(u, v, self.normal);
        let transform = DAffine3::from_mat3_translation(axes, self.normal * self.offset);
        let own = corners.iter().map(|c| axes.transpose() * (*c - transform.translation));
        let tight = own.fold(Bounds::EMPTY, Bounds::with);
        let margin = DVec3::splat(MARGIN * tight.diagonal());
        let (min, max) = (tight.min - margin, (tight.max + margin).with_z(0.0));
        Primitive { shape: Shape::Block { min, max }, transform, colour, id }
    }
}

impl Model {
    /// The model where `normal · p <= offset`, model coordinates, with the cuts closed. Closed parts and Boolean solids
    /// that the plane passes through become Boolean solids, each with a cap in its own colour. Faces that have a colour
    /// keep it; all faces of such a part get the number of the first, and its cap gets a number beyond all others.
    /// Parts that are not closed have no inside and stay open: they are [trimmed](Self::trim_by). Parts on the kept
    /// side, and an earlier trimming volume, stay unchanged.
    ///
    /// Rounding decides whether a face in the plane itself is drawn: avoid such planes.
    ///
    /// # Errors
    /// [`SolidError::Shape`] when the normal is zero or a number is not finite.
    ///
    /// # Example
    /// ```
    /// use selvedge_geometry::model::Model;
    /// let half = Model::default().section(glam::DVec3::X, 0.0).unwrap();
    /// assert!(half.solids.is_empty());
    /// ```
    pub fn section(&self, normal: DVec3, offset: f64) -> Result<Self, SolidError> {
        let half = Shape::HalfSpace { normal, offset };
        half.check().map_err(|error| SolidError::Shape { primitive: 0, error })?;
        let plane = Plane::new(normal, offset);
        let mut left = Self { instances: Vec::new(), solids: Vec::new(), ..self.clone() };
        let first = self.largest_id() + 1;
        let mut next = first;
        let mut number = || {
            next += 1;
            next - 1
        };
        let mut shared: Vec<Option<Arc<Part>>> = vec![None; self.parts.len()];
        let mut open = false;
        for instance in &self.instances {
            let Some(part) = self.parts.get(instance.part) else { continue };
            let bounds = part.control_bounds();
            if bounds.is_empty() {
                continue;
            }
            let corners = bounds.corners().map(|c| instance.transform.transform_point3(c));
            match plane.place(&corners) {
                Place::Gone => {}
                Place::Cut if part.closed => {
                    let part = shared[instance.part].get_or_insert_with(|| Arc::new(part.clone()));
                    let operand = instance.operand(part);
                    let block = plane.block(&corners, operand.colour, number());
                    left.solids.push(Solid::of(operand)?.intersection(&Solid::of(block)?)?);
                }
                place => {
                    open |= matches!(place, Place::Cut);
                    left.instances.push(instance.clone());
                }
            }
        }
        for solid in &self.solids {
            let bounds = solid.bounds();
            let bounded = bounds.min.is_finite() && bounds.max.is_finite();
            let place = if bounds.is_empty() { Place::Gone } else { plane.place(&bounds.corners()) };
            match if bounded || bounds.is_empty() { place } else { Place::Cut } {
                Place::Gone => {}
                Place::Kept => left.solids.push(solid.clone()),
                Place::Cut => {
                    let colour = solid.primitives().first().map_or(GREY, |p| p.colour);
                    let cut = if bounded {
                        plane.block(&bounds.corners(), colour, number())
                    } else {
                        Primitive { shape: half.clone(), transform: DAffine3::IDENTITY, colour, id: number() }
                    };
                    left.solids.push(solid.intersection(&Solid::of(cut)?)?);
                }
            }
        }
        left.cuts.extend(first..next);
        if open {
            let transform = DAffine3::IDENTITY;
            let half = Solid::of(Primitive { shape: half, transform, colour: GREY, id: 1 })?;
            left.trim = Some(left.trim.iter().try_fold(half, |all, t| all.intersection(t))?);
        }
        Ok(left)
    }

    /// Trims every surface by a volume, model coordinates: points outside of it are not drawn. Parts are then open
    /// shells, and show their other side where they are cut. A Boolean solid becomes its
    /// [intersection](Solid::intersection) with the volume, in the volume's colours where it cuts. Points on the
    /// volume's boundary are kept. A second call keeps the points in both volumes.
    ///
    /// Its primitives need equations: a volume with meshes or parts among them is refused when the model is
    /// drawn.
    ///
    /// # Errors
    /// [`SolidError`] when an expression becomes too large; the model stays as it was.
    pub fn trim_by(&mut self, volume: &Solid) -> Result<(), SolidError> {
        let solids: Vec<Solid> = self.solids.iter().map(|s| s.intersection(volume)).collect::<Result<_, _>>()?;
        let trim = self.trim.as_ref().map_or_else(|| Ok(volume.clone()), |before| before.intersection(volume))?;
        (self.solids, self.trim) = (solids, Some(trim));
        Ok(())
    }

    /// The largest number of a face, mesh or primitive; 0 without any.
    fn largest_id(&self) -> u32 {
        let faces = self.parts.iter().flat_map(|p| &p.faces).map(|f| f.id);
        let meshes = self.parts.iter().flat_map(|p| &p.meshes).map(|m| m.id);
        let leaves = self.solids.iter().flat_map(Solid::primitives).map(|p| p.id);
        faces.chain(meshes).chain(leaves).max().unwrap_or(0)
    }
}

impl Instance {
    /// The placed part as a primitive, with the number of its first face.
    pub(super) fn operand(&self, part: &Arc<Part>) -> Primitive {
        let part = if self.colour.is_some() { &Part::uncoloured(part) } else { part };
        let own = part.faces.iter().map(|f| f.colour).chain(part.meshes.iter().map(|m| m.colour));
        let id = part.faces.iter().map(|f| f.id).chain(part.meshes.iter().map(|m| m.id)).next();
        Primitive {
            shape: Shape::Part(part.clone()),
            transform: self.transform,
            colour: self.colour.or_else(|| own.flatten().next()).unwrap_or(GREY),
            id: id.unwrap_or(1),
        }
    }
}

impl Part {
    /// The part without colours of its faces and meshes; the same `Arc` where none has any.
    pub fn uncoloured(part: &Arc<Self>) -> Arc<Self> {
        let own = part.faces.iter().map(|f| f.colour).chain(part.meshes.iter().map(|m| m.colour));
        if own.flatten().next().is_none() {
            return part.clone();
        }
        let mut bare = Self::clone(part);
        bare.faces.iter_mut().for_each(|f| f.colour = None);
        bare.meshes.iter_mut().for_each(|m| m.colour = None);
        Arc::new(bare)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Mesh;

    /// A tetrahedron's corners, from the origin to 1 along each axis, as a part of one mesh.
    fn corner(id: u32, closed: bool, colour: Option<Colour>) -> Part {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let mut mesh = Mesh::new(id, positions, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], vec![]).unwrap();
        mesh.colour = colour;
        Part { meshes: vec![mesh], closed, ..Part::default() }
    }

    fn placed(part: usize, x: f64, colour: Option<Colour>) -> Instance {
        Instance { part, transform: DAffine3::from_translation(DVec3::X * x), colour, name: String::new() }
    }

    fn ball(x: f64, id: u32) -> Solid {
        let transform = DAffine3::from_translation(DVec3::X * x);
        Solid::of(Primitive { shape: Shape::Sphere { radius: 0.5 }, transform, colour: GREY, id }).unwrap()
    }

    #[test]
    fn what_the_plane_leaves_whole_stays_as_it_is() {
        let red = [1.0, 0.0, 0.0, 1.0];
        let model = Model {
            parts: vec![corner(7, true, Some(red)), corner(8, false, None)],
            instances: (0..2).flat_map(|part| [-1.0, 0.0, 1.0].map(|x| placed(part, x - 0.5, None))).collect(),
            solids: vec![ball(-1.0, 9), ball(0.0, 10), ball(1.0, 11)],
            ..Model::default()
        };
        let cut = model.section(DVec3::X * 3.0, 0.0).unwrap();
        // of the closed part the first, of the open one the first and the one that is cut
        assert_eq!(cut.instances, [0, 3, 4].map(|i| model.instances[i].clone()));
        assert_eq!(cut.trim.map(|t| t.primitives().len()), Some(1));
        assert_eq!(cut.solids.len(), 3);
        assert_eq!(cut.solids[1], model.solids[0]);
        // numbers of caps come after all others, and are listed
        assert_eq!(cut.cuts, [12, 13]);
        let ids = |s: &Solid| s.primitives().iter().map(|p| p.id).collect::<Vec<_>>();
        assert_eq!([ids(&cut.solids[0]), ids(&cut.solids[2])], [vec![7, 12], vec![10, 13]]);
        assert!(cut.solids[0].primitives().iter().all(|p| p.colour == red));
    }

    #[test]
    fn an_instance_that_is_painted_over_is_so_in_section() {
        let (red, blue) = ([1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]);
        let mut model = Model { parts: vec![corner(1, true, Some(red))], ..Model::default() };
        model.instances = vec![placed(0, -0.5, Some(blue))];
        let cut = model.section(DVec3::X, 0.0).unwrap();
        let [part, cap] = cut.solids[0].primitives() else { panic!("two primitives") };
        assert_eq!([part.colour, cap.colour], [blue, blue]);
        let Shape::Part(bare) = &part.shape else { panic!("a part") };
        assert_eq!(bare.meshes[0].colour, None);
    }

    #[test]
    fn a_plane_needs_a_normal() {
        let model = Model::default();
        assert!(model.section(DVec3::ZERO, 1.0).is_err());
        assert!(model.section(DVec3::X, f64::NAN).is_err());
    }

    #[test]
    fn volumes_add_up() {
        let mut model = Model { solids: vec![ball(0.0, 1)], ..Model::default() };
        model.trim_by(&ball(0.2, 1)).unwrap();
        model.trim_by(&ball(-0.2, 1)).unwrap();
        assert_eq!(model.trim.as_ref().map(|t| t.primitives().len()), Some(2));
        assert_eq!(model.solids[0].primitives().len(), 3);
    }
}
