#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`, meshes: where the ray through the pixel's centre meets the plane of its triangle.
//
//   a + s (b - a) + t (c - a),   s, t >= 0,   s + t <= 1        (s, t) is what the image (u, v) gets
//
// The rasteriser rounds corners to a fraction of a pixel, so the ray may pass a little beside the
// triangle: the nearest point of the triangle counts then.
#include "scene.glsl"
#include "view.glsl"

layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer Instances { Instance instances[]; };
layout(scalar, binding = 3) readonly buffer MeshInstances { MeshInstance mesh_instances[]; };
layout(scalar, binding = 4) readonly buffer Meshes { Mesh meshes[]; };
layout(scalar, binding = 5) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 6) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 7) readonly buffer Normals { uint normals[]; };
layout(binding = 8, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 9, rg32ui) readonly uniform uimage2D others; // in scenes without trims the same

#include "resolved.glsl"
#include "visible.glsl"

// A unit vector from the octahedron |x| + |y| + |z| = 1 unfolded to a square. Source: Z. H. Cigolle et
// al., A Survey of Efficient Representations for Independent Unit Vectors, JCGT 3 (2), 2014.
vec3 octahedral(uint word) {
    vec2 e = unpackSnorm2x16(word);
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
    return normalize(n);
}

float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uvec2 seen = imageLoad(visibility, at).xy;
    if (sees_nothing(seen.x)) seen = imageLoad(others, at).xy;
    if (!sees_mesh(seen.x)) discard;
    MeshInstance placed = mesh_instances[seen_mesh_instance(seen.x)];
    Mesh mesh = meshes[placed.mesh];
    Instance instance = instances[placed.instance];
    View view = views[placed.instance];
    uint first = 3u * seen.y;
    vec3 a = positions[triangles[first]];
    vec3 ab = positions[triangles[first + 1u]] - a;
    vec3 ac = positions[triangles[first + 2u]] - a;
    // pixels times W, relative to the pixel's centre: zero at the point that is sought
    vec4 q = to_pixel(view, vec4(a, 1.0));
    vec4 qb = to_pixel(view, vec4(ab, 0.0));
    vec4 qc = to_pixel(view, vec4(ac, 0.0));
    vec2 pixel = gl_FragCoord.xy;
    vec2 from = q.xy - pixel * q.w;
    vec2 along_b = qb.xy - pixel * qb.w;
    vec2 along_c = qc.xy - pixel * qc.w;
    float area = cross2(along_b, along_c);
    vec2 st = vec2(cross2(along_c, from), cross2(from, along_b)) / area;
    if (area == 0.0 || any(isnan(st)) || any(isinf(st))) st = vec2(1.0 / 3.0); // edge-on
    st = max(st, 0.0);
    st /= max(st.x + st.y, 1.0);

    // of sides near 1: the product of small ones would underflow
    float side = max(max(dot(ab, ab), dot(ac, ac)), 1e-36);
    vec3 n = cross(ab * inversesqrt(side), ac * inversesqrt(side));
    if ((mesh.flags & MESH_NORMALS) != 0u) {
        uint corner = mesh.first_normal + 3u * (seen.y - mesh.first_triangle);
        n = octahedral(normals[corner]) * (1.0 - st.x - st.y) + octahedral(normals[corner + 1u]) * st.x +
            octahedral(normals[corner + 2u]) * st.y;
    }
    n = instance.normal * n;
    float size = length(n);
    n = size > 0.0 ? n / size : -frame.forward;
    if (instance.mirrored != 0u) n = -n;
    float depth = q.z + st.x * qb.z + st.y * qc.z;
    write_surface(mesh.colour, instance, n, (mesh.flags & MESH_SOLID) != 0u, depth, mesh.id, st);
}
