//! The format of a movie, from the option or from the name of its file.

use super::super::Failure;
use dragonfly_movie::{MOVIE_FORMATS, MovieFormat, SequenceName, movie_format};
use std::path::Path;

/// Returns whether a path means standard output.
pub(super) fn is_stdout(path: &Path) -> bool {
    path == Path::new("-")
}

/// Returns the format called `name`, or else the one of the output.
///
/// # Errors
///
/// No format has its extension; or the name has no place for the number of a frame and the format one frame.
pub(super) fn format_of(name: Option<&str>, output: &Path) -> Result<&'static MovieFormat, Failure> {
    let format = match name {
        Some(name) => movie_format(name),
        None if is_stdout(output) => movie_format("y4m"),
        None => by_extension(output),
    };
    let format = format.ok_or_else(|| {
        let extensions: Vec<String> =
            MOVIE_FORMATS.iter().flat_map(|format| format.extensions).map(|one| format!(".{one}")).collect();
        let reason = format!("no format has this extension; use {}, or --format", extensions.join(", "));
        Failure::input(output.display(), reason)
    })?;
    if format.is_sequence && !is_stdout(output) && SequenceName::parse(output).is_none() {
        return Err(Failure::input(output.display(), "is not the name of a file"));
    }
    Ok(format)
}

/// Returns the format whose first extension is that of the path, or else one that has it too.
fn by_extension(path: &Path) -> Option<&'static MovieFormat> {
    let extension = path.extension()?.to_str()?.to_lowercase();
    let first = |format: &&MovieFormat| format.extensions.first() == Some(&extension.as_str());
    let any = |format: &&MovieFormat| format.extensions.contains(&extension.as_str());
    MOVIE_FORMATS.iter().find(first).or_else(|| MOVIE_FORMATS.iter().find(any))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_format_follows_from_the_name_of_the_file() {
        let name = |output: &str| format_of(None, Path::new(output)).map(|format| format.name).ok();
        assert_eq!(name("a/out.GIF"), Some("gif"));
        assert_eq!(name("f.####.png"), Some("png"));
        assert_eq!(name("f.apng"), Some("apng"));
        assert_eq!(name("f.exr"), Some("exr"));
        assert_eq!(name("-"), Some("y4m"));
        assert_eq!([name("out.mov"), name("out"), name("")], [None; 3]);
        assert_eq!(
            format_of(Some("webp"), Path::new("out.bin")).map(|format| format.name).ok(),
            Some("webp")
        );
    }
}
