//! Solids from dimensions, as closed parts of exact faces, and as primitives where one primitive is that solid.
//!
//! ```text
//!   block  sphere  cylinder  cone    torus    tube    gear blank    spur gear     teapot
//!    ___     _       ___      ╱╲      ___      ___       ┌─┐         _╷─╷_        _ _^_
//!   │   │  (   )    │   │    ╱  ╲    ( = )    │ │ │    ┌─┘ └─┐      ╱ (o) ╲      ( ╲   ╱)
//!   │___│    ‾      │___│   ╱____╲    ‾‾‾     │_│_│    └─────┘      ‾╵─╵‾           ‾‾‾
//! ```
//!
//! All stand on or around the origin with `z` as their axis, where the primitives of [`Shape`] do. Faces on an axis
//! of revolution have poles, not holes; plane faces are trimmed by the exact rational curves of their neighbours.
//!
//! | solid | faces | deviation |
//! |---|---|---|
//! | all but the gear's flanks | exact: rounding, below `1e-12` of the size | 0 |
//! | [`SpurGear`] | flanks are cubics | measured, at most the tolerance |

mod gear;
mod pot;
mod round;

pub use gear::{GearBlank, Keyway, SpurGear};
pub use pot::{Teapot, teapot};
pub use round::{block, cone, cylinder, sphere, torus, tube};

use super::ConstructError;
use crate::model::{Part, Shape};
use std::sync::Arc;

/// A solid made from dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its faces; [closed](Part::closed).
    pub part: Part,
    /// The same set of points as one analytic primitive, if it is one.
    pub shape: Option<Shape>,
    /// Largest distance between the faces and the solid described, in model units; 0 when exact.
    pub deviation: f64,
}

impl Body {
    fn exact(part: Part, shape: Option<Shape>) -> Self {
        Self { part, shape, deviation: 0.0 }
    }

    /// The leaf of a Boolean solid: the analytic shape, which rays meet in closed form, else the part.
    pub fn operand(self) -> Shape {
        self.shape.unwrap_or_else(|| Shape::Part(Arc::new(self.part)))
    }
}

/// A length that must be positive and finite.
fn positive(what: &'static str, value: f64) -> Result<(), ConstructError> {
    if value.is_nan() {
        return Err(ConstructError::NotFinite { what });
    }
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(ConstructError::Range { what, value, must: "positive and finite" })
    }
}

/// A length that must be below another one.
fn below(what: &'static str, value: f64, limit: f64, must: &'static str) -> Result<(), ConstructError> {
    positive(what, value)?;
    if value < limit { Ok(()) } else { Err(ConstructError::Range { what, value, must }) }
}
