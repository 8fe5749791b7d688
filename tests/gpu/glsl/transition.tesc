#version 460
layout(vertices = 1) out;
layout(push_constant) uniform Push { vec4 sides; vec2 inner; };
void main() {
    gl_TessLevelOuter = float[4](sides.x, sides.y, sides.z, sides.w);
    gl_TessLevelInner = float[2](inner.x, inner.y);
}
