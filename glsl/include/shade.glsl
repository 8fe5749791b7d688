// A neutral studio: a key light from the left, a fill from above the viewer, a rim from behind on the right, which lights
// only surfaces turned away from the viewer, a sky above a darker ground. Directions are unit vectors in view space and
// travel with the camera. A lamp's light falls with the square of the cosine: a surface that turns away has no corner
// where a lamp's light ends.
// Twin: `studio` of the judge.
#ifndef SHADE_GLSL
#define SHADE_GLSL

const vec3 KEY = vec3(-0.65, 0.46, 0.60);
const vec3 FILL = vec3(0.21, 0.33, 0.92);
const vec3 RIM = vec3(0.50, 0.50, -0.70);
const float KEY_STRENGTH = 0.86;
const float FILL_STRENGTH = 0.34;
const float RIM_STRENGTH = 0.25;
const float SUN_STRENGTH = 0.62;      // of a sun in place of the key light, by the cosine
const float SUN_FILL_STRENGTH = 0.20; // of the fill beside a sun, so that shadows are dark
const float SKY_STRENGTH = 0.20;
const float GROUND_STRENGTH = 0.12;
// What a black surface reflects: shape is seen on black parts, too.
const float BLACK = 0.03;
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

// Light of a lamp in direction `towards`, in view space.
float lamp(vec3 v, vec3 towards, float strength) {
    float cosine = max(dot(v, towards), 0.0);
    return strength * cosine * cosine;
}

// The light of a surface with normal `v` in view space: `key` is the key light's, `shine` the cosine of its highlight,
// `fill_strength` the fill's.
vec3 studio(vec3 colour, vec3 v, float key, float shine, float fill_strength) {
    float peak = max(colour.r, max(colour.g, colour.b));
    vec3 reflected = colour + max(BLACK - peak, 0.0);
    float fill = lamp(v, FILL, fill_strength) + lamp(v, RIM, RIM_STRENGTH);
    float sky = mix(GROUND_STRENGTH, SKY_STRENGTH, 0.5 + 0.5 * v.y);
    float highlight = pow(shine, SHININESS) * GLOSS;
    return toned(reflected * (key + fill + sky) + highlight);
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
    if (style == STYLE_CLAY) return studio(CLAY, v, lamp(v, KEY, KEY_STRENGTH), 0.0, FILL_STRENGTH);
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
    return studio(colour, v, lamp(v, KEY, KEY_STRENGTH), shine, FILL_STRENGTH);
}

// The same with a sun as the key light, fixed in the model: `towards` it, a unit vector in model space. `n` is the
// normal of the visible side.
vec3 shade_in_sun(vec3 colour, vec3 n, Frame frame, vec3 towards, bool reached, vec3 ray) {
    vec3 v = in_view(frame, n);
    if (frame.style != STYLE_SHADED) return styled(frame.style, v, normalize(in_view(frame, ray)));
    if (!reached) return studio(colour, v, 0.0, 0.0, SUN_FILL_STRENGTH);
    vec3 half_way = in_view(frame, towards) + vec3(0.0, 0.0, 1.0);
    float size = length(half_way);
    float shine = size > 0.0 ? max(dot(v, half_way / size), 0.0) : 0.0;
    return studio(colour, v, SUN_STRENGTH * max(dot(n, towards), 0.0), shine, SUN_FILL_STRENGTH);
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
