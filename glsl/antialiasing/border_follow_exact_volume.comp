#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `border_follow`, by the exact arcs; within a volume.
#define WITHIN_VOLUME
#define TRIM_BY_EXACT
#include "border_follow.glsl"
