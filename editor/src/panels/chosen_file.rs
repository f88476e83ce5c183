//! The request that follows a file or folder that the user chose, in the system's dialog or by its path.

use super::file_choice::FileChoice;
use super::request::{FileAction, Request};
use super::sound::SoundSettings;
use dragonfly_document::{DocumentMessage, Source};
use std::path::PathBuf;

/// Returns the request that follows the choice of `first`, and of `others` where several files can be chosen.
pub(crate) fn request(choice: FileChoice, first: PathBuf, others: Vec<PathBuf>) -> Request {
    let all = |first| std::iter::once(first).chain(others).collect();
    match choice {
        FileChoice::PoseFolder => Request::PoseFolder(first),
        FileChoice::Reference => Request::ReferenceFile(first),
        FileChoice::Sound => Request::Sound(SoundSettings { file: first, start: 0 }),
        FileChoice::RetargetSource => {
            Request::Answer(FileAction::Send(DocumentMessage::ReadSource(Source::File(first))))
        }
        FileChoice::NewScene => Request::NewScene(first),
        FileChoice::DemoScene => Request::DemoScene(first),
        FileChoice::Role => Request::AddRole(first),
        FileChoice::Prop => Request::AddProp(first),
        FileChoice::SceneSound => Request::AddSound(first),
        FileChoice::MissingModel | FileChoice::MissingSound => Request::FileFound(first),
        FileChoice::Takes => Request::ImportTakes(all(first)),
        FileChoice::MappedTakes => Request::ImportMapped(all(first)),
    }
}
