//! A page whose tables are made from files of results.

use super::results::Results;
use super::run::root;
use std::fs;
use std::path::PathBuf;

/// The tables of a page with their names, in no order.
type NamedTables = Vec<(&'static str, String)>;

/// A page, its files of results, and the tables that are made of them.
pub struct FigurePage {
    page: &'static str,
    folder: &'static str,
    names: &'static [&'static str],
    tables: fn(&RecordedResults) -> Result<NamedTables, String>,
}

impl FigurePage {
    /// Describes a page. Paths start at the root of the repository; `names` are those of the files in `folder`, without
    /// `.csv`.
    pub const fn new(
        page: &'static str,
        folder: &'static str,
        names: &'static [&'static str],
        tables: fn(&RecordedResults) -> Result<NamedTables, String>,
    ) -> Self {
        Self { page, folder, names, tables }
    }

    /// Returns the path of the page.
    pub fn path(&self) -> PathBuf {
        root().join(self.page)
    }

    /// Returns the folder with the files of results.
    pub fn folder(&self) -> PathBuf {
        root().join(self.folder)
    }

    /// Returns the path of the file of results with this name.
    pub fn file(&self, name: &str) -> PathBuf {
        self.folder().join(name).with_extension("csv")
    }

    /// Returns the names of the files of results.
    pub fn names(&self) -> &'static [&'static str] {
        self.names
    }

    /// Returns the paths, from the root of the repository, that a recorded run replaces.
    pub fn outputs(&self) -> [&'static str; 2] {
        [self.folder, self.page]
    }

    /// Reads all files of results.
    pub fn read(&self) -> Result<RecordedResults, String> {
        let read = |name: &&'static str| Ok((*name, Results::read(&self.file(name))?));
        Ok(RecordedResults(self.names.iter().map(read).collect::<Result<_, String>>()?))
    }

    /// Returns `text` with the tables of `recorded` between each `<!-- table: NAME -->` and `<!-- end -->`.
    ///
    /// Fails if the text has a marker without a table, or lacks one of the tables.
    pub fn render(&self, recorded: &RecordedResults, text: &str) -> Result<String, String> {
        let mut tables = (self.tables)(recorded)?;
        let (mut made, mut rest) = (String::new(), text);
        while let Some((before, after)) = rest.split_once("<!-- table: ") {
            let (name, after) = after.split_once(" -->").ok_or("a marker without an end")?;
            let (_, after) =
                after.split_once("<!-- end -->").ok_or_else(|| format!("the table {name} has no end"))?;
            let index = tables.iter().position(|(other, _)| *other == name);
            let (_, table) = tables.remove(index.ok_or_else(|| format!("there is no table {name}"))?);
            made += &format!("{before}<!-- table: {name} -->\n{}\n<!-- end -->", table.trim_end());
            rest = after;
        }
        match tables.first() {
            Some((name, _)) => Err(format!("the page does not show the table {name}")),
            None => Ok(made + rest),
        }
    }

    /// Writes the tables of the page.
    pub fn update(&self) -> Result<(), String> {
        let failed = |error| format!("{}: {error}", self.page);
        let text = fs::read_to_string(self.path()).map_err(failed)?;
        let made = self.render(&self.read()?, &text)?;
        fs::write(self.path(), made).map_err(failed)
    }
}

/// The files of results of a page, with their names.
pub struct RecordedResults(Vec<(&'static str, Results)>);

impl RecordedResults {
    /// Returns the results in the file `name`.
    ///
    /// # Panics
    /// If the page has no such file.
    pub fn of(&self, name: &str) -> &Results {
        let found = self.0.iter().find(|(other, _)| *other == name);
        &found.unwrap_or_else(|| panic!("the page has no file {name}")).1
    }

    /// Returns all files with their names.
    pub fn files(&self) -> impl Iterator<Item = (&'static str, &Results)> {
        self.0.iter().map(|(name, results)| (*name, results))
    }

    /// Checks that each file names its machine, commit and command, was recorded, and has rows.
    ///
    /// # Panics
    /// If one does not.
    pub fn assert_origins(&self) {
        for (name, results) in self.files() {
            for about in ["machine", "commit", "command", "priority", "rust"] {
                assert!(!["", "unknown"].contains(&results.about(about)), "{name}.csv has no {about}");
            }
            assert!(results.about("command").contains("-- --record"), "{name}.csv was not recorded");
            assert!(!results.rows.is_empty(), "{name}.csv has no rows");
        }
    }
}

/// Returns a number with a measured unit that occurs in a page outside its tables: a figure that no bench writes again.
pub fn typed_figure(page: &str) -> Option<String> {
    let outside = |part: &str| {
        let words: Vec<&str> =
            part.split("<!-- table: ").next().unwrap_or_default().split_whitespace().collect();
        let is_number = |word: &str| word.starts_with(|first: char| first.is_ascii_digit());
        let is_unit = |word: &str| {
            let word =
                word.trim_end_matches(|last: char| !last.is_alphanumeric() && last != '×' && last != '%');
            ["ns", "µs", "ms", "s", "×", "bytes", "KB", "MB", "GB", "instructions", "%"].contains(&word)
        };
        let pair = |pair: &[&str]| (is_number(pair[0]) && is_unit(pair[1])).then(|| pair.join(" "));
        words.windows(2).find_map(pair)
    };
    page.split("<!-- end -->").find_map(outside)
}
