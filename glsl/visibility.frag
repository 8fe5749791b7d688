#version 460
#extension GL_GOOGLE_include_directive : require
// Pass `visibility`, untrimmed patches: who is seen, and where on its patch.
#include "visible.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint item;
layout(location = 0) out uvec2 visible; // item + 1, (u, v) of the patch as two 16-bit fixed-point numbers

void main() {
    visible = uvec2(item + 1u, pack_uv(uv));
}
