//! Luna's `.m3d`: three dialects read as the programs of the books read them, and saved row by row.

pub(crate) mod agreement;
mod damage;
mod import;
mod made;
mod save;
mod save_random;
mod whole;
