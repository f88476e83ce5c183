//! `dragonfly --commands`: the table of the editor's commands.

use super::table::{Side, Table};
use super::{Failure, output};
use crate::panels::commands;

/// Prints one line for each command: id, title, tooltip, keys, and the condition under which it can be run.
pub(super) fn print() -> Result<(), Failure> {
    let headings = ["id", "title", "tooltip", "keys", "when"].map(|heading| (heading, Side::Left));
    let mut table = Table::new(&headings);
    for command in commands::all() {
        let keys: Vec<String> = command.shortcuts.iter().map(commands::text).collect();
        table.row([
            command.id.name().to_owned(),
            command.title.to_owned(),
            command.help.to_owned(),
            keys.join(", "),
            format!("{:?}", command.when),
        ]);
    }
    output::print(|out| table.write(out))
}
