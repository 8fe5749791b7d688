// Lists of words, fetched four at a time: `Texel::Words` and `Texel::Numbers`. A software rasteriser gathers a fetch of
// one word lane by lane, which is slower than one fetch of four.
#ifndef WORDS_GLSL
#define WORDS_GLSL

uint word_at(usamplerBuffer list, uint i) { return texelFetch(list, int(i >> 2u))[i & 3u]; }

float number_at(samplerBuffer list, uint i) { return texelFetch(list, int(i >> 2u))[i & 3u]; }

// Three numbers, from `i` on.
vec3 numbers_at(samplerBuffer list, uint i) {
    vec4 low = texelFetch(list, int(i >> 2u));
    vec4 high = texelFetch(list, int((i + 2u) >> 2u)); // contains the third
    uint k = i & 3u;
    return k < 2u ? (k == 0u ? low.xyz : low.yzw) : (k == 2u ? vec3(low.zw, high.x) : vec3(low.w, high.xy));
}

#endif
