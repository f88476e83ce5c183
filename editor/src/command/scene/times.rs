//! `dragonfly script SCENE.xml`: prints when each action begins and ends; `--schema` prints the schema of scripts.

use super::load;
use crate::command::Failure;
use crate::command::output::{print, print_json};
use crate::command::run_command::RunCommand;
use crate::command::table::{Side, Table};
use dragonfly_anim::stage::table::schema;
use dragonfly_document::LoadedScene;
use serde::Serialize;
use std::path::PathBuf;

/// Print when each action of a scene's script begins and ends, or the schema of scripts
#[derive(Clone, Debug, clap::Args)]
#[command(
    group = clap::ArgGroup::new("script").required(true),
    after_help = "\
Times are in seconds. The schema is in RELAX NG, for editors that complete and check XML; `dragonfly check` has better messages.\n\n\
Examples:\n  dragonfly script duel.xml\n  dragonfly script --schema > script.rng"
)]
pub(in crate::command) struct ScriptArguments {
    /// A script of a scene (.xml)
    #[arg(value_name = "SCENE", group = "script")]
    file: Option<PathBuf>,
    /// Print the schema of scripts
    #[arg(long, group = "script", conflicts_with = "json")]
    schema: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    json: bool,
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
        let Some(file) = self.file else {
            return print(|out| out.write_all(schema().as_bytes()));
        };
        let times = ScriptTimes::of(&load(&file)?);
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
                row.line.to_string(),
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
