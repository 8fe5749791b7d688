#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Trim textures, third step: each texel becomes the parity of the flips up to it. One column of invocations for each
// placed face; each invocation has some of the rows, and the first writes the texture's place.
#include "scene.glsl"
#include "baselines/texture.glsl"

layout(local_size_x = 1, local_size_y = 64) in;
layout(scalar, binding = 0) readonly buffer Knob { float texels_per_px; uint placed_count; };
layout(scalar, binding = 1) readonly buffer FaceSpeeds { uint face_speeds[]; };
layout(scalar, binding = 2) readonly buffer Starts { uint starts[]; };
layout(scalar, binding = 3) buffer Texels { uint texels[]; };
layout(scalar, binding = 4) readonly buffer CountersBuffer { Counters counters; };
layout(scalar, binding = 5) readonly buffer FaceInstances { FaceInstance face_instances[]; };
layout(scalar, binding = 6) readonly buffer Faces { Face faces[]; };
layout(scalar, binding = 7) writeonly buffer Places { TexturePlace places[]; };

void main() {
    uint placed = gl_GlobalInvocationID.x + gl_GlobalInvocationID.z * gl_NumWorkGroups.x;
    if (placed >= placed_count) return;
    vec2 speed = texture_speed(face_speeds[2u * placed], face_speeds[2u * placed + 1u]);
    TextureSize size = texture_size(speed, texels_per_px);
    if ((counters.failed & FAILED_INTERCEPTS) != 0u) size = TextureSize(0u, 0u, 0u);
    FaceInstance fi = face_instances[placed];
    bool trimmed = (faces[fi.face].flags & FACE_TRIMMED) != 0u;
    if (trimmed && gl_GlobalInvocationID.y == 0u) places[fi.first_bin] = TexturePlace(size, starts[placed]);
    uint shares = gl_NumWorkGroups.y * gl_WorkGroupSize.y;
    for (uint row = gl_GlobalInvocationID.y; row < size.rows; row += shares) {
        uint before = 0u; // all ones if the texel before is set
        uint word = starts[placed] + row * size.words;
        for (uint k = 0u; k < size.words; ++k) {
            uint bits = texels[word + k];
            bits ^= bits << 1;
            bits ^= bits << 2;
            bits ^= bits << 4;
            bits ^= bits << 8;
            bits ^= bits << 16;
            bits ^= before;
            before = (bits >> 31) != 0u ? 0xffffffffu : 0u;
            texels[word + k] = bits;
        }
    }
}
