#version 460
// The domain as the picture; and of each vertex what a triangle's interpolation makes variances of.
layout(quads, equal_spacing, ccw) in;
layout(location = 0) out vec2 mean;
layout(location = 1) out vec2 mean_of_squares;
void main() {
    mean = gl_TessCoord.xy;
    mean_of_squares = mean * mean;
    gl_Position = vec4(2.0 * mean - 1.0, 0.0, 1.0);
}
