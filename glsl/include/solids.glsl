// Boolean solids: leaves, their surfaces, and the part of a pixel's ray that is inside a leaf. Twin of
// src/abi/solids.rs, filled by src/scene/solids; crates/check/src/solids judges the pictures.
//
//   leaf ──▶ LeafSurface[count] ──▶ a surface's place, and its shape unless it is a plane: a leaf is the intersection
//                                  of its surfaces' insides; leaves with coinciding faces share the surface, so they
//                                  get the same depth, bit for bit
//
//     plane     n . p - w < 0                                                       inside; place (n, w)
//   and in a surface's own coordinates, p = to_local (x - centre), about the size of 1; place (centre, 0)
//     quadric   s.x p.x^2 + s.y p.y^2 + s.z p.z^2 + 2 linear p.z + constant < 0     inside
//     torus     |p|^2 + 1 - r^2 - 2 sqrt(p.x^2 + p.y^2) < 0                         inside, r = constant
//
//   Surfaces are texels: a driver fetches a texel at once, but may load a struct word by word. Surfaces with a shape
//   come first, four texels each; a place is one texel, and changes with the eye:
//     x of to_local, kind │ y of to_local, linear │ z of to_local, constant │ squares, 0
//
//        ───▶ ray     ├────────┤gap├───────┤      Span: inside from lo to hi, except in the gap;
//                     lo      g0   g1     hi      the gap is empty if g0 >= g1
#ifndef SOLIDS_GLSL
#define SOLIDS_GLSL

// The most general kind of surface in the scene; more general code is not compiled in.
const uint SURFACE_PLANE = 0u;
const uint SURFACE_QUADRIC = 1u;
const uint SURFACE_TORUS = 2u;
layout(constant_id = 5) const uint SOLIDS_HAVE = SURFACE_TORUS;

// The shape of a surface that is not a plane.
struct Surface {
    mat3 to_local;   // model directions to the surface's own coordinates (columns)
    bool is_torus;
    vec3 squares;
    float linear;
    float constant;
};

Surface surface_at(samplerBuffer surfaces, uint i) {
    int first = int(4u * i);
    vec4 x = texelFetch(surfaces, first);
    vec4 y = texelFetch(surfaces, first + 1);
    vec4 z = texelFetch(surfaces, first + 2);
    return Surface(mat3(x.xyz, y.xyz, z.xyz), x.w == float(SURFACE_TORUS), texelFetch(surfaces, first + 3).xyz, y.w, z.w);
}

// The place of a surface relative to the eye.
vec4 place_at(samplerBuffer places, uint i) { return texelFetch(places, int(i)); }

// A side of a leaf.
struct LeafSurface {
    uint surface;   // index << SIDE_SHIFT | SIDE_*
    uint leaf;
};
LeafSurface leaf_surface_at(usamplerBuffer sides, uint k) {
    uvec2 side = texelFetch(sides, int(k)).xy;
    return LeafSurface(side.x, side.y);
}

uint side_word(usamplerBuffer sides, uint k) { return texelFetch(sides, int(k)).x; }

const uint SIDE_SHIFT = 3u;
const uint SIDE_NEGATIVE = 1u; // the leaf is on the positive side of the surface's function
const uint SIDE_PLANE = 2u;    // the last sides of a leaf
const uint SIDE_MORE = 4u;     // the leaf's next side is of the same kind, plane or not

// One switch of the Blist: a primitive, placed.
struct Leaf {
    vec3 half_size;  // of its box, model axes; the centre moves with the eye
    uint first;      // of its LeafSurfaces
    uint count;
    uint colour;     // as Face.colour
    uint id;
    uint in_exit;    // the next leaf for a point inside, or EXIT_*
    uint out_exit;
    uint pre;        // the tree whose parent is the out-exit, in preorder: a leaf's descendants are
    uint end;        // [pre, end)
    uint flags;
    uint item;       // first leaf of its list: the union's, or a followed item's
};

