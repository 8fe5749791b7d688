//! Solids that a plane area sweeps: the area and its motion. `brep::sweep` makes the faces.
//!
//! ```text
//!   EXTRUDED_AREA_SOLID('',area,direction,depth)     EXTRUDED_FACE_SOLID('',face,direction,depth)
//!   REVOLVED_AREA_SOLID('',area,axis,angle)          REVOLVED_FACE_SOLID('',face,axis,angle)
//!       area: CURVE_BOUNDED_SURFACE, face: FACE_SURFACE, both of a plane
//! ```
//!
//! SWEPT_DISK_SOLID: see `disk`. Source: ISO 10303-42, 6.4 (solid model).

use super::entity::{Entity, Fault};
use super::face::EdgeTable;
use super::geometry::Geometry;
use crate::brep::{FaceGeometry, Motion, sweep};
use std::f64::consts::TAU;

/// Solids that sweep an area, a face or a disk.
pub(super) const SWEPT: [&str; 5] =
    ["EXTRUDED_AREA_SOLID", "EXTRUDED_FACE_SOLID", "REVOLVED_AREA_SOLID", "REVOLVED_FACE_SOLID", "SWEPT_DISK_SOLID"];

impl Geometry<'_> {
    /// The faces of one of [`SWEPT`].
    pub fn swept(&self, entity: Entity<'_>, table: &mut EdgeTable) -> Result<Vec<FaceGeometry>, Fault> {
        let id = entity.id();
        let Some(kind) = SWEPT[..4].iter().copied().find(|k| entity.is(k)) else {
            return self.swept_disk(entity, table);
        };
        let fields = entity.fields(kind, 1)?;
        let area = self.entity(fields.reference(0)?)?;
        let area = if area.is("CURVE_BOUNDED_SURFACE") {
            self.bounded_surface(area, table)?
        } else {
            self.face(area.id(), table)?
        };
        let motion = if kind.starts_with("EXTRUDED") {
            let depth = fields.real(2)? * self.units.length;
            if depth == 0.0 {
                return Err(Fault::Value { id, what: "the depth is 0" });
            }
            Motion::Along(self.direction(fields.reference(1)?)? * depth)
        } else {
            let (origin, axis) = self.axis(fields.reference(1)?)?;
            let angle = fields.real(2)? * self.units.angle;
            if angle == 0.0 {
                return Err(Fault::Value { id, what: "the angle is 0" });
            }
            // a whole turn as degrees of a rounded factor have it
            let whole = angle.abs() > TAU * (1.0 - 1e-9);
            let angle = if whole { TAU.copysign(angle) } else { angle };
            Motion::Around { origin, axis: axis * angle.signum(), angle: angle.abs() }
        };
        let area = FaceGeometry { id, ..area };
        let faces = sweep(area, motion, &mut table.edges, self.units.tolerance);
        let faces = faces.map_err(|what| Fault::Value { id, what })?;
        self.ledger.spend(id, 4 * faces.len())?;
        Ok(faces)
    }
}
