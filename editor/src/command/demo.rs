//! `dragonfly demo -o FILE.glb`: writes the built-in model to a file, to open elsewhere or to learn from.

use super::run_command::RunCommand;
use super::{Failure, output, tell};
use std::path::PathBuf;

/// Write the built-in model, a dragonfly with three takes, to a GLB file
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = "Example:\n  dragonfly demo -o dragonfly.glb")]
pub(super) struct DemoArguments {
    /// GLB file to write; `-` is standard output
    #[arg(short, long, value_name = "FILE.glb")]
    output: PathBuf,
}

impl RunCommand for DemoArguments {
    fn run(self) -> Result<(), Failure> {
        output::write_file(&self.output, dragonfly_document::demo::DRAGONFLY_GLB)?;
        if self.output != *"-" {
            tell(format_args!("wrote {}", self.output.display()));
        }
        Ok(())
    }
}
