// The mesh of a boundary operand's triangle. Needs boundary_operands.glsl, and `OperandMesh operand_meshes[]` in the
// order of the triangles.
#ifndef TRIANGLE_MESH_GLSL
#define TRIANGLE_MESH_GLSL

OperandMesh mesh_of(uint triangle) {
    uint from = 0u;
    uint end = uint(operand_meshes.length());
    while (end - from > 1u) {
        uint middle = (from + end) / 2u;
        if (operand_meshes[middle].first_triangle <= triangle) from = middle;
        else end = middle;
    }
    return operand_meshes[from];
}

#endif
