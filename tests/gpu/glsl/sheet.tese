#version 460
layout(quads, equal_spacing, ccw) in;
void main() {
    vec2 t = gl_TessCoord.xy;
    gl_Position = mix(mix(gl_in[0].gl_Position, gl_in[1].gl_Position, t.x),
                      mix(gl_in[2].gl_Position, gl_in[3].gl_Position, t.x), t.y);
}
