// A neutral studio: a key light from the upper left behind the viewer, a weaker fill from the
// right, a sky above a darker floor. Directions are in view space and travel with the camera.
#ifndef SHADE_GLSL
#define SHADE_GLSL

const vec3 KEY = vec3(-0.42, 0.57, 0.71);
const vec3 FILL = vec3(0.71, 0.14, 0.69);
const float KEY_STRENGTH = 0.62;
const float FILL_STRENGTH = 0.22;
const float SKY_STRENGTH = 0.26;
const float FLOOR_STRENGTH = 0.12;
const float GLOSS = 0.10;      // strength of the highlight
const float SHININESS = 48.0;

// `ray` runs from the eye to the point: in a perspective view it, not the view's axis, tells which side of a
// surface without an inside is seen.
vec3 shade(vec3 colour, vec3 n, Frame frame, bool two_sided, vec3 ray) {
    if (two_sided && dot(n, ray) > 0.0) n = -n;
    vec3 v = vec3(dot(frame.right, n), dot(frame.up, n), -dot(frame.forward, n));
    float key = max(dot(v, KEY), 0.0);
    float fill = max(dot(v, FILL), 0.0);
    float sky = mix(FLOOR_STRENGTH, SKY_STRENGTH, 0.5 + 0.5 * v.y);
    float highlight = pow(max(dot(v, normalize(KEY + vec3(0.0, 0.0, 1.0))), 0.0), SHININESS) * GLOSS;
    return colour * (KEY_STRENGTH * key + FILL_STRENGTH * fill + sky) + highlight;
}

vec4 encode(vec4 linear, uint srgb) {
    if (srgb == 0u) return linear;
    vec3 c = clamp(linear.rgb, 0.0, 1.0);
    if (srgb == ENCODE_SUMMED) return vec4(c, linear.a);
    vec3 low = c * 12.92;
    vec3 high = 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055;
    return vec4(mix(high, low, lessThanEqual(c, vec3(0.0031308))), linear.a);
}

#endif
