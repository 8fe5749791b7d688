// Which of the chords listed before and after a chord go on along its edge: bits from line_list.vert to line_list.frag.
#ifndef JOINTS_GLSL
#define JOINTS_GLSL

const uint JOINS_BEFORE = 1u;
const uint JOINS_AFTER = 2u;

#endif
