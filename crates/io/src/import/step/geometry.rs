//! The state of converting geometry, and the small geometric entities: points, directions, placements.
//!
//! All mapping of a file shares the guards that keep it finite: see `import::guard`.

use super::entity::{Entity, Fault};
use super::part21::File;
use super::units::Units;
pub(super) use crate::import::FACE_LOST;

use crate::brep::Frame;
use crate::import::guard::Guard;
use crate::import::{Place, Reasons, Warnings};
use glam::{DAffine3, DMat3, DVec3};
use std::cell::RefCell;
use std::collections::BTreeMap;

/// Deepest chain of entities that define one another: trimmed of composite of trimmed …
const MAX_DEPTH: usize = 24;

/// The work that is left, and the notes; shared by all representations of a file.
#[derive(Debug)]
pub(super) struct Ledger<'a> {
    file: &'a File<'a>,
    guard: Guard,
    notes: RefCell<Notes>,
}

/// Warnings and counts.
#[derive(Debug)]
pub(super) struct Notes {
    /// By kind and place.
    pub warnings: Warnings,
    /// Faces left out, by reason.
    pub dropped: Reasons,
    /// Items that are not drawn though they are sound, by kind.
    pub ignored: BTreeMap<String, usize>,
}

impl Notes {
    /// Adds a warning; `place` is evaluated only if the warning is kept.
    pub fn push(&mut self, kind: &'static str, place: impl FnOnce() -> Place, message: String) {
        if kind == FACE_LOST {
            self.dropped.add(&message);
        }
        self.warnings.push(kind, place, || message);
    }
}

/// Maps the geometry of one representation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Geometry<'a> {
    /// The file.
    pub file: &'a File<'a>,
    /// Units of the representation's context.
    pub units: &'a Units,
    /// Shared guards.
    pub ledger: &'a Ledger<'a>,
}

impl<'a> Ledger<'a> {
    /// A fresh budget; `warnings` are those of the syntax.
    pub fn new(file: &'a File<'a>, warnings: Warnings) -> Self {
        let guard = Guard::new(file.slot_count(), MAX_DEPTH);
        let notes = RefCell::new(Notes { warnings, dropped: Reasons::default(), ignored: BTreeMap::new() });
        Self { file, guard, notes }
    }

    /// The warnings and counts.
    pub fn finish(self) -> Notes {
        self.notes.into_inner()
    }

    /// Counts items that are not drawn though they are sound.
    pub fn ignore(&self, kind: &str, count: usize) {
        let ignored = &mut self.notes.borrow_mut().ignored;
        if let Some(sum) = ignored.get_mut(kind) {
            *sum += count;
            return;
        }
        ignored.insert(kind.to_owned(), count);
    }

    /// Takes `amount` of work for `#id` from the budget.
    pub fn spend(&self, id: u32, amount: usize) -> Result<(), Fault> {
        self.guard.spend(id, amount).map_err(Fault::Endless)
    }

    /// So much work was done that looked up no record.
    pub fn work(&self, amount: usize) {
        self.file.work(amount);
    }

    /// Warns about `#id`.
    pub fn note(&self, kind: &'static str, id: u32, message: impl Into<String>) {
        let place = || Entity::find(self.file, id).map_or(Place::File, Entity::place);
        self.notes.borrow_mut().push(kind, place, message.into());
    }

    /// Runs `f` with `#id` on the trail.
    pub fn nested<T>(&self, id: u32, f: impl FnOnce() -> Result<T, Fault>) -> Result<T, Fault> {
        self.guard.nested(id, 1, Fault::Endless, f)
    }
}

