//! The `.bvh` format: motions read as other programs read them, and saved number by number.

mod agreement;
mod damage;
mod import;
pub(crate) mod made;
mod save;
mod save_random;
mod whole;
