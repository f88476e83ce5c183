//! The list of targets. A new parser is a function here and a line in [`TARGETS`].

use dragonfly_anim::compressed::CompressedTake;
use dragonfly_anim::data::Image;
use dragonfly_anim::fast::Pose;
use dragonfly_anim::format::{ByteBudget, Formats, ImportContext, NoFiles, ReadOptions};
use dragonfly_document::edit::parse_lines;
use dragonfly_kit::folder::Folder;
use dragonfly_store::{Autosave, RealFiles};
use std::cell::OnceCell;
use std::sync::Arc;

/// A parser of bytes from outside.
#[derive(Clone, Copy)]
pub struct Target {
    /// Name, as `.ci/fuzz` takes it.
    pub name: &'static str,
    /// Extensions of the files of `tests/data` that are its seeds.
    pub extensions: &'static [&'static str],
    /// Parses the bytes. Must not panic.
    pub run: fn(&[u8]),
}

/// Every target.
pub static TARGETS: &[Target] = &[
    Target { name: "gltf", extensions: &["gltf", "glb"], run: gltf },
    Target { name: "dfm", extensions: &["dfm"], run: dfm },
    Target { name: "fbx", extensions: &["fbx"], run: fbx },
    Target { name: "bvh", extensions: &["bvh"], run: |bytes| model("fuzz.bvh", bytes) },
    Target { name: "obj", extensions: &["obj"], run: |bytes| model("fuzz.obj", bytes) },
    Target { name: "x", extensions: &["x"], run: |bytes| model("fuzz.x", bytes) },
    Target { name: "luna", extensions: &["m3d"], run: |bytes| model("fuzz.m3d", bytes) },
    Target { name: "vrm", extensions: &["vrm", "vrma"], run: |bytes| model("fuzz.vrm", bytes) },
    Target { name: "compressed", extensions: &["dfc"], run: compressed },
    Target { name: "image", extensions: &["png", "jpg"], run: image },
    Target { name: "edits", extensions: &["jsonl"], run: edits },
    Target { name: "journal", extensions: &["journal"], run: journal },
];

/// Memory that an importer may use for a fuzzed file, bytes.
const BUDGET: u64 = 64 << 20;

/// Reads a model, plans a save without an edit, and checks what was read.
fn model(name: &str, bytes: &[u8]) {
    let options = ReadOptions { budget: ByteBudget::at_most(BUDGET), ..ReadOptions::default() };
    let Ok(imported) = Formats::builtin().read(name, bytes, &NoFiles, &options) else { return };
    let _ = dragonfly_anim::check::check(&imported.model);
    let Ok(file) = imported.format.edit(name, bytes.to_vec(), &NoFiles, &options) else { return };
    let _ = file.plan(&imported.model, &[]);
}

fn gltf(bytes: &[u8]) {
    model(if bytes.starts_with(b"glTF") { "fuzz.glb" } else { "fuzz.gltf" }, bytes);
}

fn dfm(bytes: &[u8]) {
    model("fuzz.dfm", bytes);
}

/// Parses a file as the child does, and reads the bytes as an answer of one.
fn fbx(bytes: &[u8]) {
    let options = ReadOptions { budget: ByteBudget::at_most(BUDGET), ..ReadOptions::default() };
    if let Ok(model) = dragonfly_fbx::read_in_process(bytes, &ImportContext::new(&NoFiles, &options)) {
        let _ = dragonfly_anim::check::check(&model);
    }
    let _ = dragonfly_fbx::read_answer(bytes, &ImportContext::new(&NoFiles, &options));
}

fn compressed(bytes: &[u8]) {
    let Ok(take) = CompressedTake::from_bytes(bytes.to_vec()) else { return };
    // A header may claim more bones than a fuzzed file should cost.
    if take.bones() > 10_000 {
        return;
    }
    let mut pose = Pose::new(take.bones());
    for time in [take.start(), take.start() + take.length() * 0.37, f32::NAN] {
        take.sample(time, &mut pose);
    }
}

fn image(bytes: &[u8]) {
    let image = Image { bytes: bytes.into(), ..Image::default() };
    let _ = dragonfly_document::images::decode(&image, 1 << 20);
}

fn edits(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let _ = parse_lines(text);
}

thread_local! {
    /// The folder of the fuzzed journals, kept from run to run.
    static JOURNALS: OnceCell<(Folder, Autosave)> = const { OnceCell::new() };
}

fn journal(bytes: &[u8]) {
    JOURNALS.with(|journals| {
        let (_, autosave) = journals.get_or_init(|| {
            let folder = Folder::new("/dev/shm/dragonfly-fuzz-journal");
            let autosave = Autosave::new(Arc::new(RealFiles), Some(folder.join("autosave")));
            let autosave = autosave.expect("the folder is given");
            std::fs::create_dir_all(autosave.journals()).expect("a folder of our own");
            (folder, autosave)
        });
        std::fs::write(autosave.journals().join("fuzz.journal"), bytes).expect("a file of our own");
        for found in autosave.recoverable().unwrap_or_default() {
            let _ = autosave.entries(&found);
        }
    });
}
