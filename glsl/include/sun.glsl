// Whether the sun's light reaches a point, past the opaque Boolean solids and past placed parts. Twin of
// src/abi/sun.rs; the includer defines SUN_BINDING, the first of SUN_BINDINGS of src/bindings.rs.
//
//        sun ◀──┤████├────┤██├───── p        the ray to the sun, from event to event as in pass `solid_events`: p is in
//               │    │    │  │              shade if the ray is within the solid anywhere
//        ───────┴────┴────┴──┴─▶ tiles      of the sun's picture, each with its leaves and their Blist
//
// The tiles depend on scene and sun only, and are made with the scene (src/scene/sun.rs). Points beside them belong to
// the nearest tile: leaves that are missing in its list do not reach beyond it.
//
// A point of a solid lies on a known surface, so the ray's first crossing of that surface is at 0 by rule, whatever the
// point's rounding. Relative to other surfaces the point is known only up to its rounding: material between the point
// and a smaller height above its face casts no shadow on it.
//
// Triangles of spline faces deviate from the faces that they represent: a face's point may lie on either side of its
// own triangle. So a triangle is ignored for a point within its `slack` of the triangle's plane; the slack is twice the
// face's deviation. An operand's triangle counts even then if the ray meets it far enough above the point: at twice the
// height of the triangle's cell, since the cell's own points are not so far below. So a triangle nearly parallel to the
// rays counts for points far below. A ray that leaves the face passes above all corners on the way, hence above the
// other triangles.
#ifndef SUN_GLSL
#define SUN_GLSL

#include "solids.glsl"
#include "tiles.glsl"
#include "eye_ray.glsl"
#include "words.glsl"

struct Sun {
    vec3 towards;  // unit, model axes
    uint across;   // tiles; 0: no shadows
    vec3 right;    // model units to tiles
    uint down;
    vec3 up;
    vec2 eye;      // the eye's place among the tiles
    float crack;   // most width between faces that meet: tiles
};

// A tile's leaves, and the first leaf of their walk.
struct SunTile {
    uint first;
    uint end;
    uint entry;
    uint first_triangle;
    uint end_triangle;
    uint first_facet; // in the same list
    uint end_facet;
};

// A triangle of an operand without equations, across the rays: in tiles, relative to the operand's middle.
struct SunTriangle {
    vec2 corners[3];
    vec3 heights; // of the corners towards the sun, model units, relative to the middle
    uint operand;
    uint surface; // its plane, or OWN_PLANE and its number
    float slack;  // along the ray: nearer points are not met
};

// A triangle of a placed part, likewise, counter-clockwise in the sun's picture. Any point whose ray meets a facet is
// in shade, whether or not the part is closed.
struct SunFacet {
    vec2 corners[3]; // relative to the part's middle
    vec3 plane;      // its height over the first corner, and its slopes, per tile
    float steep;     // ratio of a length along the ray to a length across the plane
    float slack;     // across the plane, model units
    uint part;
};

layout(scalar, binding = SUN_BINDING + 0) uniform Suns { Sun sun; };
layout(scalar, binding = SUN_BINDING + 1) readonly buffer SunTiles { SunTile sun_tiles[]; };
layout(scalar, binding = SUN_BINDING + 2) readonly buffer SunLeaves { TileLeaf sun_leaves[]; };
layout(binding = SUN_BINDING + 3) uniform usamplerBuffer sun_triangles; // three a triangle
layout(binding = SUN_BINDING + 4) uniform usamplerBuffer sun_lists;     // triangles of each tile, and facets
layout(binding = SUN_BINDING + 5) uniform usamplerBuffer sun_facets;    // three a facet
layout(binding = SUN_BINDING + 6) uniform samplerBuffer sun_parts;      // middles, relative to the eye
// the scene's leaves; a pass that has its own bindings of them defines SUN_SEES_LEAVES, since a pass has at most 32
// bindings
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

// Number of stored spans; those of further leaves are computed in every scan.
const uint SUN_KEPT = 12u;

// Rounding of a point, relative to its depth: for a solid's side, eight ulp; for a spline face or a triangle some ten
// times the error after Newton's method, a sixtieth of a pixel in a picture a thousand pixels high.
const float ROUNDED_SIDE = 1.0 / 1048576.0;
const float ROUNDED_FACE = 1.0 / 65536.0;

