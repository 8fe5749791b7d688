// The face that is visible at a gap candidate: a pure function of the pixel's situation and its candidates. Order and
// names of the rules are those of docs/design/gaps.md. Twin: src/twin/gap_decide.rs.
//
//   gather ──candidates──▶ consider, one by one ──Evidence──▶ decide ──▶ word of the visibility buffer
//
// The includer declares `frame` and defines `outline_of`. Needs gap_candidate.glsl.
#ifndef GAP_DECIDE_GLSL
#define GAP_DECIDE_GLSL

// The end of a face near the pixel.
struct Outline {
    vec2 into; // the sum of the gap radius's points in the face, pixels; zero if all are
    bool ends; // in the other direction, the face does not reach half of the gap radius
};

Outline outline_of(Candidate c, vec2 pixel);

// The reason why the pixel is a gap candidate, and the pixel's surroundings.
struct Situation {
    bool border;       // a border is before the visible surface, or the eye in a solid; else a back face is visible
    bool isolated;     // no border is near: the pixel shows background between patches on both sides
    bool empty;        // the pixel shows no patch
    bool empty_beside; // a neighbour shows the background
    bool other_beside; // a neighbour shows a mesh or solid
    bool other;        // a mesh or solid is behind the pixel
    float other_depth;
    bool cut_open;     // a volume trims the scene
    bool in_solid;     // the eye is in a solid
    uvec2 seen;        // word of the visibility buffer
    Candidate own;     // the visible face; absent if there is none
};

// The candidates on which the decision depends.
struct Evidence {
    Candidate present;  // the nearest present one
    Candidate near;     // the nearest near one
    Candidate second;   // the nearest near one of another face
    Candidate touching; // the nearest front that touches the visible back face
    Candidate closest;  // the one whose surface passes closest to the centre, preferably before the back face
    bool closest_before;
    bool edge;          // the near ones belong to two faces
    uint met;           // the last face that met `own`
    bool corner;        // two faces meet `own`
};

// Relative depth within which a face touches another and is equally hidden.
const float SAME_DEPTH = 1e-6;

// A back face whose trims contain the whole gap radius: no border explains it, so the pixel shows a solid's inside.
bool is_interior(Situation s) { return !s.border && s.own.kind == PRESENT; }

bool own_on_pixel(Situation s) { return s.own.kind != ABSENT && s.own.miss <= ON_PIXEL_PX; }

// Candidates beyond this depth are ignored.
float depth_limit(Situation s) { return is_interior(s) ? s.own.depth * (1.0 - SAME_DEPTH) : 3.0e38; }

// Whether faces of two parts lie in each other: within rounding, neither is before the other.
bool coincide(Candidate a, Candidate b) {
    bool two_parts = a.face != 0u && b.face != 0u && a.instance != b.instance;
    return two_parts && abs(a.depth - b.depth) <= 2.0 * SAME_DEPTH * max(a.depth, b.depth);
}

// Whether `a` is seen rather than `b`. Where parts touch, a front is; of two fronts or two backs, that of the lower
// instance.
bool precedes(Candidate a, Candidate b) {
    if (!coincide(a, b)) return a.depth < b.depth;
    return a.away != b.away ? b.away : a.instance < b.instance;
}

// A mesh or solid in the pixel itself.
Candidate other_candidate(Situation s) {
    Candidate c = no_candidate();
    c.kind = PRESENT;
    c.inside = true;
    c.depth = s.other_depth;
    c.miss = 0.0;
    return c;
}

// Distance in depth at which a front and a back count as one: the front is moved back by this
// (visibility_trimmed.glsl).
float touch(Candidate front) {
    float px = (frame.perspective != 0u ? front.depth : 1.0) / frame.focal;
    return 2.0 * frame.deviation_px * (abs(front.slope.x) + abs(front.slope.y) + px) + 2.0 * SAME_DEPTH * front.depth;
}

// The state before any candidate. If no patch is visible, a mesh or solid in the pixel is present.
Evidence no_evidence(Situation s) {
    Candidate none = no_candidate();
    Evidence e = Evidence(none, none, none, none, none, false, false, 0u, false);
    if (s.border && s.empty && s.other) e.present = other_candidate(s);
    return e;
}

// Rule "touching front": a back face may lie on the front of another solid.
void consider_touching(inout Evidence e, Situation s, Candidate c) {
    bool touches = c.from != FROM_FOLD && c.kind == PRESENT && !c.away && abs(c.depth - s.own.depth) <= touch(c);
    if (touches && c.depth < e.touching.depth) e.touching = c;
}

// Rule "closest surface" compares surfaces that miss the centre. A surface that covers the centre is present, or lies
// behind the back face, or its face ends before the centre. One before the back face is better than any behind it.
void consider_closest(inout Evidence e, Candidate c, bool before) {
    bool misses = c.miss > ON_PIXEL_PX;
    if (misses && (before && !e.closest_before || before == e.closest_before && c.miss < e.closest.miss)) {
        e.closest = c;
        e.closest_before = before;
    }
}

// Rules "edge" and "common silhouette": the nearest one, the nearest of another face, and whether there are two faces.
void consider_near(inout Evidence e, Candidate c) {
    bool another = c.face != e.near.face;
    e.edge = e.edge || e.near.face != 0u && another;
    if (precedes(c, e.near)) {
        if (another) e.second = e.near;
        e.near = c;
    } else if (another && c.depth < e.second.depth) {
        e.second = c;
    }
}

