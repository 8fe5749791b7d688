#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`, Boolean solids: the tiles that may show one.
#define SQUARES 7
#include "squares.glsl"
