// A coarse map of trim curves: one bit for each cell of the bins of a placed face's strips. Written by pass `cross` in
// scenes with spline operands, read by table.glsl. Twin of src/twin/border_cells.rs.
//
//            128 columns of a bin, a texel of four words
//          ┌─┬─┬─┬─┬─┬─┬─┬─┐
//    band  │ │ │ │█│█│ │ │ │        a chord of the table lies in these cells, or up to half a scan line below or above,
//          ├─┼─┼─┼─┼─┼─┼─┼─┤        since the look-up uses the nearest line. A box without such a cell is inside or
//    band  │ │ │ │ │█│█│ │ │        outside as a whole
//          └─┴─┴─┴─┴─┴─┴─┴─┘
#ifndef BORDER_CELLS_GLSL
#define BORDER_CELLS_GLSL

const uint BORDER_BANDS = 4u;       // in a strip
const float BORDER_COLUMNS = 128.0; // in a band
// Share of a strip: more than the rounding of v times the number of strips, which is at most 2^-24 of 128.
const float BAND_ROUNDING = 1e-4;

// The bits below column `n`.
uvec4 columns_below(int n) {
    ivec4 bits = clamp(ivec4(n) - ivec4(0, 32, 64, 96), 0, 32);
    return mix((uvec4(1u) << (uvec4(bits) & 31u)) - 1u, uvec4(0xffffffffu), equal(bits, ivec4(32)));
}

// The bits of the columns from `lo` to `hi` in u; u beyond the face counts as its outermost column.
uvec4 columns_between(float lo, float hi) {
    int first = int(clamp(floor(lo * BORDER_COLUMNS), 0.0, BORDER_COLUMNS - 1.0));
    int last = int(clamp(floor(hi * BORDER_COLUMNS), 0.0, BORDER_COLUMNS - 1.0));
    return columns_below(last + 1) & ~columns_below(first);
}

#endif
