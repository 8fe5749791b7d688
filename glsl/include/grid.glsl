// Arguments of a dispatch of so many workgroups, in rows as long as the device takes: thread.glsl numbers them. Needs the
// frame's constants. Twin of src/twin/grid.rs.
#ifndef GRID_GLSL
#define GRID_GLSL

uvec3 grid_of(uint groups) {
    uint columns = min(groups, frame.most_groups);
    return uvec3(columns, columns == 0u ? 1u : (groups - 1u) / columns + 1u, 1u);
}

#endif
