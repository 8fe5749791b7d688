// Which side of a face looks at the viewer. Needs scene.glsl.
#ifndef FACING_GLSL
#define FACING_GLSL

// From the change of (u, v) per pixel to the right and down: (u, v) runs against (right, down) where
// the normal S_u x S_v looks at the viewer.
bool looks_away(vec2 dx, vec2 dy, Face face, Instance instance) {
    bool towards = (dx.x * dy.y - dx.y * dy.x < 0.0) == ((face.flags & FACE_SAME_SENSE) != 0u);
    return towards == (instance.mirrored != 0u);
}

#endif
