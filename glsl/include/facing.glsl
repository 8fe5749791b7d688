// The side of a face that faces the viewer. Needs scene.glsl.
#ifndef FACING_GLSL
#define FACING_GLSL

// From the sign of the Jacobian between (u, v) and the screen's (right, down): negative if the normal S_u x S_v points
// to the viewer.
bool looks_away(float jacobian, Face face, Instance instance) {
    bool towards = (jacobian < 0.0) == ((face.flags & FACE_SAME_SENSE) != 0u);
    return towards == (instance.mirrored != 0u);
}

// The same from the change of (u, v) per pixel to the right and down.
bool looks_away(vec2 dx, vec2 dy, Face face, Instance instance) {
    return looks_away(dx.x * dy.y - dx.y * dy.x, face, instance);
}

#endif
