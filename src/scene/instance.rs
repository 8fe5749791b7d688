//! Placed parts: the record that shaders read of each, and the changes to it between frames.
//!
//! ```text
//!   instance of the model ─▶ LivePart: its number in the scene, the centre of its part
//!        ├─ transform, hidden ──▶ placements ─▶ views of the next frame
//!        │                   ╰──▶ boxes of the trim table's cells
//!        └─ transform, colour ──▶ abi::Instance, copied at the beginning of the next frame
//! ```
//!
//! Cost: one instance's record, and a box for each of its cells in the trim table.

use super::data::SceneData;
use super::edit::{EditTarget, Write};
use super::face::pack_colour;
use super::trimmed::Trimmed;
use super::view::view;
use crate::abi;
use crate::model::{Colour, Instance};
use glam::{DAffine3, DMat3, DMat4, DVec3};

/// The view of a hidden placement moves every point this many pixels left of the picture and above it, beyond every
/// margin.
const BEYOND_PX: f32 = 1e6;

/// A host's choices for an instance, beside its placement and its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shown {
    pub visible: bool,
    /// A colour over the instance's own, blended by its opacity.
    pub highlight: Option<Colour>,
}

impl Default for Shown {
    fn default() -> Self {
        Self { visible: true, highlight: None }
    }
}

impl Shown {
    /// The colour of an instance, which replaces those of its faces.
    pub(super) fn over(self, colour: Option<Colour>) -> Option<Colour> {
        let Some(highlight) = self.highlight else { return colour.map(|c| [c[0], c[1], c[2], 1.0]) };
        let Some(under) = colour else { return Some(highlight) };
        let mixed = |i: usize| under[i] * (1.0 - highlight[3]) + highlight[i] * highlight[3];
        Some([mixed(0), mixed(1), mixed(2), 1.0])
    }
}

/// An instance of the model that is drawn as faces alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LivePart {
    /// Its number in the scene.
    pub number: u32,
    /// The centre of its part.
    pub origin: DVec3,
}

/// Why an instance was not changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InstanceError {
    /// The model has no such instance.
    #[error("the model has no instance {0}")]
    NoSuchInstance(usize),
    /// The transform or the colour is not valid.
    #[error(transparent)]
    Model(#[from] crate::model::ModelError),
    /// Rays are followed through the instance: it is transparent, or the scene has
    /// [`thickness`](crate::picture::SceneSettings::thickness) or a
    /// [`highlight`](crate::picture::SceneSettings::highlight). Upload the changed model.
    #[error("rays are followed through instance {0}, which stays as it was uploaded: upload the changed model")]
    Followed(usize),
    /// The new colour is transparent. Upload the changed model.
    #[error("instance {0} would be seen through: upload the changed model")]
    SeenThrough(usize),
    /// The scene has a [`sun`](crate::picture::SceneSettings::sun), and the shadows are those of the uploaded model.
    /// Upload the changed model.
    #[error("the shadows of instance {0} stay as they were uploaded: upload the changed model")]
    Shadows(usize),
}

impl SceneData {
    /// Views of all placements, for a camera's matrix to pixels.
    pub(crate) fn views(&self, pixels: DMat4) -> Vec<abi::View> {
        let is_hidden = |n: usize| self.hidden.get(n).is_some_and(|hidden| *hidden);
        let of = |(n, placement): (usize, &DAffine3)| if is_hidden(n) { nowhere() } else { view(pixels, *placement) };
        self.placements.iter().enumerate().map(of).collect()
    }

    /// Whether an instance of the model may change. `moves`: its placement or visibility changes.
    pub(crate) fn may_change(&self, instance: usize, moves: bool) -> Result<(), InstanceError> {
        // a cut is made again after a change, and so is a scene that is still to be loaded
        if self.live.get(instance) == Some(&None) {
            return Err(InstanceError::Followed(instance));
        }
        if moves && self.casts_shadows { Err(InstanceError::Shadows(instance)) } else { Ok(()) }
    }

