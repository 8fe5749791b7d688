// Whether the sun reaches a point, past the opaque Boolean solids and past placed parts. Twin of src/abi/sun.rs; whoever
// includes this defines SUN_BINDING, where SUN_BINDINGS of src/bindings.rs begin.
//
//        sun ◀──┤████├────┤██├───── p        the ray to the sun, from event to event as pass `solid_events` has it: in
//               │    │    │  │              shade where it is within the solid anywhere before p
//        ───────┴────┴────┴──┴─▶ tiles      seen from the sun, each with the leaves that it sees and their Blist
//
// The tiles depend on scene and sun only, and are made with the scene (src/scene/sun.rs). Points beside them are those
// of the nearest tile: what is missing in its list does not reach beyond it.
//
// A point of a solid lies on a surface that is known, so the ray's first crossing of it is at 0 by rule, whatever the
// rounding of the point. Of other surfaces the point is known within its rounding only: material between it and a
// height above its face that is less casts no shadow on it.
//
// Triangles of spline faces are near to the faces, which they are told with: a face's point may lie on either side of its
// own triangle. So a triangle is not there for a point whose distance from its plane is within its `slack`, twice what the
// face may be off it. Of an operand it is there, too, where the ray meets it twice as high above the point as the cell that
// it is of is high, which the cell's own points are not below it: one that the sun sees nearly edge-on is there for points
// far below. A ray that leaves the face passes above all of the corners that lie on the way, hence above the other
// triangles.
#ifndef SUN_GLSL
#define SUN_GLSL

#include "solids.glsl"
#include "tiles.glsl"
#include "eye_ray.glsl"
#include "words.glsl"

struct Sun {
    vec3 towards;  // unit, model axes
    uint across;   // tiles; 0: nothing casts shadows
    vec3 right;    // model units to tiles
    uint down;
    vec3 up;
    vec2 eye;      // where the eye is among the tiles
    float crack;   // between faces that meet, at most: tiles
};

// A tile's leaves, and where their walk begins.
struct SunTile {
    uint first;
    uint end;
    uint entry;
    uint first_triangle;
    uint end_triangle;
    uint first_facet; // in the same list
    uint end_facet;
};

// A triangle of an operand without equations, across the rays: in tiles, from the operand's middle.
struct SunTriangle {
    vec2 corners[3];
    vec3 heights; // of the corners towards the sun, model units, from there
    uint shell;
    uint surface; // its plane, or OWN_PLANE and its number
    float slack;  // along the ray: it does not meet points that are nearer
};

// A triangle of a placed part, likewise, counter-clockwise as the sun sees it. Whatever the part is like, what meets one
// of them is in shade.
struct SunFacet {
    vec2 corners[3]; // from the part's middle
    vec3 plane;      // its height over the first corner, and the slopes to a tile
    float steep;     // length along the ray to a length across the plane
    float slack;     // across the plane, model units
    uint part;
};

layout(scalar, binding = SUN_BINDING + 0) uniform Suns { Sun sun; };
layout(scalar, binding = SUN_BINDING + 1) readonly buffer SunTiles { SunTile sun_tiles[]; };
layout(scalar, binding = SUN_BINDING + 2) readonly buffer SunLeaves { TileLeaf sun_leaves[]; };
layout(binding = SUN_BINDING + 3) uniform usamplerBuffer sun_triangles; // three a triangle
layout(binding = SUN_BINDING + 4) uniform usamplerBuffer sun_lists;     // triangles of each tile, and facets
layout(binding = SUN_BINDING + 5) uniform usamplerBuffer sun_facets;    // three a facet
layout(binding = SUN_BINDING + 6) uniform samplerBuffer sun_parts;      // middles, seen from the eye
// the scene's; a pass that has them for itself defines SUN_SEES_LEAVES: a pass has 32 bindings at most
#ifdef SUN_SEES_LEAVES
#define casters leaves
#define caster_sides leaf_surfaces
#define caster_surfaces surfaces
#define caster_places surface_places
#define caster_middles leaf_centres
#define sun_counters counters
#else
layout(scalar, binding = SUN_BINDING + 7) readonly buffer Casters { Leaf casters[]; };
layout(binding = SUN_BINDING + 8) uniform usamplerBuffer caster_sides;
layout(binding = SUN_BINDING + 9) uniform samplerBuffer caster_surfaces;
layout(binding = SUN_BINDING + 10) uniform samplerBuffer caster_places;
layout(scalar, binding = SUN_BINDING + 11) readonly buffer CasterMiddles { vec3 caster_middles[]; };
layout(scalar, binding = SUN_BINDING + 12) buffer SunCounters { Counters sun_counters; };
#endif

