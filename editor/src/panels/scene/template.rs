//! Scenes to begin with.

use std::path::{Path, PathBuf};

/// The text of a file of lines before the first one.
pub(in crate::panels) const NO_LINES: &str =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<lines version=\"1\">\n</lines>\n";

/// Returns the script of a scene of two roles opposite each other, with two cameras and a sun. `models` are ids of the project, or files relative to its
/// folder, `scale` is the factor from their lengths to meters, and `take` is what both play.
pub fn duel_text(models: [&str; 2], scale: f64, face: &str, take: Option<&str>) -> String {
    let escaped = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
    let [first, second] = models.map(escaped);
    let face = escaped(face);
    let scale = if (scale - 1.0).abs() < 1e-6 { String::new() } else { format!(" scale=\"{scale}\"") };
    let mut actions = String::from(
        "    <shot who=\"wide\" begin=\"0\"/>\n    <shot who=\"close\" begin=\"3\" blend=\"0.5\"/>\n",
    );
    match take.map(escaped) {
        Some(take) => {
            for who in ["anna", "ben"] {
                actions += &format!("    <play who=\"{who}\" take=\"{take}\" repeat=\"fill\"/>\n");
            }
        }
        None => {
            actions += "    <!-- add clips in the menu of a lane of the timeline, or write <play who=\"anna\" take=\"…\"/> -->\n"
        }
    }
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<script version=\"1\" fps=\"24\" size=\"1280x720\">\n  <cast>\n    \
         <role   id=\"anna\" model=\"{first}\" at=\"-1 0 0\" facing=\"90\"{scale}/>\n    \
         <role   id=\"ben\" model=\"{second}\" at=\"1 0 0\" facing=\"-90\"{scale}/>\n    \
         <camera id=\"wide\" at=\"0 1.6 5\" look=\"0 1 0\" lens=\"35mm\"/>\n    \
         <camera id=\"close\" at=\"-2 1.7 2\" look=\"{face}\" lens=\"50mm\"/>\n    \
         <light  id=\"sun\" kind=\"sun\" direction=\"-1 -2 -1\" strength=\"3\"/>\n  </cast>\n\n  \
         <par id=\"scene\">\n{actions}    <wait dur=\"6\"/>\n  </par>\n</script>\n"
    )
}

/// A model of a new project.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ListedModel {
    /// The name by which scripts mean it.
    pub id: String,
    /// Its file, relative to the folder of the project.
    pub file: String,
    /// Hash of its bytes; `None` where it is missing.
    pub hash: Option<u64>,
}

impl ListedModel {
    /// Returns models with ids that are made from the names of their files, each file once.
    pub fn listed(files: impl IntoIterator<Item = (String, Option<u64>)>) -> Vec<Self> {
        let mut models: Vec<Self> = Vec::new();
        for (file, hash) in files {
            if models.iter().any(|model| model.file == file) {
                continue;
            }
            let base = id_of_file(&file);
            let numbered = (2_u32..).map(|number| format!("{base}-{number}"));
            let is_free = |id: &String| models.iter().all(|model| model.id != *id);
            let id = std::iter::once(base.clone()).chain(numbered).find(is_free).unwrap_or(base);
            models.push(Self { id, file, hash });
        }
        models
    }
}

/// Returns an id made from the name of a file: `models/The Fox.glb` becomes `the_fox`.
fn id_of_file(file: &str) -> String {
    let name = file.rsplit('/').next().unwrap_or(file);
    let stem = name.split('.').next().unwrap_or(name);
    let letter =
        |letter: char| if letter.is_ascii_alphanumeric() { letter.to_ascii_lowercase() } else { '_' };
    let id: String = stem.chars().map(letter).collect();
    if id.starts_with(|first: char| first.is_ascii_alphabetic()) && id != "main" {
        id
    } else {
        format!("model_{id}")
    }
}

/// Returns the texts of a project with a script and models, and of its file of lines. All are named relative to the folder of the project.
pub fn project_texts(script: &str, lines: &str, models: &[ListedModel]) -> [String; 2] {
    let escaped = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
    let [script, lines] = [script, lines].map(escaped);
    let model = |model: &ListedModel| {
        let hash = model.hash.map(|hash| format!(" hash=\"{hash:016x}\"")).unwrap_or_default();
        format!("    <model id=\"{}\" src=\"{}\"{hash}/>\n", model.id, escaped(&model.file))
    };
    let models: String = models.iter().map(model).collect();
    let models = if models.is_empty() { models } else { format!("  <models>\n{models}  </models>\n") };
    [
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<project version=\"1\">\n{models}  <lines src=\"{lines}\"/>\n  \
             <script id=\"main\" src=\"{script}\"/>\n</project>\n"
        ),
        NO_LINES.to_owned(),
    ]
}

/// Returns the path of a new script in `folder`, which `exists` has with none of the extensions of a project: `scene.xml`, `scene-2.xml`
/// and so on.
pub fn free_name(folder: &Path, exists: impl Fn(&Path) -> bool) -> PathBuf {
    let numbered = (2_u32..).map(|number| folder.join(format!("scene-{number}.xml")));
    let first = folder.join("scene.xml");
    let is_free = |path: &PathBuf| {
        ["xml", "meproj", "lines.xml"].iter().all(|extension| !exists(&path.with_extension(extension)))
    };
    std::iter::once(first.clone()).chain(numbered).find(is_free).unwrap_or(first)
}
