//! `dragonfly takes remove MODEL --take TAKE -o OUT`.

use super::super::choice::{model_help, source};
use super::super::edit::save;
use super::super::{Failure, tell};
use super::chosen;
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{DeleteTake, Edit, TakeRef};
use dragonfly_document::{Cancel, Editable};
use std::path::PathBuf;

/// Remove takes from a model; all other data is unchanged
#[derive(Clone, Debug, clap::Args)]
pub(super) struct RemoveTakes {
    #[arg(value_name = "MODEL", help = model_help())]
    model: PathBuf,
    /// Take, by name or by index from 0; repeatable
    #[arg(long, value_name = "TAKE", allow_hyphen_values = true, required = true)]
    take: Vec<String>,
    /// File to write; MODEL itself is allowed and is replaced atomically
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
}

impl RemoveTakes {
    pub(super) fn run(self) -> Result<(), Failure> {
        let editable = Editable::open(&source(&self.model), &Cancel::default())?;
        let indices = chosen(&editable.title, &editable.model.animation.takes, &self.take)?;
        let mut adapter = ModelAdapter::of(&editable.model);
        for index in indices.into_iter().rev() {
            adapter
                .apply(&Edit::DeleteTake(DeleteTake { take: TakeRef::Index(index) }))
                .map_err(|error| Failure::input(&editable.title, error))?;
        }
        let plan = editable.plan(&adapter).map_err(|error| Failure::input(&editable.title, error))?;
        for file in save(&editable, &plan, &self.output)? {
            tell(format_args!("wrote {} ({} bytes)", file.path, file.bytes));
        }
        Ok(())
    }
}
