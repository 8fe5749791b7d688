#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `visibility`: the exact surface at the vertices of one sub-patch.
#include "visibility_surface.glsl"
