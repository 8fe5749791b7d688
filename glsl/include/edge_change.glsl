// Pass `edge_change`: where, between the centres of pixels that lie side by side, what is seen of Boolean solids
// changes to another surface.
//
//      ●───x──●      a pixel's centre, and those to the right and below: where on the way the line goes, and how it
//      │             is drawn; 0: nowhere
//      x
//      ●
//
// Operands without equations have edges of their own, which pass `edge_line` draws. So have faces and meshes that are
// of no solid; where a solid meets one of them, the line is drawn here.
//
// Of solids that are seen through (SEEN_THROUGH), the faces of one number from the eye on are looked at, and by
// themselves the farthest ones in front of what is opaque. Where a ray meets fewer faces than that number, what is
// opaque counts as it does without them. Beside an outline of glass one number is that of another face, without a
// change of either: neither ends near, so there is no line.
#ifndef EDGE_CHANGE_GLSL
#define EDGE_CHANGE_GLSL

#include "scene.glsl"
#include "solids.glsl"
#include "boundary_operands.glsl"
#include "tiles.glsl"
#include "view.glsl"
#include "edges.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(binding = 2) uniform usamplerBuffer leaf_surfaces;
layout(binding = 3) uniform samplerBuffer surfaces;
layout(binding = 4) uniform samplerBuffer surface_places;
layout(binding = 5) uniform usamplerBuffer tile_starts;
layout(binding = 6) uniform usamplerBuffer tile_leaves;
layout(binding = 7, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 8, rg32ui) readonly uniform uimage2D meshes_and_solids; // in scenes without trims the same
layout(scalar, binding = 9) readonly buffer Instances { Instance instances[]; };
layout(scalar, binding = 10) readonly buffer Views { View views[]; };
// of operands that are meshes
layout(scalar, binding = 11) readonly buffer OperandMeshes { OperandMesh operand_meshes[]; };
layout(scalar, binding = 12) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 13) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 14) readonly buffer Planes { uint planes[]; };
// (u, v) of operands that are spline parts
layout(binding = 15, r32ui) readonly uniform uimage2D operand_uv;
layout(scalar, binding = 16) readonly buffer FaceInstances { FaceInstance face_instances[]; };
layout(scalar, binding = 17) readonly buffer Faces { Face faces[]; };
#define PATCHES_BINDING 18
#include "patches.glsl"
layout(scalar, binding = 19) readonly buffer PatchInstances { uint patch_instances[]; };
layout(binding = 20) uniform samplerBuffer points;
// of meshes that are of no solid
layout(scalar, binding = 21) readonly buffer MeshInstances { MeshInstance mesh_instances[]; };
layout(scalar, binding = 22) readonly buffer MeshTriangles { uint mesh_triangles[]; };
layout(scalar, binding = 23) readonly buffer MeshPositions { vec3 mesh_positions[]; };
#ifdef SEEN_THROUGH
layout(binding = 24, rgba32f) readonly uniform image2D layers;
#endif

layout(scalar, push_constant) uniform Push {
    uint drawn;  // LINES_*
    uint lists;  // 0: there are no lists of tiles
    float order; // 1: of two surfaces the nearer one is seen; -1: the farther one
} push;

#include "eye_ray.glsl"
#include "words.glsl"
#include "patch.glsl"
#include "refine.glsl"

#include "visible.glsl"
#include "sides.glsl"
#include "solid_sheet.glsl"
#include "solid_change.glsl"
#include "face_sheet.glsl"
#ifdef SEEN_THROUGH
#include "layer_words.glsl"
#endif

layout(location = 0) out uvec2 out_changes;

// What a pixel sees.
struct PixelSees {
    uvec2 words;
    uint uv;       // of an operand's patch
    bool is_layer; // of a solid that is seen through
};

PixelSees seen_at(ivec2 at) {
#ifdef SEEN_THROUGH
    vec4 packed = imageLoad(layers, at);
    PixelSees layer = PixelSees(uvec2(layer_word(packed), floatBitsToUint(packed.w)), layer_uv(packed), true);
    if (!sees_nothing(layer.words.x)) return layer;
    if (push.order < 0.0) return PixelSees(uvec2(0u), 0u, false);
#endif
    uvec2 seen = imageLoad(visibility, at).xy;
    if (sees_nothing(seen.x)) seen = imageLoad(meshes_and_solids, at).xy;
    return PixelSees(seen, SOLIDS_HAVE_PATCHES ? imageLoad(operand_uv, at).x : 0u, false);
}

bool is_of_solid(uint word) { return sees_solid(word) || SOLIDS_HAVE_PATCHES && sees_operand(word); }

// The tile of the band whose primitives are looked at: the pixel's, or, where that is of another band, this one's.
uint tile_near(ivec2 at) {
    uint row = uint(at.y);
    bool within = row >= frame.band_top && row - frame.band_top < band_rows(frame);
    return tile_in_band(frame, within ? uvec2(at) : uvec2(gl_FragCoord.xy));
}

uint drawn_as(uint style, float share) {
    return style == LINE_NONE ? 0u : style << CHANGE_STYLE | uint(clamp(share, 0.0, 1.0) * CHANGE_SHARES + 0.5);
}

uint style_of(float cosine) {
    bool smooth_ = cosine >= SMOOTH_COSINE;
    if ((push.drawn & LINES_SHARP) == 0u) return LINE_NONE;
    if (!smooth_ || (push.drawn & LINES_SMOOTH_FULL) != 0u) return LINE_FULL;
    return (push.drawn & LINES_SMOOTH) != 0u ? LINE_THIN : LINE_NONE;
}

