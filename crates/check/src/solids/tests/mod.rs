//! Solids along lines, against closed forms.

mod hard;
mod identities;
mod shapes;
mod volumes;
