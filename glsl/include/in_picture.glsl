// Whether a pixel is in the picture. Needs `frame`.
#ifndef IN_PICTURE_GLSL
#define IN_PICTURE_GLSL

bool is_in_picture(ivec2 at) {
    return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(frame.size)));
}

#endif
