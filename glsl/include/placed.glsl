// Patches as they are placed, for the passes that ask for one in every pixel: the buffers of scene.glsl as texels, which
// a driver fetches at once where it gathers words of storage buffers one by one. Structs are put together from those
// members that are asked for. Needs scene.glsl and view.glsl; whoever needs `instance_at` defines INSTANCES_BINDING.
#ifndef PLACED_GLSL
#define PLACED_GLSL

#include "words.glsl"

layout(binding = 1) uniform samplerBuffer views;           // four a placed part
layout(binding = 2) uniform usamplerBuffer face_instances; // three a placed face
layout(binding = 3) uniform usamplerBuffer faces;          // 13 words a face
layout(binding = 4) uniform usamplerBuffer patches;        // four a patch
layout(binding = 5) uniform usamplerBuffer items;          // a word a placed patch
layout(binding = 6) uniform samplerBuffer points;          // one a control point

View view_at(uint i) {
    int at = int(i) * 4;
    return View(texelFetch(views, at), texelFetch(views, at + 1), texelFetch(views, at + 2), texelFetch(views, at + 3));
}

#include "faces.glsl"

uint face_instance_of(uint item) { return word_at(items, item); }

Patch patch_at(uint i) {
    int at = int(i) * 4;
    uvec4 low = texelFetch(patches, at);
    uvec4 high = texelFetch(patches, at + 1);
    uvec4 domain = texelFetch(patches, at + 2);
    uvec4 bend = texelFetch(patches, at + 3);
    return Patch(
        uintBitsToFloat(low.xyz), low.w, uintBitsToFloat(high.xyz), high.w,
        uintBitsToFloat(domain), uintBitsToFloat(bend.xyz), bend.w
    );
}

#ifdef INSTANCES_BINDING
layout(binding = INSTANCES_BINDING) uniform usamplerBuffer instances; // 13 words a placed part

uint instance_word(uint at) { return word_at(instances, at); }

vec3 instance_column(uint at) {
    return uintBitsToFloat(uvec3(instance_word(at), instance_word(at + 1u), instance_word(at + 2u)));
}

Instance instance_at(uint i) {
    uint at = i * 13u;
    mat3 normal = mat3(instance_column(at), instance_column(at + 3u), instance_column(at + 6u));
    return Instance(
        normal, uintBitsToFloat(instance_word(at + 9u)), instance_word(at + 10u), instance_word(at + 11u), instance_word(at + 12u)
    );
}
#endif

#endif
