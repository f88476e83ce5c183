//! The names of recent files: with their folder where two have the same name.

use std::path::{Path, PathBuf};

/// Returns what is shown of each file.
pub(super) fn recent_names(files: &[PathBuf]) -> Vec<String> {
    let name = |path: &Path| part(path.file_name());
    let folder = |path: &Path| part(path.parent().and_then(Path::file_name));
    let others = |path: &PathBuf| {
        let (path, name_of_it) = (path.clone(), name(path));
        files.iter().filter(move |other| **other != path && name(other) == name_of_it)
    };
    let shown = |path: &PathBuf| {
        if others(path).next().is_none() {
            return name(path);
        }
        let is_unclear = others(path).any(|other| folder(other) == folder(path));
        let folder = match path.parent() {
            Some(parent) if is_unclear => parent.display().to_string(),
            Some(_) | None => folder(path),
        };
        format!("{} \u{2013} {folder}", name(path))
    };
    files.iter().map(shown).collect()
}

fn part(name: Option<&std::ffi::OsStr>) -> String {
    name.map_or(String::new(), |name| name.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_the_same_name_are_shown_with_their_folders() {
        let files = ["/a/duel/scene.xml", "/a/walk/scene.xml", "/a/fox.glb", "/b/x/rig.fbx", "/c/x/rig.fbx"];
        let shown = recent_names(&files.map(PathBuf::from));
        let dash = |name: &str, folder: &str| format!("{name} \u{2013} {folder}");
        assert_eq!(shown[..3], [dash("scene.xml", "duel"), dash("scene.xml", "walk"), "fox.glb".to_owned()]);
        // Paths have other separators elsewhere.
        assert!(shown[3].contains('b') && shown[4].contains('c') && shown[3] != shown[4], "{shown:?}");
    }
}