uint change(ivec2 at, ivec2 beside, PixelSees seen, PixelSees next) {
    bool one = seen.words.x == next.words.x;
    bool of_solid = is_of_solid(seen.words.x) || is_of_solid(next.words.x);
#ifdef SEEN_THROUGH
    // the others are drawn without what is seen through
    of_solid = seen.is_layer || next.is_layer;
#endif
    if (!of_solid) return 0u;
    // a face that is no solid's has edges of its own
    bool other = sees_face(seen.words.x) || sees_face(next.words.x);
    if (one && (SOLIDS_HAVE == SURFACE_PLANE || !sees_solid(seen.words.x))) return 0u;
    vec2 a = vec2(at) + 0.5;
    vec2 b = vec2(beside) + 0.5;
    Sheet sheets[2];
    for (uint k = 0u; k < 2u; ++k) {
        ivec2 pixel = k == 0u ? at : beside;
        uvec2 words = k == 0u ? seen.words : next.words;
        if (sees_face(words.x)) sheets[k] = face_sheet(pixel, words);
        else sheets[k] = sheet_at(pixel, words, k == 0u ? seen.uv : next.uv);
    }
    bool cap = is_cap(sheets[0]) || is_cap(sheets[1]);
    bool both = sheets[0].is_there && sheets[1].is_there;
    if (both && sheets[0].operand != 0u && sheets[0].operand == sheets[1].operand) return 0u;
    // the outline of a section through such an operand is a line of its own, too
    if (both && cap && (sheets[0].operand != 0u || sheets[1].operand != 0u)) return 0u;
    // faces that coincide are one, but caps of two solids
    bool together = both && sheets[0].surface == sheets[1].surface && sheets[0].surface != SPLINE_SHEET;
    if (together && !sheets[0].is_round && (!cap || sheets[0].leaf == sheets[1].leaf)) return 0u;
    if (together && sheets[0].is_round) {
        float ahead = depth_on(sheets[0], b);
        float close = SAME_SHEET_PX * pixel_across(sheets[0].t);
        if (abs(ahead - sheets[1].t) <= close) return 0u;
        // the near side of a torus before its far side
    }
    Change c;
    if (other) c = change_beside_face(sheets, a, b, push.order);
    else c = change_between(sheets, a, b, push.order);
    if (c.why == CHANGE_NONE) return 0u;
    if (together && !sheets[0].is_round) c = Change(CHANGE_END, 0.5, is_cap(sheets[0]), 0.0);
    if (c.why == CHANGE_MEET || c.why == CHANGE_SMOOTH) {
        uint style = style_of(c.cosine);
        if (cap && (push.drawn & LINES_SHARP) != 0u) style = LINE_BOLD;
        return drawn_as(style, c.share);
    }
    Sheet f = sheets[c.first ? 0 : 1];
    // its edges and folds are drawn by themselves
    if (f.operand != 0u || f.face != uvec2(0u)) return 0u;
    uint tries = 1u;
#ifdef SEEN_THROUGH
    if (!(c.first ? seen.is_layer : next.is_layer)) return 0u;
    // it hides no end of the other one
    bool has_other = sheets[c.first ? 1 : 0].operand == 0u;
    if (seen.is_layer && next.is_layer && has_other) tries = 2u;
#endif
    for (uint k = 0u; k < tries; ++k) {
        bool from_a = c.first == (k == 0u);
        f = sheets[from_a ? 0 : 1];
        bool folds = k == 0u && c.why == CHANGE_FOLD;
        float cosine = 0.0;
        bool cut = false;
        float end = 2.0;
        float reach = 1.0; // what is left of the way before a fold
        if (push.lists != 0u) {
            vec2 from = from_a ? a : b;
            vec2 to = from_a ? b : a;
            if (folds) {
                reach = from_a ? c.share : 1.0 - c.share;
                // at the fold itself rounding decides whether the sheet is there
                to = mix(from, to, max(reach - 1.0 / 256.0, 0.0));
            }
            end = end_of(f, from, to, tile_near(from_a ? at : beside), cosine, cut);
        }
        if (end <= 1.0) {
            end *= reach;
            uint style = (cut || is_cap(f)) && (push.drawn & LINES_SHARP) != 0u ? LINE_BOLD : style_of(cosine);
            return drawn_as(style, from_a ? end : 1.0 - end);
        }
        if (folds && (push.drawn & LINES_FOLDS) != 0u) return drawn_as(LINE_FULL, c.share);
    }
    if (c.why == CHANGE_FOLD) return 0u;
#ifdef SEEN_THROUGH
    return 0u; // something else hides it
#endif
    if (other || SOLIDS_HAVE_BOUNDARY_OPERANDS && is_cap(f)) return 0u;
    // something without an equation ends it, somewhere between
    return drawn_as(is_cap(f) && (push.drawn & LINES_SHARP) != 0u ? LINE_BOLD : style_of(0.0), 0.5);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 last = ivec2(frame.size) - 1;
    PixelSees seen = seen_at(at);
    uvec2 found = uvec2(0u);
    for (uint k = 0u; k < 2u; ++k) {
        ivec2 beside = at + ivec2(k == 0u ? 1 : 0, k == 0u ? 0 : 1);
        if (all(lessThanEqual(beside, last))) found[k] = change(at, beside, seen, seen_at(beside));
    }
    out_changes = found;
}

#endif
