//! Sets and pairs of bones: which are selected, which are hidden, and which are the left and right of the same limb.

mod hidden;
mod mirror;
mod mirror_names;
mod mirror_place;
mod selection;

pub use hidden::HiddenBones;
pub use mirror::{MirrorGuess, MirrorPair, MirrorPairs, Side, Unpaired};
pub use mirror_place::{MirrorPlane, Stance};
pub use selection::{BoneSelection, Choice};
