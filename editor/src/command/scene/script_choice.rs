//! The script of a project that a command means.

/// The script of a project.
#[derive(Clone, Debug, Default, clap::Args)]
pub(in crate::command) struct ScriptChoice {
    /// Script of a project (.meproj), by its id or its file [default: the first one]
    #[arg(long, value_name = "ID")]
    script: Option<String>,
}

impl ScriptChoice {
    /// Returns its name; `None` for the first one.
    pub(in crate::command) fn name(&self) -> Option<&str> {
        self.script.as_deref()
    }
}
