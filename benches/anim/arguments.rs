//! The command line of the bench.

use crate::case::BenchCase;

/// Mode of the bench.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum BenchMode {
    /// Prints times, ratios and goals.
    Measure,
    /// As [`Measure`](Self::Measure), and writes all results and the tables of `anim/README.md`.
    Record,
    /// Runs each case once, to test that it works.
    Check,
    /// Runs each case for the counter of instructions.
    Count,
    /// Prints the names of the cases.
    List,
    /// Prints the goals that are numbers of instructions.
    Goals,
    /// Writes the tables of `anim/README.md` from the results of earlier runs.
    Report,
    /// Writes the instructions that the script `instructions` counted.
    Instructions,
}

/// Arguments of the bench.
pub(crate) struct BenchArguments {
    pub(crate) mode: BenchMode,
    /// Folder with the counts of the script `instructions`.
    pub(crate) counts: Option<String>,
    /// Parts of names of cases; empty for all cases.
    parts: Vec<String>,
}

impl BenchArguments {
    /// Reads the arguments. Cargo passes `--bench` for `cargo bench`; without it, as for `cargo test --benches`, each
    /// case is only run once.
    pub(crate) fn read() -> Self {
        let (options, parts): (Vec<String>, Vec<String>) =
            std::env::args().skip(1).partition(|argument| argument.starts_with("--"));
        let has = |option: &str| options.iter().any(|given| given == option);
        let counts =
            options.iter().find_map(|option| option.strip_prefix("--instructions=")).map(str::to_owned);
        let mode = match () {
            () if counts.is_some() => BenchMode::Instructions,
            () if has("--list") => BenchMode::List,
            () if has("--goals") => BenchMode::Goals,
            () if has("--count") => BenchMode::Count,
            () if has("--report") => BenchMode::Report,
            () if has("--test") || !has("--bench") => BenchMode::Check,
            () if has("--record") => BenchMode::Record,
            () => BenchMode::Measure,
        };
        Self { mode, counts, parts }
    }

    /// Returns whether all cases are wanted.
    pub(crate) fn want_all(&self) -> bool {
        self.parts.is_empty()
    }

    /// Returns whether the case with this name is wanted.
    pub(crate) fn want(&self, name: &str) -> bool {
        self.parts.is_empty() || self.parts.iter().any(|part| name.contains(part))
    }

    /// Returns the parts that occur in the name of no case and in none of `others`.
    pub(crate) fn unknown<'a>(
        &'a self,
        cases: impl Iterator<Item = &'a BenchCase>,
        others: &[&str],
    ) -> Vec<&'a str> {
        let names: Vec<String> = cases.map(BenchCase::name).collect();
        let known = |part: &&&String| {
            !names.iter().any(|name| name.contains(**part)) && !others.iter().any(|other| within(other, part))
        };
        self.parts.iter().filter(|part| known(&part)).map(String::as_str).collect()
    }

    /// Returns whether a name that starts with `prefix` is wanted.
    pub(crate) fn want_prefix(&self, prefix: &str) -> bool {
        self.parts.is_empty() || self.parts.iter().any(|part| within(prefix, part))
    }
}

/// Returns whether a name that starts with `prefix` can contain `part`: within the prefix, or from the start of one
/// of its components on.
fn within(prefix: &str, part: &str) -> bool {
    let starts = prefix.match_indices('/').map(|(slash, _)| slash + 1).chain([0]);
    prefix.contains(part)
        || starts.map(|start| &prefix[start..]).any(|rest| rest.contains('/') && part.starts_with(rest))
}