uint sun_list(uint i) { return word_at(sun_lists, i); }

SunTriangle sun_triangle_at(uint i) {
    int at = int(i) * 3;
    vec4 ab = uintBitsToFloat(texelFetch(sun_triangles, at));
    vec4 ch = uintBitsToFloat(texelFetch(sun_triangles, at + 1));
    uvec4 last = texelFetch(sun_triangles, at + 2);
    vec3 heights = vec3(ch.zw, uintBitsToFloat(last.x));
    return SunTriangle(vec2[3](ab.xy, ab.zw, ch.xy), heights, last.y, last.z, uintBitsToFloat(last.w));
}

SunFacet sun_facet_at(uint i) {
    int at = int(i) * 3;
    vec4 ab = uintBitsToFloat(texelFetch(sun_facets, at));
    vec4 cp = uintBitsToFloat(texelFetch(sun_facets, at + 1));
    uvec4 last = texelFetch(sun_facets, at + 2);
    vec3 others = uintBitsToFloat(last.xyz);
    return SunFacet(vec2[3](ab.xy, ab.zw, cp.xy), vec3(cp.zw, others.x), others.y, others.z, last.w);
}

// Spans kept; those of further leaves are computed in every scan.
const uint SUN_KEPT = 12u;

// Rounding of a point, relative to its depth: of a solid's side, eight ulp; of a spline face or a triangle some ten
// times what Newton's method leaves of its depth, a sixtieth of a pixel in a picture a thousand pixels high.
const float ROUNDED_SIDE = 1.0 / 1048576.0;
const float ROUNDED_FACE = 1.0 / 65536.0;

// The part of a ray inside of a surface that is no plane, from which it sets out: one end is 0, to the bit. o is the
// ray's origin seen from the surface's centre.
Span round_from(Surface s, vec3 o, vec3 d) {
    vec3 ol = s.to_local * o;
    vec3 dl = s.to_local * d;
    if (SOLIDS_HAVE == SURFACE_TORUS && s.is_torus) {
        Span t = torus_span(ol, dl, s.constant);
        // the nearest end of its kind is the origin
        if (dot(surface_gradient(s, o), d) > 0.0) {
            if (abs(t.hi) < abs(t.g0)) t.hi = 0.0;
            else t.g0 = 0.0;
        } else {
            if (abs(t.lo) < abs(t.g1)) t.lo = 0.0;
            else t.g1 = 0.0;
        }
        return t;
    }
    // a t^2 + 2 b t < 0
    float a = dot(s.squares * dl, dl);
    float b = dot(s.squares * dl, ol) + s.linear * dl.z;
    if (a == 0.0) return b > 0.0 ? Span(-NEVER, 0.0, NEVER, NEVER) : Span(0.0, NEVER, NEVER, NEVER);
    float other = -2.0 * b / a;
    float lo = min(0.0, other);
    float hi = max(0.0, other);
    return a > 0.0 ? Span(lo, hi, NEVER, NEVER) : Span(-NEVER, NEVER, lo, hi);
}

// The same of a leaf's side; p is seen from the eye.
Span span_from(uint side, vec3 p, vec3 d) {
    vec4 place = place_at(caster_places, side >> SIDE_SHIFT);
    bool negative = (side & SIDE_NEGATIVE) != 0u;
    if ((side & SIDE_PLANE) != 0u || SOLIDS_HAVE == SURFACE_PLANE) {
        return (dot(place.xyz, d) > 0.0) != negative ? Span(-NEVER, 0.0, NEVER, NEVER) : Span(0.0, NEVER, NEVER, NEVER);
    }
    Span s = round_from(surface_at(caster_surfaces, side >> SIDE_SHIFT), p - place.xyz, d);
    return negative ? complement(s) : s;
}

// The part of the ray from p, seen from the eye, towards the sun that is inside of a leaf; p lies on `surface`.
Span caster_span(uint own, vec3 p, uint surface) {
    Span s = EVERYTHING;
    bool more = true;
    for (uint k = own >> LEAF_FLAG_BITS; more && s.lo < s.hi; ++k) {
        uint side = side_word(caster_sides, k);
        more = (side & SIDE_MORE) != 0u || (side & SIDE_PLANE) == 0u && (own & LEAF_PLANES) != 0u;
        bool is_here = side >> SIDE_SHIFT == surface;
        s = both(s, is_here ? span_from(side, p, sun.towards)
                            : side_span(caster_surfaces, caster_places, side, p, sun.towards));
    }
    return s;
}

