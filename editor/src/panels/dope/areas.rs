//! The areas of the dope sheet.

use crate::panels::context::PanelContext;
use dragonfly_document::adapter::EVENTS;
use egui::{Rect, pos2};

/// The areas of the dope sheet, points.
#[derive(Clone, Copy, Debug)]
pub(super) struct DopeAreas {
    /// The whole sheet.
    pub(super) all: Rect,
    /// The area above the names: search field and switches.
    pub(super) tools: Rect,
    /// The ruler.
    pub(super) head: Rect,
    /// The lane of markers; without height if there are none.
    pub(super) markers: Rect,
    /// The lane of events; without height if there are none.
    pub(super) events: Rect,
    /// The lane of problems; without height if there are none.
    pub(super) findings: Rect,
    /// The lane of contacts; without height if there are none.
    pub(super) contacts: Rect,
    /// The lane of the sound; without height if there is none.
    pub(super) sound: Rect,
    /// The lane of the weight of the active layer; without height if there is none.
    pub(super) weight: Rect,
    /// The bar over the selected keys.
    pub(super) bar: Rect,
    /// The names of the rows.
    pub(super) names: Rect,
    /// The canvas with the keys.
    pub(super) canvas: Rect,
}

/// Height of the ruler.
pub(in crate::panels) const RULER: f32 = 24.0;
/// Height of the lanes of markers and of events.
const MARKERS: f32 = 16.0;
/// Height of the lane of problems.
const FINDINGS: f32 = 12.0;
/// Height of the row of a bone in the lane of contacts.
const CONTACT_ROW: f32 = 14.0;
/// Largest number of rows of this height: those of more bones become lower.
const CONTACT_ROWS: usize = 6;
/// Height of the lane of the sound.
const SOUND: f32 = 28.0;
/// Height of the lane of weights, and the least height of the sheet in which there is one.
const WEIGHT: f32 = 44.0;
const LEAST_WITH_WEIGHT: f32 = 120.0;
/// Height of the bar over the selected keys.
const BAR: f32 = 8.0;
/// Margin before the start and after the end of the take.
pub(super) const ROOM: f32 = 16.0;
pub(super) const ROOM_RIGHT: f32 = 20.0;
/// Height and width of scroll bars.
pub(super) const SCROLL: f32 = 8.0;

impl DopeAreas {
    pub(super) fn of(all: Rect, context: &PanelContext<'_>) -> Self {
        // A narrow panel keeps at least half of itself for keys.
        let gutter = if all.width() < 480.0 { (all.width() * 0.3).clamp(64.0, 120.0) } else { 192.0 };
        let left = all.left() + gutter;
        let lane = |top: f32, height: f32| {
            Rect::from_min_max(
                pos2(left, top.min(all.bottom())),
                pos2(all.right(), (top + height).min(all.bottom())),
            )
        };
        let head = lane(all.top(), RULER);
        let findings = lane(head.bottom(), if context.take_findings().is_empty() { 0.0 } else { FINDINGS });
        let markers = lane(findings.bottom(), if context.markers().is_empty() { 0.0 } else { MARKERS });
        let rows = context.contacts.track().bones().len().min(CONTACT_ROWS);
        let has_events = context.slot().is_some_and(|slot| slot.result.extras.get(EVENTS).is_some());
        let events = lane(markers.bottom(), if has_events { MARKERS } else { 0.0 });
        let contacts = lane(events.bottom(), rows as f32 * CONTACT_ROW);
        let sound = if context.sound.settings().is_chosen() { SOUND } else { 0.0 };
        let sound = lane(contacts.bottom(), sound);
        let has_weight = context.layer().is_some() && all.height() > LEAST_WITH_WEIGHT;
        let weight = lane(sound.bottom(), if has_weight { WEIGHT } else { 0.0 });
        let bar = lane(weight.bottom(), BAR);
        let below = all.bottom().max(bar.bottom());
        Self {
            all,
            tools: Rect::from_min_max(all.min, pos2(left, head.bottom())),
            head,
            markers,
            events,
            findings,
            contacts,
            sound,
            weight,
            bar,
            names: Rect::from_min_max(pos2(all.left(), bar.bottom()), pos2(left, below)),
            canvas: Rect::from_min_max(pos2(left, bar.bottom()), pos2(all.right(), below)),
        }
    }
}