const uint EXIT_FALSE = 0xfffffffeu; // outside the solid
const uint EXIT_TRUE = 0xffffffffu;
const uint LEAF_UNBOUNDED = 1u;      // no box: in every tile
const uint LEAF_NEGATIVE = 2u;       // under an odd number of complements: the solid is outside it
const uint LEAF_FALLS = 4u;          // its chain of out-exits ends at EXIT_FALSE, else at EXIT_TRUE
const uint LEAF_BOUNDARY = 8u;          // an operand without equations, number `first`: see boundary_operands.glsl

const uint LEAF_ELSEWHERE = 16u;     // belongs to an item that rays are followed through; drawn by another pass
const uint LEAF_PLANES = 32u;        // its last sides are planes
const uint LEAF_ROUNDS = 64u;        // its first sides are not planes
const uint LEAF_FLAG_BITS = 7u;
const uint LEAF_CAP = 128u; // the cut of a section; not in lists of tiles

// In place of a surface's number: the plane of one triangle alone, with the triangle's number.
const uint OWN_PLANE = 0x80000000u;

const float NEVER = 3.0e38;

struct Span {
    float lo;
    float hi;
    float g0;
    float g1;
};

const Span NOTHING = Span(NEVER, -NEVER, NEVER, NEVER);
const Span EVERYTHING = Span(-NEVER, NEVER, NEVER, NEVER);

// Whether the ray is inside just behind depth t.
bool inside_span(Span s, float t) {
    return s.lo <= t && t < s.hi && !(s.g0 <= t && t < s.g1);
}

// Whether the ray is inside just in front of depth t.
bool inside_before(Span s, float t) {
    return s.lo < t && t <= s.hi && !(s.g0 < t && t <= s.g1);
}

// Whether the span begins or ends at t; an empty span does not.
bool ends_at(Span s, float t) { return s.lo < s.hi && (s.lo == t || s.hi == t || s.g0 == t || s.g1 == t); }

// The first depth behind t where the span begins or ends.
float next_of_span(Span s, float t) {
    float next = NEVER;
    if (!(s.lo < s.hi)) return next;
    if (s.g0 < s.g1) {
        if (s.g1 > t) next = s.g1;
        if (s.g0 > t) next = s.g0;
    }
    if (s.hi > t) next = min(next, s.hi);
    if (s.lo > t) next = min(next, s.lo);
    return next;
}

// The intersection of both. At most one of the two gaps lies between the ends: leaves are built that way.
Span both(Span a, Span b) {
    Span s = Span(max(a.lo, b.lo), min(a.hi, b.hi), a.g0, a.g1);
    if (b.g0 < b.g1) {
        bool cuts_a = b.g1 > s.lo && b.g0 < s.hi;
        if (cuts_a) {
            s.g0 = b.g0;
            s.g1 = b.g1;
        }
    }
    if (s.g0 < s.g1) {
        if (s.g0 <= s.lo && s.g1 > s.lo) s.lo = s.g1;
        if (s.g1 >= s.hi && s.g0 < s.hi) s.hi = s.g0;
        if (s.g0 <= s.lo || s.g1 >= s.hi) {
            s.g0 = NEVER;
            s.g1 = NEVER;
        }
    }
    return s;
}

Span complement(Span s) {
    // only for spans with one open side, and for spans that become a gap
    if (!(s.lo < s.hi)) return EVERYTHING;
    if (s.lo <= -NEVER && s.hi >= NEVER) return s.g0 < s.g1 ? Span(s.g0, s.g1, NEVER, NEVER) : NOTHING;
    if (s.lo <= -NEVER) return Span(s.hi, NEVER, NEVER, NEVER);
    if (s.hi >= NEVER) return Span(-NEVER, s.lo, NEVER, NEVER);
    return Span(-NEVER, NEVER, s.lo, s.hi);
}

// The solution of a t^2 + 2 b t + c < 0; t counts from `shift`.
Span below_zero(float a, float b, float c, float shift) {
    if (a == 0.0) {
        if (b == 0.0) return c < 0.0 ? EVERYTHING : NOTHING;
        precise float t = shift - c / (2.0 * b);
        return b > 0.0 ? Span(-NEVER, t, NEVER, NEVER) : Span(t, NEVER, NEVER, NEVER);
    }
    precise float d = b * b - a * c;
    if (!(d > 0.0)) return a > 0.0 ? NOTHING : EVERYTHING;
    precise float q = b < 0.0 ? sqrt(d) - b : -(b + sqrt(d));
    precise float t0 = shift + q / a;
    precise float t1 = shift + (q == 0.0 ? 0.0 : c / q);
    float lo = min(t0, t1);
    float hi = max(t0, t1);
    return a > 0.0 ? Span(lo, hi, NEVER, NEVER) : Span(-NEVER, NEVER, lo, hi);
}

