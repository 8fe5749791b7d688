// Patches as texels: a large scene has more bytes of them than some devices bind as a storage buffer. Needs scene.glsl;
// the includer defines PATCHES_BINDING.
#ifndef PATCHES_GLSL
#define PATCHES_GLSL

layout(binding = PATCHES_BINDING) uniform usamplerBuffer patches; // four a patch

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

#endif
