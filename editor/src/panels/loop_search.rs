//! The list of loops in a long take: searched a part in each frame of the window.

use super::style::{GRID, ROW};
use super::theme::Theme;
use super::widgets;
use dragonfly_anim::data::{BoneIndex, Skeleton, Take};
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::loops::{FoundLoop, LoopFinder, LoopSearch};
use dragonfly_anim::motion::Axis;
use egui::{Button, DragValue, RichText, ScrollArea, Ui};
use std::sync::Arc;

/// Largest number of frames that are compared: a longer take is sampled more coarsely.
const MOST_FRAMES: f32 = 2000.0;
/// Distances of bones that are computed in one frame of the window: about 2 ms.
const DISTANCES: usize = 200_000;

/// The loops that were found, and the search for them.
#[derive(Debug)]
pub(super) struct LoopCandidates {
    /// Shortest loop, seconds.
    least: f32,
    search: Option<CandidateSearch>,
}

impl Default for LoopCandidates {
    fn default() -> Self {
        Self { least: 0.5, search: None }
    }
}

/// A search in one state of a take.
#[derive(Debug)]
struct CandidateSearch {
    take: Arc<Take>,
    finder: LoopFinder,
    /// Compared frames per second.
    rate: f32,
    is_complete: bool,
}

/// Take, skeleton, frame rate and the bone that travels.
type SearchedTake<'a> = (&'a Arc<Take>, &'a Skeleton, u32, Option<BoneIndex>);

impl LoopCandidates {
    /// Draws the button and the list. `millimeters` are those in one unit of the model. Calls `choose` with a range of time in seconds that was clicked, and whether the take is to be
    /// trimmed to it.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        of: SearchedTake<'_>,
        millimeters: f32,
        mut choose: impl FnMut([f32; 2], bool),
    ) {
        let (take, skeleton, rate, travel) = of;
        ui.horizontal(|ui| {
            let button = ui.button("Find loops");
            widgets::hint_beside(&button, "Looks for parts of the take that repeat best");
            let label = ui.label("of at least");
            let field = DragValue::new(&mut self.least).range(0.1..=600.0).speed(0.05).max_decimals(2);
            ui.add(field.suffix(" s")).labelled_by(label.id);
            if button.clicked() {
                self.search = CandidateSearch::begin(take, skeleton, rate as f32, travel, self.least);
            }
        });
        if self.search.as_ref().is_some_and(|search| !Arc::ptr_eq(&search.take, take)) {
            self.search = None;
        }
        let Some(search) = &mut self.search else { return };
        search.go_on(ui, skeleton.len());
        let theme = Theme::of(ui);
        if search.finder.found().is_empty() {
            let text = if search.is_complete { "The take is shorter than that" } else { "Searching…" };
            ui.label(RichText::new(text).color(theme.weak));
            return;
        }
        ScrollArea::vertical().id_salt("found loops").max_height(5.0 * ROW).auto_shrink([false, true]).show(
            ui,
            |ui| {
                for found in search.finder.found() {
                    let range = search.range(found);
                    let frames = range.map(|time| (time * rate as f32).round() as i64);
                    ui.horizontal(|ui| {
                        let text = format!(
                            "Frames {} to {}, {:.2} s, {:.1} mm apart",
                            frames[0],
                            frames[1],
                            range[1] - range[0],
                            millimeters * found.cost
                        );
                        let play = ui.add(Button::new(text).frame_when_inactive(false));
                        widgets::hint_beside(&play, "Sets the play range to this loop");
                        ui.add_space(GRID);
                        let trim = ui.add(Button::new("Trim").small());
                        widgets::hint_beside(&trim, "Trims the take to this loop");
                        if play.clicked() || trim.clicked() {
                            choose(range, trim.clicked());
                        }
                    });
                }
            },
        );
        if !search.is_complete {
            ui.label(RichText::new("Searching…").small().color(theme.weak));
        }
    }
}

impl CandidateSearch {
    fn begin(
        take: &Arc<Take>,
        skeleton: &Skeleton,
        rate: f32,
        travel: Option<BoneIndex>,
        least: f32,
    ) -> Option<Self> {
        let rate = rate.min(MOST_FRAMES / take.length.max(1e-3));
        let frames = TakeFrames::of(take, skeleton, rate).ok()?;
        let search = LoopSearch { least, travel, up: Axis::Y, ..LoopSearch::default() };
        let near = ((0.25 * rate) as usize).max(1);
        let finder = LoopFinder::new(&frames, &search, near);
        Some(Self { take: Arc::clone(take), finder, rate, is_complete: false })
    }

    /// Searches a part, and asks for another frame of the window if something remains.
    fn go_on(&mut self, ui: &Ui, bones: usize) {
        if !self.is_complete {
            self.is_complete = self.finder.step((DISTANCES / bones.max(1)).max(1));
            ui.ctx().request_repaint();
        }
    }

    /// Returns start and end of a loop, seconds.
    fn range(&self, found: &FoundLoop) -> [f32; 2] {
        [found.first, found.last].map(|frame| self.take.start + frame as f32 / self.rate)
    }
}
