#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`, patches: the tiles that show a patch or a mesh.
#define SQUARES 9
#include "squares.glsl"
