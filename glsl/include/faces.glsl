// Faces and where they are placed, put together from texels; members that nobody asks for are not fetched.
// Needs scene.glsl; whoever includes this has `usamplerBuffer face_instances`, three texels a placed face, and `faces`,
// 13 words a face.
#ifndef FACES_GLSL
#define FACES_GLSL

#include "words.glsl"

FaceInstance face_instance_at(uint i) {
    int at = int(i) * 3;
    uvec2 a = texelFetch(face_instances, at).xy;
    uvec2 b = texelFetch(face_instances, at + 1).xy;
    uvec2 c = texelFetch(face_instances, at + 2).xy;
    return FaceInstance(a.x, a.y, b.x, b.y, c.x, c.y);
}

uint face_word(uint at) { return word_at(faces, at); }

Face face_at(uint i) {
    uint at = i * 13u;
    uvec4 domain = uvec4(face_word(at), face_word(at + 1u), face_word(at + 2u), face_word(at + 3u));
    return Face(
        uintBitsToFloat(domain), face_word(at + 4u), face_word(at + 5u), face_word(at + 6u), face_word(at + 7u),
        face_word(at + 8u), face_word(at + 9u), face_word(at + 10u), face_word(at + 11u), face_word(at + 12u)
    );
}

#endif
