#version 460
// Pass `visibility`, untrimmed patches: who is seen, and where on its patch.
layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint item;
layout(location = 0) out uvec2 visible; // item + 1, (u, v) of the patch as two 16-bit fixed-point numbers

void main() {
    visible = uvec2(item + 1u, packUnorm2x16((uv + 1.0) / 3.0));
}
