#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_layers`, in a scene with a sun.
#define SUN_BINDING 24
#define SUN_SEES_LEAVES
#include "solid_layers.glsl"
