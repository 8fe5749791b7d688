//! Solids that a plane curve sweeps. `brep::sweep` makes the faces.
//!
//! ```text
//!   162 revolution   curve, share of a turn, point and direction of the axis
//!         form 0 (default): the curve and the feet of its ends on the axis bound the area; form 1: the curve alone
//!   164 extrusion    closed curve, length, direction
//! ```
//!
//! Source: US Product Data Association, *IGES 5.3*, 1996, 4.46 and 4.47.

use super::curve::Segment;
use super::entity::{Entity, Fault};
use super::geometry::Geometry;
use super::solid::Shells;
use super::value::Value;
use crate::brep::{Boundary, Edge, FaceGeometry, Frame, Motion, SurfaceGeometry, sweep};
use crate::model::Bounds;
use glam::{DAffine3, DVec3};
use std::f64::consts::TAU;

/// Points of a segment from which the plane of a curve and its direction follow.
const SAMPLES: usize = 16;

/// Share of the size by which ends may miss each other, and a curve its plane: writers round to as few as six digits.
const ROUNDED: f64 = 1e-6;

impl<'a> Geometry<'a> {
    /// The faces of a 162 or 164, already on the trail; `map` leads to millimetres.
    pub fn swept(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Shells, Fault> {
        let id = entity.id();
        let fault = |what| Fault::Value { id, what };
        let motion = if entity.kind() == 162 { self.turn(entity, map)? } else { shift(entity, map)? };
        let segments = self.segments(entity.pointer(1)?, map)?;
        let mut outline: Vec<DVec3> = segments.iter().flat_map(|s| s.samples(SAMPLES)).collect();
        let size = outline.iter().fold(Bounds::EMPTY, |b, p| b.with(*p)).diagonal();
        let near = self.file.global.resolution.max(ROUNDED * size);
        let meets = |a: DVec3, b: DVec3| a.distance(b) <= near;

        let mut edges: Vec<Edge> = segments.iter().map(Segment::edge).collect();
        for i in 1..edges.len() {
            let (end, start) = (edges[i - 1].end, edges[i].start);
            meets(end, start).then_some(()).ok_or(fault("the curve that is swept is torn"))?;
            edges[i].start = end;
        }
        let last = edges.len() - 1;
        let ends = [edges[0].start, edges[last].end];
        if meets(ends[0], ends[1]) {
            edges[last].end = ends[0];
        } else if let (Motion::Around { origin, axis, .. }, 0) = (motion, entity.entry.form) {
            let foot = |p: DVec3| origin + axis * (p - origin).dot(axis);
            // an end on the axis is its own foot
            let [first, last] = ends.map(|p| Some(foot(p)).filter(|foot| !meets(*foot, p)));
            let way = [Some(ends[1]), last, first, Some(ends[0])].into_iter().flatten().collect::<Vec<_>>();
            Edge::chain(id, &way, &mut edges);
            outline.extend(way);
        } else {
            return Err(fault("the curve that is swept is not closed"));
        }

        let area = area(&outline).ok_or(fault("the curve that is swept bounds no area"))?;
        if outline.iter().any(|p| (*p - area.origin).dot(area.z).abs() > near) {
            return Err(fault("the curve that is swept is not plane"));
        }
        let area = FaceGeometry {
            id,
            surface: SurfaceGeometry::Plane { frame: area },
            bounds: vec![Boundary::Edges((0..edges.len()).map(|i| (i, true)).collect())],
            same_sense: true,
            ambiguous: false,
        };
        let faces = sweep(area, motion, &mut edges, near).map_err(fault)?;
        self.spend(id, 4 * faces.len())?;
        let colour = self.colour(entity);
        let mut shells = Shells::default();
        shells.edges.append(&mut edges);
        shells.faces.extend(faces.into_iter().map(|face| (face, colour)));
        Ok(shells)
    }

    /// Of a 162.
    fn turn(&self, entity: Entity<'a>, map: &DAffine3) -> Result<Motion, Fault> {
        let share = if matches!(entity.value(2), Value::Empty) { 1.0 } else { entity.real(2)? };
        if !(share > 0.0 && share <= 1.0) {
            return Err(Fault::Parameter {
                id: entity.id(),
                index: 2,
                wanted: "a share of a turn, above 0 and at most 1",
            });
        }
        let origin = map.transform_point3(entity.triple(3)?);
        // a mirrored turn goes about the opposite of the axis' image, as this frame's z does
        let frame = self.frame(entity.id(), map, origin, (direction(entity, 6)?, None))?.frame;
        Ok(Motion::Around { origin: frame.origin, axis: frame.z, angle: TAU * share })
    }
}

/// Of a 164.
fn shift(entity: Entity<'_>, map: &DAffine3) -> Result<Motion, Fault> {
    let way = direction(entity, 3)?.try_normalize();
    let way = way.ok_or(Fault::Value { id: entity.id(), what: "the direction has no length" })?;
    Ok(Motion::Along(map.transform_vector3(way * entity.length(2)?)))
}

/// A direction; z where it is left out.
fn direction(entity: Entity<'_>, first: usize) -> Result<DVec3, Fault> {
    let stated = entity.triple(first)?;
    Ok(if stated == DVec3::ZERO { DVec3::Z } else { stated })
}

/// The plane of a closed outline that runs about its z: Newell's normal.
fn area(outline: &[DVec3]) -> Option<Frame> {
    let origin = *outline.first()?;
    let sides = outline.iter().zip(outline.iter().cycle().skip(1));
    let normal: DVec3 = sides.map(|(a, b)| (*a - origin).cross(*b - origin)).sum();
    Frame::new(origin, normal.try_normalize()?, DVec3::ZERO)
}
