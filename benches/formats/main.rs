//! Accuracy of conversions and speed of readers: `cargo bench -p dragonfly-fbx --bench formats`, or
//! `-- formats/round-trips` and `-- formats/speed` for one of both. `-- --record` writes the files in `results` and the tables
//! of `anim/FORMATS.md`.
//!
//! `DRAGONFLY_MODELS` names a folder with more models for the round trips. `DRAGONFLY_BPY` names a Python with Blender's module
//! `bpy`; assimp is measured where `pkg-config` knows it.

mod assimp;
mod blender;
mod inputs;
mod reading;
mod report;
mod round_trips;
mod sources;
mod speed;

use dragonfly_kit::figures::FigureBench;
use std::process::ExitCode;

fn main() -> ExitCode {
    // The parser of FBX is this program, started again.
    if dragonfly_fbx::child::is_requested(std::env::args_os()) {
        return dragonfly_fbx::child::serve();
    }
    let command = "cargo bench -p dragonfly-fbx --bench formats";
    FigureBench::run(&report::PAGE, "formats", command, |bench| {
        bench.file("round-trips", round_trips::all);
        bench.file("speed", speed::all);
    })
}
