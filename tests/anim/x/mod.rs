//! The `.x` format in its four encodings: read as other programs read it, and its text saved key by key.

mod agreement;
mod damage;
mod import;
mod made;
mod save;
mod save_random;
mod whole;
