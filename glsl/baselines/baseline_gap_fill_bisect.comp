#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `gap_fill`, by bisection in every pixel.
#define TRIM_BY_BISECT
#include "gap_fill.glsl"
