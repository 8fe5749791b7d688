//! The state of converting geometry, and the small geometric entities: matrices, points, directions.
//!
//! ```text
//!   entity ──its matrix──▶ ──its owner's matrix──▶ ... ──unit──▶ millimetres
//!   124    x' = R x + T, itself with a matrix; rotations, reflections, uniform scales
//! ```
//!
//! Every mapping function takes the affine map from the owner's space to millimetres. All mapping of a file shares the
//! guards that keep it finite: see `import::guard`.

use super::entity::{Entity, Fault};
use super::file::File;
pub(super) use crate::import::FACE_LOST;

use crate::brep::Frame;
use crate::import::guard::Guard;
use crate::import::{Place, Pulse, Reasons, Warnings};
use glam::{DAffine3, DMat3, DVec3};
use std::cell::RefCell;

/// Deepest chain of entities that define one another.
const MAX_DEPTH: usize = 32;

/// A file, the work that it may still cause, and the warnings so far.
#[derive(Debug)]
pub(super) struct Geometry<'a> {
    /// The file.
    pub file: &'a File,
    guard: Guard,
    pulse: &'a Pulse<'a>,
    warnings: RefCell<Warnings>,
    dropped: RefCell<Reasons>,
}

/// A frame in millimetres, and the sign and scale of its heights.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub frame: Frame,
    /// 1, or -1 when heights along `z` change their sign.
    pub sign: f64,
    /// Millimetres per unit.
    pub scale: f64,
}

impl<'a> Geometry<'a> {
    /// A fresh budget; `warnings` are those of the cards. An entity and a parameter are one piece of work each.
    pub fn new(file: &'a File, warnings: Warnings, pulse: &'a Pulse<'a>) -> Self {
        let guard = Guard::new(file.value_count(), MAX_DEPTH);
        Self { file, guard, pulse, warnings: RefCell::new(warnings), dropped: RefCell::default() }
    }

    /// The warnings, and the faces left out by reason.
    pub fn finish(self) -> (Warnings, Reasons) {
        (self.warnings.into_inner(), self.dropped.into_inner())
    }

    /// Takes `amount` of work for `#id` from the budget.
    pub fn spend(&self, id: u32, amount: usize) -> Result<(), Fault> {
        self.work(amount);
        self.guard.spend(id, amount).map_err(Fault::Endless)
    }

    /// So much work was done.
    pub fn work(&self, amount: usize) {
        self.pulse.work(amount);
    }

    /// Warns about `#id`.
    pub fn note(&self, kind: &'static str, id: u32, message: impl Into<String>) {
        let message = message.into();
        if kind == FACE_LOST {
            self.dropped.borrow_mut().add(&message);
        }
        let place = || Entity::find(self.file, id).map_or(Place::File, Entity::place);
        self.warnings.borrow_mut().push(kind, place, || message);
    }

    /// Runs `f` with `#id` on the trail; its parameters count as work.
    pub fn nested<T>(&self, id: u32, f: impl FnOnce(Entity<'a>) -> Result<T, Fault>) -> Result<T, Fault> {
        let entity = Entity::find(self.file, id)?;
        self.work(1 + entity.len());
        self.guard.nested(id, 1 + entity.len(), Fault::Endless, || f(entity))
    }

    /// The entity's own space to millimetres, `outer` being its owner's.
    pub fn placed(&self, entity: Entity<'a>, outer: &DAffine3) -> Result<DAffine3, Fault> {
        match entity.entry.matrix {
            0 => Ok(*outer),
            matrix => {
                let placed = *outer * self.matrix(matrix)?;
                let sound = placed.is_finite() && placed.matrix3.determinant() != 0.0;
                sound.then_some(placed).ok_or(Fault::Value { id: matrix, what: "the matrix cannot be inverted" })
            }
        }
    }

    /// 124.
    pub fn matrix(&self, id: u32) -> Result<DAffine3, Fault> {
        self.nested(id, |entity| {
            let entity = entity.of_kind(124, "124, a matrix")?;
            let row = |i: usize| Ok(entity.triple(4 * i + 1)?.extend(entity.real(4 * i + 4)?));
            let rows = [row(0)?, row(1)?, row(2)?];
            let column = |i: usize| DVec3::new(rows[0][i], rows[1][i], rows[2][i]);
            let own = DAffine3::from_cols(column(0), column(1), column(2), column(3));
            match entity.entry.matrix {
                0 => Ok(own),
                outer => Ok(self.matrix(outer)? * own),
            }
        })
    }

    /// 116, in millimetres.
    pub fn point(&self, id: u32, outer: &DAffine3) -> Result<DVec3, Fault> {
        self.nested(id, |entity| {
            let entity = entity.of_kind(116, "116, a point")?;
            finite(id, self.placed(entity, outer)?.transform_point3(entity.triple(1)?))
        })
    }

    /// 123, not normalised, in the space of its owner.
    pub fn direction(&self, id: u32) -> Result<DVec3, Fault> {
        self.nested(id, |entity| {
            let entity = entity.of_kind(123, "123, a direction")?;
            Ok(self.placed(entity, &DAffine3::IDENTITY)?.transform_vector3(entity.triple(1)?))
        })
    }

    /// The frame with `z` and `x` given in the space that `map` leads out of.
    pub fn frame(
        &self,
        id: u32,
        map: &DAffine3,
        origin: DVec3,
        (z, x): (DVec3, Option<DVec3>),
    ) -> Result<Placed, Fault> {
        let flat = Fault::Value { id, what: "the axis has no direction" };
        let local = Frame::new(DVec3::ZERO, z, x.unwrap_or(DVec3::ZERO)).ok_or(flat.clone())?;
        let scale = similarity(&map.matrix3).ok_or(Fault::Value { id, what: "the matrix distorts a round shape" })?;
        let (x, y) = (map.transform_vector3(local.x), map.transform_vector3(local.y));
        let frame = Frame::new(origin, x.cross(y), x).ok_or(flat)?;
        let sign = if map.matrix3.determinant() < 0.0 { -1.0 } else { 1.0 };
        Ok(Placed { frame, sign, scale })
    }
}

/// A point whose coordinates did not overflow.
pub(super) fn finite(id: u32, point: DVec3) -> Result<DVec3, Fault> {
    if point.is_finite() { Ok(point) } else { Err(Fault::Value { id, what: "a coordinate is not finite" }) }
}

/// The scale of a rotation or reflection with uniform scale; writers round to as few as five digits.
pub(super) fn similarity(m: &DMat3) -> Option<f64> {
    const ROUNDED: f64 = 1e-4;
    let scale = m.determinant().abs().cbrt();
    let unit = |v: DVec3| (v.length() - scale).abs() <= ROUNDED * scale;
    let right = |a: DVec3, b: DVec3| a.dot(b).abs() <= ROUNDED * scale * scale;
    let (a, b, c) = (m.x_axis, m.y_axis, m.z_axis);
    let sound = scale.is_finite() && scale > 0.0 && unit(a) && unit(b) && unit(c);
    (sound && right(a, b) && right(b, c) && right(c, a)).then_some(scale)
}
