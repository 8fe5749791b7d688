//! The views for which a trim table is made.
//!
//! ```text
//!   everything trimmed is about as wide as the picture  ──▶ Everywhere   whole_view.rs  any view from about as far
//!   a part of it is seen                                ──▶ Of(wider)    view_cell.rs   any view of the view cell
//!   the eye is at a face, or above a pole               ──▶ Of(view)                    this view only
//! ```
//!
//! The table depends on the view alone, not on earlier frames; so does the picture.

use super::data::SceneData;
use super::view_cell::view_cell;
use super::whole_view::Ball;
use crate::model::{Bounds, Camera};
use crate::picture::TakenWay;
use glam::{DAffine3, Vec3};
use std::ops::Range;

/// Cells that share a box: a few bytes for each cell, and boxes not much larger than a cell.
const GROUP: usize = 16;

/// The input of a trim table. Two views with equal input may use the same table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum TableView {
    /// A density in pixels a model unit, for all cells, visible or not.
    Everywhere(f32),
    /// The cells that this camera sees, as densely as it sees them.
    Of(Camera),
}

impl TableView {
    /// Pixels a model unit; 0 if the camera decides.
    pub(crate) fn density(&self) -> f32 {
        match self {
            Self::Everywhere(density) => *density,
            Self::Of(_) => 0.0,
        }
    }
}

/// Boxes around everything that the table trims, in model coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Trimmed {
    ball: Option<Ball>,
    /// The box of each group of cells of one instance; empty if the instance is hidden.
    boxes: Vec<Bounds>,
    /// The range of boxes of each placed part.
    placed: Vec<PlacedBoxes>,
    /// The boxes of all faces' cells, relative to their part's centre.
    cells: Vec<[[f32; 3]; 2]>,
}

/// Boxes of one placed part.
#[derive(Clone, Debug)]
struct PlacedBoxes {
    boxes: Range<usize>,
    cells: Range<usize>,
    /// The box around all of its boxes.
    around: Bounds,
}

impl Trimmed {
    /// The boxes of a scene's placed cells; `None` without a table.
    pub(super) fn by_table(data: &SceneData) -> Option<Self> {
        if data.trim_way() != Some(TakenWay::Table) {
            return None;
        }
        let cells = data.cells.iter().map(|cell| [cell.box_min, cell.box_max]).collect();
        let mut trimmed = Self { ball: None, boxes: Vec::new(), placed: Vec::new(), cells };
        let mut faces = data.face_instances.iter().peekable();
        for (number, placement) in (0..).zip(&data.placements) {
            // the faces of a part are consecutive, and so are their cells
            let mut cells = 0..0;
            while let Some(face) = faces.next_if(|face| face.instance == number) {
                let face = face.face as usize;
                let next = data.faces.get(face + 1);
                let end = next.map_or(data.cells.len(), |next| next.first_cell as usize);
                let first = data.faces[face].first_cell as usize;
                cells = if cells.is_empty() { first..end } else { cells.start..end };
            }
            if cells.is_empty() {
                cells = 0..0;
            }
            let first = trimmed.boxes.len();
            trimmed.boxes.resize(first + cells.len().div_ceil(GROUP), Bounds::EMPTY);
            trimmed.placed.push(PlacedBoxes { boxes: first..trimmed.boxes.len(), cells, around: Bounds::EMPTY });
            trimmed.place(number as usize, Some(placement));
        }
        trimmed.settle();
        Some(trimmed)
    }

    /// Moves the part of this number, or hides it (`None`). Call [`settle`](Self::settle) after the last change.
    pub(super) fn place(&mut self, number: usize, placement: Option<&DAffine3>) {
        let Some(part) = self.placed.get_mut(number) else { return };
        let boxes = &mut self.boxes[part.boxes.clone()];
        for (bounds, cells) in boxes.iter_mut().zip(self.cells[part.cells.clone()].chunks(GROUP)) {
            let seen = cells.iter().flat_map(|cell| placement.map(|placement| box_of(cell, placement)));
            *bounds = seen.fold(Bounds::EMPTY, Bounds::union);
        }
        part.around = boxes.iter().copied().fold(Bounds::EMPTY, Bounds::union);
    }

    /// So many placed parts come behind these; `new` has those that the table trims. [`settle`](Self::settle) follows.
    pub(super) fn join(&mut self, new: Option<Self>, parts: usize) {
        let (boxes, cells) = (self.boxes.len(), self.cells.len());
        let behind = |range: Range<usize>, first: usize| range.start + first..range.end + first;
        let Some(new) = new else {
            let nothing = PlacedBoxes { boxes: boxes..boxes, cells: 0..0, around: Bounds::EMPTY };
            return self.placed.extend(std::iter::repeat_n(nothing, parts));
        };
        self.boxes.extend(new.boxes);
        self.cells.extend(new.cells);
        self.placed.extend(new.placed.into_iter().map(|part| PlacedBoxes {
            boxes: behind(part.boxes, boxes),
            cells: if part.cells.is_empty() { 0..0 } else { behind(part.cells, cells) },
            ..part
        }));
    }

    /// Updates the ball around all boxes.
    pub(super) fn settle(&mut self) {
        self.ball = Ball::around(self.placed.iter().map(|part| part.around).fold(Bounds::EMPTY, Bounds::union));
    }
}

/// The box of a placed cell.
fn box_of(cell: &[[f32; 3]; 2], placement: &DAffine3) -> Bounds {
    let [min, max] = cell.map(|p| Vec3::from_array(p).as_dvec3());
    let corners = Bounds { min, max }.corners().map(|corner| placement.transform_point3(corner));
    corners.into_iter().fold(Bounds::EMPTY, Bounds::with)
}

impl SceneData {
    /// The input of a trim table for this view and a margin of `beside_px` pixels; `None` without a table.
    pub(crate) fn table_view(&self, camera: &Camera, beside_px: f64) -> Option<TableView> {
        let trimmed = self.trimmed.as_ref()?;
        let ball = trimmed.ball.as_ref()?;
        if let Some(density) = ball.table_density(camera) {
            return Some(TableView::Everywhere(density));
        }
        let wider = view_cell(camera, beside_px, ball, &trimmed.boxes);
        Some(TableView::Of(wider.unwrap_or(*camera)))
    }
}
