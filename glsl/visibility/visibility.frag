#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `visibility`, patches without a trim test.
#include "visibility_plain.glsl"
