// Pushes a vertex on the border of a trimmed face beyond it. Needs `frame`, view.glsl and patch.glsl.
#ifndef BORDER_VERTEX_GLSL
#define BORDER_VERTEX_GLSL

#include "push.glsl"

// Borders are pushed outwards by at most MAX_PUSH of a patch's width, by at most a segment, and only as far as the
// surface stays within this share of deviation_px of its tangent. Beside a silhouette, even a step of many pixels does
// not move the border across itself, and triangles of that length would be off by pixels. Triangles at the border then
// deviate by at most (1 + sqrt(MAX_BEND) / 2)^2 deviation_px along the step.
const float MAX_BEND = 0.25;

// `border`: whether the vertex is on the face's border at u = 0, v = 0, u = 1, v = 1. `segments`: along u and v at the
// vertex, those of a side that ends there.
void push_border(Patch patch_, View view, bvec4 border, vec2 segments, inout vec2 uv, inout Jet jet) {
    if (!any(border)) return;
    vec4 q = to_pixel(view, vec4(jet.point, 1.0));
    vec4 qu = to_pixel(view, vec4(jet.du, 0.0));
    vec4 qv = to_pixel(view, vec4(jet.dv, 0.0));
    vec2 pu, pv;
    pixel_speeds(frame, q, qu, qv, pu, pv);
    vec2 push = border_push(frame, pu, pv);
    // at the end of a shared side, both of its patches must push by the same bits: along that side
    bool shared_u = (uv.x == 0.0 || uv.x == 1.0) && !(border.x || border.z);
    bool shared_v = (uv.y == 0.0 || uv.y == 1.0) && !(border.y || border.w);
    if (shared_u) push.y = 2.0 * frame.gap_radius_px / max(length(pv), 1e-12);
    if (shared_v) push.x = 2.0 * frame.gap_radius_px / max(length(pu), 1e-12);
    push = min(min(vec2(MAX_PUSH), 1.0 / segments), push);
    vec2 step_ = vec2(border.z ? push.x : border.x ? -push.x : 0.0, border.w ? push.y : border.y ? -push.y : 0.0);
    vec3 there = patch_jet(patch_.first, patch_.shape, uv + step_).point;
    vec4 straight = q + step_.x * qu + step_.y * qv;
    vec4 bent = to_pixel(view, vec4(there, 1.0));
    float near = frame.perspective != 0u ? frame.near : 0.0;
    if (min(straight.w, bent.w) > near) {
        float bend = distance(straight.xy / straight.w, bent.xy / bent.w);
        float most = MAX_BEND * frame.deviation_px;
        if (bend > most) {
            step_ *= sqrt(most / bend);
            there = patch_jet(patch_.first, patch_.shape, uv + step_).point;
        }
    }
    uv += step_;
    jet.point = there;
}

#endif
