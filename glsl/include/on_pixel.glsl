#ifndef ON_PIXEL_GLSL
#define ON_PIXEL_GLSL

// A surface passes a point of the picture if its nearest point projects within this distance.
const float ON_PIXEL_PX = 0.05;

#endif
