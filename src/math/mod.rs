//! Numbers with no geometry: exact signs and the roots of polynomials.
//!
//! ```text
//!   orientation ── on which side of a line is a point?     exact sign
//!   banded      ── A x = b, A narrow                      LU with row exchanges, linear time
//!   bernstein   ── where does a polynomial change sign?    isolation by sign variations
//!   root        ── one root in a bracket                   false position, never slower than bisection
//! ```

pub mod banded;
pub mod bernstein;
pub mod orientation;
pub mod root;
