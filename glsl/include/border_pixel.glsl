// A pixel at a border, in the list of passes `border_find` to `border_write`. Needs `frame`.
#ifndef BORDER_PIXEL_GLSL
#define BORDER_PIXEL_GLSL

struct BorderPixel {
    uint pixel; // column, row << 16
    uvec2 mean; // linear colour times opacity, and opacity: four halves
    uint sliver; // way to a pixel that sees a sliver (border_sliver.glsl): column, row << 16; NO_SLIVER
};

const uint NO_SLIVER = 0xffffffffu;

uint way_of_sliver(ivec2 way) { return uint(way.x) & 0xffffu | uint(way.y) << 16; }

// How many pixels the list has, and the grids of the next passes: of a thread a pixel, and of a thread a point.
struct BorderGrids {
    uvec3 pixels;
    uint count;
    uvec3 points;
};

ivec2 pixel_of(BorderPixel border) { return ivec2(border.pixel & 0xffffu, border.pixel >> 16); }

// Smaller bends are no jump: in pixels, and as a share of the depth's climb.
const float JUMP_PX = 2.0;
const float JUMP_OF_CLIMB = 0.5;

// Whether the depth jumps beside a pixel at depth `here`; `before` and `behind` have the differences to opposite
// neighbours, up to four pairs.
bvec4 jumps(vec4 before, vec4 behind, float here) {
    float px = (frame.perspective != 0u ? here : 1.0) / frame.focal;
    return greaterThan(abs(before + behind), JUMP_PX * px + JUMP_OF_CLIMB * abs(behind - before));
}

bool jumps(float before, float behind, float here) { return jumps(vec4(before), vec4(behind), here).x; }

#endif
