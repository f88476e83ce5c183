//! Helpers shared by the tests of all crates. Small on purpose: a test should show what it does.
//!
//! The features `store`, `document` and `picture` add the helpers that need those crates, so that the tests of a
//! crate build without the crates above it.

pub mod counting;
mod eventually;
pub mod figures;
pub mod folder;
pub mod load;
#[cfg(unix)]
pub mod mounted;
pub mod mutate;
#[cfg(unix)]
pub mod power;
pub mod process;
pub mod random;
pub mod skip;
#[cfg(unix)]
pub mod slurm;
pub mod writer;

#[cfg(feature = "document")]
pub mod document;
#[cfg(feature = "picture")]
pub mod picture;
#[cfg(feature = "store")]
pub mod store;

pub use eventually::eventually;
