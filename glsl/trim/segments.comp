#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `segments`: linear segments of each trim curve. One thread a curve of a placed face.
//
// Enough that the chords deviate by at most chord_px on the screen, and that one segment crosses at
// most LINES_PER_SEGMENT scan lines, so that the threads of pass `cross` have equal work.
// Twin: src/twin/segments.rs.
#include "scene.glsl"

// Strips of some face have several bins.
layout(constant_id = 1) const bool SCENE_HAS_BINS = false;

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1) uniform usamplerBuffer face_instances;
layout(binding = 2) uniform usamplerBuffer faces;
layout(binding = 3) uniform usamplerBuffer curves;
layout(binding = 4) uniform usamplerBuffer curve_instances; // the placed face of each
layout(binding = 5) uniform usamplerBuffer strip_starts;
layout(scalar, binding = 6) readonly buffer FaceSpeeds { uint face_speeds[]; };
layout(scalar, binding = 7) writeonly buffer SegmentCounts { uint segment_counts[]; };
layout(scalar, binding = 8) readonly buffer SeenBins { uint seen_bins[]; }; // with SCENE_HAS_BINS

#include "u_bins.glsl"
#include "curves.glsl"
#include "faces.glsl"
#include "words.glsl"

const uint LINES_PER_SEGMENT = 32u;
const float MAX_SEGMENTS = 65536.0;

uint first_row(uint bin_instance) { return word_at(strip_starts, bin_instance); }

// Scan lines of those strips from `lo` to `hi` that have a visible bin between the curve's lowest u and its loop's
// highest. A loop left of all visible bins adds nothing to winding numbers there.
uint lines_of(FaceInstance fi, uint bins, uint lo, uint hi, Curve curve) {
    if (!SCENE_HAS_BINS) return first_row(fi.first_bin + hi + 1u) - first_row(fi.first_bin + lo);
    uint from = bin_of(curve.range_u.x, bins);
    uint to = bin_of(curve.range_u.y, bins);
    uint lines = 0u;
    for (uint strip = lo; strip <= hi; ++strip) {
        uint bin_instance = fi.first_bin + strip * bins;
        uvec2 seen = seen_range(seen_bins[bin_instance]);
        if (from >= seen.x + seen.y || to < seen.x) continue;
        lines += (first_row(bin_instance + 1u) - first_row(bin_instance)) / seen.y;
    }
    return lines;
}

void main() {
    uint curve_instance = thread_number();
    if (curve_instance >= frame.curve_count) return;
    uint placed = word_at(curve_instances, curve_instance);
    FaceInstance fi = face_instance_at(placed);
    Face face = face_at(fi.face);
    Curve curve = curve_at(face.first_curve + curve_instance - fi.first_curve);
    float strips = float(strip_count(face.strips));
    uint lo = uint(clamp(floor(curve.range_v.x * strips), 0.0, strips - 1.0));
    uint hi = uint(clamp(floor(curve.range_v.y * strips), 0.0, strips - 1.0));
    uint lines = lines_of(fi, bin_count(face.strips), lo, hi, curve);
    if (lines == 0u) {
        segment_counts[curve_instance] = 0u;
        return;
    }
    vec2 speed = vec2(uintBitsToFloat(face_speeds[2u * placed]), uintBitsToFloat(face_speeds[2u * placed + 1u]));
    precise float deviation = curve.bend.x * speed.x + curve.bend.y * speed.y; // pixels, of one chord
    float for_chords = ceil(sqrt(deviation / frame.chord_px));
    float for_lines = float((lines + LINES_PER_SEGMENT - 1u) / LINES_PER_SEGMENT);
    segment_counts[curve_instance] = uint(clamp(max(for_chords, for_lines), 1.0, MAX_SEGMENTS));
}
