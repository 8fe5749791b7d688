#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `operand_patch`, patches without a trim test.
#include "operand_patch.glsl"
