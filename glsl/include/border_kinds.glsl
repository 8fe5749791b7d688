// Which surfaces are sampled at the points of a border pixel. Needs visible.glsl.
#ifndef BORDER_KINDS_GLSL
#define BORDER_KINDS_GLSL

// Some operand of a Boolean solid has no equations: where rays cross those is known at the centres of pixels alone, so
// solids are as the centre has them.
layout(constant_id = 13) const bool SOLIDS_HAVE_BOUNDARY_OPERANDS = true;

bool is_sampled(uint word) {
    return !sees_nothing(word) && (!SOLIDS_HAVE_BOUNDARY_OPERANDS || !(sees_solid(word) || sees_operand(word)));
}

#endif
