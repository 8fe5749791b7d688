#version 460
layout(vertices = 4) out;
layout(push_constant) uniform Push { float factor; };
void main() {
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    if (gl_InvocationID == 0) {
        gl_TessLevelOuter = float[4](factor, factor, factor, factor);
        gl_TessLevelInner = float[2](factor, factor);
    }
}
