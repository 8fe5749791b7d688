// The point of the exact surface under a pixel. Needs patch.glsl and view.glsl.
//
// Newton's method on F(u, v) = projection(S(u, v)) - pixel:  step = -J^-1 F, kept only while the
// distance to the pixel shrinks (at a silhouette there may be no such point).
//
// The better point is taken before the loop is left, not after. Written the other way round (`if (!nearer) break;
// best = next;`) Mesa 22.3's llvmpipe now and then gave a lane that had left the loop the step it had refused, where
// other lanes of its group went on: which, the order of the threads decided.
#ifndef REFINE_GLSL
#define REFINE_GLSL

const uint NEWTON_STEPS = 4u;
const float MAX_STEP = 0.25;      // of the patch
const float CLOSE_ENOUGH = 5e-4;  // pixels

struct Sample {
    vec2 uv;
    Jet jet;
    vec4 q;      // homogeneous pixel
    vec2 miss;   // pixels
};

// A corner of the patch: what is near it is known best from there.
vec3 base_of(Patch patch_) {
    vec4 corner = texelFetch(points, int(patch_.first));
    return corner.xyz / corner.w;
}

Sample sample_at(Patch patch_, vec3 base, View view, vec2 uv, vec2 pixel) {
    Sample s;
    s.uv = uv;
    s.jet = patch_jet_from(patch_.first, patch_.shape, base, uv);
    s.q = to_pixel(view, vec4(base, 1.0)) + to_pixel(view, vec4(s.jet.point, 0.0));
    s.miss = s.q.xy / s.q.w - pixel;
    return s;
}

// How far the pixel moves with u, and with v: the columns of J.
mat2 pixels_along(Sample s, View view) {
    vec4 qu = to_pixel(view, vec4(s.jet.du, 0.0));
    vec4 qv = to_pixel(view, vec4(s.jet.dv, 0.0));
    vec2 p = s.q.xy / s.q.w;
    return mat2((qu.xy - p * qu.w) / s.q.w, (qv.xy - p * qv.w) / s.q.w);
}

// Where Newton's method goes from there, if anywhere.
bool step_from(Sample s, View view, out vec2 step_) {
    mat2 along = pixels_along(s, view);
    vec2 pu = along[0];
    vec2 pv = along[1];
    float det = pu.x * pv.y - pu.y * pv.x;
    step_ = vec2(s.miss.x * pv.y - s.miss.y * pv.x, pu.x * s.miss.y - pu.y * s.miss.x) / det;
    float largest = max(abs(step_.x), abs(step_.y));
    if (largest > MAX_STEP) step_ *= MAX_STEP / largest;
    return dot(s.miss, s.miss) >= CLOSE_ENOUGH * CLOSE_ENOUGH && abs(det) >= 1e-12;
}

Sample refine(Patch patch_, View view, vec2 uv, vec2 pixel) {
    vec3 base = base_of(patch_);
    Sample best = sample_at(patch_, base, view, uv, pixel);
    for (uint i = 0u; i < NEWTON_STEPS; ++i) {
        vec2 step_;
        if (!step_from(best, view, step_)) break;
        Sample next = sample_at(patch_, base, view, best.uv - step_, pixel);
        bool nearer = dot(next.miss, next.miss) < dot(best.miss, best.miss);
        if (nearer) best = next;
        if (!nearer) break;
    }
    return best;
}

#endif
