#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `edge_fold`, by the exact arcs.
#define TRIM_BY_EXACT
#include "edge_fold.glsl"
