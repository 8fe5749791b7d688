// Pass `gap_fill`: decides the visible face of each gap candidate. One thread a pixel. The trim test is that of one way
// (trim.glsl).
//
//   list ──▶ situation ──gather──▶ evidence ──decide──▶ list
//            gap_gather.glsl        gap_decide.glsl
//
// The decision goes into the list, and pass `gap_write` writes it to the pixel. So neighbours show what was drawn, and
// the order of threads does not matter.
#include "scene.glsl"
#include "view.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 7, rg32ui) readonly uniform uimage2D visibility;
layout(scalar, binding = 8) buffer GapCandidates { GapCandidate candidates[]; };
layout(scalar, binding = 9) readonly buffer Bands { GapBand band_list; };
layout(binding = 11, rg32ui) readonly uniform uimage2D meshes_and_solids;
layout(scalar, binding = 12) readonly buffer MeshInstances { MeshInstance mesh_instances[]; };
layout(scalar, binding = 13) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 14) readonly buffer Positions { vec3 positions[]; };

#define TRIM_BINDING 15
#include "trim.glsl"
#ifdef WITHIN_VOLUME
#define VOLUME_BINDING (TRIM_BINDING + TRIM_BUFFERS)
#include "volume.glsl"
#endif
#include "facet.glsl"
#include "facing.glsl"
#define INSTANCES_BINDING 10
#include "placed.glsl"
#include "patch.glsl"
#include "patch_place.glsl"
#include "refine.glsl"
#include "gap_radius.glsl"
#include "visible.glsl"
#include "face_point.glsl"
#include "gap_candidate.glsl"
#include "gap_decide.glsl"
#include "gap_surface.glsl"
#include "gap_gather.glsl"

void main() {
    uint n = thread_number();
    if (n >= min(band_list.count, frame.gap_candidate_capacity)) return;
    uint listed = candidates[n].pixel;
    ivec2 at = candidate_pixel(listed);
    vec2 pixel = vec2(at) + 0.5;
    bool within = (listed & (BORDER_BEFORE | BACK_BEHIND_BORDER)) != 0u && among_backs(at);
    uvec2 seen = imageLoad(visibility, at).xy;
    bool marked = (seen.x & GAP_CANDIDATE) != 0u;
    bool front = !marked && (listed & (BORDER_BEFORE | FRONT_BETWEEN_BACKS)) == FRONT_BETWEEN_BACKS;
    if (front && !within) {
        candidates[n].word = seen;
        return;
    }
    Situation situation = situation_at(listed, at, pixel, within);
    Evidence evidence = gather(situation, at, pixel, within);
    candidates[n].word = decide(situation, evidence, pixel);
}
