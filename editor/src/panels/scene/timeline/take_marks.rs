//! Events of takes and contacts of feet on the bars that play them.

use super::sheet::SceneSheet;
use dragonfly_anim::data::Take;
use dragonfly_anim::stage::lanes::SceneBar;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::adapter::stored_events;
use dragonfly_document::{LoadedModel, SceneModel};
use egui::{Color32, Painter, Rect, Shape, Stroke, pos2};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Most repetitions of a moment that are drawn in a bar.
const MOST: usize = 200;

/// Least width of a repetition, points, in which contacts are drawn.
const LEAST_WIDTH: f32 = 36.0;

/// An event of a take.
#[derive(Clone, Debug, PartialEq)]
pub struct EventMark {
    /// Its name.
    pub name: String,
    /// Its time, after the start of the take.
    pub after: StageTime,
}

/// Returns the events that are stored with a take.
pub fn events_of(take: &Take) -> Vec<EventMark> {
    let after = |time: f32| StageTime::from_seconds(f64::from(time) - f64::from(take.start));
    let events = stored_events(&take.extras).into_iter();
    events.map(|event| EventMark { after: after(event.time), name: event.name }).collect()
}

/// A model, and the events of those of its takes that were drawn.
#[derive(Debug)]
struct KnownEvents {
    model: Arc<LoadedModel>,
    takes: BTreeMap<String, Arc<[EventMark]>>,
}

/// The events of the takes that were drawn, by the text with which the script names the model.
#[derive(Debug, Default)]
pub(super) struct TakeMarks {
    known: BTreeMap<String, KnownEvents>,
}

impl TakeMarks {
    /// Draws the events and contacts of the take that a bar plays.
    pub(super) fn show(
        &mut self,
        painter: &Painter,
        sheet: &SceneSheet<'_>,
        bar: &SceneBar,
        rect: Rect,
        color: Color32,
    ) {
        let Some(script) = sheet.scene.script.as_ref().filter(|_| bar.clip.is_some()) else { return };
        let Some(element) = script.actions().get(bar.action).map(|_| script.element(bar.action)) else {
            return;
        };
        let (Some(who), Some(take)) = (element.value("who"), element.value("take")) else { return };
        let x = |time: StageTime| sheet.scale.x_of(time.seconds() as f32);
        contacts(painter, sheet, bar, (who, take, rect), color);
        let thing = script.thing_element(who).map(|thing| &script.tree().elements()[thing]);
        let Some(model) = thing.and_then(|thing| thing.value("model")) else { return };
        for event in self.events(sheet, model, take).iter() {
            for time in bar.occurrences(event.after, MOST) {
                let (x, top) = (x(time), rect.top());
                let corners = vec![pos2(x - 3.5, top), pos2(x + 3.5, top), pos2(x, top + 5.0)];
                painter.add(Shape::convex_polygon(corners, sheet.theme.accent, Stroke::NONE));
            }
        }
    }

    /// Returns the events of a take, read once for each model.
    fn events(&mut self, sheet: &SceneSheet<'_>, model: &str, take: &str) -> Arc<[EventMark]> {
        let Some(SceneModel::Loaded(loaded)) = sheet.scene.models.get(model) else { return Arc::default() };
        let known = self.known.get(model).filter(|known| Arc::ptr_eq(&known.model, loaded));
        if let Some(events) = known.and_then(|known| known.takes.get(take)) {
            return Arc::clone(events);
        }
        let takes = &loaded.model.animation.takes;
        let found = takes.iter().find(|own| own.name == take).map_or_else(Vec::new, |take| events_of(take));
        let events: Arc<[EventMark]> = found.into();
        if known.is_none() {
            let new = KnownEvents { model: Arc::clone(loaded), takes: BTreeMap::new() };
            self.known.insert(model.to_owned(), new);
        }
        if let Some(known) = self.known.get_mut(model) {
            known.takes.insert(take.to_owned(), Arc::clone(&events));
        }
        events
    }
}

/// Draws when feet are on the ground as thin lines at the bottom of a bar, one below the other.
fn contacts(
    painter: &Painter,
    sheet: &SceneSheet<'_>,
    bar: &SceneBar,
    (who, take, rect): (&str, &str, Rect),
    color: Color32,
) {
    if sheet.scale.per_second() * bar.once.seconds() < f64::from(LEAST_WIDTH) {
        return;
    }
    let plan = sheet.scene.plan.as_ref();
    let thing = plan.and_then(|plan| plan.things().get(plan.thing_called(who)?));
    let Some(model) = thing.and_then(|thing| thing.model.as_ref()) else { return };
    let Some(take) = model.take_called(take).and_then(|take| model.takes().get(take)) else { return };
    let x = |time: StageTime| sheet.scale.x_of(time.seconds() as f32);
    for contact in take.contacts() {
        let y = rect.bottom() - 2.0 - 2.0 * contact.foot as f32;
        if y < rect.center().y {
            continue;
        }
        // One that crosses the end of the take continues at its start.
        let rest = [StageTime::ZERO, contact.to - take.length()];
        for part in [[contact.from, contact.to.min(take.length())], rest] {
            for [from, to] in bar.occurrences_of_part(part, MOST) {
                painter.hline(x(from)..=x(to), y, Stroke::new(1.0, color));
            }
        }
    }
}
