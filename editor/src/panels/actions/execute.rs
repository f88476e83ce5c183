//! The one place where requests are executed.

#![deny(clippy::wildcard_enum_match_arm)]

use super::{
    added_files, bones, clipboard, drags, dropped, files, framing, keys, layers, locks, look, playback,
    scene, scene_files, scene_time, scope, sets, takes,
};
use crate::panels::commands;
use crate::panels::dropped_files::{DropPlace, FileUse};
use crate::panels::file_choice::FileChoice;
use crate::panels::keys::KeysRequest;
use crate::panels::reference::settings::ReferenceSettings;
use crate::panels::request::{Effect, FileAction, Request};
use crate::panels::settings::IkSettings;
use crate::panels::sound::SoundSettings;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_document::edit::{Edit, TrimTake};
use dragonfly_document::{Change, ClipOrder, DocumentMessage, SceneFileKind, Source, Then};
use dragonfly_picture::between;
use dragonfly_sound::is_sound_file;

/// Executes a request of a panel.
pub(in crate::panels) fn execute(workspace: &mut Workspace, request: Request) -> Option<Effect> {
    let said = workspace.status.said();
    let effect = perform(workspace, request);
    if let Some(Effect::Change(Change::Edit(Edit::TrimTake(TrimTake { from, to, to_start: true, .. }), _))) =
        effect
    {
        // The play range becomes the whole take, which starts at another time; the playhead moves there, too.
        keys::set_range(workspace, None);
        let time = between(workspace.player.time(), from, to) - from + workspace.read().take_bounds().0;
        playback::seek(workspace, time);
    }
    if matches!(effect, Some(Effect::Change(_))) {
        workspace.status.keep_last(workspace.status.said() != said);
    }
    playback::bound_playback(workspace);
    keep_settings(workspace);
    locks::unlocked(workspace, effect?)
}

/// Executes a request without what follows every one.
pub(super) fn perform(workspace: &mut Workspace, request: Request) -> Option<Effect> {
    match request {
        Request::Command(id) => return run(workspace, commands::get(id)),
        Request::Select(bone) => {
            workspace.keys.lose_focus();
            workspace.bones.select(bone);
        }
        Request::SelectBones(bones, choice) => {
            workspace.keys.lose_focus();
            workspace.bones.choose(&bones, choice);
        }
        Request::Hide { bones, hide } => workspace.bones.hide(&bones, hide),
        Request::Angles(given) => workspace.given.give(given),
        Request::Timeline(request) => return keys_request(workspace, request),
        Request::Change(change) => return Some(Effect::Change(change)),
        Request::PastePose { text, mirrored } => return clipboard::paste(workspace, &text, mirrored),
        Request::Hover(bone) => workspace.bones.hover(Some(bone)),
        Request::ShowTake(take) => playback::show_take(workspace, take),
        Request::ChooseLayer(layer) => layers::choose(workspace, layer),
        Request::CompareWith(with) => workspace.compared = with,
        Request::Preview(preview) => workspace.preview = preview,
        Request::Seek(time) => playback::seek(workspace, time),
        Request::Speed(speed) => playback::set_speed(workspace, speed),
        Request::Repeat(repeat) => playback::set_repeat(workspace, repeat),
        Request::FrameRate(rate) if workspace.read().scene().is_some() => {
            return scene_time::set_rate(workspace, rate);
        }
        Request::FrameRate(rate) => workspace.frame_rate.choose(rate),
        Request::LengthUnit(meters) => workspace.unit.choose(meters),
        Request::Scale(scale) => look::set_scale(workspace, scale),
        Request::Keys(keys) => workspace.settings.keys = keys,
        Request::Camera(camera) => return framing::move_camera(workspace, camera),
        Request::Viewport(rect) => framing::set_viewport(workspace, rect),
        Request::SecondView(rect) => workspace.camera.set_second(rect),
        Request::Ghosts(ghosts) => workspace.settings.tools.ghosts = ghosts.sanitized(),
        Request::Falloff(falloff) => scope::set_falloff(workspace, falloff),
        Request::Shields(shields) => framing::set_shields(workspace, shields),
        Request::Wheel(by) => return framing::wheel(workspace, by),
        Request::Point(pointer) => bones::point(workspace, pointer),
        Request::PointElsewhere => {
            workspace.stage.hover(None);
        }
        Request::Open(Source::File(file)) if workspace.read().scene().is_some() && is_sound_file(&file) => {
            return dropped::dropped(workspace, vec![file]);
        }
        Request::Open(Source::File(file)) if workspace.model.view().is_some() && is_sound_file(&file) => {
            workspace.sound.set(SoundSettings { file, ..SoundSettings::default() });
        }
        Request::Open(source) => return Some(Effect::File(FileAction::Leave(Then::Open(source)))),
        Request::ImportTakes(files) => {
            return Some(Effect::File(FileAction::Send(DocumentMessage::ImportTakes(ClipOrder::of(files)))));
        }
        Request::ChooseMapped(order) => {
            workspace.retarget.set_order(*order);
            return Some(Effect::Choose(FileChoice::MappedTakes, workspace.read().model_folder()));
        }
        Request::ImportMapped(files) => {
            let order = ClipOrder { files, ..workspace.retarget.take_order()? };
            workspace.prompts.show(None);
            return Some(Effect::File(FileAction::Send(DocumentMessage::ImportTakes(order))));
        }
        Request::Overlay(overlay) => workspace.prompts.show(overlay),
        Request::TogglePanel(id) => return Some(Effect::TogglePanel(id)),
        Request::RenameTake(index) => takes::rename(workspace, index),
        Request::Answer(action) => return files::answered(workspace, action),
        Request::Dismiss => return files::dismiss(workspace),
        Request::PropertiesLook(look) => workspace.settings.properties = look,
        Request::CurvesLook(look) => workspace.settings.curves = look.sanitized(),
        Request::PoseFolder(folder) => {
            let text = format!("The folder of poses is {}", folder.display());
            workspace.say(MessageSeverity::Info, text);
            workspace.settings.pose_folder = Some(folder);
        }
        Request::Sound(settings) => workspace.sound.set(settings),
        Request::Reference(settings) => workspace.reference.set(settings),
        Request::ReferenceFile(file) => {
            let now = workspace.reference.settings().clone();
            workspace.reference.set(ReferenceSettings { file, shown: true, ..now });
        }
        Request::Choose(choice, from) => return Some(Effect::Choose(choice, from)),
        Request::Sets(action) => sets::perform(workspace, &action),
        Request::Scene(request) => return scene::perform(workspace, request),
        Request::Dropped(files) => return dropped::dropped(workspace, files),
        Request::DroppedModels(models) => return added_files::add_known(workspace, &models),
        Request::AddLayerFrom(take) => return layers::add_from(workspace, take),
        Request::AddRole(path) => {
            return scene_files::want(workspace, vec![(SceneFileKind::Model, path)], FileUse::Role);
        }
        Request::AddProp(path) => {
            return scene_files::want(workspace, vec![(SceneFileKind::Model, path)], FileUse::Prop);
        }
        Request::AddSound(path) => {
            let used = FileUse::Add(DropPlace::Nowhere);
            return scene_files::want(workspace, vec![(SceneFileKind::Sound, path)], used);
        }
        Request::CopyFiles(wanted) => return Some(scene_files::copy(workspace, wanted)),
        Request::FileFound(path) => {
            workspace.prompts.close_missing();
            return scene_files::found(workspace, path);
        }
        Request::TypeFoundFile => scene_files::type_path(workspace),
        Request::LookAtFolder(folder) => {
            return Some(Effect::File(FileAction::Send(DocumentMessage::LookAtFolder(folder))));
        }
        Request::NewScene(path) => return Some(Effect::NewScene(path)),
        Request::DemoScene(folder) => return Some(Effect::DemoScene(folder)),
    }
    None
}

