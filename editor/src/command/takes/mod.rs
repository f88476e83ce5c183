//! `dragonfly takes list|add|extract|remove`: takes of other files onto a model, and out of it.

mod add;
mod extract;
mod list;
mod remove;

use super::Failure;
use super::choice::plain;
use super::run_command::RunCommand;
use clap::Subcommand;
use dragonfly_anim::data::Take;
use std::sync::Arc;

/// Add takes of other files to a model, write takes as files of their own, remove takes
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = "\
Examples:\n  dragonfly takes list Hero.glb\n  \
dragonfly takes add Hero.glb captures/*.bvh -o Hero2.glb\n  \
dragonfly takes extract Hero.glb --each -o clips --to glb\n  \
dragonfly takes remove Hero.glb --take Test -o Hero2.glb")]
pub(super) struct TakesArguments {
    #[command(subcommand)]
    action: TakesAction,
}

/// What to do with takes.
#[derive(Clone, Debug, Subcommand)]
enum TakesAction {
    List(list::ListTakes),
    Add(add::AddClips),
    Extract(extract::ExtractTakes),
    Remove(remove::RemoveTakes),
}

impl RunCommand for TakesArguments {
    fn run(self) -> Result<(), Failure> {
        match self.action {
            TakesAction::List(arguments) => arguments.run(),
            TakesAction::Add(arguments) => arguments.run(),
            TakesAction::Extract(arguments) => arguments.run(),
            TakesAction::Remove(arguments) => arguments.run(),
        }
    }
}

/// Returns the indices of the takes that were named, by name or by index from 0; a name has priority.
///
/// # Errors
///
/// A take that does not exist.
fn chosen(title: &str, takes: &[Arc<Take>], wanted: &[String]) -> Result<Vec<usize>, Failure> {
    let found = |wanted: &String| {
        let named = takes.iter().position(|take| take.name == *wanted);
        let numbered = || wanted.parse().ok().filter(|&index| index < takes.len());
        named
            .or_else(numbered)
            .ok_or_else(|| Failure::input(title, format_args!("there is no take \"{}\"", plain(wanted))))
    };
    let mut indices = wanted.iter().map(found).collect::<Result<Vec<usize>, _>>()?;
    indices.sort_unstable();
    indices.dedup();
    Ok(indices)
}
