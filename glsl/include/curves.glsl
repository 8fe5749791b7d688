// Trim curves of placed faces, composed of texels; unused members are not fetched. Needs scene.glsl and
// `usamplerBuffer curves`, three texels a curve.
#ifndef CURVES_GLSL
#define CURVES_GLSL

Curve curve_at(uint i) {
    int at = int(i) * 3;
    vec4 ends = uintBitsToFloat(texelFetch(curves, at));
    uvec4 points = texelFetch(curves, at + 1); // and bend
    vec4 ranges = uintBitsToFloat(texelFetch(curves, at + 2));
    return Curve(ends.xy, ends.zw, points.x, points.y, uintBitsToFloat(points.zw), ranges.xy, ranges.zw);
}

#endif
