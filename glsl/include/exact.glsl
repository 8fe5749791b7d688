// The exact trim test: a cell, and the few arcs of its list. Twin of src/twin/exact.rs; crates/geometry/src/trim/exact
// describes the data structure.
//
//   face ──▶ cell of the first level ──▶ part of the cell, if it is split ──▶ winding + list ──▶ arcs
//
// The includer defines EXACT_BINDING, the first of its three buffers.
#ifndef EXACT_GLSL
#define EXACT_GLSL

struct ExactFace {
    uint first_cell;
    uint first;  // column, and row << 16; signed
    uint counts; // columns, and rows << 16
    uint bits;   // columns to the domain, as a power of two, and rows << 16
};

struct ExactCell {
    uint first;  // arc of its list, or CELL_SPLIT and its first part
    int winding; // of the arcs that are not in the list; or halvings
};

struct ExactArc {
    vec2 low;
    vec2 high;
    vec2 corner;    // where the tangents at the ends meet, less low; zero for a straight arc
    float fullness; // corner² = fullness · low · high, in barycentric coordinates; 0 for a straight arc
    uint shape;     // AT_LOW, AT_HIGH, ARC_UP, ARC_LAST
};

// texels: a driver fetches them at once, but gathers words of storage buffers one by one
layout(binding = EXACT_BINDING + 0) uniform usamplerBuffer exact_faces; // one a face
layout(binding = EXACT_BINDING + 1) uniform usamplerBuffer exact_cells; // two cells in one
layout(binding = EXACT_BINDING + 2) uniform usamplerBuffer exact_arcs;  // two an arc

const uint CELL_SPLIT = 0x80000000u;
const uint AT_LOW = 1u; // at this end of the arc, the loop leaves the list
const uint AT_HIGH = 2u;
const uint ARC_UP = 4u;   // the loop runs from low to high
const uint ARC_LAST = 8u; // of its list
const float MARGIN = 0.25; // around a cell, as a share of its sides: the list is valid for points there, too
const float FAR = 1e30;   // larger coordinates are invalid

// A list of arcs, and the points for which it is valid.
struct ExactList {
    uint first;  // arc
    int winding; // of the arcs that are not in it
    vec2 lo;     // the cell's rectangle; unbounded for the outermost cells
    vec2 hi;
    vec2 margin; // around the rectangle, where the list is valid, too
};

// A face's cells.
struct ExactGrid {
    uint first_cell;
    vec2 first;
    vec2 counts;
    uvec2 bits;
};

float power_of_two(int bits) { return uintBitsToFloat(uint(127 + bits) << 23u); }

vec2 exact_scale(ExactGrid grid) { return vec2(power_of_two(int(grid.bits.x)), power_of_two(int(grid.bits.y))); }

ExactGrid exact_grid(uint face) {
    uvec4 words = texelFetch(exact_faces, int(face));
    vec2 first = vec2(bitfieldExtract(int(words.y), 0, 16), bitfieldExtract(int(words.y), 16, 16));
    vec2 counts = vec2(words.z & 0xffffu, words.z >> 16u);
    return ExactGrid(words.x, first, counts, uvec2(words.w & 0xffffu, words.w >> 16u));
}

ExactCell exact_cell_at(uint i) {
    uvec4 two = texelFetch(exact_cells, int(i >> 1u));
    uvec2 cell = (i & 1u) == 0u ? two.xy : two.zw;
    return ExactCell(cell.x, int(cell.y));
}

ExactArc exact_arc_at(uint i) {
    vec4 ends = uintBitsToFloat(texelFetch(exact_arcs, int(2u * i)));
    uvec4 rest = texelFetch(exact_arcs, int(2u * i + 1u));
    return ExactArc(ends.xy, ends.zw, uintBitsToFloat(rest.xy), uintBitsToFloat(rest.z), rest.w);
}

vec2 exact_index(ExactGrid grid, vec2 uv) {
    precise vec2 at = uv * exact_scale(grid) - grid.first;
    return min(max(floor(at), 0.0), grid.counts - 1.0);
}

vec2 exact_part(ExactGrid grid, vec2 uv, vec2 index, uint halvings) {
    float parts = power_of_two(int(halvings));
    precise vec2 at = (uv * exact_scale(grid) - grid.first - index) * parts;
    return min(max(floor(at), 0.0), parts - 1.0);
}

ExactCell exact_cell(ExactGrid grid, vec2 index) {
    return exact_cell_at(grid.first_cell + uint(index.y * grid.counts.x + index.x));
}

uint exact_halvings(ExactCell cell) { return (cell.first & CELL_SPLIT) != 0u ? uint(cell.winding) : 0u; }

