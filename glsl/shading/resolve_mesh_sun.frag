#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`, meshes, in a scene with a sun.
#define SUN_BINDING 11
#include "resolve_mesh.glsl"
