//! The files of a save: those that change, and those that another folder needs with them.

use super::adapter::{TextFile, TextFiles};
use super::beside::BesideStamps;
use super::copied_files::{CANCELLED, CopiedFiles, ensure_inside, other_file};
use super::editable::{Editable, is_same_path};
use super::edited_content::EditedContent;
use super::needed_files::NeededFiles;
use super::source::file_name;
use super::text_source::{contains_scene, is_project};
use super::{Cancel, Folder};
use dragonfly_anim::format::{OutputFile, SavePlan};
use dragonfly_store::{FileStamp, RealFiles, folder_of};
use std::path::{Path, PathBuf};

/// Path and contents of a file to write.
pub type WrittenFile = (PathBuf, Vec<u8>);

/// The files of a save.
#[derive(Debug, Default)]
pub struct SaveFiles {
    /// The files that the document needs next to it, which another folder gets. They are copied first.
    pub copied: CopiedFiles,
    /// The files that are written. The file itself is last, so that it never refers to a file that does not exist.
    pub written: Vec<WrittenFile>,
    /// Texts of the document that another folder has already, with the same contents, and the stamps with which they were found to be the same.
    pub(super) kept: Vec<(PathBuf, FileStamp)>,
    /// Whether they are in another folder than the document.
    pub(super) is_elsewhere: bool,
}

impl Editable {
    /// Returns whether `output` is in another folder than the file of the document.
    pub(super) fn is_elsewhere(&self, output: &Path) -> bool {
        self.path.as_deref().is_some_and(|own| !is_same_path(folder_of(own), folder_of(output)))
    }

    /// Returns the files that saving as `output` writes. What the document needs is copied along to another folder: the files next to a
    /// model; the texts, models and sounds of a scene. Models of a scene may be read to know which files they need; `progress` is called with
    /// the fraction of them that was read. The folder of `output` need not exist.
    ///
    /// # Errors
    ///
    /// The path and the reason why it is impossible, or it was cancelled. A file that the other folder has must be the one that is needed.
    pub fn files(
        &self,
        plan: &SavePlan,
        output: &Path,
        cancel: &Cancel,
        progress: &dyn Fn(f32),
    ) -> Result<SaveFiles, String> {
        let Some((main, beside)) = plan.files.split_last() else { return Ok(SaveFiles::default()) };
        let folder = folder_of(output);
        let written = |file: &OutputFile| (folder.join(&file.name), file.bytes.clone());
        // Standard output and devices are in no folder that could get the other files.
        let is_device = output == Path::new("-") || output.metadata().is_ok_and(|data| !data.is_file());
        let is_elsewhere = |_: &&Path| !is_device && self.is_elsewhere(output);
        let from = self.path.as_deref().map(folder_of).filter(is_elsewhere);
        let mut files = SaveFiles { is_elsewhere: from.is_some(), ..SaveFiles::default() };
        let none = BesideStamps::default();
        let earlier = self.copies.of(output).unwrap_or(&none);
        let Some(from) = from else {
            if !is_device {
                self.ensure_not_shared(output)?;
                self.ensure_not_needed(plan, output, cancel, progress)?;
            }
            files.written = beside.iter().map(written).collect();
            files.written.push((output.to_path_buf(), main.bytes.clone()));
            return Ok(files);
        };
        let from = match (Folder::new(from), &self.content) {
            (Ok(from), _) => from,
            // Its folder is gone, and the texts are here.
            (Err(error), EditedContent::Texts(texts)) => {
                files.add_texts(&saved_texts(texts, plan), folder, earlier)?;
                files.written.push((output.to_path_buf(), main.bytes.clone()));
                files.copied.add_missing(format!("nothing was copied from {}: {error}", from.display()));
                return Ok(files);
            }
            (Err(error), EditedContent::Model(_)) => return Err(format!("{}: {error}", from.display())),
        };
        let needed = match &self.content {
            EditedContent::Model(file) => {
                files.written = beside.iter().map(written).collect();
                let is_written = |name: &String| beside.iter().any(|file| file.name == *name);
                let names = file.neighbors().into_iter().filter(|name| !is_written(name));
                NeededFiles { names: names.collect(), reasons: Vec::new() }
            }
            EditedContent::Texts(texts) => {
                let texts = saved_texts(texts, plan);
                files.add_texts(&texts, folder, earlier)?;
                let is_of_project = self.path.as_deref().is_some_and(is_project);
                let needed = NeededFiles::of(&texts, is_of_project, &from, cancel, progress);
                let is_other = |name: &String| texts.called(name).is_none();
                NeededFiles { names: needed.names.into_iter().filter(is_other).collect(), ..needed }
            }
        };
        if cancel.is_cancelled() {
            return Err(CANCELLED.to_owned());
        }
        files.copied = CopiedFiles::find(from, folder, needed.names, earlier, cancel)?;
        files.copied.add_errors(needed.reasons);
        if files.has(output) {
            return Err(needed_file(output));
        }
        files.written.push((output.to_path_buf(), main.bytes.clone()));
        Ok(files)
    }

