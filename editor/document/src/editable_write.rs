//! Writes the files of a save, and makes later saves relative to them.

use super::adapter::ModelAdapter;
use super::beside::{BesideStamps, ReadOnce};
use super::editable::{Editable, WrittenFile, make_folder, opened, places};
use super::edited_content::EditedContent;
use super::source::file_name;
use super::unused;
use super::writing::{FilesSaved, Overwrite, SaveFailure, Writing};
use dragonfly_anim::data::{AnimationData, ModelData};
use dragonfly_anim::format::gltf::save::buffer_of_save;
use dragonfly_anim::root_bone::BoneShift;
use dragonfly_store::{
    ExpectedFile, RealFiles, SaveOptions, folder_of, remove_unfinished, save as save_file,
};
use std::path::Path;
use std::sync::Arc;

impl Editable {
    /// Writes `files`, which [`Self::files`] returned, and makes later saves relative to them where they become the file of the
    /// document.
    ///
    /// # Errors
    ///
    /// The reason. Existing files are unchanged then, unless the error names them.
    pub(super) fn write(
        &mut self,
        adapter: &ModelAdapter,
        mut files: Vec<WrittenFile>,
        how: Writing<'_>,
    ) -> Result<FilesSaved, SaveFailure> {
        let Some((main, bytes)) = files.pop() else { return Ok(FilesSaved::default()) };
        if how.overwrite == Overwrite::AsRead
            && let Some((path, _)) = self.changed_beside()
        {
            return Err(SaveFailure::Changed(path.to_path_buf()));
        }
        let mut beside = BesideStamps::default();
        let mut saved = FilesSaved::default();
        for (path, bytes) in &files {
            make_folder(path)?;
            let old = self.beside.of(path).filter(|_| how.overwrite == Overwrite::AsRead);
            let is_new_text =
                matches!(&self.content, EditedContent::Texts(_)) && how.overwrite == Overwrite::AsRead;
            let expected = match old {
                Some(stamp) => ExpectedFile::Stamp(stamp),
                // A text that the project got since it was opened.
                None if is_new_text => ExpectedFile::Nothing,
                None => ExpectedFile::Anything,
            };
            // A text of a project has versions as the project has.
            let versions = how.versions.filter(|_| matches!(self.content, EditedContent::Texts(_)));
            let options = SaveOptions { expected, versions };
            let done = save_file(&RealFiles, path, bytes, &options).map_err(SaveFailure::of)?;
            beside.add(done.path, done.stamp);
            saved.files.push(path.clone());
        }
        if how.overwrite == Overwrite::AsRead && how.becomes && self.has_unchanged_main(&main, &bytes) {
            self.beside.extend(beside);
            saved.bytes = bytes.len();
            saved.files.push(main);
            self.content = EditedContent::Texts(adapter.texts().clone());
            return Ok(saved);
        }
        let expected = match (how.overwrite, &self.stamp) {
            (Overwrite::AsRead, Some(stamp)) => ExpectedFile::Stamp(stamp),
            (Overwrite::Nothing, _) => ExpectedFile::Nothing,
            _ => ExpectedFile::Anything,
        };
        let options = SaveOptions { expected, versions: how.versions };
        let done = save_file(&RealFiles, &main, &bytes, &options).map_err(SaveFailure::of)?;
        saved.files.push(main.clone());
        saved.notices = done.notices;
        saved.bytes = bytes.len();
        let is_elsewhere = self.path.as_deref().is_some_and(|path| folder_of(path) != folder_of(&main));
        if is_elsewhere && matches!(self.content, EditedContent::Texts(_)) {
            let notice = "its models were not copied to the new folder; `dragonfly pack` collects all files of a scene";
            saved.notices.push(notice.to_owned());
        }
        let name = file_name(&main);
        remove_unfinished(&RealFiles, folder_of(&main), &|other| buffer_of_save(other, &name).is_some());
        if how.becomes {
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

    /// Returns whether a save writes other texts and leaves the main one, at this path, as it is.
    pub(super) fn has_unchanged_main(&self, path: &Path, bytes: &[u8]) -> bool {
        let EditedContent::Texts(texts) = &self.content else { return false };
        let is_same = texts.main().is_some_and(|text| text.as_bytes() == bytes);
        texts.list().len() > 1 && is_same && self.is_own(path)
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
