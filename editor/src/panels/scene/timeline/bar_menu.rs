//! The entries of the context menu of a bar.

use super::menu_entry::gesture;
use super::sheet::SceneSheet;
use crate::panels::commands::Id;
use crate::panels::menu::{item, submenu};
use crate::panels::request::Request;
use crate::panels::scene::gesture_request::gesture_request;
use crate::panels::scene::{ChangedThings, SceneRequest};
use crate::panels::submenu::entry;
use dragonfly_anim::stage::gesture::{FadeEnd, GestureScene, set_fade, set_repeat, set_speed, wait_after};
use dragonfly_anim::stage::script::StageRepeat;
use dragonfly_anim::stage::table::element;
use dragonfly_anim::stage::time::{Decimal, StageTime};
use dragonfly_document::MissingFile;
use dragonfly_document::edit::ScriptLabel;
use egui::Ui;

/// Factors of speed that are offered.
const SPEEDS: [f64; 7] = [0.25, 0.5, 0.75, 1.0, 1.5, 2.0, -1.0];
/// Numbers of repetitions that are offered.
const REPEATS: [&str; 4] = ["1", "2", "3", "4"];
/// Durations of fades that are offered, seconds.
const FADES: [f64; 5] = [0.0, 0.1, 0.25, 0.5, 1.0];

/// Draws the entries for an action.
pub(super) fn show(ui: &mut Ui, action: usize, sheet: &SceneSheet<'_>, requests: &mut Vec<Request>) {
    let Some((_, bar)) = sheet.lanes.bar_of(action) else { return };
    let row = element(bar.kind);
    let own = [action];
    let things = ChangedThings::Actions(&own);
    let has = |name: &str| row.is_some_and(|row| row.attribute(name).is_some());
    let missing = missing_sound(action, sheet);
    let place =
        missing.as_ref().and_then(|missing| Some(missing.named_in(sheet.scene.included_place_of(missing)?)));
    if let Some(place) = place {
        ui.add_enabled(false, egui::Button::new(place).frame_when_inactive(false));
    } else if let Some(missing) = missing
        && entry(ui, "Find the sound…").clicked()
    {
        requests.push(Request::Scene(SceneRequest::Find(missing)));
        ui.close();
    }
    for id in [Id::ClipToPlayhead, Id::ClipStartToPlayhead, Id::ClipEndToPlayhead, Id::SplitActions] {
        item(ui, sheet.context, id, false, requests);
    }
    ui.separator();
    if has("fade-in") || has("blend") {
        fade_entries(ui, "Fade in", FadeEnd::In, action, sheet, requests);
    }
    if has("fade-out") {
        fade_entries(ui, "Fade out", FadeEnd::Out, action, sheet, requests);
    }
    if bar.kind == "play" {
        submenu(ui, "Speed", |ui| {
            for speed in SPEEDS {
                let title = format!("{speed}×");
                gesture(
                    ui,
                    &title,
                    (SceneRequest::Text, ScriptLabel::ChangeSpeed, things),
                    sheet,
                    requests,
                    |scene| set_speed(scene, action, speed),
                );
            }
        });
    }
    if has("repeat") {
        submenu(ui, "Repeat", |ui| {
            for times in REPEATS {
                let Some(number) = Decimal::parse(times) else { continue };
                let title = format!("{times}×");
                gesture(
                    ui,
                    &title,
                    (SceneRequest::Text, ScriptLabel::ChangeRepeat, things),
                    sheet,
                    requests,
                    |scene| set_repeat(scene, action, StageRepeat::Times(number)),
                );
            }
            gesture(
                ui,
                "For as long as there is time",
                (SceneRequest::Text, ScriptLabel::ChangeRepeat, things),
                sheet,
                requests,
                |scene| set_repeat(scene, action, StageRepeat::Fill),
            );
        });
    }
    let is_in_seq = sheet.scene.script.as_ref().is_some_and(|script| script.is_in_seq(action));
    if is_in_seq && entry(ui, "Wait after it").clicked() {
        let wait = |scene: &GestureScene<'_>| wait_after(scene, action);
        requests.push(gesture_request(
            sheet.context,
            sheet.scene,
            (SceneRequest::Text, ScriptLabel::AddWait, things),
            wait,
        ));
        ui.close();
    }
    ui.separator();
    for id in [Id::CutActions, Id::CopyActions, Id::PasteActions] {
        item(ui, sheet.context, id, false, requests);
    }
    ui.separator();
    for id in [Id::SceneDuplicate, Id::SceneDelete, Id::SceneLift] {
        item(ui, sheet.context, id, false, requests);
    }
}

/// Returns the sound of an action, if it is missing.
fn missing_sound(action: usize, sheet: &SceneSheet<'_>) -> Option<MissingFile> {
    let script = sheet.scene.script.as_ref()?;
    let source = script.element(action).value("src")?;
    sheet.context.scene_editing.sounds().missing().find(|missing| missing.name == source)
}

fn fade_entries(
    ui: &mut Ui,
    title: &str,
    end: FadeEnd,
    action: usize,
    sheet: &SceneSheet<'_>,
    requests: &mut Vec<Request>,
) {
    let own = [action];
    let things = ChangedThings::Actions(&own);
    submenu(ui, title, |ui| {
        for seconds in FADES {
            let title = if seconds == 0.0 { "None".to_owned() } else { format!("{seconds} s") };
            gesture(
                ui,
                &title,
                (SceneRequest::Text, ScriptLabel::ChangeFade, things),
                sheet,
                requests,
                |scene| set_fade(scene, action, end, StageTime::from_seconds(seconds)),
            );
        }
    });
}
