// Exclusive prefix sums: shared by the three steps. Figure and contract: src/frame/common/scan.rs.

#include "abi/scan.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(constant_id = 22) const bool COUNT_ON_GPU = false;

layout(scalar, binding = 0) readonly buffer Values { uint values[]; };
layout(scalar, binding = 1) buffer Offsets { uint offsets[]; };
layout(scalar, binding = 2) buffer Sums { uint sums[]; };
layout(scalar, binding = 3) buffer Total { uint total[]; };
layout(scalar, binding = 4) readonly buffer Counts { uint counts[]; };
layout(scalar, push_constant) uniform Push { ScanParams params; };

const uint LANES = 64;           // invocations of a workgroup
const uint PER_LANE = 16;        // elements of each
const uint BLOCK = LANES * PER_LANE;

uint element_count() {
    return COUNT_ON_GPU ? min(counts[params.count_index], params.count) : params.count;
}

uint block_count() {
    uint count = element_count();
    return count / BLOCK + uint(count % BLOCK != 0);
}

shared uint lane_sums[LANES];

// Sum of `sum` over the lanes before this one; `block_sum` over all (Hillis and Steele: each step adds the value twice
// as far back). Every lane of the workgroup must call it.
uint scan_lanes(uint sum, out uint block_sum) {
    uint lane = gl_LocalInvocationIndex;
    lane_sums[lane] = sum;
    barrier();
    for (uint step = 1; step < LANES; step *= 2) {
        uint before = lane >= step ? lane_sums[lane - step] : 0;
        barrier();
        lane_sums[lane] += before;
        barrier();
    }
    block_sum = lane_sums[LANES - 1];
    uint before = lane_sums[lane] - sum;
    barrier();   // the next call writes lane_sums
    return before;
}
