//! Files: what is opened, saved, left.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::Open, When::Always, "Open…", &[key(CTRL, Key::O)], "Opens a model (glTF 2.0: .glb, .gltf; Dragonfly: .dfm)"),
    command(Id::OpenPath, When::Always, "Open by path…", &[key(CTRL.plus(SHIFT), Key::O)], "Opens a model whose path is typed or pasted"),
    command(Id::OpenBuiltIn, When::Always, "Built-in dragonfly", &[], "Opens the model that is part of the program"),
    command(Id::CancelLoading, When::Loading, "Stop loading", &[], "Keeps what is open and forgets what is being loaded"),
    command(Id::Quit, When::Always, "Quit", &[key(CTRL, Key::Q)], "Ends the program"),
];