// The quartic of a torus along a ray, from the point nearest to its centre: depressed,
// t^4 + p t^2 + q t + s, evaluated as a difference of squares.
struct Torus {
    vec3 o;
    vec3 d;   // unit
    float e;  // |o|^2 + 1 - r^2
    float p;
    float q;
};

float torus_value(Torus f, float t) {
    float w = t * t + f.e;
    float rho = length(f.o.xy + t * f.d.xy);
    return (w - 2.0 * rho) * (w + 2.0 * rho);
}

float torus_slope(Torus f, float t) { return (4.0 * t * t + 2.0 * f.p) * t + f.q; }

// Newton's method doubles the correct digits. Near a double root it gains one bit a step, like bisection.
const uint MOST_STEPS = 30u;
// A smaller step, relative to the torus, is rounding.
const float SETTLED = 6e-8;

// A root of the slope, starting on the side on which the slope bends away from 0, so that no step overshoots.
float torus_turn(Torus f, float t) {
    for (uint i = 0u; i < MOST_STEPS; ++i) {
        float bend = 12.0 * t * t + 2.0 * f.p;
        float step_ = bend == 0.0 ? 0.0 : torus_slope(f, t) / bend;
        t -= step_;
        if (abs(step_) <= SETTLED) break;
    }
    return t;
}

// The root of the value between lo and hi, where it is monotone and changes its sign: Newton's method, with bisection
// if a step leaves the interval.
float torus_root(Torus f, float lo, float hi) {
    bool rising = torus_value(f, lo) < 0.0;
    float t = 0.5 * (lo + hi);
    for (uint i = 0u; i < MOST_STEPS; ++i) {
        float value = torus_value(f, t);
        if ((value < 0.0) == rising) lo = t;
        else hi = t;
        float next = t - value / torus_slope(f, t);
        if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
        bool settled = abs(next - t) <= SETTLED;
        t = next;
        if (settled) break;
    }
    return t;
}

// `o` and `d` are in the torus's own coordinates.
Span torus_span(vec3 o, vec3 d, float r) {
    float speed = length(d);
    Torus f;
    f.d = d / speed;
    float shift = -dot(o, f.d);
    f.o = o + shift * f.d;
    float k = dot(f.o, f.o);
    float around = (1.0 + r) * (1.0 + r);
    if (!(around > k)) return NOTHING;
    // A sphere of more than the torus's own size: at its own, a ray that meets the outer equator has a root where the
    // search begins, and rounding decides whether the value changes its sign there.
    float reach = sqrt(1.25 * around - k);
    f.e = k + (1.0 - r) * (1.0 + r);
    f.p = 2.0 * f.e - 4.0 * dot(f.d.xy, f.d.xy);
    f.q = -8.0 * dot(f.o.xy, f.d.xy);
    // the value is monotone between the roots of its slope, and the slope between the roots of its own slope
    float w = f.p < 0.0 ? min(sqrt(f.p / -6.0), reach) : 0.0;
    float stops[6];
    stops[0] = -reach;
    uint stop_count = 1u;
    float from = -reach;
    for (uint i = 0u; i < 3u; ++i) {
        float to = i == 0u ? -w : i == 1u ? w : reach;
        if (from < to && (torus_slope(f, from) < 0.0) != (torus_slope(f, to) < 0.0)) {
            stops[stop_count] = clamp(torus_turn(f, i == 0u ? from : i == 1u ? 0.0 : to), from, to);
            ++stop_count;
        }
        from = to;
    }
    stops[stop_count] = reach;
    float roots[4];
    uint count = 0u;
    for (uint i = 0u; i < 4u; ++i) {
        if (i >= stop_count) break;
        if ((torus_value(f, stops[i]) < 0.0) == (torus_value(f, stops[i + 1u]) < 0.0)) continue;
        float t = torus_root(f, stops[i], stops[i + 1u]);
        // a spindle torus: the value is positive in the lemon, too, where the solid is not hollow
        if (t * t + f.e < 0.0) continue;
        precise float root = (t + shift) / speed;
        roots[count] = root;
        ++count;
    }
    if (count == 4u) return Span(roots[0], roots[3], roots[1], roots[2]);
    if (count >= 2u) return Span(roots[0], roots[count - 1u], NEVER, NEVER);
    return NOTHING;
}