// The list of a part of a cell.
ExactList exact_list_of(ExactGrid grid, ExactCell cell, vec2 index, vec2 part) {
    uint halvings = exact_halvings(cell);
    float parts = power_of_two(int(halvings));
    // fetched for whole cells, too: a branch would run both sides
    ExactCell own = exact_cell_at((cell.first & ~CELL_SPLIT) + uint(part.y * parts + part.x));
    if ((cell.first & CELL_SPLIT) == 0u) own = cell;
    ivec2 bits = -ivec2(grid.bits + halvings);
    vec2 side = vec2(power_of_two(bits.x), power_of_two(bits.y));
    precise vec2 at = index * parts + part;
    bvec2 is_first = lessThanEqual(at, vec2(0.0));
    bvec2 is_last = greaterThanEqual(at, grid.counts * parts - 1.0);
    precise vec2 lo = (grid.first * parts + at) * side;
    precise vec2 hi = lo + side;
    vec2 none = vec2(FAR);
    return ExactList(own.first, own.winding, mix(lo, -none, is_first), mix(hi, none, is_last), MARGIN * side);
}

// The list of the cell that contains a point.
ExactList exact_list(uint face, vec2 uv) {
    ExactGrid grid = exact_grid(face);
    vec2 index = exact_index(grid, uv);
    ExactCell cell = exact_cell(grid, index);
    return exact_list_of(grid, cell, index, exact_part(grid, uv, index, exact_halvings(cell)));
}

vec2 exact_chord(ExactArc arc) {
    precise vec2 chord = arc.high - arc.low;
    return chord;
}

// The sides of an arc's triangle.
struct ArcSides {
    float turned;   // 1 if the triangle is left of its chord, else -1, which then flips the signs of the sides
    vec2 to_high;   // from the lower end
    vec2 to_corner; // from the lower end
    vec2 back;      // from the higher end to the corner
};

ArcSides arc_sides(ExactArc arc) {
    vec2 chord = exact_chord(arc);
    precise float area = chord.x * arc.corner.y - arc.corner.x * chord.y;
    float turned = area < 0.0 ? -1.0 : 1.0;
    vec2 to_high = turned * chord;
    vec2 to_corner = turned * arc.corner;
    precise vec2 back = to_corner - to_high;
    return ArcSides(turned, to_high, to_corner, back);
}

// The place of a point, at `p` from the lower and `q` from the higher end: corner, high and low, barycentric. Linear in
// both.
vec3 arc_place(ArcSides sides, vec2 p, vec2 q) {
    precise float middle = sides.to_high.x * p.y - p.x * sides.to_high.y;
    precise float high = p.x * sides.to_corner.y - sides.to_corner.x * p.y;
    precise float low = sides.back.x * q.y - q.x * sides.back.y; // as a difference it would have the longer sides' rounding
    return vec3(middle, high, low);
}

// Whether an arc is to the right of a point between its ends.
bool arc_right_of(ExactArc arc, ArcSides sides, vec3 place) {
    precise float square = place.x * place.x;
    precise float product = max(place.z, 0.0) * (arc.fullness * max(place.y, 0.0));
    bool beyond = place.x > 0.0 && square > product;
    return beyond == (sides.turned > 0.0);
}

vec3 arc_place_of(ExactArc arc, ArcSides sides, vec2 uv) {
    precise vec2 p = uv - arc.low;
    precise vec2 q = uv - arc.high;
    return arc_place(sides, p, q);
}

// Whether the arc passes uv.y, low.y < uv.y <= high.y, at some u > uv.x; `place` is the place of uv.
bool arc_right_at(ExactArc arc, ArcSides sides, vec3 place, vec2 uv) {
    bool right = arc_right_of(arc, sides, place);
    return uv.y == arc.high.y ? arc.high.x > uv.x : right; // at the end, the same as the neighbouring arc
}

bool arc_right(ExactArc arc, vec2 uv) {
    ArcSides sides = arc_sides(arc);
    return arc_right_at(arc, sides, arc_place_of(arc, sides, uv), uv);
}

// The winding number that an arc adds to a point at v; `right`: it is to the right there.
int arc_winding(ExactArc arc, float v, bool right) {
    int direction = (arc.shape & ARC_UP) != 0u ? 1 : -1;
    int low = (arc.shape & AT_LOW) != 0u ? direction : 0;
    int high = (arc.shape & AT_HIGH) != 0u ? direction : 0;
    return v > arc.low.y ? (v > arc.high.y ? high : right ? direction : 0) - low : 0;
}

bool is_number(vec2 uv) { return all(lessThan(abs(uv), vec2(FAR))); }

bool holds_for(ExactList list, vec2 uv) {
    return all(greaterThanEqual(uv, list.lo - list.margin)) && all(lessThanEqual(uv, list.hi + list.margin));
}

// Winding number of a point in a list's box; 0 for NaN.
int exact_winding_in(ExactList list, vec2 uv) {
    int winding = list.winding;
    bool more = true;
    for (uint i = list.first; more; ++i) {
        ExactArc arc = exact_arc_at(i);
        winding += arc_winding(arc, uv.y, arc_right(arc, uv));
        more = (arc.shape & ARC_LAST) == 0u;
    }
    return is_number(uv) ? winding : 0;
}

// Winding number of the face's loops around uv; 0 for NaN.
int exact_winding(uint face, vec2 uv) {
    return is_number(uv) ? exact_winding_in(exact_list(face, uv), uv) : 0;
}

#endif
