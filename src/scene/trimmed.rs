//! Which views a trim table is made for.
//!
//! ```text
//!   all that is trimmed is about as wide as the picture  ──▶ Everywhere    around.rs    any view from about as far
//!   a part of it is seen                                 ──▶ Of(wider)     nearby.rs    any view from near by
//!   the eye is at a face, or above a pole                ──▶ Of(view)                   this view
//! ```
//!
//! Each follows from the view alone, not from what was drawn before: so does the picture.

use super::data::SceneData;
use super::view_cell::view_cell;
use super::whole_view::Ball;
use crate::model::{Bounds, Camera};
use crate::picture::TakenWay;
use glam::Vec3;

/// Cells that share a box: a few bytes for each, and yet boxes that are not much larger than a cell.
const GROUP: usize = 16;

/// What a trim table is made of: two views with the same can have the same table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TableView {
    /// So many pixels a model unit, seen or not.
    Everywhere(f32),
    /// What this camera sees, as fine as it sees it.
    Of(Camera),
}

impl TableView {
    /// Pixels a model unit; 0 where that is as a camera sees it.
    pub(crate) fn density(&self) -> f32 {
        match self {
            Self::Everywhere(density) => *density,
            Self::Of(_) => 0.0,
        }
    }
}

/// Where what the table trims is, in the model's coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Trimmed {
    ball: Ball,
    /// Of some of its cells each.
    boxes: Vec<Bounds>,
}

impl Trimmed {
    /// As placed; `None` where there is no table.
    pub(super) fn by_table(data: &SceneData) -> Option<Self> {
        if data.trim_way() != Some(TakenWay::Table) {
            return None;
        }
        let boxes: Vec<Bounds> = data
            .cell_items
            .chunks(GROUP)
            .zip((0..).step_by(GROUP))
            .map(|(group, first)| {
                let cells = group.iter().zip(first..).map(|(&placed, item)| box_of(data, placed, item));
                cells.fold(Bounds::EMPTY, Bounds::union)
            })
            .collect();
        let ball = Ball::around(boxes.iter().copied().fold(Bounds::EMPTY, Bounds::union))?;
        Some(Self { ball, boxes })
    }
}

/// Of a cell of the face instance.
fn box_of(data: &SceneData, placed: u32, item: u32) -> Bounds {
    let placed = data.face_instances[placed as usize];
    let cell = data.cells[(data.faces[placed.face as usize].first_cell + item - placed.first_cell) as usize];
    let [min, max] = [cell.box_min, cell.box_max].map(|p| Vec3::from_array(p).as_dvec3());
    let placement = data.placements[placed.instance as usize];
    let corners = Bounds { min, max }.corners().map(|corner| placement.transform_point3(corner));
    corners.into_iter().fold(Bounds::EMPTY, Bounds::with)
}

impl SceneData {
    /// What a trim table for this view and so many pixels beside it is made of; `None` where there is no table.
    pub(crate) fn table_view(&self, camera: &Camera, beside_px: f64) -> Option<TableView> {
        let trimmed = self.trimmed.as_ref()?;
        if let Some(density) = trimmed.ball.table_density(camera) {
            return Some(TableView::Everywhere(density));
        }
        let wider = view_cell(camera, beside_px, &trimmed.ball, &trimmed.boxes);
        Some(TableView::Of(wider.unwrap_or(*camera)))
    }
}
