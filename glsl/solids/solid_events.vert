#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_events`: the tiles that may show a solid.
#define SQUARES 12
#include "squares.glsl"