    /// Checks that a project does not get a second name in its folder: both would have the same scripts and lines, and a change of one would
    /// change the other.
    fn ensure_not_shared(&self, output: &Path) -> Result<(), String> {
        let EditedContent::Texts(texts) = &self.content else { return Ok(()) };
        let own = self.path.as_deref().filter(|own| own.exists() && !self.is_own(output));
        let (Some(own), [_, shared, more @ ..]) = (own, texts.list()) else { return Ok(()) };
        let others = match more.len() {
            0 => String::new(),
            1 => " and one more file".to_owned(),
            more => format!(" and {more} more files"),
        };
        Err(format!(
            "{}: it would have {}{others} in common with {}, and a change of one would change both; choose another folder, \
             which gets everything that the project needs",
            output.display(),
            shared.name,
            file_name(own),
        ))
    }

    /// Checks that a save as another file of the folder does not replace a file that the document needs. Reads models only where the file is
    /// not itself a script or a project: no format has one among the files that a model needs.
    fn ensure_not_needed(
        &self,
        plan: &SavePlan,
        output: &Path,
        cancel: &Cancel,
        progress: &dyn Fn(f32),
    ) -> Result<(), String> {
        let EditedContent::Texts(texts) = &self.content else { return Ok(()) };
        if self.is_own(output) || output.symlink_metadata().is_err() {
            return Ok(());
        }
        let folder = Folder::of(output).map_err(|error| format!("{}: {error}", output.display()))?;
        let texts = saved_texts(texts, plan);
        let is_of_project = self.path.as_deref().is_some_and(is_project);
        let needed = match contains_scene(output) {
            true => NeededFiles::named(&texts, is_of_project, &folder, cancel),
            false => NeededFiles::of(&texts, is_of_project, &folder, cancel, progress),
        };
        let others = texts.list().iter().skip(1).map(|file| file.name.to_string());
        // A missing file that is needed is no reason: then there is no file of this name.
        let is_it = |name: &String| is_same_path(&folder_of(output).join(name), output);
        match needed.names.into_iter().chain(others).any(|name| is_it(&name)) {
            true => Err(needed_file(output)),
            false => Ok(()),
        }
    }
}

/// Returns the reason why a document is not saved in place of a file that it needs.
fn needed_file(path: &Path) -> String {
    format!("{}: the scene needs another file of this name; choose another name", path.display())
}

impl SaveFiles {
    /// Returns whether a file that is needed, or another text, has this path.
    fn has(&self, path: &Path) -> bool {
        let written = self.written.iter().map(|(path, _)| &**path);
        let kept = self.kept.iter().map(|(path, _)| &**path);
        let copied = self.copied.paths().chain(self.copied.present());
        written.chain(kept).chain(copied).any(|other| is_same_path(other, path))
    }

    /// Adds the texts of a document, apart from the main one, to be written into `folder`. `earlier` are copies that the document wrote before, which
    /// are replaced unless they changed since.
    ///
    /// # Errors
    ///
    /// The path of another file of this name, or of one that is outside of the folder through links.
    fn add_texts(&mut self, texts: &TextFiles, folder: &Path, earlier: &BesideStamps) -> Result<(), String> {
        for TextFile { name, text } in texts.list().iter().skip(1) {
            let (path, bytes) = (folder.join(&**name), text.as_bytes());
            ensure_inside(folder, &path)?;
            let there = FileStamp::take(&RealFiles, &path).ok();
            if let Some(stamp) = there.filter(|stamp| stamp.is_of(bytes)) {
                self.kept.push((path, stamp));
            } else if path.symlink_metadata().is_ok() && earlier.unchanged(&path).is_none() {
                return Err(other_file(&path));
            } else {
                self.written.push((path, bytes.to_vec()));
            }
        }
        Ok(())
    }
}

/// Returns the texts of a document as a plan saves them.
fn saved_texts(on_disk: &TextFiles, plan: &SavePlan) -> TextFiles {
    let Some((main, beside)) = plan.files.split_last() else { return on_disk.clone() };
    let text = |file: &OutputFile| -> std::sync::Arc<str> { String::from_utf8_lossy(&file.bytes).into() };
    let mut texts = on_disk.list().to_vec();
    if let Some(own) = texts.first_mut() {
        own.text = text(main);
    }
    for file in beside {
        match texts.iter_mut().skip(1).find(|own| *own.name == *file.name) {
            Some(own) => own.text = text(file),
            None => texts.push(TextFile { name: file.name.as_str().into(), text: text(file) }),
        }
    }
    TextFiles::new(texts)
}
