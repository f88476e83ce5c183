//! `dragonfly script SCENE.xml`: prints when each action begins and ends; `--schema` prints the schema of scripts.

use super::{ScriptChoice, load};
use crate::command::Failure;
use crate::command::output::{print, print_json};
use crate::command::run_command::RunCommand;
use crate::command::table::{Side, Table};
use dragonfly_anim::stage::table::{LINE_FILES, PROJECTS, SCRIPTS, Vocabulary};
use dragonfly_document::LoadedScene;
use serde::Serialize;
use std::path::PathBuf;

/// Print when each action of a scene's script begins and ends, or the schema of scripts
#[derive(Clone, Debug, clap::Args)]
#[command(
    group = clap::ArgGroup::new("source").required(true),
    after_help = "\
Times are in seconds. The schema is in RELAX NG, for editors that complete and check XML; `dragonfly check` has better messages.\n\n\
Examples:\n  dragonfly script duel.xml\n  dragonfly script --schema > script.rng\n  dragonfly script --schema project > project.rng"
)]
pub(in crate::command) struct ScriptArguments {
    /// A scene (.xml) or a project (.meproj)
    #[arg(value_name = "SCENE", group = "source")]
    file: Option<PathBuf>,
    /// Print the schema of scripts, or that of another kind of text
    #[arg(
        long,
        group = "source",
        conflicts_with_all = ["json", "script"],
        value_name = "KIND",
        num_args = 0..=1,
        default_missing_value = "script"
    )]
    schema: Option<SchemaKind>,
    #[command(flatten)]
    script: ScriptChoice,
    /// Print one JSON document instead of text
    #[arg(long)]
    json: bool,
}

/// A kind of text that has a schema.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum SchemaKind {
    /// The script of a scene
    Script,
    /// A project
    Project,
    /// A file of drawn lines
    Lines,
}

impl SchemaKind {
    fn vocabulary(self) -> &'static Vocabulary {
        match self {
            Self::Script => &SCRIPTS,
            Self::Project => &PROJECTS,
            Self::Lines => &LINE_FILES,
        }
    }
}

/// The times of a script.
#[derive(Serialize)]
struct ScriptTimes {
    file: String,
    /// Seconds.
    length: f64,
    actions: Vec<ActionRow>,
}

/// One action.
#[derive(Serialize)]
struct ActionRow {
    /// The included file that it is in; absent for the script itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    line: u32,
    action: &'static str,
    id: Option<String>,
    who: Option<String>,
    /// Seconds.
    begin: f64,
    /// Seconds.
    end: f64,
}

impl RunCommand for ScriptArguments {
    fn run(self) -> Result<(), Failure> {
        if let Some(kind) = self.schema {
            return print(|out| out.write_all(kind.vocabulary().schema().as_bytes()));
        }
        let Some(file) = self.file else { return Err(Failure::input("SCENE", "is missing")) };
        let times = ScriptTimes::of(&load(&file, &self.script)?);
        if self.json { print_json(&times) } else { print(|out| times.table().write(out)) }
    }
}

impl ScriptTimes {
    fn of(scene: &LoadedScene) -> Self {
        let schedule = scene.plan.schedule();
        let actions = schedule.times().iter().enumerate().map(|(action, times)| {
            let element = scene.script.element(action);
            let value = |name: &str| element.value(name).map(str::to_owned);
            ActionRow {
                file: scene.script.tree().file_of(element).map(str::to_owned),
                line: scene.script.tree().place(element.range.start).line,
                action: element.row.name,
                id: value("id"),
                who: value("who"),
                begin: times.begin.seconds(),
                end: times.end.seconds(),
            }
        });
        Self { file: scene.title.clone(), length: schedule.length().seconds(), actions: actions.collect() }
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&[
            ("line", Side::Right),
            ("action", Side::Left),
            ("id", Side::Left),
            ("who", Side::Left),
            ("begin", Side::Right),
            ("end", Side::Right),
        ]);
        for row in &self.actions {
            table.row([
                row.file.as_ref().map_or_else(|| row.line.to_string(), |file| format!("{file}:{}", row.line)),
                row.action.to_owned(),
                row.id.clone().unwrap_or_default(),
                row.who.clone().unwrap_or_default(),
                format!("{:.3}", row.begin),
                format!("{:.3}", row.end),
            ]);
        }
        table
    }
}
