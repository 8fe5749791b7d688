// The point of a shared side. Every patch evaluates it from the control points of its piece's owner, at the same
// parameter, and gets the same bits. Needs placed.glsl and patch.glsl; the includer defines LINK_BINDING.
#ifndef LINK_GLSL
#define LINK_GLSL

layout(scalar, binding = LINK_BINDING) readonly buffer Links { Link links[]; };

// Exact at both ends, where it is the control point.
vec3 side_point(uint side, float x) {
    Patch owner = patch_at(side >> 2);
    int n = int(degree_u(owner.shape));
    int k = int(degree_v(owner.shape));
    bool along_v = (side & 1u) == 0u;
    int step = along_v ? n + 1 : 1;
    int at = int(owner.first) + ((side & 2u) == 0u ? 0 : along_v ? n : k * (n + 1));
    int degree = along_v ? k : n;
    float s = 1.0 - x;
    float f = 1.0;
    float c = 1.0;
    vec4 a = texelFetch(points, at) * s;
    for (int i = 1; i < degree; ++i) {
        f *= x;
        c *= float(degree - i + 1) / float(i);
        a = (a + texelFetch(points, at + i * step) * (f * c)) * s;
    }
    a += texelFetch(points, at + degree * step) * (f * x);
    return SCENE_HAS_RATIONAL && is_rational(owner.shape) ? a.xyz * (1.0 / a.w) : a.xyz;
}

// The point of a patch's side at `x` along it; `own` if the side is not shared.
vec3 linked_point(uint patch_, uint side, float x, vec3 own) {
    uint at = 4u * patch_ + side;
    Link link = links[at];
    if (!link_shared(link)) return own;
    // parameter of the whole curve; exact, because the numbers of segments of linked sides are powers of two
    float t = (float(link_start(link)) + (link_reversed(link) ? 1.0 - x : x)) / float(1u << link_halvings(link));
    for (uint k = 0u; k < LINK_MOST_SIDES; ++k) {
        if (link_owner(link)) {
            float y = t * float(1u << link_halvings(link)) - float(link_start(link));
            if (y >= 0.0 && y <= 1.0) return side_point(at, link_reversed(link) ? 1.0 - y : y);
        }
        at = link.next;
        link = links[at];
    }
    return own;
}

#endif
