//! Inverse kinematics: from the desired position of a hand or a foot, or the point to look at, to the rotations that
//! reach it.
//!
//! Every solver changes rotations of poses relative to the parents and nothing else, so bones keep their lengths;
//! [`place_feet`] also moves the hips. Targets are in to-root (model) space. Of the matrices a solver reads only that
//! of the parent of its first bone; everything below follows from the poses. After a solve the caller chains the poses
//! again with [`crate::animation::to_root()`].
//!
//! | solver | bones | method |
//! |---|---|---|
//! | [`two_bone`] | upper and lower part of a limb | law of cosines, exact in one step |
//! | [`chain`] | any number of consecutive bones | FABRIK, finished in closed form; with joint limits damped least squares after it |
//! | [`line_of_action`] | any number of consecutive bones | directions of the parts of a stroke, by arc length |
//! | [`look_at`] | several bones of a chain, each with a share | turns towards the target from the first bone to the last |
//! | [`place_feet`] | hips and legs | lowers the hips, then [`two_bone`] for each leg |
//!
//! # Common rules
//!
//! * Solvers are total: no input makes them panic or write a number that is not finite. Where there is no solution they
//!   return an [`IkError`] and leave the poses as they were.
//! * A weight of zero (or below, or NaN) changes nothing, bit for bit; a weight above one counts as one.
//! * Parents may be scaled differently per axis, or mirrored: the problem is transformed into the space of the parent
//!   of the first bone, where its lengths do not change when it turns, and the solution is valid in to-root space
//!   again.
//! * They allocate nothing, except that a [`ChainScratch`] grows to the longest chain it has been used for; [`line_of_action`], which runs once a stroke,
//!   allocates.
//! * The same input gives the same output.

mod chain;
mod error;
mod fabrik;
mod foot;
mod limited;
mod line_of_action;
mod look_at;
mod path;
pub(crate) mod turn;
mod two_bone;

pub use chain::{Chain, ChainScratch, Limit, chain};
pub use error::{IkError, Reach};
pub use foot::{Feet, Ground, Leg, place_feet};
pub use line_of_action::{ActionLine, line_of_action};
pub use look_at::{Gaze, LookAt, look_at};
pub use two_bone::{EndOrientation, Pole, TwoBone, soft_distance, two_bone};
