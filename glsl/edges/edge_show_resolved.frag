#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `edge_show`, over the linear colours that the target shows.
#define SHOWS_RESOLVED
#include "edge_show.glsl"