// The part of a ray inside a surface other than a plane, for a ray that starts on the surface: one end is exactly 0. o
// is the ray's origin relative to the surface's centre.
Span round_from(Surface s, vec3 o, vec3 d) {
    vec3 ol = s.to_local * o;
    vec3 dl = s.to_local * d;
    if (SOLIDS_HAVE == SURFACE_TORUS && s.is_torus) {
        Span t = torus_span(ol, dl, s.constant);
        // the nearest end of this kind is the origin
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

// The same for a leaf's side; p is relative to the eye.
Span span_from(uint side, vec3 p, vec3 d) {
    vec4 place = place_at(caster_places, side >> SIDE_SHIFT);
    bool negative = (side & SIDE_NEGATIVE) != 0u;
    if ((side & SIDE_PLANE) != 0u || SOLIDS_HAVE == SURFACE_PLANE) {
        return (dot(place.xyz, d) > 0.0) != negative ? Span(-NEVER, 0.0, NEVER, NEVER) : Span(0.0, NEVER, NEVER, NEVER);
    }
    Span s = round_from(surface_at(caster_surfaces, side >> SIDE_SHIFT), p - place.xyz, d);
    return negative ? complement(s) : s;
}

// The part of the ray from p, relative to the eye, towards the sun that is inside a leaf; p lies on `surface`.
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

// The winding of the triangle around q, which is in the corners' coordinates: 1 if the ray through q leaves by the
// triangle, -1 if it enters. An edge counts if it passes q's height, bottom included and top excluded, on the right.
int turns(SunTriangle triangle, vec2 q) {
    int sum = 0;
    for (uint k = 0u; k < 3u; ++k) {
        vec2 from = triangle.corners[k];
        vec2 to = triangle.corners[(k + 1u) % 3u];
        bool up = to.y > from.y;
        vec2 low = up ? from : to;
        vec2 high = up ? to : from;
        if (!(low.y <= q.y && high.y > q.y)) continue;
        // always from low to high, so both neighbours of an edge get the same sign
        precise float side = (high.x - low.x) * (q.y - low.y) - (high.y - low.y) * (q.x - low.x);
        if (side > 0.0) sum += up ? 1 : -1;
    }
    return sum;
}

// Height of a triangle over q, or over a point near its nearest point to q.
float height_over(vec2 corners[3], vec3 heights, vec2 q) {
    vec2 b = corners[1] - corners[0];
    vec2 c = corners[2] - corners[0];
    vec2 p = q - corners[0];
    float area = b.x * c.y - b.y * c.x;
    vec2 st = area == 0.0 ? vec2(0.0) : vec2(p.x * c.y - p.y * c.x, b.x * p.y - b.y * p.x) / area;
    st = max(st, 0.0);
    st /= max(st.x + st.y, 1.0); // rounded, q may lie beside it
    return heights.x + st.x * (heights.y - heights.x) + st.y * (heights.z - heights.x);
}

// The state of a caster at a place of the ray.
struct Met {
    bool inside; // just behind the place
    float next;  // where it begins or ends next
};

// Most attempts to send a ray past cracks.
const uint CRACK_TRIES = 7u;

// For an operand without equations, at t of the ray from p, which lies on `surface`, towards the sun.
//
// A line leaves a closed surface as often as it enters it. If it does not, it passes through a crack between the
// triangles of two spline faces that meet; then a line beside it is taken, at most as far away as such cracks are wide.
Met meet_mesh(uint operand, vec3 middle, SunTile tile, vec3 p, uint surface, float t, inout uint steps, inout uint wanted) {
    Met met = Met(false, NEVER);
    vec2 q = vec2(dot(sun.right, p - middle), dot(sun.up, p - middle));
    float height = dot(sun.towards, p - middle);
    int whole = 1;
    for (uint k = 0u; k < CRACK_TRIES && whole != 0; ++k) {
        // three times to each of three directions, and farther away
        vec2 way = k % 3u == 0u ? vec2(1.0, 0.25) : k % 3u == 1u ? vec2(-0.75, 0.75) : vec2(-0.25, -1.0);
        vec2 at_q = q + way * (sun.crack * float((k + 2u) / 3u) * (1.0 / 3.0));
        // moved by 3 deviations, a point's ray comes 4 deviations nearer to its own face than the triangle
        float slack = k == 0u ? 1.0 : 2.0;
        met = Met(false, NEVER);
        whole = 0;
        int around = 0;
        wanted += tile.end_triangle - tile.first_triangle;
        for (uint i = tile.first_triangle; i < tile.end_triangle; ++i) {
            ++steps;
            SunTriangle triangle = sun_triangle_at(sun_list(i));
            if (triangle.operand != operand) continue;
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

// Rounding of a facet's corner, relative to its place, times two: the width of a gap between two facets that meet.
const float ROUNDED_CORNER = 1.0 / 8388608.0;

// Whether a placed part lies between p, which is known within `rounding`, and the sun. Facets are enlarged by half of
// their slack, so that two faces that meet within it leave no gap. They are enlarged in their own planes: the same
// width across the rays would reach high above the face where the sun's rays are nearly parallel to it.
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
            // twice an area, which is `steep` times larger in the plane
            float long_side = length(vec3(side, dot(facet.plane.yz, side) * to_tiles));
            float least = margin * long_side / facet.steep + rounded * length(side);
            within = within && side.x * from.y - side.y * from.x >= -least;
        }
        float at = facet.plane.x + dot(facet.plane.yz, q - facet.corners[0]) - height;
        behind = within && at > facet.steep * (facet.slack + rounding);
    }
    // if a driver ends the loop early, entries are missing
    if (!behind && steps != tile.end_facet - tile.first_facet) atomicAdd(sun_counters.clamps, 1u);
    return behind;
}

// Whether the sun lights the point at this depth of the pixel's ray. `n` is the face's unit normal on the lit side.
// `surface` is the number of the Boolean solids' surface that contains the point, or OWN_PLANE and its triangle's, or
// NO_SURFACE.
bool in_sun(Ray ray, float depth, vec3 n, uint surface) {
    float rise = dot(n, sun.towards);
    if (!(rise > 0.0)) return false; // turned away from the sun
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
    // if a driver ends the loop early, entries are missing
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
            if ((here.of & LEAF_BOUNDARY) != 0u) {
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
