// Mean and Gaussian curvature of the visible surface; the mean is above 0 where the surface bulges. Patches: bend.glsl;
// sides of Boolean solids: side_curvature.glsl. In scenes without styles of curvature none of it is compiled. Needs
// scene.glsl, `frame` and shade.glsl.
//
// Source: M. do Carmo, Differential Geometry of Curves and Surfaces, 1976, 3-3; R. Goldman, Curvature formulas for
// implicit curves and surfaces, 2005.
#ifndef CURVATURE_GLSL
#define CURVATURE_GLSL

layout(constant_id = 31) const bool SHOWS_CURVATURE = false;

// 1 / model units, and its square.
struct Curvature {
    float mean;
    float gaussian;
};

const Curvature NO_CURVATURE = Curvature(0.0, 0.0);

bool shows_curvature() { return SHOWS_CURVATURE && frame.style >= STYLE_MEAN_CURVATURE; }

// `v`: the normal in view space, towards the eye.
vec3 curvature_colour(Curvature c, vec3 v) {
    bool mean = frame.style == STYLE_MEAN_CURVATURE;
    float share = mean ? c.mean * frame.curvature : c.gaussian * frame.curvature * frame.curvature;
    return of_curvature(share, v);
}

#endif
