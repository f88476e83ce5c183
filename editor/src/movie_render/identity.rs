//! The identity of what a movie shows: parts of a movie with different ones are not joined, and are not kept when it is resumed.

use dragonfly_store::hash;

/// Returns the identity of a movie: a hash of the content of its files, of every setting that changes a frame, as a text, and of the version of this
/// program.
pub fn movie_tag(content: u64, settings: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!("{version} {:016x}", hash(format!("{version}\n{content:016x}\n{settings}").as_bytes()))
}
