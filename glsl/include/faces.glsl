// Faces and where they are placed, put together from texels; members that nobody asks for are not fetched.
// Needs scene.glsl; whoever includes this has `usamplerBuffer face_instances`, three texels a placed face, and `faces`,
// 13 a face.
#ifndef FACES_GLSL
#define FACES_GLSL

FaceInstance face_instance_at(uint i) {
    int at = int(i) * 3;
    uvec2 a = texelFetch(face_instances, at).xy;
    uvec2 b = texelFetch(face_instances, at + 1).xy;
    uvec2 c = texelFetch(face_instances, at + 2).xy;
    return FaceInstance(a.x, a.y, b.x, b.y, c.x, c.y);
}

uint face_word(int at) { return texelFetch(faces, at).x; }

Face face_at(uint i) {
    int at = int(i) * 13;
    uvec4 domain = uvec4(face_word(at), face_word(at + 1), face_word(at + 2), face_word(at + 3));
    return Face(
        uintBitsToFloat(domain), face_word(at + 4), face_word(at + 5), face_word(at + 6), face_word(at + 7),
        face_word(at + 8), face_word(at + 9), face_word(at + 10), face_word(at + 11), face_word(at + 12)
    );
}

#endif
