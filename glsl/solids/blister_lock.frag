#version 460
// Pass `blister`: where the walk ended inside, the layer's face bounds the solid. The stencil test passes these pixels
// and locks them.
layout(binding = 0, rg32ui) readonly uniform uimage2D layer;
layout(location = 0) out uvec2 found;

void main() {
    found = imageLoad(layer, ivec2(gl_FragCoord.xy)).xy;
    if (found.x == 0u) discard;
}
