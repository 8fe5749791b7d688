// Faces and placed faces, composed of texels; unused members are not fetched. Needs scene.glsl and
// `usamplerBuffer face_instances`, two texels a placed face, and `faces`, four a face.
#ifndef FACES_GLSL
#define FACES_GLSL

FaceInstance face_instance_at(uint i) {
    int at = int(i) * 2;
    uvec4 a = texelFetch(face_instances, at);
    uvec4 b = texelFetch(face_instances, at + 1);
    return FaceInstance(a.x, a.y, a.z, a.w, b.x, b.y, b.zw);
}

Face face_at(uint i) {
    int at = int(i) * 4;
    uvec4 a = texelFetch(faces, at + 1);
    uvec4 b = texelFetch(faces, at + 2);
    uvec4 c = texelFetch(faces, at + 3);
    return Face(uintBitsToFloat(texelFetch(faces, at)), a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.yzw);
}

#endif
