// Where between two neighbouring pixels' centres the surface changes that is seen, and why. Needs solid_sheet.glsl,
// tiles.glsl, edges.glsl, and the lists of tiles.
//
//     meet   ╲   ╱    both surfaces have one depth         fold   ╮      the nearer one turns away from the eye
//             ╲ ╱                                                 │
//              ●                                             ─────┘
//     end    ────●    the nearer one ends at a third         smooth ──⌒── as meet, with one normal
//                │    surface, which is hidden
//
// The place is a root of the difference of two depths, of the third surface's function along the nearer one, or halves
// the way to where the nearer one is met no more.
#ifndef SOLID_CHANGE_GLSL
#define SOLID_CHANGE_GLSL

// Smooth: the cosine of one degree.
const float SMOOTH_COSINE = 0.99984770;
// Halvings of the way between two centres.
const uint CHANGE_STEPS = 9u;
// Depths that differ by less than this share of a pixel are met.
const float MET_PX = 1.0 / 512.0;
// Two depths of one surface, followed over a pixel, differ by less.
const float SAME_SHEET_PX = 0.5;
// How far outside of a primitive a point of its boundary is by rounding, of a pixel.
const float ON_SIDE_PX = 0.5;

const uint CHANGE_NONE = 0u;
const uint CHANGE_MEET = 1u;
const uint CHANGE_FOLD = 2u;
const uint CHANGE_END = 3u;
const uint CHANGE_SMOOTH = 4u;

struct Change {
    uint why;
    float share;  // of the way from the first centre to the second
    bool first;   // of a fold or an end: the first pixel's surface is the nearer one
    float cosine; // between the normals of both surfaces: of a meeting
};

// Model units across a pixel.
float pixel_across(float t) { return (frame.perspective != 0u ? t : 1.0) / frame.focal; }

bool is_cap(Sheet s) {
    bool is_side = s.is_there && s.leaf != NO_LEAF && s.operand == 0u;
    return is_side && (leaves[s.leaf].flags & LEAF_CAP) != 0u;
}

vec3 point_on(float t, vec2 place) {
    Ray ray = eye_ray(frame, place);
    return ray.o + t * ray.d;
}

// How far outside of a leaf's side a point is, model units: by its value over its slope.
float outside_side(uint side, vec3 p) {
    uint i = side >> SIDE_SHIFT;
    vec4 place = place_at(surface_places, i);
    float outside;
    if ((side & SIDE_PLANE) != 0u || SOLIDS_HAVE == SURFACE_PLANE) {
        outside = dot(place.xyz, p) - place.w;
    } else {
        Surface s = surface_at(surfaces, i);
        vec3 slope = 2.0 * surface_gradient(s, p - place.xyz);
        outside = surface_value(s, p - place.xyz) / max(length(slope), 1e-20);
    }
    return (side & SIDE_NEGATIVE) != 0u ? -outside : outside;
}

vec3 across_surface(uint side, vec3 p) {
    uint i = side >> SIDE_SHIFT;
    vec4 place = place_at(surface_places, i);
    if ((side & SIDE_PLANE) != 0u || SOLIDS_HAVE == SURFACE_PLANE) return place.xyz;
    return normalize(surface_gradient(surface_at(surfaces, i), p - place.xyz));
}

// Within all sides of the leaf but those of two surfaces.
bool is_on_leaf(Leaf leaf, vec3 p, uint but, uint and, float slack) {
    bool on = true;
    for (uint k = leaf.first; k < leaf.first + leaf.count && on; ++k) {
        uint side = side_word(leaf_surfaces, k);
        if (side >> SIDE_SHIFT != but && side >> SIDE_SHIFT != and) on = outside_side(side, p) <= slack;
    }
    return on;
}

// Depths of a sheet at the way's beginning, middle and end, as a parabola.
float depth_along(vec3 depths, float share) {
    float b = 4.0 * depths.y - 3.0 * depths.x - depths.z;
    float a = 2.0 * (depths.x + depths.z) - 4.0 * depths.y;
    return depths.x + share * (b + share * a);
}

