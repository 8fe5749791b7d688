// Arguments of a dispatch of `groups` workgroups, in rows as long as the device takes. thread.glsl numbers the
// workgroups. Needs the frame's constants. Twin: src/twin/grid.rs.
#ifndef GRID_GLSL
#define GRID_GLSL

uvec3 grid_of(uint groups) {
    uint columns = min(groups, frame.most_groups);
    return uvec3(columns, columns == 0u ? 1u : (groups - 1u) / columns + 1u, 1u);
}

#endif
