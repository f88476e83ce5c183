//! Job files for render farms and clusters: one command, run once for each part of the work.
//!
//! The program schedules nothing itself. It prints what existing engines take: Open Job Description, Slurm, OpenCue,
//! Flamenco. A new engine is a file here and a line in the list `engines!`.

mod flamenco;
mod opencue;
mod openjd;
mod slurm;

/// The number of the part in the arguments of a job.
const PART: &str = "\u{1}";

/// A command for a farm: `dragonfly` with the same arguments for each part but for its number, and maybe another command after all parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct FarmJob {
    name: &'static str,
    arguments: Vec<String>,
    numbers: PartNumbers,
    /// Arguments of the command that puts the parts together.
    last: Option<Vec<String>>,
}

/// The numbers of the parts of a job: `count` of them, the first one and each `step` after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PartNumbers {
    /// Number of the first part.
    pub(super) first: u64,
    /// Difference between the numbers of two parts.
    pub(super) step: u64,
    /// Number of parts, at least one.
    pub(super) count: u64,
}

impl PartNumbers {
    /// Returns the number of the last part.
    fn last(self) -> u64 {
        self.first + self.count.saturating_sub(1) * self.step
    }

    /// Returns the numbers as farms write them, with `by` before a step: `1-12`, `0-192:48`.
    fn range(self, by: &str) -> String {
        let (first, last) = (self.first, self.last());
        match (self.step, self.count) {
            (1, _) => format!("{first}-{last}"),
            (_, 1) => first.to_string(),
            (step, _) => format!("{first}-{last}{by}{step}"),
        }
    }
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
        check(&arguments)?;
        arguments.push("--shard".to_owned());
        arguments.push(format!("{PART}/{parts}"));
        let numbers = PartNumbers { first: 1, step: 1, count: parts as u64 };
        Ok(Self { name, arguments, numbers, last: None })
    }

    /// Returns a job that runs `dragonfly` with these arguments and `--frames NUMBER+STEP -o OUTPUT` for each of `numbers`, the first frame of the part, and
    /// after all of them with the arguments `last`. `output` returns the output of a part by its number.
    ///
    /// # Errors
    ///
    /// An argument with a line end, which not every engine can pass on.
    pub(super) fn of_frames(
        name: &'static str,
        arguments: impl IntoIterator<Item = String>,
        numbers: PartNumbers,
        output: impl Fn(&str) -> String,
        last: Option<Vec<String>>,
    ) -> Result<Self, String> {
        let mut arguments: Vec<String> = arguments.into_iter().collect();
        check(&arguments)?;
        check(&[output("")])?;
        check(last.as_deref().unwrap_or_default())?;
        let frames = format!("{PART}+{}", numbers.step);
        arguments.extend(["--frames".to_owned(), frames, "-o".to_owned(), output(PART)]);
        Ok(Self { name, arguments, numbers, last })
    }

    /// Returns the arguments with `token` in place of the number of the part.
    fn arguments(&self, token: &str) -> impl Iterator<Item = String> {
        self.arguments.iter().map(move |argument| argument.replace(PART, token))
    }

    /// Returns the command after all parts as one line for a POSIX shell; `None` where there is none.
    fn last_shell_line(&self) -> Option<String> {
        let last = self.last.clone()?;
        Some(Self { arguments: last, last: None, ..self.clone() }.shell_line(""))
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

/// Returns an error for arguments that cannot be in a job file.
fn check(arguments: &[String]) -> Result<(), String> {
    match arguments.iter().find(|argument| argument.chars().any(char::is_control)) {
        Some(odd) => Err(format!("{odd:?} contains a control character and cannot be part of a job file")),
        None => Ok(()),
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
    /// Slurm: an array job, `sbatch JOB`; of a movie a script that submits two jobs, `sh JOB`
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

    #[test]
    fn jobs_of_parts_that_are_counted_stay_as_they_were() {
        let job = FarmJob::sharded("a", ["convert".to_owned()], 12).expect("a job");
        let text = |engine: FarmEngine| engine.text(&job).expect("a job file");
        assert_eq!(
            text(FarmEngine::Slurm),
            "#!/bin/sh\n#SBATCH --job-name=a\n#SBATCH --array=1-12\n#SBATCH --requeue\n\
             exec dragonfly convert --shard \"$SLURM_ARRAY_TASK_ID\"/12\n"
        );
        let flamenco = text(FarmEngine::Flamenco);
        let lines = [
            "function compileJob(job) {\n    for (let part = 1; part <= 12; part++) {\n        const task",
            "        const args = [\"convert\",\"--shard\"].concat([part + \"/12\"]);\n",
            "        job.addTask(task);\n    }\n}\n",
        ];
        assert!(lines.iter().all(|line| flamenco.contains(line)), "{flamenco}");
        let opencue = text(FarmEngine::Opencue);
        let lines = [
            "    <layers>\n      <layer name=\"parts\" type=\"Render\">\n        <cmd>",
            "        <range>1-12</range>\n        <chunk>1</chunk>\n        <services>\n",
            "      </layer>\n    </layers>\n    <depends/>\n  </job>\n</spec>\n",
        ];
        assert!(lines.iter().all(|line| opencue.contains(line)), "{opencue}");
        let openjd = text(FarmEngine::Openjd);
        assert!(openjd.contains("\"range\": \"1-12\"") && openjd.contains("\"name\": \"Parts\""), "{openjd}");
    }

    #[test]
    fn every_engine_gets_the_first_frame_of_each_part_and_the_command_after_them() {
        let arguments = ["movie", "it's a duel.xml"].map(str::to_owned);
        let numbers = PartNumbers { first: 48, step: 48, count: 3 };
        let last = ["movie", "--join", "parts", "-o", "a duel.mp4"].map(str::to_owned).to_vec();
        let output = |part: &str| format!("parts/{part}.mp4");
        let job =
            FarmJob::of_frames("dragonfly-movie", arguments, numbers, output, Some(last)).expect("a job");
        let frames = [
            (FarmEngine::Openjd, ["48-144:48", "{{Task.Param.Part}}+48", "parts/{{Task.Param.Part}}.mp4"]),
            (FarmEngine::Slurm, ["--array=0-2", "\"$((48 + SLURM_ARRAY_TASK_ID * 48))\"+48", "--dependency"]),
            (FarmEngine::Opencue, ["48-144x48", "#IFRAME#+48", "parts/#IFRAME#.mp4"]),
            (FarmEngine::Flamenco, ["part <= 144; part += 48", "part + \"+48\"", "addDependency"]),
        ];
        for (engine, words) in frames {
            let text = engine.text(&job).expect("a job file");
            assert!(words.iter().all(|word| text.contains(word)), "{engine:?}: {text}");
            assert!(text.contains("--join") && text.contains("a duel.mp4"), "{engine:?}: {text}");
            assert!(!text.contains(PART) && text.ends_with('\n'), "{engine:?}");
        }
        let without = FarmJob { last: None, ..job };
        for engine in FarmEngine::value_variants() {
            let text = engine.text(&without).expect("a job file");
            let after = ["--join", "LAYER_ON_LAYER", "addDependency", "--dependency", "dependsOn"];
            assert!(!after.iter().any(|word| text.contains(word)) && text.contains("+48"), "{text}");
        }
    }
}