// How often the triangle goes around q, which has the corners' coordinates: 1 where the ray through q leaves by it, -1
// where it enters. An edge counts when it passes q's height, bottom included and top excluded, on the right.
int turns(SunTriangle triangle, vec2 q) {
    int sum = 0;
    for (uint k = 0u; k < 3u; ++k) {
        vec2 from = triangle.corners[k];
        vec2 to = triangle.corners[(k + 1u) % 3u];
        bool up = to.y > from.y;
        vec2 low = up ? from : to;
        vec2 high = up ? to : from;
        if (!(low.y <= q.y && high.y > q.y)) continue;
        // always the same way round, so both neighbours of an edge get the same sign
        precise float side = (high.x - low.x) * (q.y - low.y) - (high.y - low.y) * (q.x - low.x);
        if (side > 0.0) sum += up ? 1 : -1;
    }
    return sum;
}

// How high a triangle is over q, or over what is nearly its nearest point to q.
float height_over(vec2 corners[3], vec3 heights, vec2 q) {
    vec2 b = corners[1] - corners[0];
    vec2 c = corners[2] - corners[0];
    vec2 p = q - corners[0];
    float area = b.x * c.y - b.y * c.x;
    vec2 st = area == 0.0 ? vec2(0.0) : vec2(p.x * c.y - p.y * c.x, b.x * p.y - b.y * p.x) / area;
    st = max(st, 0.0);
    st /= max(st.x + st.y, 1.0); // rounded, q may be beside it
    return heights.x + st.x * (heights.y - heights.x) + st.y * (heights.z - heights.x);
}

// A caster at a place of the ray.
struct Met {
    bool inside; // just behind it
    float next;  // where it begins or ends next
};

// Tries to send a ray past cracks.
const uint CRACK_TRIES = 7u;

// Of an operand without equations, at t of the ray from p, which lies on `surface`, towards the sun.
//
// A line leaves what is closed as often as it enters it. Where it does not, it slips through a crack between the triangles
// of two spline faces that meet, and another is taken that is beside it by no more than such cracks are wide.
Met meet_mesh(uint shell, vec3 middle, SunTile tile, vec3 p, uint surface, float t, inout uint steps, inout uint wanted) {
    Met met = Met(false, NEVER);
    vec2 q = vec2(dot(sun.right, p - middle), dot(sun.up, p - middle));
    float height = dot(sun.towards, p - middle);
    int whole = 1;
    for (uint k = 0u; k < CRACK_TRIES && whole != 0; ++k) {
        // thrice to three sides, and farther away
        vec2 way = k % 3u == 0u ? vec2(1.0, 0.25) : k % 3u == 1u ? vec2(-0.75, 0.75) : vec2(-0.25, -1.0);
        vec2 at_q = q + way * (sun.crack * float((k + 2u) / 3u) * (1.0 / 3.0));
        // on its own face, a point's ray that is moved by 3 deviations comes by 4 of them nearer than the triangle
        float slack = k == 0u ? 1.0 : 2.0;
        met = Met(false, NEVER);
        whole = 0;
        int around = 0;
        wanted += tile.end_triangle - tile.first_triangle;
        for (uint i = tile.first_triangle; i < tile.end_triangle; ++i) {
            ++steps;
            SunTriangle triangle = sun_triangle_at(sun_list(i));
            if (triangle.shell != shell) continue;
            int sum = turns(triangle, at_q);
            if (triangle.slack > 0.0) whole += sum;
            // the point's own plane is crossed at 0
            if (sum == 0 || triangle.surface == surface) continue;
            float at;
            if ((triangle.surface & OWN_PLANE) != 0u) {
                at = height_over(triangle.corners, triangle.heights, at_q) - height;
            } else {
                at = plane_depth(place_at(caster_places, triangle.surface), p, sun.towards);
            }
            if (!(at > t && at > slack * triangle.slack)) continue;
            around += sum;
            met.next = min(met.next, at);
        }
        met.inside = around != 0;
    }
    return met;
}

// Of a facet's corner, relative to its place, and as much again: what is left between two facets that meet.
const float ROUNDED_CORNER = 1.0 / 8388608.0;

