//! Other people's ways, next to ours: for measurements and tests, not for frames.
//!
//! | module | rival of |
//! |---|---|
//! | [`slefe`], [`factors`] | pass `bound`: how finely a patch is divided |

pub mod factors;
pub mod slefe;