// The first place on the way from `from` to `to` at which the sheet gets to a side of a primitive; 2 where it gets to
// none. `tile`: of the band, whose primitives are looked at. `cosine`: between both normals there; `cut`: it is a
// section's.
float end_of(Sheet f, vec2 from, vec2 to, uint tile, out float cosine, out bool cut) {
    vec3 depths;
    for (uint k = 0u; k < 3u; ++k) depths[k] = depth_on(f, mix(from, to, 0.5 * float(k)));
    float best = 2.0;
    cosine = 0.0;
    cut = false;
    if (!is_depth(depths.y) || !is_depth(depths.z)) return best;
    float slack = ON_SIDE_PX * pixel_across(f.t);
    uint item = leaves[f.leaf].item;
    uint first = min(word_at(tile_starts, tile), frame.tile_leaf_capacity);
    uint end = min(word_at(tile_starts, tile + 1u), frame.tile_leaf_capacity);
    vec3 p0 = point_on(depths.x, from);
    vec3 p1 = point_on(depths.z, to);
    for (uint i = first; i < end; ++i) {
        uint number = leaf_number(tile_leaf_at(tile_leaves, i));
        Leaf leaf = leaves[number];
        // a solid that is seen through ends at its own sides, and at what is opaque
        bool is_opaque = number < frame.followed_leaf;
        if (!is_opaque && leaf.item != item || (leaf.flags & LEAF_BOUNDARY) != 0u) continue;
        for (uint k = leaf.first; k < leaf.first + leaf.count; ++k) {
            uint side = side_word(leaf_surfaces, k);
            if (side >> SIDE_SHIFT == f.surface) continue;
            float h0 = outside_side(side, p0);
            float h1 = outside_side(side, p1);
            if ((h0 < 0.0) == (h1 < 0.0)) continue;
            float low = 0.0;
            float high = 1.0;
            float share = 0.0;
            vec3 p;
            for (uint j = 0u; j < 3u; ++j) {
                share = mix(low, high, clamp(h0 / (h0 - h1), 0.0, 1.0));
                vec2 at = mix(from, to, share);
                p = point_on(depth_along(depths, share), at);
                float h = outside_side(side, p);
                if ((h < 0.0) == (h0 < 0.0)) {
                    low = share;
                    h0 = h;
                } else {
                    high = share;
                    h1 = h;
                }
            }
            if (share >= best || !is_on_leaf(leaf, p, side >> SIDE_SHIFT, f.surface, slack)) continue;
            vec3 across = across_surface(side, p);
            if (is_opaque && leaf.item != item) {
                // a side that is turned away from the eye lies behind its primitive, which hides the sheet before it
                bool away = dot(across, eye_ray(frame, mix(from, to, share)).d) > 0.0;
                bool inward = ((side & SIDE_NEGATIVE) != 0u) != ((leaf.flags & LEAF_NEGATIVE) != 0u);
                if (away != inward) continue;
            }
            best = share;
            cut = (leaf.flags & LEAF_CAP) != 0u;
            cosine = abs(dot(normal_on(f, p), across));
        }
    }
    return best;
}

