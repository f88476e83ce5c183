//! Sets and pairs of bones: selected bones, hidden bones, mirror pairs.

mod hidden;
mod hide;
mod mirror;
mod mirror_names;
mod mirror_pair;
mod mirror_place;
mod selection;

pub use hidden::HiddenBones;
pub use mirror::{MirrorPairs, Unpaired};
pub use mirror_pair::{BodySide, MirrorGuess, MirrorPair};
pub use mirror_place::{MirrorPlane, Stance};
pub use selection::{BoneSelection, Choice};
