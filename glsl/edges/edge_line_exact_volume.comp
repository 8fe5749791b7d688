#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `edge_line`, by the exact test; within a volume.
#define WITHIN_VOLUME
#define TRIM_BY_EXACT
#include "edge_line.glsl"
