#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `visibility`, patches without a trim test, in scenes where faces share sides and that a volume trims.
#define LINK_BINDING 14
#include "visibility_surface.glsl"