// Between pixels that see two surfaces, or nothing at one of them. `a` and `b` are their centres. `order`: 1 where of
// two surfaces the nearer one is seen, -1 where it is the farther one.
Change change_between(Sheet sheets[2], vec2 a, vec2 b, float order) {
    Change c = Change(CHANGE_NONE, 0.5, sheets[0].is_there, 0.0);
    bool two = sheets[0].is_there && sheets[1].is_there;
    bool swapped = !sheets[0].is_there;
    uint mode = CHANGE_FOLD;
    float g0 = 0.0; // depth of the first sheet less that of the second, at the ends of what is left of the way
    float g1 = 0.0;
    float low = 0.0;
    float high = 1.0;
    bool done = false;
    float share = 0.0;
    float depths[2];
    float footprint = pixel_across(sheets[swapped ? 1 : 0].t);
    for (uint i = 0u; i < CHANGE_STEPS + 2u && !done; ++i) {
        share = i == 0u ? 0.0 : i == 1u ? 1.0 : 0.5 * (low + high);
        if (i > 1u && mode == CHANGE_MEET) share = mix(low, high, clamp(g0 / (g0 - g1), 0.02, 0.98));
        if (i > 1u && mode == CHANGE_SMOOTH) {
            share = sqrt(abs(g0)) / max(sqrt(abs(g0)) + sqrt(abs(g1)), 1e-30);
        }
        vec2 place = swapped ? mix(b, a, share) : mix(a, b, share);
        for (uint k = 0u; k < 2u; ++k) {
            uint of = swapped ? 1u - k : k;
            depths[k] = sheets[of].is_there ? depth_on(sheets[of], place) : NEVER;
        }
        bool met0 = is_depth(depths[0]);
        bool met1 = is_depth(depths[1]);
        float g = order * (depths[0] - depths[1]);
        if (i == 0u) {
            g0 = met0 && met1 ? g : NEVER;
        } else if (i == 1u) {
            g1 = met0 && met1 ? g : NEVER;
            bool both = is_depth(g0) && is_depth(g1);
            if (!two) {
                c.first = !swapped;
                mode = met0 ? CHANGE_END : CHANGE_FOLD;
                done = mode == CHANGE_END;
            } else if (both && (g0 < 0.0) != (g1 < 0.0)) {
                mode = CHANGE_MEET;
            } else if (both) {
                c.first = g0 < 0.0;
                mode = CHANGE_SMOOTH;
            } else if (is_depth(g0)) {
                // the first one folds before it gets to the second centre
                c.first = g0 < 0.0;
                mode = CHANGE_FOLD;
            } else if (is_depth(g1)) {
                // the same from the other side
                c.first = g1 < 0.0;
                mode = CHANGE_FOLD;
                swapped = true;
                g0 = -g1;
            } else {
                // neither is there where the other is seen: the nearer one hides the farther
                c.first = order * (sheets[0].t - sheets[1].t) < 0.0;
                swapped = !c.first;
                two = false;
            }
        } else if (mode == CHANGE_SMOOTH) {
            done = true;
            mode = met0 && met1 && abs(g) < MET_PX * 64.0 * footprint ? CHANGE_SMOOTH : CHANGE_END;
        } else {
            // before the change: the first sheet is there, and on the same side of the second
            bool before = met0 && (!two || !met1 || (g < 0.0) == (g0 < 0.0));
            if (mode == CHANGE_FOLD && met0 && !before) {
                // they meet before that
                mode = CHANGE_MEET;
                g1 = g;
                high = share;
            } else if (before) {
                low = share;
                if (met1) g0 = g;
            } else {
                high = share;
                if (met0 && met1) g1 = g;
            }
            done = mode == CHANGE_MEET && abs(g) < MET_PX * footprint;
        }
    }
    // what folds lies behind: the nearer one ends before
    if (mode == CHANGE_FOLD && two && c.first == swapped) mode = CHANGE_END;
    c.why = mode;
    bool meets_ = mode == CHANGE_MEET || mode == CHANGE_SMOOTH;
    c.share = meets_ ? share : 0.5 * (low + high);
    if (swapped) c.share = 1.0 - c.share;
    if (meets_) {
        Ray ray = eye_ray(frame, mix(a, b, c.share));
        vec3 p = ray.o + (is_depth(depths[0]) ? depths[0] : sheets[0].t) * ray.d;
        vec3 n[2];
        for (uint k = 0u; k < 2u; ++k) {
            n[k] = normal_on(sheets[k], p);
            if (dot(n[k], ray.d) > 0.0) n[k] = -n[k];
        }
        c.cosine = dot(n[0], n[1]);
        if (mode == CHANGE_SMOOTH && c.cosine < SMOOTH_COSINE) c.why = CHANGE_END;
    }
    return c;
}

#endif
