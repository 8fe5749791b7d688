// Which face belongs at a gap candidate: a pure function of the pixel's situation and its candidates. The rules, in the
// order and the words of docs/design/gaps.md. Twin: src/twin/gap_decide.rs.
//
//   gather ──candidates──▶ consider, one by one ──Evidence──▶ decide ──▶ word of the visibility buffer
//
// Whoever includes this declares `frame` and defines `outline_of`. Needs gap_candidate.glsl.
#ifndef GAP_DECIDE_GLSL
#define GAP_DECIDE_GLSL

// Where a face ends near the pixel.
struct Outline {
    vec2 into; // the sum of the gap radius's points in the face, pixels; zero where all are
    bool ends; // the other way the face does not reach half of the gap radius
};

Outline outline_of(Candidate c, vec2 pixel);

// Why the pixel is a gap candidate, and what is known about it.
struct Situation {
    bool border;       // a border lies before what is seen, or the eye is within a solid; else a back face is seen
    bool isolated;     // no border is near: nothing is seen, between patches on both sides
    bool empty;        // no patch is seen
    bool empty_beside; // a neighbour shows the background
    bool other_beside; // a neighbour shows a mesh or solid
    bool other;        // a mesh or solid is behind the pixel
    float other_depth;
    bool cut_open;     // a volume trims the scene
    uvec2 seen;        // word of the visibility buffer
    Candidate own;     // the face that is seen; absent where there is none
};

// Of the candidates, what decides.
struct Evidence {
    Candidate present;  // the nearest that is present
    Candidate near;     // the nearest that is near
    Candidate second;   // the nearest that is near, of another face
    Candidate touching; // the nearest front that touches the back face that is seen
    Candidate closest;  // whose surface passes closest to the centre, before the back face if possible
    bool closest_before;
    bool edge;          // near ones are of two faces
    uint met;           // the face that met `own` last
    bool corner;        // two faces meet `own`
};

// Relative depth within which a face touches another, and is as hidden as that.
const float SAME_DEPTH = 1e-6;

// A back face all of whose gap radius is inside its trims: no border explains it, the pixel looks into a solid.
bool is_interior(Situation s) { return !s.border && s.own.kind == PRESENT; }

bool own_on_pixel(Situation s) { return s.own.kind != ABSENT && s.own.miss <= ON_PIXEL_PX; }

// Candidates beyond this depth do not count.
float depth_limit(Situation s) { return is_interior(s) ? s.own.depth * (1.0 - SAME_DEPTH) : 3.0e38; }

// A mesh or solid at the very pixel.
Candidate other_candidate(Situation s) {
    Candidate c = no_candidate();
    c.kind = PRESENT;
    c.inside = true;
    c.depth = s.other_depth;
    c.miss = 0.0;
    return c;
}

// How far apart in depth a front and a back count as one: the front stands back by this (visibility_trimmed.glsl).
float touch(Candidate front) {
    float px = (frame.perspective != 0u ? front.depth : 1.0) / frame.focal;
    return 2.0 * frame.deviation_px * (abs(front.slope.x) + abs(front.slope.y) + px) + 2.0 * SAME_DEPTH * front.depth;
}

// Before any candidate. Where no patch is seen, a mesh or solid at the pixel is there.
Evidence no_evidence(Situation s) {
    Candidate none = no_candidate();
    Evidence e = Evidence(none, none, none, none, none, false, false, 0u, false);
    if (s.border && s.empty && s.other) e.present = other_candidate(s);
    return e;
}

// Rule "touching front": a back face may lie on another solid's front.
void consider_touching(inout Evidence e, Situation s, Candidate c) {
    bool touches = c.from != FROM_FOLD && c.kind == PRESENT && !c.away && abs(c.depth - s.own.depth) <= touch(c);
    if (touches && c.depth < e.touching.depth) e.touching = c;
}

// Rule "closest surface": of what the back face does not hide. One before it is better than any behind it.
void consider_closest(inout Evidence e, Candidate c, bool before) {
    bool hidden = !before && c.miss <= ON_PIXEL_PX;
    if (!hidden && (before && !e.closest_before || before == e.closest_before && c.miss < e.closest.miss)) {
        e.closest = c;
        e.closest_before = before;
    }
}

// Rules "edge" and "common silhouette": the nearest, the nearest of another face, and whether there are two faces.
void consider_near(inout Evidence e, Candidate c) {
    bool another = c.face != e.near.face;
    e.edge = e.edge || e.near.face != 0u && another;
    if (c.depth < e.near.depth) {
        if (another) e.second = e.near;
        e.near = c;
    } else if (another && c.depth < e.second.depth) {
        e.second = c;
    }
}

// Rule "hidden third": the own face may be a third one that two others hide, where they meet before it.
void consider_corner(inout Evidence e, Situation s, Candidate c) {
    if (c.kind == ABSENT || c.face == s.own.face || !(c.depth - lean(c) - lean(s.own) <= s.own.depth)) return;
    e.corner = e.corner || e.met != 0u && e.met != c.face;
    e.met = c.face;
}

