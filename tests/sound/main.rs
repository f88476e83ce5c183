//! Promises of the sound crate: what is decoded, mixed and played is what the files and the script say.

mod damage;
mod decode;
mod mix;
mod voice;
