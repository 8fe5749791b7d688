#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `border_follow`, by the trim table; within a volume.
#define WITHIN_VOLUME
#define TRIM_BY_TABLE
#include "border_follow.glsl"