    /// Changes an instance of the model. Returns the write to the GPU's array; `None` in a cut.
    pub(crate) fn change(&mut self, nth: usize, instance: &Instance, shown: Shown) -> Option<Write> {
        let LivePart { number, origin } = (*self.live.get(nth)?)?;
        let placement = instance.transform * DAffine3::from_translation(origin);
        self.placements[number as usize] = placement;
        self.hide(number, !shown.visible);
        let record = placed_part(instance.transform, shown.over(instance.colour), 0);
        let offset = u64::from(number) * size_of::<abi::Instance>() as u64;
        Some(Write { to: EditTarget::Instances, offset, bytes: bytemuck::bytes_of(&record).to_vec() })
    }

    /// Applies `shown` to all instances, in a scene that is not on the GPU yet.
    pub(crate) fn show(&mut self, instances: &[Instance], shown: &[Shown]) {
        if shown.iter().all(|shown| *shown == Shown::default()) {
            return;
        }
        for number in 0..self.instances.len() {
            let Some(nth) = (self.sources[number][1] as usize).checked_sub(1) else { continue };
            self.hide(number as u32, !shown[nth].visible);
            let colour = shown[nth].over(instances[nth].colour);
            self.instances[number].colour = colour.map_or(0, pack_colour);
        }
        // edge lines may have placements of their own
        let lines = self.edges.iter().flat_map(|edges| &edges.piece_instances);
        let hidden: Vec<u32> = lines.filter(|i| !shown[i.instance as usize - 1].visible).map(|i| i.placement).collect();
        hidden.into_iter().for_each(|placement| self.hide(placement, true));
        self.settle();
    }

    /// Updates everything that depends on several placements; call it after the last change.
    pub(crate) fn settle(&mut self) {
        self.trimmed.iter_mut().for_each(Trimmed::settle);
    }

    pub(super) fn hide(&mut self, number: u32, hidden: bool) {
        if hidden || !self.hidden.is_empty() {
            self.hidden.resize(self.placements.len(), false);
            self.hidden[number as usize] = hidden;
        }
        if let Some(trimmed) = &mut self.trimmed {
            let placement = &self.placements[number as usize];
            trimmed.place(number as usize, (!hidden).then_some(placement));
        }
    }
}

/// A view that moves every point out of the picture.
fn nowhere() -> abi::View {
    let beyond = [0.0, 0.0, 0.0, -BEYOND_PX];
    abi::View { x: beyond, y: beyond, depth: [0.0; 4], w: [0.0, 0.0, 0.0, 1.0] }
}

/// The record that shaders read of a placed part. `colour` is drawn over its faces' colours, by its opacity; `operand`
/// is the number of its operand.
pub(super) fn placed_part(transform: DAffine3, colour: Option<Colour>, operand: u32) -> abi::Instance {
    let linear = transform.matrix3;
    // normals transform by the cofactor matrix: the inverse transpose times the determinant, which also exists for
    // singular transforms; the sign of the determinant is stored separately
    let cofactor = DMat3::from_cols(
        linear.y_axis.cross(linear.z_axis),
        linear.z_axis.cross(linear.x_axis),
        linear.x_axis.cross(linear.y_axis),
    );
    let unit = 1.0 / cofactor.to_cols_array().iter().fold(0.0f64, |m, x| m.max(x.abs())).max(f64::MIN_POSITIVE);
    abi::Instance {
        normal: (cofactor * unit).to_cols_array_2d().map(|c| c.map(|x| x as f32)),
        scale: (stretch(linear) as f32).next_up(),
        colour: colour.map_or(0, pack_colour),
        mirrored: u32::from(linear.determinant() < 0.0),
        operand,
        ..abi::Instance::default()
    }
}

/// The largest factor by which a linear map lengthens a vector, rounded up: exact for similarity
/// transforms, else the bound `sqrt(|M|_1 |M|_inf)`.
pub(super) fn stretch(m: DMat3) -> f64 {
    let gram = m.transpose() * m;
    let s2 = gram.x_axis.x;
    let off = gram - DMat3::from_diagonal(DVec3::splat(s2));
    if off.to_cols_array().iter().all(|x| x.abs() <= 1e-9 * s2) {
        return s2.sqrt() * (1.0 + 1e-9);
    }
    let columns = [m.x_axis, m.y_axis, m.z_axis].map(|c| c.abs().element_sum());
    let t = m.transpose();
    let rows = [t.x_axis, t.y_axis, t.z_axis].map(|c| c.abs().element_sum());
    let most = |x: [f64; 3]| x.into_iter().fold(0.0, f64::max);
    (most(columns) * most(rows)).sqrt()
}