// Whether a placed part lies between p, which is known within `rounding`, and the sun. Facets are larger than they are by
// half of their slack, so that there is nothing between two faces that meet within it: larger in their own planes, since
// across the rays as much would be far off where the sun sees them nearly edge-on, high above the face that they are of.
bool behind_part(SunTile tile, vec3 p, float rounding) {
    float to_tiles = length(sun.right);
    uint part = 0xffffffffu;
    vec2 q = vec2(0.0);
    float height = 0.0;
    bool behind = false;
    uint steps = 0u;
    for (uint i = tile.first_facet; i < tile.end_facet && !behind; ++i) {
        ++steps;
        SunFacet facet = sun_facet_at(sun_list(i));
        if (facet.part != part) {
            part = facet.part;
            vec3 from = p - texelFetch(sun_parts, int(part)).xyz;
            q = vec2(dot(sun.right, from), dot(sun.up, from));
            height = dot(sun.towards, from);
        }
        float margin = 0.5 * facet.slack * to_tiles;
        vec2 first = min(min(facet.corners[0], facet.corners[1]), facet.corners[2]) - margin;
        vec2 last = max(max(facet.corners[0], facet.corners[1]), facet.corners[2]) + margin;
        if (any(lessThan(q, first)) || any(greaterThan(q, last))) continue;
        float rounded = ROUNDED_CORNER * max(abs(q.x), abs(q.y));
        bool within = true;
        for (uint k = 0u; k < 3u; ++k) {
            vec2 side = facet.corners[(k + 1u) % 3u] - facet.corners[k];
            vec2 from = q - facet.corners[k];
            // twice an area, which is `steep` times as much in the plane
            float long_side = length(vec3(side, dot(facet.plane.yz, side) * to_tiles));
            float least = margin * long_side / facet.steep + rounded * length(side);
            within = within && side.x * from.y - side.y * from.x >= -least;
        }
        float at = facet.plane.x + dot(facet.plane.yz, q - facet.corners[0]) - height;
        behind = within && at > facet.steep * (facet.slack + rounding);
    }
    // a driver that ends long loops is found by what is missing
    if (!behind && steps != tile.end_facet - tile.first_facet) atomicAdd(sun_counters.clamps, 1u);
    return behind;
}

// Whether the sun lights the point at this depth of the pixel's ray; `n` is the face's unit normal on the side that is
// lit, `surface` the number of the Boolean solids' surface that it lies on, or OWN_PLANE and its triangle's, or
// NO_SURFACE.
bool in_sun(Ray ray, float depth, vec3 n, uint surface) {
    float rise = dot(n, sun.towards);
    if (!(rise > 0.0)) return false; // in its own shade
    if (sun.across == 0u) return true;
    vec3 p = ray.o + depth * ray.d;
    vec2 last = vec2(sun.across, sun.down) - 1.0;
    uvec2 at_tile = uvec2(clamp(sun.eye + vec2(dot(sun.right, p), dot(sun.up, p)), vec2(0.0), last));
    SunTile tile = sun_tiles[at_tile.y * sun.across + at_tile.x];
    float rounding = abs(depth) * ((surface & OWN_PLANE) != 0u ? ROUNDED_FACE : ROUNDED_SIDE);
    if (behind_part(tile, p, rounding)) return false;
    if (tile.entry >= EXIT_FALSE) return tile.entry == EXIT_FALSE;
    Span kept[SUN_KEPT];
    float t = 0.0;
    bool lit = true;
    bool done = false;
    // a driver that ends long loops is found by what is missing
    uint wanted = 0u;
    uint steps = 0u;
    // four events a leaf, one a triangle
    uint most = 4u * (tile.end - tile.first) + (tile.end_triangle - tile.first_triangle) + 1u;
    for (uint scan = 0u; scan < most && !done; ++scan) {
        uint at = tile.entry;
        float next = NEVER;
        wanted += tile.end - tile.first;
        for (uint i = tile.first; i < tile.end; ++i) {
            ++steps;
            TileLeaf here = sun_leaves[i];
            bool is_kept = i - tile.first < SUN_KEPT;
            Met met;
            if ((here.of & LEAF_SHELL) != 0u) {
                met = meet_mesh(here.of >> LEAF_FLAG_BITS, caster_middles[here.leaf], tile, p, surface, t, steps, wanted);
            } else {
                Span s;
                if (is_kept && scan > 0u) {
                    s = kept[i - tile.first];
                } else {
                    s = caster_span(here.of, p, surface);
                    if (is_kept) kept[i - tile.first] = s;
                }
                met = Met(inside_span(s, t), next_of_span(s, t));
            }
            if (i == at) at = met.inside ? here.in_exit : here.out_exit;
            next = min(next, met.next);
        }
        lit = at != EXIT_TRUE || (scan == 0u && next * rise <= rounding);
        done = !lit || next >= NEVER;
        t = next;
    }
    if (steps != wanted || !done) atomicAdd(sun_counters.clamps, 1u);
    return lit;
}

#endif
