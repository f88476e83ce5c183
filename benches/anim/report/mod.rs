//! Makes the tables of `anim/README.md` from the files of results, and from nothing else.
//!
//! The bench writes the files and the page; a test makes the page again and compares.

pub(crate) mod results;
mod tables;

use results::Results;
use std::path::{Path, PathBuf};

/// The files of results.
pub(crate) struct RecordedResults {
    /// Times, from `cargo bench -p dragonfly-anim -- --record`.
    pub(crate) times: Results,
    /// Sizes and errors of compressed takes, from the same run.
    pub(crate) sizes: Results,
    /// Instructions, from `benches/anim/instructions --record`.
    pub(crate) instructions: Results,
}

/// Returns the root of the repository.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Returns the file of results with this name: `times`, `sizes`, `instructions`.
pub(crate) fn file(name: &str) -> PathBuf {
    root().join("benches/anim/results").join(name).with_extension("csv")
}

/// Returns the page with the tables.
pub(crate) fn page() -> PathBuf {
    root().join("anim/README.md")
}

impl RecordedResults {
    /// Reads the three files.
    pub(crate) fn read() -> Result<Self, String> {
        let read = |name| Results::read(&file(name));
        Ok(Self { times: read("times")?, sizes: read("sizes")?, instructions: read("instructions")? })
    }
}

/// Returns `page` with the text between each `<!-- table: NAME -->` and `<!-- end -->` made from the results.
///
/// Fails if the page has a marker without a table, or lacks one of the tables.
pub(crate) fn render(recorded: &RecordedResults, page: &str) -> Result<String, String> {
    let mut tables = tables::all(recorded)?;
    let (mut text, mut rest) = (String::new(), page);
    while let Some((before, after)) = rest.split_once("<!-- table: ") {
        let (name, after) = after.split_once(" -->").ok_or("a marker without an end")?;
        let (_, after) =
            after.split_once("<!-- end -->").ok_or_else(|| format!("the table {name} has no end"))?;
        let index = tables.iter().position(|(other, _)| *other == name);
        let (_, table) = tables.remove(index.ok_or_else(|| format!("there is no table {name}"))?);
        text += &format!("{before}<!-- table: {name} -->\n{}\n<!-- end -->", table.trim_end());
        rest = after;
    }
    match tables.first() {
        Some((name, _)) => Err(format!("the page does not show the table {name}")),
        None => Ok(text + rest),
    }
}

/// Writes the tables of the page.
#[allow(dead_code, reason = "the test that shares this file only compares")]
pub(crate) fn update() -> Result<(), String> {
    let text = std::fs::read_to_string(page()).map_err(|error| format!("anim/README.md: {error}"))?;
    let made = render(&RecordedResults::read()?, &text)?;
    std::fs::write(page(), made).map_err(|error| format!("anim/README.md: {error}"))
}
