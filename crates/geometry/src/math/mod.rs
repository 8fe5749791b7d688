//! Numbers with no geometry: exact signs, the roots of polynomials, eigenvectors.
//!
//! ```text
//!   orientation ── on which side of a line is a point?     exact sign
//!   banded      ── A x = b, A narrow                      LU with row exchanges, linear time
//!   octahedral  ── which way, in 32 bits?                 octahedron unfolded to a square
//!   eigen       ── along which axes is a quadric?         rotations of Jacobi
//!   bernstein   ── where does a polynomial change sign?    isolation by sign variations
//!   root        ── one root in a bracket                   false position, never slower than bisection
//!   gauss       ── what is the integral?                  a rule, halved until it agrees
//!   golden      ── where is one valley lowest?          golden section, one value a step
//!   random      ── which test case?                       the same sequence everywhere
//! ```

pub mod banded;
pub mod bernstein;
pub mod eigen;
pub mod gauss;
pub mod golden;
pub mod octahedral;
pub mod orientation;
pub mod random;
pub mod root;
