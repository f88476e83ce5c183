//! The trait of all subcommands.

use super::Failure;

/// A subcommand of the command line.
pub(super) trait RunCommand {
    /// Runs the subcommand.
    fn run(self) -> Result<(), Failure>;
}
