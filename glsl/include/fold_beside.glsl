// What pixels around a pixel see of patches, for outlines of curved faces. Needs visible.glsl, in_picture.glsl, images
// `visibility`, `meshes_and_solids` and `operand_uv`, and SOLIDS_HAVE_PATCHES.
#ifndef FOLD_BESIDE_GLSL
#define FOLD_BESIDE_GLSL

// A fold is drawn so far from the centre of the pixel that sees the face.
const float FOLD_REACH_PX = 1.5;

// The pixels around a pixel, by rows; number 4 is itself.
ivec2 beside_pixel(ivec2 at, uint k) { return at + ivec2(k % 3u, k / 3u) - 1; }

// A pixel's patch; x is 0 where it sees none.
uvec2 patch_seen(ivec2 at) {
    if (!is_in_picture(at)) return uvec2(0u);
    uvec2 seen = imageLoad(visibility, at).xy;
    if (SOLIDS_HAVE_PATCHES && sees_nothing(seen.x)) seen = imageLoad(meshes_and_solids, at).xy;
    if (SOLIDS_HAVE_PATCHES && sees_operand(seen.x)) {
        return uvec2(seen_patch_instance(seen.x) + 1u, imageLoad(operand_uv, at).x);
    }
    return sees_nothing(seen.x) || sees_other(seen.x) ? uvec2(0u) : uvec2(seen_patch_instance(seen.x) + 1u, seen.y);
}

#endif
