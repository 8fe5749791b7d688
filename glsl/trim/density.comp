#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `density`: the pixels that each v-strip of a trimmed face can cover. One thread a cell.
//
//   |S_v| <= speed_v  and  W >= w over the cell   =>   strip height in pixels <= speed_v pixels / strips
//
// The largest value of the strip's visible cells replaces the paper's sup rho. Strips without a visible cell get no
// scan line, and bins beyond the visible ones no row. A table for all views from about the same distance
// (src/scene/whole_view.rs) uses the same density everywhere, for hidden cells, too. Twin: src/twin/density.rs.
#include "u_bins.glsl"
#include "octahedral.glsl"
#include "scene.glsl"
#include "view.glsl"

// Strips of some face have several bins.
layout(constant_id = 1) const bool SCENE_HAS_BINS = false;

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer Instances { Instance instances[]; };
layout(scalar, binding = 3) readonly buffer FaceInstances { FaceInstance face_instances[]; };
layout(scalar, binding = 4) readonly buffer Faces { Face faces[]; };
layout(scalar, binding = 5) readonly buffer Cells { Cell cells[]; };
layout(scalar, binding = 6) readonly buffer CellInstances { uint cell_face_instance[]; };
layout(scalar, binding = 7) buffer StripHeights { uint strip_heights[]; }; // float bits, pixels
layout(scalar, binding = 8) buffer FaceSpeeds { uint face_speeds[]; };     // float bits, pixels per unit u, v
layout(scalar, binding = 9) buffer SeenBins { uint seen_bins[]; }; // a bit for each bin of a strip, with SCENE_HAS_BINS

// Pixels that one unit of the cell can cover; negative if the cell is not visible.
float pixels_of(FaceInstance fi, Face face, Cell cell) {
    Instance instance = instances[fi.instance];
    if (frame.table_density > 0.0) return frame.table_density * instance.scale;
    View view = views[fi.instance];
    float margin = frame.gap_radius_px + 1.0;
    Seen seen = see(view, frame, cell.box_min, cell.box_max, margin, far_of(face, frame));
    if (seen.w < 0.0) return -1.0;
    if (frame.perspective != 0u) {
        seen.w = max(seen.w, nearest_in_slab(view, frame, octahedral(cell.normal), cell.low, cell.high, margin));
    }
    return pixels_per_unit(frame, instance, seen);
}

void main() {
    uint cell_instance = thread_number();
    if (cell_instance >= frame.cell_count) return;
    uint placed = cell_face_instance[cell_instance];
    FaceInstance fi = face_instances[placed];
    Face face = faces[fi.face];
    Cell cell = cells[face.first_cell + cell_instance - fi.first_cell];
    if (cell.speed_v < 0.0) return; // no loop meets its patch
    float pixels = pixels_of(fi, face, cell);
    if (pixels < 0.0) return;
    // positive floats order like their bits
    float height = cell.speed_v * pixels / float(strip_count(face.strips));
    uint bin = cell.bin % bin_count(face.strips);
    uint strip = fi.first_bin + cell.bin - bin;
    atomicMax(strip_heights[strip], floatBitsToUint(max(height, 1e-6)));
    if (SCENE_HAS_BINS) atomicOr(seen_bins[strip], 1u << bin);
    atomicMax(face_speeds[2u * placed], floatBitsToUint(cell.speed_u * pixels));
    atomicMax(face_speeds[2u * placed + 1u], floatBitsToUint(cell.speed_v * pixels));
}
