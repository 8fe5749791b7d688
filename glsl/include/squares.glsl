// Two triangles over each square of tiles that pass `solid_squares` or `seen_squares` found, one instance a tile. The
// pass that draws them defines SQUARES, the binding.
#ifndef SQUARES_GLSL
#define SQUARES_GLSL

#include "scene.glsl"
#include "tiles.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = SQUARES) readonly buffer TileSquares { uint tile_squares[]; };

void main() {
    uint across = tile_count(frame).x;
    uvec2 tile = uvec2(gl_InstanceIndex % across, gl_InstanceIndex / across);
    uint side = tile_squares[gl_InstanceIndex];
    gl_Position = side > 0u ? tile_corner(frame, Rect(tile, tile + side - 1u), gl_VertexIndex) : OFF_THE_PICTURE;
}

#endif
