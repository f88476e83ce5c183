//! A small scene for tests of movies, and what is read back of them.

use crate::program::{Outcome, dragonfly, outcome};
use crate::scene_sounds::write_thunder;
use dragonfly_kit::folder::{Folder, data};
use std::fs;
use std::path::{Path, PathBuf};

/// Size of the movies of tests.
pub(crate) const SIZE: [u32; 2] = [64, 36];

/// A box that moves for `SECONDS`, seen by two cameras, with a sound and a title.
const SCENE: &str = r#"<script version="1" fps="24" size="64x36">
  <cast>
    <prop id="box" model="box.glb" at="0 0 0"/>
    <camera id="wide" at="0 1 6" look="0 0 0"/>
    <camera id="near" at="1 1 3" look="0 0 0"/>
    <path id="way" points="-1 0 0  1 0.5 0"/>
  </cast>
  <par dur="SECONDS">
    <move who="box" path="way" dur="SECONDS"/>
    <shot who="wide" begin="0"/>
    <shot id="close" who="near" begin="0.26"/>
    <sound src="thunder.wav" begin="0.1"/>
    <title text="Hi" begin="0.2" end="0.4"/>
  </par>
</script>
"#;

/// A folder with a scene, in which the program runs.
pub(crate) struct MovieScene {
    folder: Folder,
}

impl MovieScene {
    /// Writes a scene of a number of frames.
    pub(crate) fn new(name: &str, frames: u32) -> Self {
        let folder = Folder::new(name);
        fs::copy(data("gltf/box_sparse.glb"), folder.join("box.glb")).expect("a copy");
        write_thunder(&folder.join("thunder.wav"));
        let scene = SCENE.replace("SECONDS", &format!("{frames}f"));
        fs::write(folder.join("scene.xml"), scene).expect("a file");
        Self { folder }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Runs the program in the folder, with arguments that are separated by blanks.
    #[track_caller]
    pub(crate) fn run(&self, arguments: &str) -> Outcome {
        outcome(dragonfly(arguments.split_whitespace()).current_dir(self.folder()))
    }

    /// Returns the names of the files and folders that a movie may have left, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let own = ["scene.xml", "box.glb", "thunder.wav"];
        let all = fs::read_dir(self.folder()).expect("the folder");
        let names = all.map(|entry| entry.expect("an entry").file_name().into_string().expect("a name"));
        let mut names: Vec<String> = names.filter(|name| !own.contains(&name.as_str())).collect();
        names.sort();
        names
    }
}

/// Returns the lines of progress in JSON on stderr: frames that are done, of how many, and the seconds left.
pub(crate) fn progress_lines(stderr: &str) -> Vec<(u64, u64, f64)> {
    let lines = stderr.lines().filter(|line| line.starts_with('{'));
    lines
        .map(|line| {
            let value: serde_json::Value = serde_json::from_str(line).expect("JSON");
            let number = |key: &str| value[key].as_u64().expect(key);
            (number("frame"), number("of"), value["seconds_left"].as_f64().expect("seconds"))
        })
        .collect()
}

/// Returns whether bytes contain a text.
pub(crate) fn contains(bytes: &[u8], text: &[u8]) -> bool {
    bytes.windows(text.len()).any(|found| found == text)
}
