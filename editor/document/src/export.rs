//! Files of other formats from a model: all of it, a part of it, or each take as a file of its own.

use super::conversion::{checked_preset, checked_textures, planned, write_files, written_extensions};
use super::import;
use super::make_folder;
use super::source::file_name;
use dragonfly_anim::data::{AnimationData, ModelData, Take};
use dragonfly_anim::format::{Format, SavePlan};
use dragonfly_fbx::TexturePlacement;
use dragonfly_store::folder_of;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Largest number of characters of a take's name in the name of a file.
const NAME: usize = 100;

/// The part of a model that is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ExportContent {
    /// Bones, meshes, materials, images and takes.
    #[default]
    Everything,
    /// All but the takes.
    Model,
    /// Bones and takes.
    Takes,
}

/// The files to write from a model.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExportOrder {
    /// The file to write. Its extension determines the format; with [`Self::each`], the names of the takes are added to its name.
    pub output: PathBuf,
    /// Name of the preset: the program for which the files are.
    pub preset: Option<String>,
    /// Place of the images; the usual one of the format where absent.
    pub textures: Option<TexturePlacement>,
    /// The part of the model.
    pub content: ExportContent,
    /// Indices of the takes; all where absent.
    pub takes: Option<Vec<usize>>,
    /// Whether each take becomes a file of its own, named `Model@Take`.
    pub each: bool,
    /// Frames per second at which each take gets a key instead of its own keys; for OBJ, a file for each frame of the first take.
    pub bake: Option<u32>,
    /// Whether to write the files, or only to find out what would be lost.
    pub is_written: bool,
}

/// A file of an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportedFile {
    /// The path.
    pub path: PathBuf,
    /// Size in bytes, with the files next to it.
    pub bytes: usize,
    /// Names of the files that it refers to, which are written next to it.
    pub beside: Vec<String>,
    /// Whether a file of this path, or of one next to it, existed before.
    pub replaces: bool,
}

/// The files of an export, and what they do not contain.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExportReport {
    /// The files, in the order of the takes.
    pub files: Vec<ExportedFile>,
    /// Content that the format cannot represent, one sentence each.
    pub lost: Vec<String>,
}

/// Questions what exports would lose. One is answered at a time, and only the newest one waits: while a path is typed, each letter is a
/// new question, and an answer takes as long as the export.
#[derive(Debug, Default)]
pub(super) struct ExportQuestions {
    is_running: bool,
    waiting: Option<ExportOrder>,
}

impl ExportQuestions {
    /// Returns the order if it can start now. A question that cannot waits in place of an older one.
    pub(super) fn begin(&mut self, order: ExportOrder) -> Option<ExportOrder> {
        if order.is_written || !std::mem::replace(&mut self.is_running, true) {
            return Some(order);
        }
        self.waiting = Some(order);
        None
    }

    /// Ends the question that was answered. Returns the one that waits.
    pub(super) fn next(&mut self) -> Option<ExportOrder> {
        let next = self.waiting.take();
        self.is_running = next.is_some();
        next
    }
}

/// Writes the files of `order` from `model`. With `is_written` false, only finds out what would be lost.
///
/// # Errors
///
/// The extension is not one of a format that is written, the format has no such preset or cannot represent the model, or a file cannot
/// be written: path or preset, and the reason. Files that were written before stay.
pub fn export_files(model: &ModelData, order: &ExportOrder) -> Result<ExportReport, String> {
    let format = format_of(&order.output)?;
    if let Some(preset) = &order.preset {
        checked_preset(&format, preset)?;
    }
    if let Some(textures) = order.textures {
        checked_textures(&format, textures)?;
    }
    let takes = &model.animation.takes;
    let takes: Vec<&Arc<Take>> = match (&order.takes, order.content) {
        (_, ExportContent::Model) => Vec::new(),
        (None, _) => takes.iter().collect(),
        (Some(indices), _) => indices.iter().filter_map(|&index| takes.get(index)).collect(),
    };
    let mut report = ExportReport::default();
    let mut write = |path: &Path, takes: &[&Arc<Take>]| {
        let part = part(model, takes, order.content);
        let choices = (order.preset.as_deref(), order.textures, order.bake.map(|rate| rate as f32));
        let plan = planned(&format, part, &file_name(path), choices)
            .map_err(|error| format!("{}: {error}", path.display()))?;
        report.add(path, &plan);
        if order.is_written {
            make_folder(path)?;
            write_files(path, &plan).map_err(|error| error.to_string())?;
        }
        Ok::<(), String>(())
    };
    if !order.each {
        write(&order.output, &takes)?;
        return Ok(report);
    }
    let mut names = FileNames::of(&order.output);
    for take in takes {
        write(&names.path(&take.name), &[take])?;
    }
    Ok(report)
}

