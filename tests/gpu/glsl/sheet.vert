#version 460
// Corners of a sheet over [-1, 1] x [-1, 0] in clip space: the upper half of the picture.
void main() {
    gl_Position = vec4(gl_VertexIndex % 2 * 2.0 - 1.0, gl_VertexIndex / 2 - 1.0, 0.25, 1.0);
}