fn keys_request(workspace: &mut Workspace, request: KeysRequest) -> Option<Effect> {
    match request {
        KeysRequest::Select { channels, shapes, stretch, choice } => {
            keys::select(workspace, &channels, shapes, stretch, choice)
        }
        KeysRequest::SelectKeys { parts, shapes, choice } => {
            let take = workspace.read().shared_take().cloned();
            workspace.keys.select_parts(take.as_deref(), &parts, &shapes, choice);
        }
        KeysRequest::SelectRow(bone, choice) => {
            let listed = workspace.read().listed_bones();
            workspace.bones.choose(&[bone], choice);
            workspace.keys.keep_rows(listed, workspace.bones.bones());
        }
        KeysRequest::Deselect => workspace.keys.deselect(),
        KeysRequest::Window(window) => keys::show_window(workspace, window),
        KeysRequest::Drag(op) => return drags::drag_keys(workspace, op),
        KeysRequest::Buttonless(step) => workspace.keys.step_buttonless(step),
        KeysRequest::Aim(aim) => workspace.keys.set_aim(aim),
        KeysRequest::Release => return drags::release_keys(workspace),
        KeysRequest::Cancel => return drags::cancel_keys(workspace),
        KeysRequest::Flag(flag, bone, on) => workspace.keys.set_flag(flag, bone, on),
        KeysRequest::Snap(on) => workspace.keys.set_snap(on),
        KeysRequest::OnlySelected(on) => workspace.keys.set_only_selected(on),
        KeysRequest::Filter(text) => {
            workspace.keys.set_filter(text);
            let listed = workspace.read().listed_bones();
            workspace.keys.deselect_all_but(&listed);
        }
        KeysRequest::Marker(action) => keys::change_markers(workspace, action),
        KeysRequest::Range(range) => keys::set_range(workspace, range),
    }
    None
}

/// Runs a command, or reports why it cannot be run.
fn run(workspace: &mut Workspace, command: &'static commands::Command) -> Option<Effect> {
    let command = scene::counterpart(workspace, command);
    if !command.when.holds(&workspace.read()) {
        workspace.say(MessageSeverity::Info, command.when.reason());
        return None;
    }
    (command.run)(workspace)
}

/// Copies the state that is remembered between runs into the settings.
fn keep_settings(workspace: &mut Workspace) {
    let ik = workspace.tools.ik();
    workspace.settings.tools.ik = IkSettings { on: ik.on, length: ik.length };
    workspace.settings.timeline = workspace.keys.settings();
}