// Rule "hidden third": two other faces that meet before the own face may hide it.
void consider_corner(inout Evidence e, Situation s, Candidate c) {
    if (c.kind == ABSENT || c.face == s.own.face || !(c.depth - lean(c) - lean(s.own) <= s.own.depth)) return;
    e.corner = e.corner || e.met != 0u && e.met != c.face;
    e.met = c.face;
}

void consider(inout Evidence e, Situation s, Candidate c) {
    // rule "far front": beyond the next pixel, a face's border and its back are no evidence
    if (c.from != FROM_BESIDE && (c.kind != PRESENT || c.away)) return;
    bool before = c.depth <= depth_limit(s);
    consider_closest(e, c, before);
    consider_touching(e, s, c);
    if (!before) return;
    if (c.kind == PRESENT && precedes(c, e.present)) e.present = c;
    if (c.kind == NEAR) consider_near(e, c);
    consider_corner(e, s, c);
}

// Whether a near face is before all that is present. It is not where it touches another part's face that is present.
bool near_first(Evidence e) {
    return e.near.kind == NEAR && e.near.depth < e.present.depth && !coincide(e.near, e.present);
}

// Whether `a` hides `b` up to a silhouette in which both end here:
//
//     nearer     a ──.__         __.·· b continued      left of the edge, where both exist, a is visible;
//                       `──.__.·´                       right of it neither exists, but rounding may leave b there,
//                        __.─´`·.__                     or both continued, of which b is nearer
//     farther    b ──.─´           `·· a continued
//
// A face that ends in an edge other than a silhouette lies on the other side of it, and a face that continues beyond
// the edge is visible there. `a` is present within the gap radius, before `b`: showing it is off by at most the gap
// radius.
bool covers(Candidate a, Candidate b, vec2 pixel) {
    if (max(a.miss, b.miss) > ON_PIXEL_PX) return false; // a surface's own silhouette
    Outline of_a;
    Outline of_b;
    for (uint k = 0u; k < 2u; ++k) { // one call, which drivers inline
        of_a = of_b;
        Candidate c = a;
        if (k == 1u) c = b;
        of_b = outline_of(c, pixel);
    }
    bool together = dot(of_a.into, of_b.into) > 0.0 && of_a.ends && of_b.ends;
    return together && a.depth - b.depth + dot(a.slope - b.slope, of_a.into) < 0.0;
}

// Rule "common silhouette", for two near ones: beyond their silhouette the hidden one continues before the other.
void put_covering_first(inout Evidence e, vec2 pixel) {
    bool meet = e.second.kind == NEAR && !wholly_before(e.near, e.second);
    if (meet && covers(e.second, e.near, pixel)) e.near = e.second;
}

// Rule "common silhouette", for the own face: whether the nearest candidate hides it up to the end of both.
bool own_is_covered(Situation s, Evidence e, vec2 pixel) {
    Candidate nearest = e.present;
    if (near_first(e)) nearest = e.near;
    bool ends = s.border && own_on_pixel(s) && s.own.kind == NEAR;
    return ends && nearest.kind != ABSENT && nearest.face != s.own.face && covers(nearest, s.own, pixel);
}

// Rule "grown front": the own face reaches the pixel because it is drawn beyond its border. It stays, unless something
// present meets it or lies before it.
bool own_has_grown(Situation s, Evidence e) {
    return !s.own.inside && wholly_before(s.own, e.present) && !wholly_before(e.near, s.own);
}

// Rule "interior back": the pixel shows a solid's inside through a gap.
uvec2 behind_gap(Situation s, Evidence e) {
    if (e.present.kind == PRESENT && !near_first(e)) return e.present.word;
    if (e.near.kind == NEAR) return e.near.word;
    if (e.touching.kind == PRESENT) return e.touching.word;
    return e.closest.miss <= GAP_SLACK * frame.gap_radius_px ? e.closest.word : s.seen;
}

uvec2 decide(Situation s, Evidence e, vec2 pixel) {
    put_covering_first(e, pixel);
    if (is_interior(s)) return behind_gap(s, e);
    bool covered = own_is_covered(s, e, pixel);
    bool covering_edge = covered && near_first(e);
    bool grown = false;
    // the own face is a candidate, too, unless rule "hidden third" or "common silhouette" excludes it
    bool third = s.own.kind == NEAR && e.corner;
    if (s.border && own_on_pixel(s) && !covered && !third && precedes(s.own, e.present)) {
        grown = own_has_grown(s, e);
        if (s.own.inside || grown) {
            e.present = s.own;
            e.present.kind = PRESENT;
        }
    }
    // rule "other": if patches end near the pixel, the mesh or solid behind them is known at the pixel itself
    bool patches_end = s.empty_beside || s.other_beside || e.present.kind == PRESENT;
    if (!s.border && s.other && patches_end && s.other_depth < e.present.depth) e.present = other_candidate(s);
    // rule "edge": two faces meet before all that is present. An isolated pixel has no edge near
    bool edge = covering_edge || e.edge && near_first(e) && !grown && !s.isolated;
    // rule "outline of the part": the inside of a part that the volume cuts open, and before it the border of one face
    bool cut_open = s.cut_open && s.border && own_on_pixel(s) && s.own.inside && s.own.away;
    edge = edge || cut_open && e.near.kind == NEAR && e.near.depth < s.own.depth;
    if (edge) return e.near.word;
    if (e.present.kind == PRESENT) return e.present.word;
    // rule "background": nothing is present, and the border of the visible face is no evidence. A ray that begins in a
    // solid leaves it through a face
    bool ends = s.border ? s.empty : s.empty_beside;
    if (ends && !s.in_solid) return uvec2(0u);
    if (e.near.kind == NEAR) return e.near.word;
    if (!s.border && s.other) return uvec2(0u);
    return s.seen;
}

#endif
