#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `edge_fold`, by the trim table.
#define TRIM_BY_TABLE
#include "edge_fold.glsl"
