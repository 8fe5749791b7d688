// A neutral studio: a key light from the upper left behind the viewer, a fill from the right, a rim from behind on the
// right, which lights only surfaces turned away from the viewer, a sky above a darker ground. Directions are unit vectors
// in view space and travel with the camera.
// Twin: `studio` of the judge.
#ifndef SHADE_GLSL
#define SHADE_GLSL

const vec3 KEY = vec3(-0.42, 0.57, 0.71);
const vec3 FILL = vec3(0.71, 0.14, 0.69);
const vec3 RIM = vec3(0.64, 0.48, -0.60);
const float KEY_STRENGTH = 0.62;
const float FILL_STRENGTH = 0.22;
const float RIM_STRENGTH = 0.30;
const float SKY_STRENGTH = 0.26;
const float GROUND_STRENGTH = 0.12;
const float GLOSS = 0.10;      // strength of the highlight
const float SHININESS = 48.0;

// Light up to this value is shown unchanged; above, it approaches 1.
const float SHOULDER = 0.76;

// Colour of clay, linear.
const vec3 CLAY = vec3(0.58, 0.52, 0.46);
// Pairs of stripes, from pole to pole, of the room that a zebra reflects.
const float ZEBRA_STRIPES = 12.0;
// Pairs of bands from the normal towards the key light to the one away from it: five degrees a band.
const float ISOPHOTE_BANDS = 18.0;
// Ends and middle of the scale of curvature, sRGB: hollow, flat, bulging.
const vec3 HOLLOW = vec3(0.129, 0.400, 0.675);
const vec3 FLAT = vec3(0.941);
const vec3 BULGING = vec3(0.698, 0.094, 0.169);

// Depth of the background, in images of linear colour and depth.
const float UNSEEN = 3.0e38;

vec3 in_view(Frame frame, vec3 v) { return vec3(dot(frame.right, v), dot(frame.up, v), -dot(frame.forward, v)); }

// A neutral tone curve: it keeps hues and clips no light.
vec3 toned(vec3 light) {
    float peak = max(light.r, max(light.g, light.b));
    if (peak <= SHOULDER) return light;
    float rest = 1.0 - SHOULDER;
    return light * ((1.0 - rest * rest / (peak - SHOULDER + rest)) / peak);
}

// The light of a surface with normal `v` in view space, for the key light's cosines; the other lights are constant.
vec3 studio(vec3 colour, vec3 v, float key, float shine) {
    float fill = FILL_STRENGTH * max(dot(v, FILL), 0.0) + RIM_STRENGTH * max(dot(v, RIM), 0.0);
    float sky = mix(GROUND_STRENGTH, SKY_STRENGTH, 0.5 + 0.5 * v.y);
    float highlight = pow(shine, SHININESS) * GLOSS;
    return toned(colour * (KEY_STRENGTH * key + fill + sky) + highlight);
}

// Linear light for sRGB colours.
vec3 decoded(vec3 c) {
    return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

// Light that shades sides slightly and keeps colours.
vec3 paper(vec3 colour, vec3 v) { return colour * mix(0.7, 1.0, max(v.z, 0.0)); }

// The colour of a curvature: `share` of the largest on the scale, above 0 where the surface bulges towards the eye.
vec3 of_curvature(float share, vec3 v) {
    float size = min(abs(share), 1.0);
    return paper(decoded(mix(FLAT, share < 0.0 ? HOLLOW : BULGING, size)), v);
}

// Styles that show the surface instead of its light; `v` is the normal of the visible side. Styles of curvature show grey
// if it is unknown: on triangles, and behind transparent surfaces.
vec3 styled(uint style, vec3 v, vec3 ray) {
    if (style == STYLE_NORMALS) return decoded(0.5 + 0.5 * v);
    if (style == STYLE_CLAY) return studio(CLAY, v, max(dot(v, KEY), 0.0), 0.0);
    if (style == STYLE_TECHNICAL) return paper(vec3(1.0), v);
    if (style >= STYLE_MEAN_CURVATURE) return paper(vec3(0.3), v);
    if (style == STYLE_ISOPHOTES) {
        float angle = acos(clamp(dot(v, normalize(KEY)), -1.0, 1.0));
        return paper(vec3(fract(ISOPHOTE_BANDS * angle / 3.14159265) < 0.5 ? 0.9 : 0.02), v);
    }
    // the room's stripes run around the vertical: the height of the reflected ray decides the stripe
    float height = clamp(reflect(ray, v).y, -1.0, 1.0);
    float stripe = fract(ZEBRA_STRIPES * acos(height) / 3.14159265);
    float light = 0.35 + 0.65 * max(v.z, 0.0);
    return vec3(stripe < 0.5 ? 0.9 * light : 0.02);
}

// `ray` runs from the eye to the point. For a surface without an inside it decides the visible side, since in a
// perspective view the view axis does not.
vec3 shade(vec3 colour, vec3 n, Frame frame, bool two_sided, vec3 ray) {
    if (two_sided && dot(n, ray) > 0.0) n = -n;
    vec3 v = in_view(frame, n);
    if (frame.style != STYLE_SHADED) return styled(frame.style, v, normalize(in_view(frame, ray)));
    float shine = max(dot(v, normalize(KEY + vec3(0.0, 0.0, 1.0))), 0.0);
    return studio(colour, v, max(dot(v, KEY), 0.0), shine);
}

// The same with a sun as the key light, fixed in the model: `towards` it, a unit vector in model space. `n` is the
// normal of the visible side.
vec3 shade_in_sun(vec3 colour, vec3 n, Frame frame, vec3 towards, bool reached, vec3 ray) {
    vec3 v = in_view(frame, n);
    if (frame.style != STYLE_SHADED) return styled(frame.style, v, normalize(in_view(frame, ray)));
    if (!reached) return studio(colour, v, 0.0, 0.0);
    vec3 half_way = in_view(frame, towards) + vec3(0.0, 0.0, 1.0);
    float size = length(half_way);
    float shine = size > 0.0 ? max(dot(v, half_way / size), 0.0) : 0.0;
    return studio(colour, v, max(dot(n, towards), 0.0), shine);
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
