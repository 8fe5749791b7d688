#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `edge_fold`, of scenes without trims.
#define TRIM_BY_UNTRIMMED
#include "edge_fold.glsl"
