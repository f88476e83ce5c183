//! A new thing is one file, its `mod`, and one entry in a list: shown by planting one of each kind in a copy of the project.
//!
//! ARCHITECTURE.md has the table of what a new thing needs. The copy gets exactly that for each row, is built once, and the
//! tests that walk the lists, and those that are planted with the things, run in it.

mod copy;
mod list;
mod map;

use copy::ProjectCopy;

/// The tests that run in the copy: the planted ones, and those that walk a list.
const WALKING: &[&str] = &[
    "planted::",
    "formats::every_format",
    "formats::what_every_writable_format_writes_reads_back",
    "check::every_rule_of_the_list",
    "check::each_broken_model",
    "old_journals::every_edit_type",
    "passes::",
    "shaders::",
    "commands::",
    "keymap::no_shortcut_runs_two_commands",
    "keymap::essential_commands",
    "keymap::every_shortcut_reads_back",
    "panels::every_panel",
    "questions::every_kind_of_question",
    "questions::every_question_fits",
    "settings::the_panel_layout_is_restored",
    "command_line::the_table_of_commands",
    "command_line::help_lists_every_command",
];

/// Takes about a minute where the project is built.
#[test]
fn one_file_and_one_list_entry_are_enough_to_add_a_thing_of_each_kind() {
    let copy = ProjectCopy::planted();
    let mut arguments = vec!["--no-fail-fast"];
    arguments.extend(["--test", "anim", "--test", "document", "--test", "picture", "--test", "editor", "--"]);
    arguments.extend(WALKING);
    let output = copy.test(&arguments);
    let [report, messages] =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{report}\n{messages}");
    let passed =
        |test: &str| report.lines().filter(|line| line.contains(test) && line.ends_with(" ok")).count();
    for test in WALKING {
        assert!(passed(test) > 0, "{test} did not run:\n{report}");
    }
    assert_eq!(passed("planted::"), list::COUNT, "{report}");
    // Only the panel that is in no list is reported.
    let warnings: Vec<&str> = messages.lines().filter(|line| line.starts_with("warning: ")).collect();
    let about = |line: &&&str| !line.contains("generated 1 warning");
    let warnings: Vec<&&str> = warnings.iter().filter(about).collect();
    assert_eq!(warnings, [&"warning: struct `ForgottenPanel` is never constructed"], "{messages}");
}
