//! `dragonfly takes extract MODEL -o OUT|DIR`.

use super::super::choice::{File, plain};
use super::super::output::print;
use super::super::{Failure, tell};
use super::chosen;
use dragonfly_anim::data::{AnimationData, ModelData};
use dragonfly_anim::format::Format;
use dragonfly_document::{checked_preset, export, formats, make_folder, write_files, written_extensions};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Write takes of a model to a new file, or each to its own
#[derive(Clone, Debug, clap::Args)]
pub(super) struct ExtractTakes {
    #[command(flatten)]
    file: File,
    /// Take, by name or by index from 0; repeatable [default: all]
    #[arg(long, value_name = "TAKE", allow_hyphen_values = true)]
    take: Vec<String>,
    /// File to write, or with --each the folder, which is created where it is missing
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Write each take to a file of its own, named `Model@Take`
    #[arg(long)]
    each: bool,
    /// File name extension of the files in the folder
    #[arg(long, value_name = "EXT", requires = "each")]
    to: Option<String>,
    /// Program for which the files are written: unity, unreal, maya or blender, for .fbx
    #[arg(long, value_name = "PRESET")]
    preset: Option<String>,
    /// Leave out meshes, materials and images
    #[arg(long)]
    no_mesh: bool,
    /// Leave out all takes
    #[arg(long, conflicts_with_all = ["take", "each", "no_mesh"])]
    no_takes: bool,
}

impl ExtractTakes {
    pub(super) fn run(self) -> Result<(), Failure> {
        let loaded = self.file.load()?;
        let takes = &loaded.model.animation.takes;
        let indices = match (&*self.take, self.no_takes) {
            (_, true) => Vec::new(),
            ([], false) => (0..takes.len()).collect(),
            (wanted, false) => chosen(&loaded.title, takes, wanted)?,
        };
        let part = |indices: &[usize]| self.part(&loaded.model, indices);
        if !self.each {
            let extension =
                self.output.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
            let format = self.writer(extension)?;
            return self.write(&loaded.title, format, &part(&indices), &self.output);
        }
        let extension = self.to.clone().unwrap_or_else(|| {
            loaded
                .format
                .filter(|format| format.export.is_some())
                .map_or("glb", |format| format.extension())
                .to_owned()
        });
        let format = self.writer(&extension)?;
        let stem = loaded.title.rsplit_once('.').map_or(&*loaded.title, |(stem, _)| stem);
        let mut used = HashSet::new();
        for index in indices {
            let name = file_name(stem, &takes[index].name, &extension, &mut used);
            let path = self.output.join(name);
            make_folder(&path).map_err(Failure::Input)?;
            self.write(&loaded.title, format, &part(&[index]), &path)?;
        }
        Ok(())
    }
}

impl ExtractTakes {
    /// Returns the model with these takes alone.
    fn part(&self, model: &ModelData, indices: &[usize]) -> ModelData {
        let takes = indices.iter().map(|&index| Arc::clone(&model.animation.takes[index])).collect();
        let animation = AnimationData { skeleton: Arc::clone(&model.animation.skeleton), takes };
        if self.no_mesh {
            let mut avatar = model.avatar.clone();
            // Expressions set morph targets of meshes.
            avatar.expressions.iter_mut().for_each(|expression| expression.binds.clear());
            return ModelData { name: model.name.clone(), animation, avatar, ..ModelData::default() };
        }
        ModelData { animation, ..model.clone() }
    }

    /// Returns the format of an extension that can be written, with the preset if there is one.
    fn writer(&self, extension: &str) -> Result<Format, Failure> {
        let format = writer(extension)?;
        if let Some(preset) = &self.preset {
            checked_preset(&format, preset).map_err(|reason| Failure::input("--preset", reason))?;
        }
        Ok(format)
    }

    fn write(&self, title: &str, format: Format, model: &ModelData, path: &Path) -> Result<(), Failure> {
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let plan = export(&format, model, &name, self.preset.as_deref())
            .map_err(|error| Failure::input(title, error))?;
        write_files(path, &plan).map_err(|error| Failure::Input(error.to_string()))?;
        let bytes = plan.files.last().map_or(0, |file| file.bytes.len());
        tell(format_args!("wrote {} ({bytes} bytes)", path.display()));
        print(|out| plan.lost.iter().try_for_each(|lost| writeln!(out, "not written: {lost}")))
    }
}

/// Returns the format of an extension that can be written.
fn writer(extension: &str) -> Result<Format, Failure> {
    let formats = formats();
    let found = formats.by_extension(extension).filter(|format| format.export.is_some()).copied();
    found.ok_or_else(|| {
        let known = written_extensions();
        Failure::Input(format!(".{}: files of this kind cannot be written; use {known}", plain(extension)))
    })
}

/// Returns a name that no file of this run has: `Model@Take.glb`, without characters that file systems forbid.
fn file_name(stem: &str, take: &str, extension: &str, used: &mut HashSet<String>) -> String {
    let allowed = |character: char| match character {
        '/' | '\\' | ':' | '*' | '?' | '"' | '<' | '>' | '|' => '_',
        character if character.is_control() => '_',
        character => character,
    };
    let take: String = take.chars().map(allowed).take(100).collect();
    let take = if take.trim().is_empty() { "Take" } else { take.trim() };
    let numbered = |number: usize| match number {
        1 => format!("{stem}@{take}.{extension}"),
        number => format!("{stem}@{take} {number}.{extension}"),
    };
    // Some file systems do not distinguish capitals.
    let name = (1..).map(numbered).find(|name| !used.contains(&name.to_lowercase())).unwrap_or_default();
    used.insert(name.to_lowercase());
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_takes_have_different_names_that_every_file_system_allows() {
        let mut used = HashSet::new();
        let mut name = |take: &str| file_name("Hero", take, "glb", &mut used);
        assert_eq!(name("Walk"), "Hero@Walk.glb");
        assert_eq!(name("walk"), "Hero@walk 2.glb");
        assert_eq!(name("Armature|Run/\u{7}"), "Hero@Armature_Run__.glb");
        assert_eq!(name("  "), "Hero@Take.glb");
    }
}
