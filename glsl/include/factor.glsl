// The guaranteed tessellation factor. Twin of src/twin/factor.rs, where it is derived.
#ifndef FACTOR_GLSL
#define FACTOR_GLSL

const float SPARE = 0.125; // share of additional quads that less slender ones may cost
const float UP = 1.00001;  // a few ulp up, so that rounding never breaks the bound

// Whether one segment along each parameter keeps the bound.
bool is_undivided(vec3 bend, float budget) {
    float a = bend.x / budget;
    float b = bend.y / budget;
    float c = bend.z / budget;
    precise float undivided = (a + 2.0 * b + c) * UP;
    return undivided <= 1.0;
}

// A pair tau_u, tau_v of small product with bend.x / tau_u^2 + 2 bend.y / (tau_u tau_v) + bend.z / tau_v^2 <= budget.
vec2 factors(vec3 bend, float budget) {
    float a = bend.x / budget;
    float b = bend.y / budget;
    float c = bend.z / budget;
    if (is_undivided(bend, budget)) return vec2(1.0);
    float al = max(a, 1e-20);
    float cl = max(c, 1e-20);
    // the ratio tau_u / tau_v nearest to 1 with a / r + c r <= q
    precise float q = 2.0 * ((1.0 + SPARE) * sqrt(al * cl) + SPARE * b);
    precise float most = q + sqrt(max(q * q - 4.0 * al * cl, 0.0));
    float r = clamp(1.0, 2.0 * al / most, most / (2.0 * cl));
    precise float tv = sqrt(a / (r * r) + 2.0 * b / r + c);
    precise float tu = r * tv;
    if (tv < 1.0) {
        tu = (b + sqrt(b * b + a * (1.0 - c))) / (1.0 - c);
        return vec2(ceil(tu * UP), 1.0);
    }
    if (tu < 1.0) {
        tv = (b + sqrt(b * b + c * (1.0 - a))) / (1.0 - a);
        return vec2(1.0, ceil(tv * UP));
    }
    return ceil(vec2(tu, tv) * UP);
}

#endif
