#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `gap_fill`, without a trim test.
#define TRIM_BY_UNTRIMMED
#include "gap_fill.glsl"
