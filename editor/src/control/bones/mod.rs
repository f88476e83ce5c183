//! Choosing bones: by click, by box and lasso, by their neighbours, by their other side.

mod cycle;
mod hidden;
mod mirror;
mod mirror_names;
mod mirror_place;
mod region;
mod selection;
mod skin;

pub use cycle::ClickCycle;
pub use hidden::HiddenBones;
pub use mirror::{MirrorGuess, MirrorPair, MirrorPairs, Side, Unpaired};
pub use mirror_place::{MirrorPlane, Stance};
pub use region::{Lasso, Region, bones_in_region};
pub use selection::{BoneSelection, Choice};
pub use skin::{SkinHit, pick_skin};
