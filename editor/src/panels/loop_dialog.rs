//! The dialog for loops: the gap between the end of the take and its start, closing it, moving the start, and finding loops.

use super::bone_choice::{BoneChoice, names};
use super::context::PanelContext;
use super::dialog_preview::DialogPreview;
use super::keys::KeysRequest;
use super::loop_search::LoopCandidates;
use super::overlay_title;
use super::request::Request;
use super::shown_skeleton::{ShownSkeleton, SkeletonChange};
use super::style::{GRID, ROW};
use super::theme::Theme;
use super::widgets;
use dragonfly_anim::data::{BoneIndex, Skeleton, Take};
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::loops::{BoneLoopGap, is_one_frame_short, loop_gaps};
use dragonfly_anim::motion::{Axis, guess_hips};
use dragonfly_document::Change;
use dragonfly_document::edit::{BoneRef, CloseLoop, Edit, ShiftLoop, TakeRef, TrimTake};
use egui::{Button, DragValue, Grid, RichText, ScrollArea, Ui};
use glam::Vec3;
use std::sync::Arc;

/// Width of the dialog, points.
const WIDTH: f32 = 420.0;
/// Distance on the ground, meters, from which on a figure is taken to travel.
const TRAVELS: f32 = 0.1;
/// Gaps below these are not seen: millimeters and degrees.
const SMALL: [f32; 2] = [1.0, 0.5];

/// State of the dialog.
#[derive(Debug)]
pub(super) struct LoopDialog {
    /// The take for which the bone that travels was guessed.
    guessed: Option<(Arc<Skeleton>, usize)>,
    of: ShownSkeleton,
    travel: Option<BoneIndex>,
    frames: u32,
    shift: i32,
    gaps: Option<LoopGaps>,
    candidates: LoopCandidates,
    /// Whether the viewport shows the end over the start.
    shows_end: bool,
}

impl Default for LoopDialog {
    fn default() -> Self {
        Self {
            guessed: None,
            of: ShownSkeleton::default(),
            travel: None,
            frames: 8,
            shift: 0,
            gaps: None,
            candidates: LoopCandidates::default(),
            shows_end: true,
        }
    }
}

/// The gaps of a take, computed once for each of its states.
#[derive(Debug)]
struct LoopGaps {
    take: Arc<Take>,
    rate: u32,
    travel: Option<BoneIndex>,
    /// The largest gap first.
    worst: Vec<BoneLoopGap>,
    is_short: bool,
    /// Distance on the ground from the end of the bone that travels to its start.
    back: Vec3,
}

impl LoopGaps {
    fn of(take: &Arc<Take>, skeleton: &Skeleton, rate: u32, travel: Option<BoneIndex>) -> Self {
        let frames = TakeFrames::ends(take, skeleton, rate as f32);
        let (mut worst, mut is_short, mut back) = (Vec::new(), false, Vec3::ZERO);
        if let Ok(frames) = frames {
            worst = loop_gaps(&frames, travel, Axis::Y);
            worst.sort_by(|a, b| b.position.total_cmp(&a.position).then(b.rotation.total_cmp(&a.rotation)));
            is_short = is_one_frame_short(&frames, travel, Axis::Y);
            if let Some(travel) = travel {
                back = frames.position(0, travel) - frames.position(frames.len() - 1, travel);
                back.y = 0.0;
                back = if back.is_finite() { back } else { Vec3::ZERO };
            }
        }
        Self { take: Arc::clone(take), rate, travel, worst, is_short, back }
    }

    fn is_of(&self, take: &Arc<Take>, rate: u32, travel: Option<BoneIndex>) -> bool {
        Arc::ptr_eq(&self.take, take) && (self.rate, self.travel) == (rate, travel)
    }
}