void consider(inout Evidence e, Situation s, Candidate c) {
    // rule "far front": farther away than the next pixel a face's border tells nothing, nor does its back
    if (c.from != FROM_BESIDE && (c.kind != PRESENT || c.away)) return;
    bool before = c.depth <= depth_limit(s);
    consider_closest(e, c, before);
    consider_touching(e, s, c);
    if (!before) return;
    if (c.kind == PRESENT && c.depth < e.present.depth) e.present = c;
    if (c.kind == NEAR) consider_near(e, c);
    consider_corner(e, s, c);
}

// Whether `a` hides `b` up to a silhouette in which both end here:
//
//     nearer     a ──.__         __.·· b continued      to the left of the edge, where both are, a is seen;
//                       `──.__.·´                       to the right neither is, but rounding may leave b there,
//                        __.─´`·.__                     or both continued, of which b is nearer
//     farther    b ──.─´           `·· a continued
//
// Who ends in an edge that is no silhouette lies on the other side of it, and who goes on beyond it is seen there. `a` is
// there within the gap radius, before `b`: to show it is off by no more than that.
bool covers(Candidate a, Candidate b, vec2 pixel) {
    if (max(a.miss, b.miss) > ON_PIXEL_PX) return false; // a surface's own silhouette
    Outline of_a;
    Outline of_b;
    for (uint k = 0u; k < 2u; ++k) { // one call, which drivers copy to where it is called
        of_a = of_b;
        Candidate c = a;
        if (k == 1u) c = b;
        of_b = outline_of(c, pixel);
    }
    bool together = dot(of_a.into, of_b.into) > 0.0 && of_a.ends && of_b.ends;
    return together && a.depth - b.depth + dot(a.slope - b.slope, of_a.into) < 0.0;
}

// Rule "common silhouette", of two that are near: beyond their silhouette the hidden one goes on before the other.
void put_covering_first(inout Evidence e, vec2 pixel) {
    bool meet = e.second.kind == NEAR && !wholly_before(e.near, e.second);
    if (meet && covers(e.second, e.near, pixel)) e.near = e.second;
}

// Rule "common silhouette", of the own face: whether the nearest candidate hides it up to where both end.
bool own_is_covered(Situation s, Evidence e, bool near_first, vec2 pixel) {
    Candidate nearest = e.present;
    if (near_first) nearest = e.near;
    bool ends = s.border && own_on_pixel(s) && s.own.kind == NEAR;
    return ends && nearest.kind != ABSENT && nearest.face != s.own.face && covers(nearest, s.own, pixel);
}

// Rule "grown front": the own face reaches to the pixel, drawn beyond its border. It stays, unless something that is there
// meets it or lies before it.
bool own_has_grown(Situation s, Evidence e) {
    return !s.own.inside && wholly_before(s.own, e.present) && !wholly_before(e.near, s.own);
}

// Rule "interior back": the pixel looks into a solid through a gap.
uvec2 behind_gap(Situation s, Evidence e) {
    bool near_first = e.near.kind == NEAR && e.near.depth < e.present.depth;
    if (e.present.kind == PRESENT && !near_first) return e.present.word;
    if (e.near.kind == NEAR) return e.near.word;
    if (e.touching.kind == PRESENT) return e.touching.word;
    return e.closest.miss <= GAP_SLACK * frame.gap_radius_px ? e.closest.word : s.seen;
}

uvec2 decide(Situation s, Evidence e, vec2 pixel) {
    put_covering_first(e, pixel);
    if (is_interior(s)) return behind_gap(s, e);
    bool near_first = e.near.kind == NEAR && e.near.depth < e.present.depth;
    bool covered = own_is_covered(s, e, near_first, pixel);
    bool grown = false;
    // the own face is a candidate as well, unless rule "hidden third" or "common silhouette" says otherwise
    bool third = s.own.kind == NEAR && e.corner;
    if (s.border && own_on_pixel(s) && !covered && !third && s.own.depth < e.present.depth) {
        grown = own_has_grown(s, e);
        if (s.own.inside || grown) {
            e.present = s.own;
            e.present.kind = PRESENT;
        }
    }
    // rule "other": where patches end near the pixel, a mesh or solid behind them is known at the pixel itself
    bool patches_end = s.empty_beside || s.other_beside || e.present.kind == PRESENT;
    if (!s.border && s.other && patches_end && s.other_depth < e.present.depth) e.present = other_candidate(s);
    // rule "edge": two faces meet before all that is present. An isolated pixel has no edge near
    bool edge = covered && near_first || e.edge && e.near.depth < e.present.depth && !grown && !s.isolated;
    // rule "outline of the part": the inside of what the volume cuts open, and before it the border of one face
    bool cut_open = s.cut_open && s.border && own_on_pixel(s) && s.own.inside && s.own.away;
    edge = edge || cut_open && e.near.kind == NEAR && e.near.depth < s.own.depth;
    if (edge) return e.near.word;
    if (e.present.kind == PRESENT) return e.present.word;
    // rule "background": nothing is there, and the border of what is seen tells nothing
    if (s.border ? s.empty : s.empty_beside) return uvec2(0u);
    if (e.near.kind == NEAR) return e.near.word;
    if (!s.border && s.other) return uvec2(0u);
    return s.seen;
}

#endif
