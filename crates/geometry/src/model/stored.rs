//! The stored form of a model, which becomes a [`Model`] only if it passes [`Model::check`].
//!
//! ```text
//!   bytes ──serde──▶ ModelData ──Model::check──▶ Model
//!                       └─ Mesh, Surface, TrimLoop    check their own on the way up: see their `try_from`
//! ```

use super::{Instance, Model, ModelError, Part, Solid};
use serde::Deserialize;

/// A [`Model`] as stored.
#[derive(Deserialize)]
pub(super) struct ModelData {
    name: String,
    parts: Vec<Part>,
    instances: Vec<Instance>,
    solids: Vec<Solid>,
    trim: Option<Solid>,
    unit: String,
    coincident: Option<f64>,
}

impl TryFrom<ModelData> for Model {
    type Error = ModelError;

    fn try_from(data: ModelData) -> Result<Self, ModelError> {
        let ModelData { name, parts, instances, solids, trim, unit, coincident } = data;
        let model = Self { name, parts, instances, solids, trim, unit, coincident, cuts: Vec::new() };
        model.check()?;
        Ok(model)
    }
}
