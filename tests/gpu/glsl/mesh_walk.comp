#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Walks across meshes, mesh_walk.glsl, one thread a walk, for src/parity/mesh_walk.rs.
#include "scene.glsl"
#include "view.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Views { View views[]; };
layout(scalar, binding = 1) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 2) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 3) readonly buffer Neighbours { uint neighbours[]; };

#include "facet.glsl"
#include "mesh_walk.glsl"

struct Walk {
    uint view;
    uint triangle;
    vec2 middle;
    vec2 point; // from there
    float nearest;
};
struct Answer {
    Met met;
    vec4 weights; // of the first triangle
};

layout(scalar, binding = 4) readonly buffer Walks { Walk walks[]; };
layout(scalar, binding = 5) writeonly buffer Answers { Answer answers[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    Walk w = walks[i];
    View view = views[w.view];
    Met met = walk_to(w.triangle, view, w.middle + w.point, w.nearest);
    answers[i] = Answer(met, weights_of(facing_at(w.triangle, view, w.middle), w.point));
}
