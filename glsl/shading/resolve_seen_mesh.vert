#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`, meshes: the tiles that show a patch or a mesh.
#define SQUARES 10
#include "squares.glsl"
