// Slivers: faces narrower than a pixel at a border, which no pixel around sees; another pixel farther along the border
// may. Needs placed.glsl, visible.glsl, border_around.glsl, `frame` and `visibility`.
//
//     A A · ·       a sliver s between A and nothing: rows apart it covers a centre. The pixel x and those around it see
//     A A s ·       none of it. Rows, or columns where the border runs along them, are looked at on both sides, and of
//     A x · ·       each the three pixels in the middle; s counts where no pixel to its sides in the row sees it, too
//     A A · ·
#ifndef BORDER_SLIVER_GLSL
#define BORDER_SLIVER_GLSL

// Rows looked at. A sliver that covers a third of a pixel, seen once in k rows, is seen in k / 3 rows one behind the
// other. The last one lies within the rows of the band before (src/frame/antialiasing/smooth_borders.rs).
const uint FAR_ROWS = 7u;
const int FAR_ROW[FAR_ROWS] = int[](2, 3, 4, 6, 8, 11, 15);

// The placed face that a pixel sees, from 1 on; 0 of none.
uint placed_face_at(ivec2 at) {
    if (!is_in_picture(at)) return 0u;
    uint word = imageLoad(visibility, at).x;
    if (sees_nothing(word) || sees_other(word)) return 0u;
    return face_instance_of(seen_patch_instance(word)) + 1u;
}

// The nearest pixel along the border that sees a sliver of a face that is none of `placed`, those of the pixels around;
// as BorderPixel has it.
uint sliver_along(ivec2 at, uint placed[AROUND]) {
    uint changes_x = 0u;
    uint changes_y = 0u;
    for (uint i = 0u; i < 3u; ++i) {
        for (uint j = 0u; j < 2u; ++j) {
            changes_x += uint(placed[3u * i + j] != placed[3u * i + j + 1u]);
            changes_y += uint(placed[3u * j + i] != placed[3u * j + i + 3u]);
        }
    }
    ivec2 across = changes_x >= changes_y ? ivec2(1, 0) : ivec2(0, 1);
    uint found = NO_SLIVER;
    for (uint i = 0u; i < 2u * FAR_ROWS; ++i) {
        ivec2 row = at + ((i & 1u) != 0u ? -1 : 1) * FAR_ROW[i / 2u] * across.yx;
        for (int j = -1; j <= 1; ++j) {
            ivec2 there = row + j * across;
            uint face = placed_face_at(there);
            bool is_new = face != 0u;
            for (uint k = 0u; k < AROUND; ++k) is_new = is_new && placed[k] != face;
            if (!is_new) continue;
            if (placed_face_at(there - across) == face || placed_face_at(there + across) == face) continue;
            found = way_of_sliver(there - at);
        }
        if (found != NO_SLIVER) break;
    }
    return found;
}

#endif
