// The point of the exact surface under a pixel. Needs patch.glsl and view.glsl.
//
// Newton's method on F(u, v) = projection(S(u, v)) - pixel:  step = -J^-1 F, continued only while the distance to the
// pixel shrinks (at a silhouette there may be no such point). With REFINE_DAMPED, which an includer defines, a step that
// leads farther away is halved instead: near a pole, where u turns as much as v moves, and beside a silhouette, whole steps
// lead too far.
//
// The better point is stored before the loop is left. If it is stored afterwards (`if (!nearer) break; best = next;`),
// Mesa 22.3's llvmpipe sometimes gives a lane that has left the loop the step that it rejected, while other lanes of
// its group continue. The result then depends on the order of threads.
#ifndef REFINE_GLSL
#define REFINE_GLSL

const uint NEWTON_STEPS = 4u;
// The same with halved steps among them: at balls' poles, twelve find no more points.
const uint DAMPED_STEPS = 8u;
const float MAX_STEP = 0.25;      // of the patch, or of the patch before the split
const float CLOSE_ENOUGH = 5e-4;  // pixels

struct Sample {
    vec2 uv;
    Jet jet;
    vec4 q;      // homogeneous pixel
    vec2 miss;   // pixels
};

// Some patch has a fine net (src/scene/fine.rs).
layout(constant_id = 20) const bool SCENE_HAS_FINE = false;

// Control points, from `first` on, and their base, a point near the patch, relative to which they are most precise.
// `less`: the offset still to be subtracted.
struct Net {
    uint first;
    vec3 less;
    vec3 base;
};

// The fine net, or the control points relative to a corner.
Net net_of(Patch patch_) {
    uint count = (degree_u(patch_.shape) + 1u) * (degree_v(patch_.shape) + 1u);
    bool fine = SCENE_HAS_FINE && has_fine_net(patch_.shape);
    vec4 base = texelFetch(points, int(patch_.first + (fine ? count : 0u)));
    base.xyz /= base.w;
    return Net(patch_.first + (fine ? count + 1u : 0u), fine ? vec3(0.0) : base.xyz, base.xyz);
}

Sample sample_of(Jet jet, Net net, View view, vec2 uv, vec2 pixel) {
    Sample s;
    s.uv = uv;
    s.jet = jet;
    s.q = to_pixel(view, vec4(net.base, 1.0)) + to_pixel(view, vec4(s.jet.point, 0.0));
    s.miss = s.q.xy / s.q.w - pixel;
    return s;
}

Sample sample_at(Patch patch_, Net net, View view, vec2 uv, vec2 pixel) {
    return sample_of(patch_jet_from(net.first, patch_.shape, net.less, uv), net, view, uv, pixel);
}

// Change of the pixel with u, and with v: the columns of J. `qu` and `qv` are the derivatives of the homogeneous pixel.
mat2 pixels_along(vec4 q, vec4 qu, vec4 qv) {
    vec2 p = q.xy / q.w;
    return mat2((qu.xy - p * qu.w) / q.w, (qv.xy - p * qv.w) / q.w);
}

mat2 pixels_along(Sample s, View view) {
    return pixels_along(s.q, to_pixel(view, vec4(s.jet.du, 0.0)), to_pixel(view, vec4(s.jet.dv, 0.0)));
}

bool misses(Sample s, float close) { return dot(s.miss, s.miss) >= close * close; }

// The step J^-1 F in a patch, as long as it may be; false where J has no inverse.
bool newton_step(mat2 along, vec2 miss, Patch patch_, out vec2 step_) {
    vec2 pu = along[0];
    vec2 pv = along[1];
    float det = pu.x * pv.y - pu.y * pv.x;
    step_ = vec2(miss.x * pv.y - miss.y * pv.x, pu.x * miss.y - pu.y * miss.x) / det;
    vec2 steps = abs(step_) / (MAX_STEP * pieces_of(patch_.shape));
    step_ /= max(max(steps.x, steps.y), 1.0);
    return abs(det) >= 1e-12;
}

// The next step of Newton's method on the patch, if there is one.
bool step_from(Patch patch_, Sample s, View view, float close, out vec2 step_) {
    return newton_step(pixels_along(s, view), s.miss, patch_, step_) && misses(s, close);
}

// The sample after a step on a plane, whose derivatives are constant.
Sample along_plane(Sample s, View view, vec2 step_, vec2 pixel) {
    s.uv -= step_;
    s.jet.point -= step_.x * s.jet.du + step_.y * s.jet.dv;
    s.q -= step_.x * to_pixel(view, vec4(s.jet.du, 0.0)) + step_.y * to_pixel(view, vec4(s.jet.dv, 0.0));
    s.miss = s.q.xy / s.q.w - pixel;
    return s;
}

// Iterates until the point is within `close` pixels. One call of `sample_at`, which drivers inline.
Sample refine_to(Patch patch_, View view, vec2 uv, vec2 pixel, float close) {
    Net net = net_of(patch_);
    Sample best;
    best.uv = uv;
    vec2 step_ = vec2(0.0);
#ifdef REFINE_DAMPED
    for (uint i = 0u; i <= DAMPED_STEPS; ++i) {
#else
    for (uint i = 0u; i <= NEWTON_STEPS; ++i) {
#endif
        Sample next = sample_at(patch_, net, view, best.uv - step_, pixel);
        bool nearer = i == 0u || dot(next.miss, next.miss) < dot(best.miss, best.miss);
        if (nearer) best = next;
#ifdef REFINE_DAMPED
        step_ *= 0.5; // unless there is a new one
        if (!nearer) continue;
#else
        if (!nearer) break;
#endif
        if (!step_from(patch_, best, view, close, step_)) break;
    }
    return best;
}

Sample refine(Patch patch_, View view, vec2 uv, vec2 pixel) { return refine_to(patch_, view, uv, pixel, CLOSE_ENOUGH); }

#endif
