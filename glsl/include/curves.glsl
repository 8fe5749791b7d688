// Trim curves of placed faces, put together from texels; members that nobody asks for are not fetched.
// Needs scene.glsl; whoever includes this has `usamplerBuffer curves`, five texels a curve.
#ifndef CURVES_GLSL
#define CURVES_GLSL

Curve curve_at(uint i) {
    int at = int(i) * 5;
    uvec2 start = texelFetch(curves, at).xy;
    uvec2 end = texelFetch(curves, at + 1).xy;
    uvec2 points = texelFetch(curves, at + 2).xy;
    uvec2 bend = texelFetch(curves, at + 3).xy;
    uvec2 range_v = texelFetch(curves, at + 4).xy;
    return Curve(
        uintBitsToFloat(start), uintBitsToFloat(end), points.x, points.y, uintBitsToFloat(bend), uintBitsToFloat(range_v)
    );
}

#endif