impl LoopDialog {
    /// Draws the dialog.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        ui.set_width(WIDTH);
        overlay_title::show(ui, "Loop", requests);
        let theme = Theme::of(ui);
        let (Some(view), Some(take), Some(shown)) =
            (context.view, context.shown_take(), context.playback.take)
        else {
            ui.label(RichText::new("Show a take first").color(theme.weak));
            return;
        };
        let skeleton = &view.loaded.model.animation.skeleton;
        if let SkeletonChange::Shifted(shift) = self.of.follow(context.view) {
            self.travel = self.travel.and_then(|travel| shift.bone(travel));
            self.guessed = self.guessed.take().map(|(_, at)| (Arc::clone(skeleton), at));
        }
        self.guess(skeleton, take, shown, context.unit.meters());
        let (rate, name) = (context.frame_rate, TakeRef::Index(shown));
        self.choose_travel(ui, context);
        if !self.gaps.as_ref().is_some_and(|gaps| gaps.is_of(take, rate, self.travel)) {
            self.gaps = Some(LoopGaps::of(take, skeleton, rate, self.travel));
        }
        self.list(ui, context);
        self.show_end(ui, context, requests);
        self.close(ui, &name, rate, requests);
        self.move_start(ui, &name, rate, requests);
        ui.separator();
        let unit = context.unit.millimeters();
        self.candidates.show(ui, (take, skeleton, rate, self.travel), unit, |range, wanted| {
            requests.push(Request::Timeline(KeysRequest::Range(Some(range))));
            if wanted {
                let [from, to] = range;
                let trim = Edit::TrimTake(TrimTake { take: name.clone(), from, to, to_start: true });
                requests.push(Request::Change(Change::Edit(trim, None)));
            }
        });
    }

    /// Guesses which bone travels: the hips, if they do not come back to where they were.
    fn guess(&mut self, skeleton: &Arc<Skeleton>, take: &Take, shown: usize, unit: f32) {
        let is_guessed =
            self.guessed.as_ref().is_some_and(|(of, at)| Arc::ptr_eq(of, skeleton) && *at == shown);
        if is_guessed {
            return;
        }
        self.guessed = Some((Arc::clone(skeleton), shown));
        self.travel = guess_hips(skeleton).filter(|&hips| {
            let Ok(frames) = TakeFrames::ends(take, skeleton, 30.0) else { return false };
            let way = frames.position(frames.len() - 1, hips) - frames.position(0, hips);
            way.x.hypot(way.z) * unit > TRAVELS
        });
    }

    fn choose_travel(&mut self, ui: &mut Ui, context: &PanelContext<'_>) {
        let names = names(context);
        ui.horizontal(|ui| {
            ui.label("Travels");
            let label = "The bone whose way on the ground is left out: a walk repeats in everything else";
            let choice = BoneChoice { names: &names, none: Some("Nothing"), label, width: 200.0 };
            if let Some(chosen) = choice.show(ui, self.travel) {
                self.travel = chosen;
            }
        });
        ui.add_space(GRID);
    }

    fn list(&self, ui: &mut Ui, context: &PanelContext<'_>) {
        let theme = Theme::of(ui);
        let Some(gaps) = &self.gaps else { return };
        let unit = context.unit.millimeters();
        let is_seen =
            |gap: &BoneLoopGap| unit * gap.position > SMALL[0] || gap.rotation.to_degrees() > SMALL[1];
        let seen = gaps.worst.iter().filter(|gap| is_seen(gap)).count();
        let text = match (gaps.is_short, seen) {
            (true, _) => "The last frame is missing: the take repeats if it goes on for one frame".to_owned(),
            (false, 0) => "The end leads into the start".to_owned(),
            (false, 1) => "1 bone jumps from the end to the start".to_owned(),
            (false, count) => format!("{count} bones jump from the end to the start"),
        };
        let color = if gaps.is_short || seen > 0 { theme.warning } else { theme.text };
        ui.label(RichText::new(text).color(color));
        ui.add_space(GRID);
        ScrollArea::vertical()
            .id_salt("gaps of bones")
            .max_height(6.0 * ROW)
            .auto_shrink([false, true])
            .show(ui, |ui| {
                Grid::new("gaps").num_columns(4).spacing([3.0 * GRID, 2.0]).striped(true).show(ui, |ui| {
                    for title in ["Bone", "Position", "Velocity", "Rotation"] {
                        ui.label(RichText::new(title).small().color(theme.faint));
                    }
                    ui.end_row();
                    for gap in gaps.worst.iter().take(seen.max(3)) {
                        let name = context.bone_name(gap.bone);
                        let name = widgets::cut_in_middle(ui, &name, 150.0, &egui::TextStyle::Body);
                        ui.label(name);
                        let color = if is_seen(gap) { theme.text } else { theme.weak };
                        for text in [
                            format!("{:.1} mm", unit * gap.position),
                            format!("{:.0} mm/s", unit * gap.velocity),
                            format!("{:.1}°", gap.rotation.to_degrees()),
                        ] {
                            ui.label(RichText::new(text).color(color));
                        }
                        ui.end_row();
                    }
                });
            });
        ui.add_space(2.0 * GRID);
    }

    /// Draws the switch for the second skeleton in the viewport, and keeps that up to date.
    fn show_end(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let switch = ui.checkbox(&mut self.shows_end, "Show the end over the start");
        widgets::hint_beside(
            &switch,
            "Draws the poses of the end and of the start in the viewport as two skeletons, with lines between joints that differ",
        );
        ui.add_space(GRID);
        let offset = self.gaps.as_ref().map_or(Vec3::ZERO, |gaps| gaps.back);
        let preview = if self.shows_end { DialogPreview::LoopEnd { offset } } else { DialogPreview::Nothing };
        if preview != context.preview {
            requests.push(Request::Preview(preview));
        }
    }

    fn close(&mut self, ui: &mut Ui, take: &TakeRef, rate: u32, requests: &mut Vec<Request>) {
        let travel = self.travel.map(BoneRef::Index);
        ui.horizontal(|ui| {
            let button = ui.button("Close loop");
            widgets::hint_beside(
                &button,
                "Changes the last frames so that they lead into the start; feet stay in the contacts of the take",
            );
            let label = ui.label("over the last");
            let field = DragValue::new(&mut self.frames).range(1..=1000).speed(0.1).suffix(" frames");
            ui.add(field).labelled_by(label.id);
            if button.clicked() {
                let (take, rate) = (take.clone(), Some(rate as f32));
                let edit = CloseLoop { take, frames: self.frames, travel, contacts: Vec::new(), rate };
                requests.push(Request::Change(Change::Edit(Edit::CloseLoop(edit), None)));
            }
        });
    }

    fn move_start(&mut self, ui: &mut Ui, take: &TakeRef, rate: u32, requests: &mut Vec<Request>) {
        let travel = self.travel.map(BoneRef::Index);
        ui.horizontal(|ui| {
            let button = ui.add_enabled(self.shift != 0, Button::new("Shift"));
            widgets::hint_beside(
                &button,
                "Moves all keys around the loop; those after the end come back at the start (phase)",
            );
            let label = ui.label("all keys by");
            let field = DragValue::new(&mut self.shift).range(-10_000..=10_000).speed(0.1).suffix(" frames");
            ui.add(field).labelled_by(label.id);
            if button.clicked() {
                let by = self.shift as f32 / rate.max(1) as f32;
                let edit = ShiftLoop { take: take.clone(), by, travel, rate: None };
                requests.push(Request::Change(Change::Edit(Edit::ShiftLoop(edit), None)));
            }
        });
    }
}
