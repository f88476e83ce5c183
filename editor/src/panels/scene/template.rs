//! Scenes to begin with.

use std::path::{Path, PathBuf};

/// The text of a file of lines before the first one.
pub(in crate::panels) const NO_LINES: &str =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<lines version=\"1\">\n</lines>\n";

/// Returns the script of a scene of two roles opposite each other, with two cameras and a sun. `models` are files relative to the
/// folder of the script, `scale` is the factor from their lengths to meters, and `take` is what both play.
pub fn duel_text(models: [&str; 2], scale: f64, take: Option<&str>) -> String {
    let escaped = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
    let [first, second] = models.map(escaped);
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
            actions += "    <!-- add takes in the menu of a lane of the timeline, or write <play who=\"anna\" take=\"…\"/> -->\n"
        }
    }
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<script version=\"1\" fps=\"24\" size=\"1280x720\">\n  <cast>\n    \
         <role   id=\"anna\" model=\"{first}\" at=\"-1 0 0\" facing=\"90\"{scale}/>\n    \
         <role   id=\"ben\" model=\"{second}\" at=\"1 0 0\" facing=\"-90\"{scale}/>\n    \
         <camera id=\"wide\" at=\"0 1.6 5\" look=\"0 1 0\" lens=\"35mm\"/>\n    \
         <camera id=\"close\" at=\"-2 1.7 2\" look=\"ben\" lens=\"50mm\"/>\n    \
         <light  id=\"sun\" kind=\"sun\" direction=\"-1 -2 -1\"/>\n  </cast>\n\n  \
         <par id=\"scene\">\n{actions}    <wait dur=\"6\"/>\n  </par>\n</script>\n"
    )
}

/// Returns the texts of a project with a script, and of its file of lines. Both are named relative to the folder of the project.
pub fn project_texts(script: &str, lines: &str) -> [String; 2] {
    let [script, lines] =
        [script, lines].map(|text| text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;"));
    [
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<project version=\"1\">\n  <lines src=\"{lines}\"/>\n  \
             <script id=\"main\" src=\"{script}\"/>\n</project>\n"
        ),
        NO_LINES.to_owned(),
    ]
}

/// Returns a path in `folder` that `exists` does not have: `scene.xml`, `scene-2.xml` and so on.
pub fn free_name(folder: &Path, exists: impl Fn(&Path) -> bool) -> PathBuf {
    let numbered = (2_u32..).map(|number| folder.join(format!("scene-{number}.xml")));
    let first = folder.join("scene.xml");
    std::iter::once(first.clone()).chain(numbered).find(|path| !exists(path)).unwrap_or(first)
}
