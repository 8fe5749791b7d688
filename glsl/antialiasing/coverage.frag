#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `coverage`: pixels that a trimmed face covers in part get the colours of what else they see.
//
//     ┌─────────┐   the face of a neighbour, in front of what is seen here:  its share, of the neighbour's colour
//     │  ╱ own  │   the face that is seen here:                              its share
//     │ ╱   ·   │
//     │╱ beyond │   the face of a neighbour, behind it, that begins where it ends:  its share
//     └─────────┘   what none of them covers:                                the colour of the pixel beyond the border
// Two faces that meet here both know the border, and each covers what the other leaves.
//
// A face covers what its trim curves say: the exact area of the pixel inside them (coverage.glsl). Only pixels beside
// another face, or another thing, are looked at; what ends without a trim curve (silhouettes of curved faces, meshes,
// Boolean solids) stays as it is. What is seen at a pixel's centre does not change.
#include "scene.glsl"
#include "view.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 7, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 8, rgba32f) readonly uniform image2D resolved; // linear colour, depth; UNSEEN where nothing is

#define EXACT_BINDING 9
#include "exact.glsl"
#include "coverage.glsl"
#include "mean.glsl"
#include "placed.glsl"
#include "patch.glsl"
#include "refine.glsl"
#include "gap_radius.glsl"
#include "visible.glsl"
#include "on_pixel.glsl"
#include "unmixed.glsl"

// Relative depth within which faces touch.
const float TOUCHES = 1e-5;
// Two points of a face are on one sheet of it when they are this near: else a seam runs between the pixels.
const float SAME_SHEET_PX = 4.0;
// Faces beside a pixel.
const uint MOST_FACES = 4u;

// How a face lies at a pixel.
struct Covering {
    bool known;
    float depth;
    vec2 uv; // of the face
    mat2 along;
    Cover cover;
};

// Placed face + 1 of a pixel that sees a patch, else 0.
uint placed_face(uvec2 seen) {
    return sees_nothing(seen.x) ? 0u : face_instance_of(seen_patch_instance(seen.x)) + 1u;
}

vec2 face_uv(Patch patch_, vec2 uv) { return patch_.domain.xy + uv * patch_.domain.zw; }

// The face that is seen somewhere, at a pixel near that.
Covering covering(uvec2 seen, vec2 pixel) {
    uint patch_instance = seen_patch_instance(seen.x);
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    Covering c = Covering(false, UNSEEN, vec2(0.0), mat2(1.0), Cover(1.0, vec2(0.0), false));
    if ((face.flags & FACE_TRIMMED) == 0u) return c;
    Patch patch_ = patch_at(face.first_patch + patch_instance - fi.first_patch_instance);
    View view = view_at(fi.instance);
    Sample s = refine(patch_, view, unpack_uv(seen.y), pixel);
    mat2 along = pixels_along(s, view);
    c.along = mat2(along[0] / patch_.domain.z, along[1] / patch_.domain.w);
    c.known = length(s.miss) <= ON_PIXEL_PX && determinant(c.along) != 0.0;
    if (!c.known) return c;
    c.depth = s.q.z;
    c.uv = face_uv(patch_, s.uv);
    c.cover = exact_cover(fi.face, c.uv, c.along);
    return c;
}

// Whether a pixel beside sees the sheet of the face that is seen here: near in the face, and turned to the eye by the
// same side. Beside a fold its two sheets are near each other in the face.
bool on_sheet(uvec2 seen, Covering here) {
    uint patch_instance = seen_patch_instance(seen.x);
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Patch patch_ = patch_at(face_at(fi.face).first_patch + patch_instance - fi.first_patch_instance);
    vec2 uv = unpack_uv(seen.y);
    if (length(here.along * (face_uv(patch_, uv) - here.uv)) >= SAME_SHEET_PX) return false;
    View view = view_at(fi.instance);
    Sample s = sample_at(patch_, net_of(patch_), view, uv, vec2(0.0));
    return determinant(pixels_along(s, view)) * determinant(here.along) >= 0.0;
}

vec4 mixed(ivec2 at, uvec2 own, uint own_face) {
    vec2 pixel = vec2(at) + 0.5;
    float depth = imageLoad(resolved, at).a;
    Covering here = Covering(false, UNSEEN, vec2(0.0), mat2(1.0), Cover(1.0, vec2(0.0), false));
    if (own_face != 0u) here = covering(own, pixel);
    vec4 sum = vec4(0.0);
    float rest = 1.0;
    vec4 next = vec4(0.0); // of faces behind this one
    float next_share = 0.0;
    ivec2 other = at; // sees something else
    uint met[MOST_FACES];
    uint met_count = 0u;
    for (uint k = 0u; k < DIRECTION_COUNT; ++k) {
        ivec2 beside = at + ivec2(sign(DIRECTIONS[k]));
        if (!is_in_picture(beside)) continue;
        uvec2 seen = imageLoad(visibility, beside).xy;
        uint face = placed_face(seen);
        if (face != own_face) other = beside;
        bool known = face == 0u || (face == own_face && (!here.cover.cut || on_sheet(seen, here)));
        for (uint i = 0u; i < met_count; ++i) known = known || met[i] == face;
        if (known || met_count == MOST_FACES) continue;
        met[met_count++] = face;
        Covering there = covering(seen, pixel);
        // one that covers all of it is hidden here, or was not drawn: by a volume that trims the scene
        if (!there.known || !there.cover.cut) continue;
        // at a seam the own face goes on; another sheet of it is as another face
        bool goes_on = face == own_face && abs(there.depth - depth) <= TOUCHES * depth;
        if (!goes_on && !(there.depth < depth * (1.0 + TOUCHES))) {
            // it begins where the face that is seen here ends
            if (!here.cover.cut || dot(there.cover.outward, here.cover.outward) >= 0.0) continue;
            next += there.cover.share * unmixed_at(beside);
            next_share += there.cover.share;
            continue;
        }
        float share = min(there.cover.share, rest);
        sum += share * unmixed_at(beside);
        rest -= share;
    }
    float share = here.cover.cut ? min(here.cover.share, rest) : rest;
    sum += share * unmixed_at(at);
    rest -= share;
    if (next_share > 0.0) {
        share = min(next_share, rest);
        sum += share / next_share * next;
        rest -= share;
    }
    if (rest > 0.0) {
        vec2 outward = here.cover.outward;
        float size = max(abs(outward.x), abs(outward.y));
        ivec2 beyond = at + (size > 0.0 ? ivec2(roundEven(outward / size)) : ivec2(0));
        // a border may leave the picture, and a slit be narrower than a pixel
        if (!is_in_picture(beyond)) beyond = other;
        uvec2 seen = imageLoad(visibility, beyond).xy;
        if (placed_face(seen) == own_face && (!here.cover.cut || on_sheet(seen, here))) beyond = other;
        sum += rest * unmixed_at(beyond);
    }
    return sum;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uvec2 own = imageLoad(visibility, at).xy;
    uint own_face = placed_face(own);
    // what the host drew hides it
    if (frame.background.a < 0.0 && own_face != 0u && imageLoad(resolved, at).a >= UNSEEN) discard;
    bool alone = true;
    for (uint k = 0u; k < DIRECTION_COUNT; ++k) {
        ivec2 beside = at + ivec2(sign(DIRECTIONS[k]));
        if (is_in_picture(beside)) alone = alone && placed_face(imageLoad(visibility, beside).xy) == own_face;
    }
    write_mean(alone ? unmixed_at(at) : mixed(at, own, own_face));
}
