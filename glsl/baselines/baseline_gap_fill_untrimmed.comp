#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `gap_fill`, with no test at all.
#define TRIM_BY_UNTRIMMED
#include "gap_fill.glsl"
