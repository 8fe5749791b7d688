#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `border_mesh`, within a volume.
#define WITHIN_VOLUME
#include "border_mesh.glsl"
