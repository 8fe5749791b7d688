#ifndef ON_PIXEL_GLSL
#define ON_PIXEL_GLSL

// A surface passes a point of the picture when its nearest point projects this close to it.
const float ON_PIXEL_PX = 0.05;

#endif