impl ExportReport {
    fn add(&mut self, path: &Path, plan: &SavePlan) {
        let bytes = plan.files.iter().map(|file| file.bytes.len()).sum();
        let count = plan.files.len().saturating_sub(1);
        let beside: Vec<String> = plan.files.iter().take(count).map(|file| file.name.clone()).collect();
        let folder = folder_of(path);
        let replaces = path.exists() || beside.iter().any(|name| folder.join(name).exists());
        self.files.push(ExportedFile { path: path.to_owned(), bytes, beside, replaces });
        for lost in plan.lost.iter().map(ToString::to_string) {
            if !self.lost.contains(&lost) {
                self.lost.push(lost);
            }
        }
    }
}

/// Returns the format of a file, by its extension.
fn format_of(path: &Path) -> Result<Format, String> {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    import::written_format(extension).ok_or_else(|| {
        format!("{}: files of this kind cannot be written; use {}", path.display(), written_extensions())
    })
}

/// Returns a part of the model, with these takes.
fn part(model: &ModelData, takes: &[&Arc<Take>], content: ExportContent) -> ModelData {
    let takes = takes.iter().map(|&take| Arc::clone(take)).collect();
    let animation = AnimationData { skeleton: Arc::clone(&model.animation.skeleton), takes };
    match content {
        ExportContent::Everything | ExportContent::Model => ModelData { animation, ..model.clone() },
        ExportContent::Takes => {
            let mut avatar = model.avatar.clone();
            // Expressions set morph targets of meshes.
            avatar.expressions.iter_mut().for_each(|expression| expression.binds.clear());
            ModelData { name: model.name.clone(), animation, avatar, ..ModelData::default() }
        }
    }
}

/// The names of the files of takes: `Model@Take.glb`, without characters that file systems forbid, each different from the others.
struct FileNames {
    folder: PathBuf,
    stem: String,
    extension: String,
    /// In lower case: some file systems do not distinguish capitals.
    used: HashSet<String>,
}

impl FileNames {
    fn of(output: &Path) -> Self {
        let text = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        Self {
            folder: output.parent().map(Path::to_owned).unwrap_or_default(),
            stem: text(output.file_stem()),
            extension: text(output.extension()),
            used: HashSet::new(),
        }
    }

    fn path(&mut self, take: &str) -> PathBuf {
        let allowed = |character: char| match character {
            '/' | '\\' | ':' | '*' | '?' | '"' | '<' | '>' | '|' => '_',
            character if character.is_control() => '_',
            character => character,
        };
        let take: String = take.chars().map(allowed).take(NAME).collect();
        let take = if take.trim().is_empty() { "Take" } else { take.trim() };
        let (stem, extension) = (&self.stem, &self.extension);
        let numbered = |number: usize| match number {
            1 => format!("{stem}@{take}.{extension}"),
            number => format!("{stem}@{take} {number}.{extension}"),
        };
        let is_new = |name: &String| !self.used.contains(&name.to_lowercase());
        let name = (1..).map(numbered).find(is_new).unwrap_or_default();
        self.used.insert(name.to_lowercase());
        self.folder.join(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_takes_have_different_names_that_every_file_system_allows() {
        let mut names = FileNames::of(Path::new("out/Hero.glb"));
        let mut name = |take: &str| names.path(take).to_string_lossy().replace('\\', "/");
        assert_eq!(name("Walk"), "out/Hero@Walk.glb");
        assert_eq!(name("walk"), "out/Hero@walk 2.glb");
        assert_eq!(name("Armature|Run/\u{7}"), "out/Hero@Armature_Run__.glb");
        assert_eq!(name("  "), "out/Hero@Take.glb");
    }
}
