//! Fuzzes one target with libFuzzer: the variable `DRAGONFLY_FUZZ` names it. `DRAGONFLY_FUZZ_SEEDS` names a folder into which
//! its seeds are written first. See `.ci/fuzz`.

#![no_main]

use dragonfly_fuzz::{TARGETS, Target, seeds};
use std::sync::OnceLock;

/// The target of this process.
fn target() -> &'static Target {
    static TARGET: OnceLock<&'static Target> = OnceLock::new();
    TARGET.get_or_init(|| {
        let name = std::env::var("DRAGONFLY_FUZZ").unwrap_or_default();
        let known = || TARGETS.iter().map(|target| target.name).collect::<Vec<_>>().join(", ");
        let found = TARGETS.iter().find(|target| target.name == name);
        found.unwrap_or_else(|| panic!("DRAGONFLY_FUZZ={name} is no target; there are {}", known()))
    })
}

libfuzzer_sys::fuzz_target!(init: {
    if let Some(folder) = std::env::var_os("DRAGONFLY_FUZZ_SEEDS") {
        let folder = std::path::PathBuf::from(folder);
        for (number, seed) in seeds(target()).iter().filter(|seed| seed.bytes.len() < 200_000).enumerate() {
            std::fs::write(folder.join(format!("seed-{number}")), &seed.bytes).expect("the folder can be written");
        }
    }
}, |bytes: &[u8]| (target().run)(bytes));
