//! `dragonfly pack PROJECT -o FILE.zip` and `dragonfly unpack FILE.zip -o FOLDER`: a project with everything that it needs.

use super::output::write_file;
use super::run_command::RunCommand;
use super::{Failure, tell};
use dragonfly_document::{Cancel, PackError, pack, unpack};
use std::path::PathBuf;

/// Collect a project, or a scene's script, with every file that it needs into one archive
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = "\
Models, the files that they need, scripts, lines, edits and sounds are packed with their names relative to the project. If one of\n\
them is missing, nothing is written.\n\n\
Examples:\n  dragonfly pack duel.meproj -o duel.zip\n  dragonfly unpack duel.zip -o duel")]
pub(super) struct PackArguments {
    /// A scene (.xml) or a project (.meproj)
    #[arg(value_name = "PROJECT")]
    file: PathBuf,
    /// Archive to write (.zip)
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Unpack an archive of a project into a folder
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = "\
No file is overwritten, and no file is written outside of the folder.\n\n\
Examples:\n  dragonfly unpack duel.zip -o duel")]
pub(super) struct UnpackArguments {
    /// An archive (.zip)
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Folder for its files; it is created
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,
}

impl From<PackError> for Failure {
    fn from(error: PackError) -> Self {
        Self::Input(error.to_string())
    }
}

impl RunCommand for PackArguments {
    fn run(self) -> Result<(), Failure> {
        let bytes = pack(&self.file, &Cancel::default())?;
        write_file(&self.output, &bytes)?;
        tell(format_args!("wrote {} ({} bytes)", self.output.display(), bytes.len()));
        Ok(())
    }
}

impl RunCommand for UnpackArguments {
    fn run(self) -> Result<(), Failure> {
        for path in unpack(&self.file, &self.output)? {
            tell(format_args!("wrote {}", path.display()));
        }
        Ok(())
    }
}
