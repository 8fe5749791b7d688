// Pass `visibility`: the exact surface at the vertices of one sub-patch. If faces share sides, the entry point defines
// LINK_BINDING: vertices of plain patches on shared sides lie on the common curve.
//
// Two sub-patches with a common side compute its vertices from the same integers (segment k of n), so they agree bit
// for bit. On the border of a trimmed face the outermost vertices are pushed gap_radius_px beyond it: the surface
// continues, and the trim test finds material on both sides of an edge even if rounding or chords leave a gap.
#include "scene.glsl"
#include "view.glsl"

layout(constant_id = 2) const bool TRIMMED = false;
layout(constant_id = 11) const bool DRAWS_OPERANDS = false;

layout(quads, equal_spacing, ccw) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };

#include "placed.glsl"
#include "patch.glsl"
#include "border_vertex.glsl"
#ifdef LINK_BINDING
#include "link.glsl"
#endif

layout(location = 0) patch in uint in_patch_instance;
layout(location = 1) patch in uint in_instance;
layout(location = 2) patch in uint in_patch;
layout(location = 3) patch in uvec2 in_place;
layout(location = 4) patch in uvec2 in_splits;
layout(location = 5) patch in uvec4 in_edges;
layout(location = 0) out vec2 out_uv; // of the patch
layout(location = 1) flat out uint out_patch_instance;

float along_side(float x, uint place, uint splits, uint edge) {
    uint n = edge / splits;
    return float(place * n + uint(x * float(n) + 0.5)) / float(edge);
}

// Segments along u and v at the border's vertex `uv`: those of a side that ends there, the same for both patches at
// that side.
vec2 segments_across(vec2 uv) {
    uvec2 n = uvec2(gl_TessLevelInner[0], gl_TessLevelInner[1]) * in_splits;
    if (uv.y == 0.0) n.x = in_edges.y;
    if (uv.y == 1.0) n.x = in_edges.w;
    if (uv.x == 0.0) n.y = in_edges.x;
    if (uv.x == 1.0) n.y = in_edges.z;
    return vec2(max(n, uvec2(1u)));
}

void main() {
    vec2 t = gl_TessCoord.xy;
    vec2 uv = (vec2(in_place) + t) / vec2(in_splits);
    // sides of the whole patch: canonical positions
    bool left = t.x == 0.0 && in_place.x == 0u;
    bool right = t.x == 1.0 && in_place.x + 1u == in_splits.x;
    bool bottom = t.y == 0.0 && in_place.y == 0u;
    bool top = t.y == 1.0 && in_place.y + 1u == in_splits.y;
    if (left || right) {
        uv.x = left ? 0.0 : 1.0;
        if (!(bottom || top)) uv.y = along_side(t.y, in_place.y, in_splits.y, left ? in_edges.x : in_edges.z);
    }
    if (bottom || top) {
        uv.y = bottom ? 0.0 : 1.0;
        if (!(left || right)) uv.x = along_side(t.x, in_place.x, in_splits.x, bottom ? in_edges.y : in_edges.w);
    }
    Patch patch_ = patch_at(in_patch);
    View view = view_at(in_instance);
    Jet jet = patch_jet(patch_.first, patch_.shape, uv);
#ifdef LINK_BINDING
    // corners are control points, the same for all patches that meet there
    if ((left || right) != (bottom || top)) {
        uint side = left ? 0u : bottom ? 1u : right ? 2u : 3u;
        jet.point = linked_point(in_patch, side, left || right ? uv.y : uv.x, jet.point);
    }
#endif
    if (TRIMMED) {
        uint borders = borders_of(patch_.shape);
        left = left && (borders & BORDER_U0) != 0u;
        right = right && (borders & BORDER_U1) != 0u;
        bottom = bottom && (borders & BORDER_V0) != 0u;
        top = top && (borders & BORDER_V1) != 0u;
        push_border(patch_, view, bvec4(left, bottom, right, top), segments_across(uv), uv, jet);
    }
    vec4 q = to_pixel(view, vec4(jet.point, 1.0));
    gl_Position = DRAWS_OPERANDS ? to_clip_unending(frame, q) : to_clip(frame, q);
    out_uv = uv;
    out_patch_instance = in_patch_instance;
}
