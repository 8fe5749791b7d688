// The guaranteed tessellation factor. Twin of src/twin/factor.rs, where it is derived.
#ifndef FACTOR_GLSL
#define FACTOR_GLSL

// Smallest product tau_u tau_v with bend.x / tau_u^2 + 2 bend.y / (tau_u tau_v) + bend.z / tau_v^2 <= budget.
vec2 factors(vec3 bend, float budget) {
    float a = bend.x / budget;
    float b = bend.y / budget;
    float c = bend.z / budget;
    if (a + 2.0 * b + c <= 1.0) return vec2(1.0);
    float r = sqrt(max(a, 1e-20) / max(c, 1e-20));
    float tv = sqrt(a / (r * r) + 2.0 * b / r + c);
    float tu = r * tv;
    if (tv < 1.0) {
        tv = 1.0;
        tu = (b + sqrt(b * b + a * (1.0 - c))) / (1.0 - c);
    } else if (tu < 1.0) {
        tu = 1.0;
        tv = (b + sqrt(b * b + c * (1.0 - a))) / (1.0 - a);
    }
    // a few ulp up, so that rounding never breaks the bound
    return ceil(vec2(tu, tv) * 1.00001);
}

#endif
