#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `visibility`, trimmed patches without a trim test.
#define TRIM_BY_UNTRIMMED
#include "visibility_trimmed.glsl"
