//! Writes the files of a save, and makes later saves relative to them.

use super::adapter::{ModelAdapter, TextFile, TextFiles};
use super::beside::{BesideStamps, ReadOnce};
use super::copied_files::other_file;
use super::editable::{Editable, is_same_path, opened, places};
use super::edited_content::EditedContent;
use super::new_folders::make_folder;
use super::save_files::{SaveFiles, WrittenFile};
use super::source::file_name;
use super::writing::{FilesSaved, Overwrite, SaveFailure, UnsavedFile, Writing, save_file};
use super::written_copies::WrittenCopies;
use super::{Cancel, unused};
use dragonfly_anim::data::{AnimationData, ModelData};
use dragonfly_anim::format::gltf::save::buffer_of_save;
use dragonfly_anim::root_bone::BoneShift;
use dragonfly_store::{ExpectedFile, FileState, RealFiles, SaveOptions, folder_of, remove_unfinished};
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl Editable {
    /// Writes `files`, which [`Self::files`] returned, and makes later saves relative to them where they become the file of the
    /// document. Copies of other files come first.
    ///
    /// # Errors
    ///
    /// The reason. If another program changed one of the files, none was written. Otherwise those before the one that failed were, and
    /// later saves are relative to them too. In another folder those that were created are removed again.
    pub(super) fn write(
        &mut self,
        adapter: &ModelAdapter,
        files: SaveFiles,
        how: Writing<'_>,
        cancel: &Cancel,
    ) -> Result<FilesSaved, SaveFailure> {
        if !how.is_elsewhere {
            return self.write_files(adapter, files, &how, cancel, &mut WrittenCopies::default());
        }
        let earlier = self.copies.clone();
        let written = files.written.iter().map(|(path, _)| &**path);
        let mut copies = WrittenCopies::before(files.copied.paths().chain(written));
        self.write_files(adapter, files, &how, cancel, &mut copies).map_err(|reason| {
            let stay = copies.remove();
            if stay.is_empty() {
                self.copies = earlier;
            }
            let reason = if cancel.is_cancelled() { SaveFailure::Cancelled(Vec::new()) } else { reason };
            reason.with_staying(stay)
        })
    }

    /// Writes the files, and adds those in another folder to `copies`.
    fn write_files(
        &mut self,
        adapter: &ModelAdapter,
        files: SaveFiles,
        how: &Writing<'_>,
        cancel: &Cancel,
        copies: &mut WrittenCopies,
    ) -> Result<FilesSaved, SaveFailure> {
        let SaveFiles { copied, written: mut files, kept, .. } = files;
        let Some((main, bytes)) = files.pop() else { return Ok(FilesSaved::default()) };
        self.check_expected(&files, &main, how)?;
        let mut beside = BesideStamps::default();
        let mut saved = FilesSaved { notices: copied.notices().collect(), ..FilesSaved::default() };
        let (mut bytes_copied, all) = (0, copied.bytes().max(1));
        copied.write(how.versions, cancel, |path, bytes, done| {
            saved.notices.extend(done.notices);
            saved.files.push(path.to_path_buf());
            copies.add(path, done.stamp);
            self.copies.add(&main, done.path, done.stamp);
            bytes_copied += bytes as u64;
            (how.copied)(saved.files.len(), (bytes_copied as f32 / all as f32).min(1.0));
        })?;
        if how.is_elsewhere && cancel.is_cancelled() {
            return Err(SaveFailure::Cancelled(Vec::new()));
        }
        for (path, stamp) in kept {
            // It was found to be the same when the files were listed.
            if !matches!(stamp.state(&RealFiles, &path), Ok(FileState::Same)) {
                return Err(SaveFailure::Other(other_file(&path)));
            }
            if let Ok(path) = path.canonicalize() {
                beside.add(path, stamp);
            }
        }
        for (path, bytes) in &files {
            // A text of a project has versions as the project has.
            let versions = how.versions.filter(|_| matches!(self.content, EditedContent::Texts(_)));
            let options = SaveOptions { expected: self.expected(path, &main, how), versions };
            let done = make_folder(path)
                .map_err(UnsavedFile::from)
                .and_then(|()| save_file(how.disk, path, bytes, &options));
            match done {
                Ok(done) => {
                    if how.is_elsewhere {
                        copies.add(path, done.stamp);
                        self.copies.add(&main, done.path.clone(), done.stamp);
                    }
                    beside.add(done.path, done.stamp);
                    saved.notices.extend(done.notices);
                    saved.files.push(path.clone());
                }
                Err(UnsavedFile { reason, own }) => {
                    if let Some((own, stamp)) = own {
                        if how.is_elsewhere {
                            copies.add(path, stamp);
                            self.copies.add(&main, own.clone(), stamp);
                        }
                        beside.add(own, stamp);
                        saved.files.push(path.clone());
                    }
                    self.note_written(adapter, &main, &saved.files, beside);
                    return Err(if how.is_elsewhere { reason.of_copy(other_file(path)) } else { reason });
                }
            }
        }
        if self.keeps_main(&main, &bytes, how.overwrite) {
            self.beside.extend(beside);
            saved.bytes = bytes.len();
            self.content = EditedContent::Texts(adapter.texts().clone());
            return Ok(saved);
        }
        let expected = match (how.overwrite, &self.stamp) {
            (Overwrite::AsRead, Some(stamp)) => ExpectedFile::Stamp(stamp),
            (Overwrite::Nothing, _) => ExpectedFile::Nothing,
            _ => ExpectedFile::Anything,
        };
        let options = SaveOptions { expected, versions: how.versions };
        let done = match save_file(how.disk, &main, &bytes, &options) {
            Ok(done) => done,
            Err(UnsavedFile { reason, own }) => {
                self.note_written(adapter, &main, &saved.files, beside);
                // The main file is there, and refers to the others.
                if own.is_some() {
                    copies.keep();
                }
                if let Some((_, stamp)) = own.filter(|_| self.is_own(&main)) {
                    self.stamp = Some(stamp);
                }
                return Err(reason);
            }
        };
        saved.files.push(main.clone());
        saved.notices.extend(done.notices);
        saved.bytes = bytes.len();
        let name = file_name(&main);
        remove_unfinished(&RealFiles, folder_of(&main), &|other| buffer_of_save(other, &name).is_some());
        if how.becomes {
            self.copies.forget();
            if !self.is_own(&main) {
                self.beside = BesideStamps::default();
            }
            self.beside.extend(beside);
            self.stamp = Some(done.stamp);
            self.title = file_name(&main);
            self.path = Some(main.clone());
            if let Err(reason) = self.begin_again(adapter, bytes) {
                saved
                    .notices
                    .push(format!("the saved file cannot be edited further: {reason}; open it again"));
            }
            saved.notices.extend(unused::notice(&main, &self.content.neighbors()));
        }
        Ok(saved)
    }

    /// Returns what a file next to the main one must be when it is written.
    fn expected(&self, path: &Path, main: &Path, how: &Writing<'_>) -> ExpectedFile<'_> {
        let is_text = matches!(self.content, EditedContent::Texts(_));
        let is_decided = || how.replaces.iter().any(|other| is_same_path(other, path));
        match self.beside.of(path) {
            // There was none when the files were listed, or an earlier copy.
            _ if how.is_elsewhere && is_text => {
                let earlier = self.copies.of(main).and_then(|copies| copies.of(path));
                earlier.map_or(ExpectedFile::Nothing, ExpectedFile::Stamp)
            }
            _ if how.overwrite != Overwrite::AsRead => ExpectedFile::Anything,
            // The user decided about a file that the document had not read.
            Some(stamp) => ExpectedFile::Stamp(stamp),
            // A text that the project got since it was opened.
            None if is_text && !is_decided() => ExpectedFile::Nothing,
            None => ExpectedFile::Anything,
        }
    }

    /// Checks that no other program changed or created any of the files, before the first one is written.
    fn check_expected(
        &self,
        files: &[WrittenFile],
        main: &Path,
        how: &Writing<'_>,
    ) -> Result<(), SaveFailure> {
        if how.overwrite == Overwrite::AsRead {
            if let Some((path, _)) = self.changed_beside() {
                return Err(SaveFailure::Changed(path.to_path_buf()));
            }
            if self.state_of(main) == Some(FileState::Changed) {
                return Err(SaveFailure::Changed(main.to_path_buf()));
            }
        }
        for (path, _) in files {
            let is_as_expected = match self.expected(path, main, how) {
                ExpectedFile::Anything => true,
                ExpectedFile::Nothing => path.symlink_metadata().is_err(),
                // Of the document's own folder they were checked.
                ExpectedFile::Stamp(stamp) => {
                    !how.is_elsewhere || stamp.state(&RealFiles, path).ok() != Some(FileState::Changed)
                }
            };
            if !is_as_expected {
                let reason = SaveFailure::Exists(path.clone());
                return Err(if how.is_elsewhere { reason.of_copy(other_file(path)) } else { reason });
            }
        }
        if how.overwrite == Overwrite::Nothing && main.symlink_metadata().is_ok() {
            return Err(SaveFailure::Exists(main.to_path_buf()));
        }
        Ok(())
    }

    /// Makes later saves relative to the texts that a save wrote before it failed.
    fn note_written(
        &mut self,
        adapter: &ModelAdapter,
        main: &Path,
        written: &[PathBuf],
        beside: BesideStamps,
    ) {
        let EditedContent::Texts(old) = &self.content else { return };
        if !self.is_own(main) {
            return;
        }
        let folder = folder_of(main);
        let is_written = |file: &TextFile| written.iter().any(|path| *path == folder.join(&*file.name));
        let (mut texts, new) = (old.list().to_vec(), adapter.texts().list());
        for file in new.iter().filter(|file| is_written(file)) {
            match texts.iter_mut().find(|old| old.name == file.name) {
                Some(old) => old.text = file.text.clone(),
                None => texts.push(file.clone()),
            }
        }
        self.content = EditedContent::Texts(TextFiles::new(texts));
        self.beside.extend(beside);
    }

    /// Returns whether a save as `path` writes only other texts and leaves the main one, with these bytes, as it is.
    pub(super) fn keeps_main(&self, path: &Path, bytes: &[u8], overwrite: Overwrite) -> bool {
        let EditedContent::Texts(texts) = &self.content else { return false };
        let is_same = texts.main().is_some_and(|text| text.as_bytes() == bytes);
        let is_there = || self.state_of(path).map_or_else(|| path.exists(), |state| state == FileState::Same);
        overwrite == Overwrite::AsRead && texts.list().len() > 1 && is_same && self.is_own(path) && is_there()
    }

    /// Returns the state of the main file at `path` since it was read or saved last; `None` where that is not known.
    fn state_of(&self, path: &Path) -> Option<FileState> {
        self.stamp.as_ref().and_then(|stamp| stamp.state(&RealFiles, path).ok())
    }

    /// Makes later saves relative to `bytes`, which contain the takes of `adapter`.
    fn begin_again(&mut self, adapter: &ModelAdapter, bytes: Vec<u8>) -> Result<(), String> {
        let format = match &self.content {
            EditedContent::Model(file) => file.format(),
            EditedContent::Texts(_) => {
                self.content = EditedContent::Texts(adapter.texts().clone());
                return Ok(());
            }
        };
        let door = self.path.as_deref().and_then(|path| ReadOnce::of(path).ok());
        let file = opened(format, &self.title, bytes, door.as_ref(), self.conventions);
        self.content = EditedContent::Model(Arc::new(file.map_err(|error| error.to_string())?));
        self.beside.extend(door.map(|door| door.stamps()).unwrap_or_default());
        let skeleton = Arc::clone(adapter.skeleton());
        let shift = BoneShift::between(&self.model.animation.skeleton, &skeleton);
        let model = shift.and_then(|shift| shift.model(&self.model, &skeleton));
        let model = model.ok_or("its bones are not those that were opened")?;
        let animation = AnimationData { skeleton, takes: adapter.saved_takes() };
        self.on_disk = Arc::new(ModelData { animation, ..model });
        self.places = Some(places(adapter));
        Ok(())
    }
}
