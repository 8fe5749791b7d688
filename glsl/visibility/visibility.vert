#version 460
// Pass `visibility`, first stage: one vertex a sub-patch.
layout(location = 0) flat out uint sub_patch;

void main() {
    sub_patch = gl_VertexIndex;
}
