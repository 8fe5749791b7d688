#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Trim textures, second step: at each crossing of a row and a trim curve, flips the texel behind it. One column of
// invocations for each curve; each invocation has some of the chords.
#include "scene.glsl"
#include "baselines/texture.glsl"

layout(local_size_x = 1, local_size_y = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Knob { float texels_per_px; uint placed_count; };
layout(binding = 2) uniform usamplerBuffer face_instances;
layout(binding = 3) uniform usamplerBuffer faces;
layout(binding = 4) uniform usamplerBuffer curves;
layout(binding = 5) uniform samplerBuffer curve_points;
layout(binding = 6) uniform usamplerBuffer curve_instances; // the placed face of each
layout(scalar, binding = 7) readonly buffer FaceSpeeds { uint face_speeds[]; };
layout(scalar, binding = 8) readonly buffer Starts { uint starts[]; };
layout(scalar, binding = 9) buffer Texels { uint texels[]; };
layout(scalar, binding = 10) buffer CountersBuffer { Counters counters; };

#include "curve.glsl"
#include "curves.glsl"
#include "faces.glsl"
#include "words.glsl"

const uint SHARES = 64u;
// Error of a chord in texels, in addition to half a texel.
const float CHORD_TEXELS = 0.0625;
const float MAX_CHORDS = 65536.0;
// Rows for one invocation: a long straight curve gets several invocations.
const float ROWS_PER_CHORD = 64.0;

void flip(TextureSize size, uint start, vec2 a, vec2 b) {
    vec2 scale = vec2(size.columns, size.rows);
    a *= scale;
    b *= scale;
    float lo = min(a.y, b.y);
    float hi = max(a.y, b.y);
    // rows whose middle lies above lo, up to hi: bottom-open, top-closed
    int first = max(int(floor(lo - 0.5)) + 1, 0);
    int last = min(int(floor(hi - 0.5)), int(size.rows) - 1);
    for (int row = first; row <= last; ++row) {
        float t = (float(row) + 0.5 - a.y) / (b.y - a.y);
        float column = max(ceil(mix(a.x, b.x, clamp(t, 0.0, 1.0)) - 0.5), 0.0);
        if (column >= scale.x) continue;
        uint bit = uint(column);
        atomicXor(texels[start + uint(row) * size.words + bit / 32u], 1u << (bit & 31u));
    }
}

void main() {
    uint curve_instance = gl_GlobalInvocationID.x + gl_GlobalInvocationID.z * gl_NumWorkGroups.x;
    if (curve_instance >= frame.curve_count) return;
    uint placed = word_at(curve_instances, curve_instance);
    FaceInstance fi = face_instance_at(placed);
    Face face = face_at(fi.face);
    Curve curve = curve_at(face.first_curve + curve_instance - fi.first_curve);
    vec2 speed = texture_speed(face_speeds[2u * placed], face_speeds[2u * placed + 1u]);
    TextureSize size = texture_size(speed, texels_per_px);
    uint start = starts[placed];
    uint end = starts[placed_count];
    if (curve_instance == 0u && gl_LocalInvocationID.y == 0u) {
        atomicMax(counters.intercepts, end);
        if (end > frame.intercept_capacity) atomicOr(counters.failed, FAILED_INTERCEPTS);
    }
    // otherwise a size was cut or did not fit: the host enlarges the buffer and records again
    if (size.words == 0u || end > frame.intercept_capacity || (counters.failed & FAILED_INTERCEPTS) != 0u) return;
    vec2 texels_ = vec2(size.columns, size.rows);
    float for_chords = ceil(sqrt(dot(curve.bend, texels_) / CHORD_TEXELS));
    float for_rows = ceil((curve.range_v.y - curve.range_v.x) * texels_.y / ROWS_PER_CHORD);
    uint n = uint(clamp(max(for_chords, for_rows), 1.0, MAX_CHORDS));
    for (uint k = gl_LocalInvocationID.y; k < n; k += SHARES) {
        flip(size, start, curve_point(curve, k, n), curve_point(curve, k + 1u, n));
    }
}
