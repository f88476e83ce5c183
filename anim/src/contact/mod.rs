//! Contacts of feet with the ground: detection, slide, and locking.
//!
//! | function | result |
//! |---|---|
//! | [`detect_contacts`] | the intervals in which bones are in contact with the ground |
//! | [`contact_slide`], [`take_slide`] | how far bones slide while they are in contact |
//! | [`SlideMeter`] | the contact that slides fastest, measured in steps |
//! | [`lock_contacts`] | a take in which they do not slide |
//! | [`hold_contacts`] | a changed take in which they stay where they were before the change |
//! | [`ContactTrack`] | the contacts of a take: edited, retimed, cut and mirrored with it |
//!
//! A contact is the same [`Contact`] that key reduction respects, so detected contacts can be given to
//! [`crate::reduce::Contacts::given`]. Detection reads a take sampled at its frame rate ([`crate::frames`]). Contacts are
//! measured in scene space: a figure that walks on the spot has no contact, because its feet slide as fast as it
//! walks; give it back its root motion first ([`crate::motion`]).

mod detect;
mod feet;
mod lock;
mod meter;
mod slide;
mod track;

pub use crate::reduce::Contact;
pub use detect::{ContactThresholds, detect_contacts};
pub use feet::{feet_by_name, limb_of};
pub(crate) use lock::lock_planted;
pub use lock::{LockError, LockSettings, LockedTake, hold_contacts, lock_contacts};
pub use meter::{SlideMeter, SlideSpeed};
pub use slide::{ContactSlide, TakeSlide, contact_slide, take_slide};
pub use track::ContactTrack;
