#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `blister`: finds the owners of the locked faces, by the walk of pass `solid_events`.
#define FACE_IS_FOUND
#include "solid_events.glsl"
