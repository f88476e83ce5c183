//! The `.bvh` format: motions read as other programs read them, and saved number by number.

mod agreement;
mod damage;
mod import;
pub(crate) mod made;
pub(crate) mod rate;
mod roots;
mod save;
mod save_random;
mod whole;
