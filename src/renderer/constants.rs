//! One frame's constants, from the camera, its settings and the room that there is.

use super::{FrameInput, Loaded, TargetFormats};
use crate::abi;
use crate::budget::Budget;
use crate::frame::counts::Counts;
use crate::gpu::Device;
use crate::model::srgb;
use crate::scene::{InSight, Reach, TableView, seen_by};
use ash::vk;

/// The colour target's format encodes linear light by itself.
fn encodes(formats: &TargetFormats) -> bool {
    matches!(formats.colour, vk::Format::R8G8B8A8_SRGB | vk::Format::B8G8R8A8_SRGB | vk::Format::A8B8G8R8_SRGB_PACK32)
}

/// The clear colour of the target; 0 where the host's picture stays. Twin of `encode` in
/// shade.glsl.
pub(super) fn background(input: &FrameInput<'_>, formats: &TargetFormats) -> [f32; 4] {
    let [r, g, b, opacity] = input.settings.background.unwrap_or_default();
    if encodes(formats) {
        return [r, g, b, opacity];
    }
    let encoded = |c: f32| srgb::encoded(f64::from(c.clamp(0.0, 1.0))) as f32;
    [encoded(r), encoded(g), encoded(b), opacity]
}

/// The constants that every shader of the frame reads. `table`: the view of the trim table, if it is not this view.
pub(super) fn constants(
    device: &Device,
    loaded: &Loaded,
    input: &FrameInput<'_>,
    formats: &TargetFormats,
    (table, in_sight): (Option<&TableView>, &InSight),
) -> abi::Frame {
    let camera = input.camera;
    let budget = Budget::of(input.settings.tolerance_px);
    let (right, up, forward) = camera.axes();
    let (counts, room) = (loaded.counts, loaded.capacities);
    let frame = abi::Frame {
        deviation_px: budget.deviation as f32,
        gap_radius_px: budget.gap_radius as f32,
        row_px: budget.row as f32,
        chord_px: budget.chord as f32,
        table_density: table.map_or(0.0, TableView::density),
        fixed_factor: input.settings.levels.fixed().unwrap_or(0),
        listed_patch_instances: in_sight.patch_instances,
        run_count: in_sight.runs.len() as u32,
        cell_count: counts.cells,
        bin_count: counts.bins,
        curve_count: counts.curves,
        draw_vertices: draw_vertices(device),
        encode_srgb: u32::from(!encodes(formats)),
        sub_patch_capacity: room.tessellation.sub_patches,
        draw_capacity: room.tessellation.draws,
        corner_lists: counts.corner_lists,
        row_capacity: room.trim.rows,
        intercept_capacity: room.trim.intercepts,
        gap_candidate_capacity: room.gaps.candidates,
        leaf_count: counts.leaves,
        block_leaf_capacity: room.solids.block_leaves,
        tile_leaf_capacity: room.solids.tile_leaves,
        fragment_capacity: room.solids.fragments,
        followed_leaf: counts.followed_leaf,
        layer_capacity: room.solids.layers,
        side_count: counts.leaf_sides,
        band_top: 0,
        band_height: room.solids.band_rows.saturating_mul(abi::TILE).min(camera.size.1.next_multiple_of(abi::TILE)),
        right: right.as_vec3().to_array(),
        up: up.as_vec3().to_array(),
        forward: forward.as_vec3().to_array(),
        // with a negative opacity the shader leaves the background as it is
        background: input.settings.background.unwrap_or([0.0, 0.0, 0.0, -1.0]),
        offset: [0.0; 2],
        spread_px: spread_px(counts) as f32,
        samples: counts.samples.count(),
        style: input.settings.style as u32,
        curvature: input.settings.curvature_range.recip() as f32,
        most_groups: device.limits().max_compute_work_group_count[0],
        ..abi::Frame::default()
    };
    seen_by(camera, frame)
}

/// How far samples lie from their pixel's centre, along either axis.
fn spread_px(counts: Counts) -> f64 {
    counts.samples.offsets().iter().flatten().fold(0.0, |far, x| x.abs().max(far))
}

/// The margins of pass `bound` around the picture and around a patch: `glsl/include/bound.glsl`.
pub(super) fn reach(counts: Counts, tolerance_px: f64) -> Reach {
    let budget = Budget::of(tolerance_px);
    let skirt = if counts.trim.is_some() { budget.gap_radius } else { 0.0 };
    Reach { beside_px: budget.gap_radius + 1.0, beyond_px: budget.deviation + spread_px(counts) + skirt }
}

/// Vertices before a sub-patch that the same draw has.
pub(super) fn draw_vertices(device: &Device) -> u32 {
    device.quirks().max_tessellated_vertices_per_draw.saturating_sub(MOST_VERTICES).max(1)
}

/// Vertices of one sub-patch at the hardware's factor of 64: a draw may exceed its budget by so many.
const MOST_VERTICES: u32 = 65 * 65;
