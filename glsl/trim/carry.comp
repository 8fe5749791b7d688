#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `carry`: the winding number at the start of each row of a strip with several bins, from the crossings of its
// scan line in the bins before. One workgroup a strip, one thread a scan line at a time.
//
//   bin               0     1     2     3
//   crossings add up  +1    0     -1    0      as pass `cross` counted them
//   at the start      0    1     1     0
//
// Twin: src/twin/carry.rs.
#include "u_bins.glsl"
#include "scene.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1) uniform usamplerBuffer strips;
layout(scalar, binding = 2) readonly buffer WideStrips { uint wide_strips[]; }; // bin instances
layout(scalar, binding = 3) buffer RowWindings { int row_windings[]; };

layout(scalar, push_constant) uniform Push { uint wide_strip_count; } push;

void main() {
    uint n = workgroup_number();
    if (n >= push.wide_strip_count) return;
    StripRows rows = strip_rows(strips, wide_strips[n]);
    for (uint line = gl_LocalInvocationID.x; line < rows.lines; line += gl_WorkGroupSize.x) {
        int winding = 0;
        for (uint bin = rows.first_bin; bin <= last_bin(rows); ++bin) {
            uint row = row_of(rows, line, bin);
            if (row >= frame.row_capacity) return; // the host enlarges the table and records again
            int crossed = row_windings[row];
            row_windings[row] = winding;
            winding += crossed;
        }
    }
}
