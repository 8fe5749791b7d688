#version 460
// Variance of u and of v over the triangle's vertices, with the pixel's barycentric weights.
layout(location = 0) in vec2 mean;
layout(location = 1) in vec2 mean_of_squares;
layout(location = 0) out vec2 variance;
void main() {
    variance = mean_of_squares - mean * mean;
}