impl<'a> Geometry<'a> {
    /// The entity `#id`.
    pub fn entity(&self, id: u32) -> Result<Entity<'a>, Fault> {
        Entity::find(self.file, id)
    }

    /// CARTESIAN_POINT in millimetres.
    pub fn point(&self, id: u32) -> Result<DVec3, Fault> {
        let point = self.triple(id, "CARTESIAN_POINT")? * self.units.length;
        if point.is_finite() { Ok(point) } else { Err(Fault::Value { id, what: "a coordinate is not finite" }) }
    }

    /// DIRECTION, normalised.
    pub fn direction(&self, id: u32) -> Result<DVec3, Fault> {
        let direction = self.triple(id, "DIRECTION")?;
        direction.try_normalize().ok_or(Fault::Value { id, what: "the direction has no length" })
    }

    /// VECTOR: direction times magnitude, in millimetres. A magnitude of 0 counts as 1: edges and extrusions use the
    /// direction.
    pub fn vector(&self, id: u32) -> Result<DVec3, Fault> {
        let fields = self.entity(id)?.fields("VECTOR", 1)?;
        let magnitude = fields.real(1)?.abs();
        let magnitude = if magnitude > 0.0 { magnitude } else { 1.0 };
        let vector = self.direction(fields.reference(0)?)? * (magnitude * self.units.length);
        if vector.is_finite() { Ok(vector) } else { Err(Fault::Value { id, what: "the vector is not finite" }) }
    }

    /// Up to three coordinates; missing ones are 0.
    fn triple(&self, id: u32, kind: &'static str) -> Result<DVec3, Fault> {
        let fields = self.entity(id)?.fields(kind, 1)?;
        let mut xyz = [0.0; 3];
        let mut count = 0;
        for value in fields.list(0)? {
            let number = value.number().filter(|x| x.is_finite());
            let number = number.ok_or(Fault::Value { id, what: "a coordinate is not a finite number" })?;
            *xyz.get_mut(count).ok_or(Fault::Value { id, what: "more than three coordinates" })? = number;
            count += 1;
        }
        if count < 2 { Err(Fault::Value { id, what: "fewer than two coordinates" }) } else { Ok(xyz.into()) }
    }

    /// AXIS1_PLACEMENT: a point and a unit direction.
    pub fn axis(&self, id: u32) -> Result<(DVec3, DVec3), Fault> {
        let entity = self.entity(id)?;
        let fields = entity.fields("AXIS1_PLACEMENT", 1)?;
        let (location, axis) = match entity.fields("PLACEMENT", 1) {
            Ok(placement) => (placement.reference(0)?, fields.optional(0)),
            Err(_) => (fields.reference(0)?, fields.optional(1)),
        };
        Ok((self.point(location)?, axis.map_or(Ok(DVec3::Z), |d| self.direction(d))?))
    }

    /// AXIS2_PLACEMENT_3D, or _2D in the plane z = 0, as a frame (ISO 10303-42, `build_axes`).
    pub fn frame(&self, id: u32) -> Result<Frame, Fault> {
        let entity = self.entity(id)?;
        if let Ok(fields) = entity.fields("AXIS2_PLACEMENT_2D", 1) {
            let x = fields.optional(1).map(|d| self.direction(d)).transpose()?;
            return Ok(frame(self.point(fields.reference(0)?)?, DVec3::Z, x));
        }
        let fields = entity.fields("AXIS2_PLACEMENT_3D", 1)?;
        let (location, first) = match entity.fields("PLACEMENT", 1) {
            Ok(placement) => (placement.reference(0)?, 0),
            Err(_) => (fields.reference(0)?, 1),
        };
        let z = fields.optional(first).map_or(Ok(DVec3::Z), |d| self.direction(d))?;
        let x = fields.optional(first + 1).map(|d| self.direction(d)).transpose()?;
        Ok(frame(self.point(location)?, z, x))
    }

    /// A placement or a CARTESIAN_TRANSFORMATION_OPERATOR_3D as a map from its coordinates to the
    /// surrounding ones.
    pub fn transform(&self, id: u32) -> Result<DAffine3, Fault> {
        let entity = self.entity(id)?;
        let kind = "CARTESIAN_TRANSFORMATION_OPERATOR_3D";
        if !entity.is(kind) {
            return Ok(to_affine(self.frame(id)?));
        }
        // axis1, axis2, origin, scale in front of axis3; schemas differ in the names before them, so
        // the origin, the only point, is looked for
        let (base, z) = match entity.fields("CARTESIAN_TRANSFORMATION_OPERATOR", 0) {
            Ok(base) => (base, entity.fields(kind, 0)?.optional(0)),
            Err(_) => (entity.fields(kind, 0)?, None),
        };
        let is_point = |d: u32| self.entity(d).is_ok_and(|e| e.is("CARTESIAN_POINT"));
        let at =
            (2..6).find(|&i| base.optional(i).is_some_and(is_point)).ok_or(entity.not("an operator with an origin"))?;
        let z = z.or(base.optional(at + 2));
        let direction = |d: Option<u32>| d.map(|d| self.direction(d)).transpose();
        let (x, y, z) = (direction(base.optional(at - 2))?, direction(base.optional(at - 1))?, direction(z)?);
        let origin = self.point(base.reference(at)?)?;
        let scale = base.value(at + 1).and_then(super::part21::Value::number).unwrap_or(1.0);
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(Fault::Value { id, what: "the scale is not a positive number" });
        }
        let z = z.or(x.zip(y).and_then(|(x, y)| x.cross(y).try_normalize())).unwrap_or(DVec3::Z);
        let frame = frame(origin, z, x);
        // a mirrored operator has its second axis against z × x
        let sign = if y.is_some_and(|y| y.dot(frame.y) < 0.0) { -1.0 } else { 1.0 };
        let axes = DMat3::from_cols(frame.x, frame.y * sign, frame.z) * scale;
        Ok(DAffine3::from_mat3_translation(axes, origin))
    }
}

/// The frame with axis `z` and reference direction `x`; when `x` is missing or along `z`, the standard's
/// default: the x axis of space, or its y axis when `z` is along x.
pub(super) fn frame(origin: DVec3, z: DVec3, x: Option<DVec3>) -> Frame {
    let across = |x: DVec3| Some(x - z * x.dot(z)).filter(|p| p.length() > 1e-9).and_then(DVec3::try_normalize);
    let x = x.and_then(across).or_else(|| across(DVec3::X)).or_else(|| across(DVec3::Y)).unwrap_or(DVec3::Z);
    Frame { origin, x, y: z.cross(x), z }
}

/// Frame coordinates to the surrounding ones.
pub(super) fn to_affine(frame: Frame) -> DAffine3 {
    DAffine3::from_mat3_translation(DMat3::from_cols(frame.x, frame.y, frame.z), frame.origin)
}
