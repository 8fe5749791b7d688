// The distance by which the borders of trimmed faces are pushed outwards.
#ifndef PUSH_GLSL
#define PUSH_GLSL

// Most of it, as a share of the patch's width.
const float MAX_PUSH = 0.5;

// Pixels per unit u and v at a homogeneous pixel with these derivatives.
void pixel_speeds(Frame frame, vec4 q, vec4 qu, vec4 qv, out vec2 pu, out vec2 pv) {
    float w = frame.perspective != 0u ? max(q.w, frame.near) : 1.0;
    pu = (qu.xy - q.xy / w * qu.w) / w;
    pv = (qv.xy - q.xy / w * qv.w) / w;
}

// Twice the gap radius, across the border: a step du moves it by du * area / |pv| pixels across itself.
vec2 border_push(Frame frame, vec2 pu, vec2 pv) {
    float area = abs(pu.x * pv.y - pu.y * pv.x);
    return 2.0 * frame.gap_radius_px * vec2(length(pv), length(pu)) / max(area, 1e-12);
}

vec2 border_push(Frame frame, vec4 q, vec4 qu, vec4 qv) {
    vec2 pu, pv;
    pixel_speeds(frame, q, qu, qv, pu, pv);
    return border_push(frame, pu, pv);
}

#endif