// The part of the ray o + t d inside the surface; o is the ray's origin relative to the surface's centre.
Span surface_span(Surface s, vec3 o, vec3 d) {
    precise vec3 ol = s.to_local * o;
    precise vec3 dl = s.to_local * d;
    if (SOLIDS_HAVE == SURFACE_TORUS && s.is_torus) return torus_span(ol, dl, s.constant);
    // start at the point nearest to the middle, to avoid cancellation
    vec3 size = abs(s.squares);
    float dd = dot(size * dl, dl);
    precise float shift = dd > 0.0 ? -dot(size * dl, ol) / dd : 0.0;
    ol += shift * dl;
    precise float a = dot(s.squares * dl, dl);
    precise float b = dot(s.squares * dl, ol) + s.linear * dl.z;
    precise float c = dot(s.squares * ol, ol) + 2.0 * s.linear * ol.z + s.constant;
    return below_zero(a, b, c, shift);
}

// The ray's distance from the plane at its origin, along the normal, and its speed along the normal.
vec2 over_plane(vec4 plane, vec3 o, vec3 d) {
    precise float height = dot(plane.xyz, o) - plane.w;
    precise float speed = dot(plane.xyz, d);
    return vec2(height, speed);
}

// The depth at which the ray meets the plane.
float plane_depth(vec4 plane, vec3 o, vec3 d) {
    vec2 ray = over_plane(plane, o, d);
    precise float t = -ray.x / ray.y;
    return t;
}

// The part of the ray o + t d, relative to the eye, on the leaf's side of a plane. A ray within the plane is outside
// the half-space below it.
Span plane_span(vec4 plane, bool negative, vec3 o, vec3 d) {
    vec2 ray = over_plane(plane, o, d);
    if (ray.y == 0.0) return (ray.x < 0.0) != negative ? EVERYTHING : NOTHING;
    float t = plane_depth(plane, o, d);
    return (ray.y > 0.0) != negative ? Span(-NEVER, t, NEVER, NEVER) : Span(t, NEVER, NEVER, NEVER);
}

// The part of the ray inside a leaf's side.
Span side_span(samplerBuffer surfaces, samplerBuffer places, uint side, vec3 o, vec3 d) {
    uint i = side >> SIDE_SHIFT;
    bool negative = (side & SIDE_NEGATIVE) != 0u;
    vec4 place = place_at(places, i);
    if ((side & SIDE_PLANE) != 0u || SOLIDS_HAVE == SURFACE_PLANE) return plane_span(place, negative, o, d);
    Span s = surface_span(surface_at(surfaces, i), o - place.xyz, d);
    return negative ? complement(s) : s;
}

// The surface's function at p, given relative to its centre.
float surface_value(Surface s, vec3 p) {
    vec3 q = s.to_local * p;
    if (SOLIDS_HAVE == SURFACE_TORUS && s.is_torus) {
        return dot(q, q) + (1.0 - s.constant) * (1.0 + s.constant) - 2.0 * length(q.xy);
    }
    return dot(s.squares * q, q) + 2.0 * s.linear * q.z + s.constant;
}

// The gradient of the surface's function; model directions, not of unit length.
vec3 surface_gradient(Surface s, vec3 p) {
    vec3 q = s.to_local * p;
    vec3 g;
    if (SOLIDS_HAVE == SURFACE_TORUS && s.is_torus) {
        float rho = max(length(q.xy), 1e-20);
        g = vec3(q.xy * (1.0 - 1.0 / rho), q.z);
    } else {
        g = s.squares * q + vec3(0.0, 0.0, s.linear);
    }
    return g * s.to_local; // the transposed map takes gradients to model directions
}

#endif
