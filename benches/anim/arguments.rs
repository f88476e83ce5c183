//! What the command line asks for.

use crate::case::Case;

/// What is done with the cases.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Mode {
    /// Times, ratios and goals.
    Measure,
    /// Each case once, to see that it works.
    Check,
    /// Each case for the counter of instructions.
    Count,
    /// Their names.
    List,
    /// The goals that are instructions.
    Goals,
}

/// What the command line asks for.
pub(crate) struct Arguments {
    pub(crate) mode: Mode,
    /// Parts of names; none: everything.
    parts: Vec<String>,
}

impl Arguments {
    /// Cargo says `--bench` when it is asked to measure; `cargo test --benches` does not, and there works are only tried.
    pub(crate) fn read() -> Self {
        let (options, parts): (Vec<String>, Vec<String>) =
            std::env::args().skip(1).partition(|argument| argument.starts_with("--"));
        let has = |option: &str| options.iter().any(|given| given == option);
        let mode = match () {
            () if has("--list") => Mode::List,
            () if has("--goals") => Mode::Goals,
            () if has("--count") => Mode::Count,
            () if has("--test") || !has("--bench") => Mode::Check,
            () => Mode::Measure,
        };
        Self { mode, parts }
    }

    /// Is a case of this name asked for?
    pub(crate) fn want(&self, name: &str) -> bool {
        self.parts.is_empty() || self.parts.iter().any(|part| name.contains(part))
    }

    /// The parts that belong to no case and no name of `others`.
    pub(crate) fn unknown<'a>(
        &'a self,
        cases: impl Iterator<Item = &'a Case>,
        others: &[&str],
    ) -> Vec<&'a str> {
        let names: Vec<String> = cases.map(Case::name).collect();
        let known = |part: &&&String| {
            !names.iter().any(|name| name.contains(**part)) && !others.iter().any(|other| within(other, part))
        };
        self.parts.iter().filter(|part| known(&part)).map(String::as_str).collect()
    }

    /// Is something asked for whose names begin with `beginning`?
    pub(crate) fn want_beginning(&self, beginning: &str) -> bool {
        self.parts.is_empty() || self.parts.iter().any(|part| within(beginning, part))
    }
}

/// Could `part` be part of a name that begins with `beginning`, from one of its slashes on?
fn within(beginning: &str, part: &str) -> bool {
    let starts = beginning.match_indices('/').map(|(slash, _)| slash + 1).chain([0]);
    beginning.contains(part)
        || starts.map(|start| &beginning[start..]).any(|rest| rest.contains('/') && part.starts_with(rest))
}
