//! A scene seen by a camera: what the passes get from the host.

use crate::abi;
use crate::budget::Budget;
use crate::model::{Camera, Model};
use crate::picture::{SceneSettings, TrimWay};
use crate::scene::{SceneData, seen_by, view};
use crate::twin;

/// One scene, one view.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub data: SceneData,
    pub views: Vec<abi::View>,
    pub frame: abi::Frame,
}

impl Case {
    /// Patches as they are. Room for everything; draws are cut small enough that there are several.
    pub(crate) fn new(model: &Model, camera: &Camera, tolerance_px: f64) -> Self {
        let data = SceneData::uncut(model, Self::settings()).expect("no operand that cannot be drawn");
        Self::of(data, camera, tolerance_px)
    }

    /// Patches of trimmed faces cut as renderers get them.
    #[cfg(test)]
    pub(crate) fn cut(model: &Model, camera: &Camera, tolerance_px: f64) -> Self {
        let data = SceneData::new(model, Self::settings()).expect("no operand that cannot be drawn");
        Self::of(data, camera, tolerance_px)
    }

    fn settings() -> SceneSettings {
        SceneSettings { trim: TrimWay::Table, ..SceneSettings::default() }
    }

    fn of(data: SceneData, camera: &Camera, tolerance_px: f64) -> Self {
        camera.check().expect("the camera of a case shows something");
        let pixels = camera.pixel_matrix();
        let views = data.placements.iter().map(|&placement| view(pixels, placement)).collect();
        let budget = Budget::of(tolerance_px);
        let frame = abi::Frame {
            deviation_px: budget.deviation as f32,
            ring_px: budget.ring as f32,
            row_px: budget.row as f32,
            chord_px: budget.chord as f32,
            item_count: data.items.len() as u32,
            cell_count: data.cell_items.len() as u32,
            bay_count: data.bay_count,
            curve_count: data.curve_items.len() as u32,
            draw_vertices: 5000,
            sub_patch_capacity: 1 << 16,
            draw_capacity: 256,
            row_capacity: 1 << 18,
            intercept_capacity: 1 << 20,
            ..Default::default()
        };
        Self { data, views, frame: seen_by(camera, frame) }
    }

    /// The scene for the twins.
    pub(crate) fn scene(&self) -> twin::Scene<'_> {
        let d = &self.data;
        twin::Scene {
            views: &self.views,
            instances: &d.instances,
            face_instances: &d.face_instances,
            faces: &d.faces,
            patches: &d.patches,
            cones: &d.cones,
            points: &d.points,
            outside: &d.outside,
            links: &d.links,
            items: &d.items,
            cells: &d.cells,
            cell_items: &d.cell_items,
            curves: &d.curves,
            curve_points: &d.curve_points,
            curve_items: &d.curve_items,
        }
    }
}
