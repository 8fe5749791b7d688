#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `operand_patch`, trimmed patches, by a baseline: trim textures.
#define TRIMMED
#define TRIM_BY_TEXTURE
#include "operand_patch.glsl"
