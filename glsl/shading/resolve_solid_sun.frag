#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`, Boolean solids, in a scene with a sun.
#define SUN_BINDING 14
#include "resolve_solid.glsl"
