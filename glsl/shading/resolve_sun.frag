#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`, patches, in a scene with a sun.
#define SUN_BINDING 10
#include "resolve.glsl"
