// From part coordinates to the picture. Twin of src/twin/view.rs.
//
// Each placed part has four rows (X, Y, D, W): pixel = (X, Y) / W, D = depth along the view axis.
#ifndef VIEW_GLSL
#define VIEW_GLSL

struct View {
    vec4 x;
    vec4 y;
    vec4 depth;
    vec4 w;
};

// A dot product with fixed rounding: every pipeline that draws a shared vertex gets the same bits, and so does the
// twin.
float row_times(vec4 row, vec4 p) {
    precise float sum = row.x * p.x + row.y * p.y + row.z * p.z + row.w * p.w;
    return sum;
}

vec4 to_pixel(View view, vec4 p) {
    return vec4(row_times(view.x, p), row_times(view.y, p), row_times(view.depth, p), row_times(view.w, p));
}

// Reversed depth, times `w` in a perspective view: 1 at the near plane, 0 at the far one. Floats are densest near 0,
// where perspective needs them.
float reversed_depth(Frame frame, float depth) {
    float range = 1.0 / (frame.far - frame.near);
    return (frame.far - depth) * range * (frame.perspective != 0u ? frame.near : 1.0);
}

// Clip coordinates of a homogeneous pixel.
vec4 to_clip(Frame frame, vec4 q) {
    precise vec2 xy = q.xy * 2.0 / frame.size - q.w; // as in `row_times`
    return vec4(xy, reversed_depth(frame, q.z), q.w);
}

// In a parallel view depth continues beyond the far plane, to this many times its distance from the near one.
const float RUN = 16.0;

// The same without the far plane.
vec4 to_clip_unending(Frame frame, vec4 q) {
    float z = frame.perspective != 0u ? frame.near : 1.0 - (q.z - frame.near) / (RUN * (frame.far - frame.near));
    return vec4(q.xy * 2.0 / frame.size - q.w, z, q.w);
}

// A box in the picture.
struct Seen {
    float w;     // smallest in front of the near plane, 1 in a parallel view; negative if no part is visible
    float slant; // largest stretch of a pixel towards its corners, at most the picture's
    vec2 low;    // its pixels
    vec2 high;
};

// Projects the box `lo` to `hi`; `margin` widens the picture, in pixels; `far` is the far plane's depth.
Seen see(View view, Frame frame, vec3 lo, vec3 hi, float margin, float far) {
    Seen seen = Seen(3.0e38, 0.0, vec2(3.0e38), vec2(-3.0e38));
    float steepest = 0.0; // squared slope
    uint outside = 63u;
    for (uint i = 0u; i < 8u; ++i) {
        vec3 c = vec3((i & 1u) == 0u ? lo.x : hi.x, (i & 2u) == 0u ? lo.y : hi.y, (i & 4u) == 0u ? lo.z : hi.z);
        vec4 q = to_pixel(view, vec4(c, 1.0));
        seen.w = min(seen.w, q.w);
        precise vec2 pixel = q.xy / q.w;
        seen.low = min(seen.low, pixel);
        seen.high = max(seen.high, pixel);
        precise vec2 slope = (pixel - frame.principal_px) / frame.focal_px;
        precise float slope2 = slope.x * slope.x + slope.y * slope.y;
        steepest = max(steepest, slope2);
        precise vec2 below = q.xy + margin * q.w;                 // negative left of and above the picture
        precise vec2 above = q.xy - (frame.size + margin) * q.w;  // positive right of and below it
        uint here = 0u;
        here |= below.x < 0.0 ? 1u : 0u;
        here |= above.x > 0.0 ? 2u : 0u;
        here |= below.y < 0.0 ? 4u : 0u;
        here |= above.y > 0.0 ? 8u : 0u;
        here |= q.z < frame.near ? 16u : 0u;
        here |= q.z > far ? 32u : 0u;
        outside &= here;
    }
    if (outside != 0u) return Seen(-1.0, 0.0, vec2(0.0), vec2(0.0));
    if (frame.perspective == 0u) return Seen(1.0, 1.0, seen.low, seen.high);
    if (seen.w < frame.near) return Seen(frame.near, frame.slant, vec2(-3.0e38), vec2(3.0e38));
    precise float slant = sqrt(1.0 + steepest);
    seen.slant = min(slant, frame.slant);
    return seen;
}

// Rounding of the sums below, relative to the magnitudes of their terms.
const float SLAB_ROUNDING = 1e-5;

// A lower bound of W for the part of a slab of points that a perspective picture, `margin` pixels wider, shows:
//
//            ╱      ╱              low <= n . p <= high,   n = a x + b y + c w  in rows of the view (their xyz)
//     eye   ╱ slab ╱
//      •───╱─▶    ╱       =>       n . p - n . eye = W (a X/W + b Y/W + c),  largest in a corner of the picture
//         ╱      ╱
//
// 0 if the eye is in the slab. A box around the eye gives no bound, but the slab around a curved piece of surface is as
// thin as the piece is flat.
float nearest_in_slab(View view, Frame frame, vec3 n, float low, float high, float margin) {
    vec3 x = view.x.xyz;
    vec3 y = view.y.xyz;
    vec3 w = view.w.xyz;
    precise vec3 yw = y.yzx * w.zxy - y.zxy * w.yzx;
    precise vec3 wx = w.yzx * x.zxy - w.zxy * x.yzx;
    precise vec3 xy = x.yzx * y.zxy - x.zxy * y.yzx;
    precise float det = x.x * yw.x + x.y * yw.y + x.z * yw.z;
    precise float a = (n.x * yw.x + n.y * yw.y + n.z * yw.z) / det;
    precise float b = (n.x * wx.x + n.y * wx.y + n.z * wx.z) / det;
    precise float c = (n.x * xy.x + n.y * xy.y + n.z * xy.z) / det;
    precise vec3 eye = vec3(a * view.x.w, b * view.y.w, c * view.w.w); // their sum is -n . eye
    precise float off = eye.x + eye.y + eye.z;
    precise float rounding = SLAB_ROUNDING * (abs(eye.x) + abs(eye.y) + abs(eye.z) + max(abs(low), abs(high)));
    precise float before = low + off - rounding;
    precise float behind = -(high + off) - rounding;
    float gap = max(before, behind);
    if (gap <= 0.0) return 0.0;
    vec2 slope = before > 0.0 ? vec2(a, b) : -vec2(a, b);
    float straight = before > 0.0 ? c : -c;
    vec2 last = frame.size + margin;
    precise vec2 most = max(slope * -margin, slope * last);
    precise float steepest = straight + most.x + most.y;
    precise float slack = SLAB_ROUNDING * (abs(straight) + abs(most.x) + abs(most.y));
    precise float least = gap / (steepest + slack);
    return steepest + slack > 0.0 ? least : 0.0;
}

// Rounding of a vertex' pixel; far above that of single precision for pictures up to 16384 pixels.
const float PIXEL_ROUNDING = 0.015625;

// Whether the centre of a pixel is within `margin` pixels of the box.
bool covers_a_centre(Seen seen, float margin) {
    vec2 reach = vec2(margin + PIXEL_ROUNDING);
    precise vec2 first = ceil(seen.low - reach - 0.5);
    precise vec2 last = floor(seen.high + reach - 0.5);
    return first.x <= last.x && first.y <= last.y;
}

// Most pixels that one part unit of a visible surface covers.
float pixels_per_unit(Frame frame, Instance instance, Seen seen) {
    return frame.focal * seen.slant * instance.scale / seen.w;
}

#endif
