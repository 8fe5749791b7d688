// The engine's picture in the window's view, and marks over what is hovered and selected.
//
//   window pixel ──(origin, scale)──▶ picture pixel ──face, instance──▶ marked? tint; at the mark's border a line
//
// A mark is an instance and a face number, as the engine's images have them; face 0 stands for every face.
#version 450

layout(binding = 0) uniform sampler2D colour;
layout(binding = 1) uniform usampler2D faces;
layout(binding = 2) uniform usampler2D instances;
layout(std430, binding = 3) readonly buffer Marks { uvec2 marks[]; };
layout(push_constant) uniform Push {
    vec2 origin;  // of the view, window pixels
    vec2 scale;   // picture pixels per window pixel
    uint hovered; // 1: the first mark is hovered
    uint count;
};
layout(location = 0) out vec4 seen;

const vec3 HOVERED = vec3(1.0, 0.55, 0.05);
const vec3 SELECTED = vec3(0.05, 0.35, 1.0);

// Of the first mark that the picture's pixel is in, plus 1; 0 without one.
uint mark_of(ivec2 at) {
    ivec2 inside = clamp(at, ivec2(0), textureSize(faces, 0) - 1);
    uint face = texelFetch(faces, inside, 0).x;
    uint instance = texelFetch(instances, inside, 0).x;
    if (face == 0u) {
        return 0u;
    }
    for (uint i = 0u; i < count; i++) {
        if (marks[i].x == instance && (marks[i].y == face || marks[i].y == 0u)) {
            return i + 1u;
        }
    }
    return 0u;
}

void main() {
    vec2 at = (gl_FragCoord.xy - origin) * scale;
    seen = vec4(texture(colour, at / vec2(textureSize(colour, 0))).rgb, 1.0);
    if (count == 0u) {
        return;
    }
    ivec2 pixel = ivec2(at);
    uint mark = mark_of(pixel);
    ivec2 step = max(ivec2(scale), ivec2(1));
    bool border = mark != mark_of(pixel + ivec2(step.x, 0)) || mark != mark_of(pixel + ivec2(0, step.y));
    uint shown = max(mark, border ? max(mark_of(pixel + ivec2(step.x, 0)), mark_of(pixel + ivec2(0, step.y))) : 0u);
    if (shown == 0u) {
        return;
    }
    vec3 tint = hovered == 1u && shown == 1u ? HOVERED : SELECTED;
    seen.rgb = mix(seen.rgb, tint, border ? 0.9 : 0.35);
}
