//! Job files for render farms and clusters: one command, run once for each part of the work.
//!
//! The program schedules nothing itself. It prints what existing engines take: Open Job Description, Slurm, OpenCue,
//! Flamenco. A new engine is a file here and a line in the list `engines!`.

mod flamenco;
mod opencue;
mod openjd;
mod slurm;

/// The number of the part in the arguments of a job, from 1.
const PART: &str = "\u{1}";

/// A command for a farm: `dragonfly` with the same arguments for each part but for its number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct FarmJob {
    name: &'static str,
    arguments: Vec<String>,
    parts: usize,
}

impl FarmJob {
    /// Returns a job of `parts` parts that runs `dragonfly` with these arguments and `--shard PART/PARTS`.
    ///
    /// # Errors
    ///
    /// An argument with a line end, which not every engine can pass on.
    pub(super) fn sharded(
        name: &'static str,
        arguments: impl IntoIterator<Item = String>,
        parts: usize,
    ) -> Result<Self, String> {
        let mut arguments: Vec<String> = arguments.into_iter().collect();
        if let Some(odd) = arguments.iter().find(|argument| argument.chars().any(char::is_control)) {
            return Err(format!("{odd:?} contains a control character and cannot be part of a job file"));
        }
        arguments.push("--shard".to_owned());
        arguments.push(format!("{PART}/{parts}"));
        Ok(Self { name, arguments, parts })
    }

    /// Returns the arguments with `token` in place of the number of the part.
    fn arguments(&self, token: &str) -> impl Iterator<Item = String> {
        self.arguments.iter().map(move |argument| argument.replace(PART, token))
    }

    /// Returns the command as one line for a POSIX shell, in which `token` is expanded.
    fn shell_line(&self, token: &str) -> String {
        let quoted = |argument: &String| match argument.split_once(PART) {
            // The token is outside of the quotes, so that it is expanded.
            Some((before, after)) => format!("{}{token}{}", shell_word(before), shell_word(after)),
            None => match argument.is_empty() {
                true => "''".to_owned(),
                false => shell_word(argument),
            },
        };
        let words: Vec<String> = self.arguments.iter().map(quoted).collect();
        format!("dragonfly {}", words.join(" "))
    }
}

/// Returns a word of a POSIX shell without any expansion; nothing for an empty text.
fn shell_word(text: &str) -> String {
    let is_plain = |character: char| character.is_ascii_alphanumeric() || "-_./=:,+@%".contains(character);
    if text.chars().all(is_plain) { text.to_owned() } else { format!("'{}'", text.replace('\'', r"'\''")) }
}

/// Declares [`FarmEngine`] from a list of `Name => module` lines.
macro_rules! engines {
    ($($(#[$doc:meta])* $Name:ident => $module:ident,)*) => {
        /// A program that runs the parts of a job on many machines.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
        pub(super) enum FarmEngine {
            $($(#[$doc])* $Name,)*
        }

        impl FarmEngine {
            /// Returns the text of the job file.
            ///
            /// # Errors
            ///
            /// An argument that the engine cannot pass on.
            pub(super) fn text(self, job: &FarmJob) -> Result<String, String> {
                match self { $(Self::$Name => $module::text(job),)* }
            }
        }
    };
}

engines! {
    /// Open Job Description, for example for AWS Deadline Cloud; `openjd run JOB`
    Openjd => openjd,
    /// Slurm: an array job; `sbatch JOB`
    Slurm => slurm,
    /// OpenCue: a job specification in XML; `cueman` or the API launches it
    Opencue => opencue,
    /// Flamenco: a job type, a file for the folder `scripts` of its manager
    Flamenco => flamenco,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::ValueEnum;

    fn job() -> FarmJob {
        let arguments = ["convert", "my clips", "-o", "it's <out> & \"more\"", "--to", "glb"];
        FarmJob::sharded("dragonfly-convert", arguments.map(str::to_owned), 12).expect("a job")
    }

    #[test]
    fn a_shell_line_quotes_what_a_shell_would_expand_and_only_that() {
        assert_eq!(
            job().shell_line("$PART"),
            r#"dragonfly convert 'my clips' -o 'it'\''s <out> & "more"' --to glb --shard $PART/12"#
        );
        let empty = FarmJob::sharded("a", ["".to_owned()], 1).expect("a job");
        assert_eq!(empty.shell_line("1"), "dragonfly '' --shard 1/1");
    }

    #[test]
    fn every_engine_gets_each_part_once_and_no_argument_ends_a_line() {
        for engine in FarmEngine::value_variants() {
            let text = engine.text(&job()).expect("a job file");
            assert!(text.contains("1-12") || text.contains("part <= 12"), "{engine:?}: {text}");
            assert!(!text.contains(PART) && text.ends_with('\n'), "{engine:?}");
        }
        FarmJob::sharded("a", ["two\nlines".to_owned()], 2).expect_err("a line end");
    }
}
