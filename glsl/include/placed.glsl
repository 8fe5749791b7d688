// Placed patches, for passes that read one in every pixel: the buffers of scene.glsl as texels, which a driver fetches
// at once, where it gathers words of storage buffers one by one. Structs are composed of the members in use. Needs
// scene.glsl and view.glsl; for `instance_at` the includer defines INSTANCES_BINDING.
#ifndef PLACED_GLSL
#define PLACED_GLSL

#define PATCHES_BINDING 4
#include "patches.glsl"
#include "words.glsl"

layout(binding = 1) uniform samplerBuffer views;           // four a placed part
layout(binding = 2) uniform usamplerBuffer face_instances; // two a placed face
layout(binding = 3) uniform usamplerBuffer faces;          // four a face
layout(binding = 5) uniform usamplerBuffer patch_instances;          // a word a placed patch
layout(binding = 6) uniform samplerBuffer points;          // one a control point

View view_at(uint i) {
    int at = int(i) * 4;
    return View(texelFetch(views, at), texelFetch(views, at + 1), texelFetch(views, at + 2), texelFetch(views, at + 3));
}

#include "faces.glsl"

uint face_instance_of(uint patch_instance) { return word_at(patch_instances, patch_instance); }

#ifdef INSTANCES_BINDING
layout(binding = INSTANCES_BINDING) uniform usamplerBuffer instances; // four a placed part

Instance instance_at(uint i) {
    int at = int(i) * 4;
    vec4 a = uintBitsToFloat(texelFetch(instances, at));
    vec4 b = uintBitsToFloat(texelFetch(instances, at + 1));
    uvec4 c = texelFetch(instances, at + 2);
    uvec4 d = texelFetch(instances, at + 3);
    mat3 normal = mat3(a.xyz, vec3(a.w, b.xy), vec3(b.zw, uintBitsToFloat(c.x)));
    return Instance(normal, uintBitsToFloat(c.y), c.z, c.w, d.x, d.yzw);
}
#endif

#endif
