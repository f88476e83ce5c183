//! Messages about copies of files where nothing came of them: the scene is not open any more, or the save was stopped.

use crate::scene_bench::{FOXES, scene};
use crate::scene_files::{done, open_another, window_in};
use crate::scene_sounds::move_to;
use crate::workbench::Window;
use dragonfly::app::scene_files;
use dragonfly::panels::dialogs::Question;
use dragonfly::panels::dropped_files::{DroppedModel, DroppedModels, ModelForm, UnknownModels};
use dragonfly::panels::status::{MessageSeverity, StatusMessage};
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::bounds::AxisBox;
use dragonfly_document::{NotSaved, SaveOrder, Then};
use dragonfly_kit::folder::{Folder, data};
use std::fs;

fn last(window: &Window) -> StatusMessage {
    window.state().state.read().status.last().cloned().expect("a message")
}

/// Copies a model from another folder for the scene, after the user agreed. Returns the files before the scene gets them.
fn copied(window: &mut Window, other: &Folder) -> scene_files::SceneFilesAnswer {
    fs::copy(data("gltf/Fox.glb"), other.join("knight.glb")).expect("a copy");
    let state = &mut window.state_mut().state;
    let effect = state.execute(Request::AddRole(other.join("knight.glb")));
    let Some(Effect::LookAtFiles(wanted)) = effect else { panic!("{effect:?}") };
    let (wanted, copied) = done(scene_files::look, wanted).expect("it can be read");
    assert_eq!(state.files_answered(wanted, copied), None);
    let question = state.read().question().cloned();
    let Some(Question::Copy(question)) = question else { panic!("{question:?}") };
    let effect = state.execute(Request::CopyFiles(question.wanted));
    let Some(Effect::CopyFiles(wanted)) = effect else { panic!("{effect:?}") };
    done(scene_files::copy, wanted)
}

/// The message about a copy for a scene that is not open any more.
const NOT_ADDED: &str = "The scene is not open any more: its files were not added, but they were copied into its folder: models/knight.glb";

#[test]
fn copies_for_a_scene_that_is_not_open_any_more_are_named() {
    let (folder, other) = (Folder::new("copies-late"), Folder::new("copies-late-other"));
    let mut window = window_in(&folder, scene(FOXES));
    let (wanted, copies) = copied(&mut window, &other).expect("a copy");
    move_to(window.state_mut(), &other);
    assert_eq!(window.state_mut().state.files_answered(wanted, copies), None);
    assert_eq!(last(&window).text, NOT_ADDED);
}

#[test]
fn copies_are_named_also_where_the_scene_is_closed_while_the_copied_model_is_read() {
    let (folder, other) = (Folder::new("copies-read"), Folder::new("copies-read-other"));
    let mut window = window_in(&folder, scene(FOXES));
    let (wanted, copies) = copied(&mut window, &other).expect("a copy");
    let effect = window.state_mut().state.files_answered(wanted, copies);
    let Some(Effect::LookAtModels(unknown)) = effect else { panic!("{effect:?}") };
    let UnknownModels { place, sounds, hashes, copied, target, .. } = *unknown;
    open_another(&mut window);
    let name = "models/knight.glb".to_owned();
    let models = vec![DroppedModel { name, form: ModelForm::Figure, scale: 1.0, around: AxisBox::EMPTY }];
    let dropped = DroppedModels { models, place, sounds, hashes, copied, target };
    let effect = window.state_mut().state.execute(Request::DroppedModels(Box::new(dropped)));
    assert_eq!((effect, last(&window).text.as_str()), (None, NOT_ADDED));
}

#[test]
fn a_save_that_the_user_stopped_is_no_error_and_files_that_stay_are_named() {
    let mut window = scene(FOXES).window();
    let mut stopped = |then: Option<Then>, stay: &[&str]| {
        let stay = stay.iter().map(Into::into).collect();
        let state = &mut window.state_mut().state;
        assert_eq!(state.not_saved(SaveOrder::own(then), NotSaved::Cancelled(stay)), None);
        let is_asked = state.read().question().is_some();
        let message = last(&window);
        (message.level, message.text, is_asked)
    };
    let nothing = "The save was stopped; nothing was changed".to_owned();
    assert_eq!(stopped(None, &[]), (MessageSeverity::Info, nothing.clone(), false));
    let some = "The save was stopped; files that were written before stay: /a/Fox.glb, /a/end.xml".to_owned();
    assert_eq!(stopped(None, &["/a/Fox.glb", "/a/end.xml"]), (MessageSeverity::Warning, some, false));
    // A user who wanted to leave is asked what to do with the changes.
    assert_eq!(stopped(Some(Then::Quit), &[]), (MessageSeverity::Info, nothing, true));
}
