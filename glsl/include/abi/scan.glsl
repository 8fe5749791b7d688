// Push constants of the prefix sum: twin of src/abi/scan.rs.

struct ScanParams {
    uint count;        // elements, or the most that counts[count_index] may be
    uint count_index;
    uint total_index;
};
