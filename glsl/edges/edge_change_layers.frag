#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `edge_change`, of what is seen through.
#define SEEN_THROUGH
#include "edge_change.glsl"
