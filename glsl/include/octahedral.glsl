// Directions as two 16-bit numbers: points of the octahedron |x| + |y| + |z| = 1, unfolded to a square. Source: Z. H.
// Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, JCGT 3 (2), 2014. Twin of
// crates/geometry/src/math/octahedral.rs.
#ifndef OCTAHEDRAL_GLSL
#define OCTAHEDRAL_GLSL

// A point of the octahedron, not a unit vector.
vec3 octahedral(uint word) {
    precise vec2 e = vec2(ivec2(word << 16, word) >> 16) / 32767.0;
    precise float z = 1.0 - abs(e.x) - abs(e.y);
    precise vec2 folded = (1.0 - abs(e.yx)) * mix(vec2(1.0), vec2(-1.0), lessThan(e, vec2(0.0)));
    return vec3(z < 0.0 ? folded : e, z);
}

#endif
