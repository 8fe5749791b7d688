#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `mesh`, within a volume: writes the visible triangle, if its point is within the volume.
#include "scene.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };

#define VOLUME_BINDING 5
#include "volume.glsl"

layout(location = 0) flat in uvec2 seen;
layout(location = 0) out uvec2 visible;

void main() {
    float parallel = frame.far - gl_FragCoord.z * (frame.far - frame.near);
    float depth = frame.perspective != 0u ? 1.0 / gl_FragCoord.w : parallel;
    if (!in_volume(vec4(gl_FragCoord.xy, depth, 1.0), ON_PX)) discard;
    visible = seen;
}
