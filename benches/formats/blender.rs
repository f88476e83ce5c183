//! Blender's importer and exporter of glTF, measured by `blender.py` in a Python with `bpy` that `DRAGONFLY_BPY` names.

use dragonfly_kit::figures::root;
use std::path::Path;
use std::process::Command;

/// Times of Blender, in milliseconds.
pub(crate) struct BlenderTimes {
    pub(crate) open: Vec<f64>,
    pub(crate) save: Vec<f64>,
}

/// Opens a file, changes a key and saves it, a few times; `None` without Blender.
pub(crate) fn times(file: &Path) -> Option<BlenderTimes> {
    let python = std::env::var_os("DRAGONFLY_BPY")?;
    let script = root().join("benches/formats/blender.py");
    let output = Command::new(python).arg(script).arg(file).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let of = |word: &str| {
        text.lines().filter_map(|line| line.strip_prefix(word)?.trim().parse().ok()).collect::<Vec<f64>>()
    };
    let times = BlenderTimes { open: of("TIME open "), save: of("TIME save ") };
    (!times.open.is_empty() && !times.save.is_empty()).then_some(times)
}
