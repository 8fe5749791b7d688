#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `visibility`, patches without a trim test, in scenes where faces share sides.
#define LINK_BINDING 10
#include "visibility_surface.glsl"
