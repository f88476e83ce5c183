//! Builds the fault layer and returns the environment variables that load it into a program.

use dragonfly_kit::folder::Folder;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The fault layer as one test uses it, with a folder for its log.
pub(crate) struct Layer {
    pub(crate) folder: Folder,
}

impl Layer {
    /// Returns the layer, which is built at the first use.
    pub(crate) fn new(name: &str) -> Self {
        library();
        Self { folder: Folder::new(&format!("layer-{name}")) }
    }

    /// Returns the environment variables that load the layer and make `call` return `result`, `times` times in all.
    pub(crate) fn environment(&self, call: &str, result: i32, times: usize) -> Vec<(String, String)> {
        let folder = library().parent().expect("a folder").display().to_string();
        [
            ("VK_LAYER_PATH", folder),
            ("VK_INSTANCE_LAYERS", "VK_LAYER_DRAGONFLY_fault".to_owned()),
            ("FAULT_CALL", call.to_owned()),
            ("FAULT_RESULT", result.to_string()),
            ("FAULT_TIMES", times.to_string()),
            ("FAULT_EVERY", "3".to_owned()),
            ("FAULT_LOG", self.log().display().to_string()),
        ]
        .map(|(name, value)| (name.to_owned(), value))
        .into()
    }

    /// Returns the number of faults so far.
    pub(crate) fn faults(&self) -> usize {
        lines(self.log())
    }

    /// Restarts the count.
    pub(crate) fn forget(&self) {
        let _ = std::fs::remove_file(self.log());
    }

    fn log(&self) -> PathBuf {
        self.folder.join("faults.log")
    }
}

/// Returns the number of lines of a file; 0 if it does not exist yet.
pub(crate) fn lines(path: impl AsRef<Path>) -> usize {
    std::fs::read_to_string(path).map_or(0, |text| text.lines().count())
}

/// Returns the path of the built library. The manifest that the Vulkan loader needs is in the same folder.
fn library() -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/editor/fault_layer/fault_layer.c");
        // One folder per process: two test runs at once must not write into each other's library.
        let folder =
            Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fault-layer-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let library = folder.join("libfault_layer.so");
        let status = Command::new("cc")
            .args([
                "-shared",
                "-fPIC",
                "-O1",
                "-Wall",
                "-Wextra",
                "-Werror",
                "-fvisibility=hidden",
                "-pthread",
                "-o",
            ])
            .arg(&library)
            .arg(&source)
            .status()
            .expect("a C compiler");
        assert!(status.success(), "the layer does not compile (Debian: libvulkan-dev)");
        let description = serde_json::json!({
            "file_format_version": "1.1.2",
            "layer": {
                "name": "VK_LAYER_DRAGONFLY_fault",
                "type": "GLOBAL",
                "library_path": library,
                "api_version": "1.3.0",
                "implementation_version": "1",
                "description": "Makes things go wrong on purpose"
            }
        });
        std::fs::write(folder.join("fault_layer.json"), description.to_string()).expect("a file");
        library
    })
}
