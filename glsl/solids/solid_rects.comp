#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_rects`: the tiles that the box around each leaf may cover. One thread a leaf.
// Twin: src/twin/solid_rects.rs.
#include "scene.glsl"
#include "solids.glsl"
#include "tiles.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(scalar, binding = 2) readonly buffer LeafCentres { vec3 leaf_centres[]; };
layout(scalar, binding = 3) writeonly buffer Rects { Rect rects[]; };

const Rect NOWHERE = Rect(uvec2(1u), uvec2(0u));

// Margin for the rounding of a position and for samples up to 7/16 beside the centre.
const float MARGIN_PX = 0.5;

Rect rect_of(Leaf leaf, vec3 centre) {
    uvec2 last = tile_count(frame) - 1u;
    if ((leaf.flags & LEAF_UNBOUNDED) != 0u) return Rect(uvec2(0u), last);
    vec3 axes[3] = vec3[](frame.right, frame.up, frame.forward);
    vec3 middle;
    vec3 reach;
    for (uint k = 0u; k < 3u; ++k) {
        middle[k] = dot(axes[k], centre);
        reach[k] = dot(abs(axes[k]), leaf.half_size);
    }
    float nearest = middle.z - reach.z;
    float farthest = middle.z + reach.z;
    if (farthest < frame.near || nearest > frame.far) return NOWHERE;
    if (frame.perspective != 0u && nearest < frame.near) return Rect(uvec2(0u), last);
    // the box in view axes: a corner's slope is largest at its nearest or farthest depth
    vec2 lo = middle.xy - reach.xy;
    vec2 hi = middle.xy + reach.xy;
    if (frame.perspective != 0u) {
        lo = min(lo / nearest, lo / farthest);
        hi = max(hi / nearest, hi / farthest);
    }
    lo = frame.focal_px * lo - MARGIN_PX;
    hi = frame.focal_px * hi + MARGIN_PX;
    // y goes down in the picture
    vec2 first = vec2(frame.principal_px.x + lo.x, frame.principal_px.y - hi.y);
    vec2 end = vec2(frame.principal_px.x + hi.x, frame.principal_px.y - lo.y);
    if (any(lessThan(end, vec2(0.0))) || any(greaterThan(first, frame.size))) return NOWHERE;
    vec2 most = frame.size - 1.0;
    return Rect(uvec2(clamp(first, vec2(0.0), most)) / TILE, uvec2(clamp(end, vec2(0.0), most)) / TILE);
}

void main() {
    uint n = thread_number();
    if (n >= frame.leaf_count) return;
    rects[n] = rect_of(leaves[n], leaf_centres[n]);
}
