#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `edge_line`, of scenes without trims; within a volume.
#define WITHIN_VOLUME
#define TRIM_BY_UNTRIMMED
#include "edge_line.glsl"
