//! The dialog for root motion: the path on the ground, and the commands that move travel between bones.

use super::bone_choice::{BoneChoice, names};
use super::commands::{self, Id};
use super::context::PanelContext;
use super::overlay_title;
use super::request::Request;
use super::shown_skeleton::{ShownSkeleton, SkeletonChange};
use super::style::GRID;
use super::theme::Theme;
use super::widgets;
use dragonfly_anim::animation::to_parent;
use dragonfly_anim::data::{BoneIndex, Skeleton, Take};
use dragonfly_anim::inbetween::gaussian;
use dragonfly_anim::motion::{guess_hips, guess_root};
use dragonfly_anim::sample::{rest_pose, sample_track};
use dragonfly_document::edit::{
    BoneRef, Edit, MoveTravel, RemoveTravel, RestoreTravel, TRAVEL, TakeRef, TravelPart,
};
use dragonfly_document::{Change, View};
use egui::{Button, DragValue, Painter, Pos2, Rect, RichText, Sense, Stroke, StrokeKind, Ui, pos2, vec2};
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// Largest number of points of the path.
const POINTS: usize = 400;
/// Width of the dialog and height of the path, points.
const SIZE: [f32; 2] = [380.0, 190.0];

/// State of the dialog: the bones and the options.
#[derive(Debug)]
pub(super) struct RootMotionDialog {
    /// The skeleton for which bones were chosen.
    of: ShownSkeleton,
    hips: Option<BoneIndex>,
    root: Option<BoneIndex>,
    parts: Vec<TravelPart>,
    smooth: f32,
    path: Option<(GroundPathKey, Arc<GroundPath>)>,
}

impl Default for RootMotionDialog {
    fn default() -> Self {
        let (of, parts) = (ShownSkeleton::default(), TravelPart::usual());
        Self { of, hips: None, root: None, parts, smooth: 0.0, path: None }
    }
}

/// Inputs of the path: the generation of the view, the take, bone, and the smoothing in hundredths of a frame.
type GroundPathKey = (u64, usize, BoneIndex, u32);

/// Positions of a bone over a take.
#[derive(Debug)]
struct GroundPath {
    places: Vec<Vec3>,
    smoothed: Vec<Vec3>,
    /// The turn about the vertical from start to end, radians.
    turn: f32,
}

impl GroundPath {
    fn of(skeleton: &Skeleton, take: &Take, bone: BoneIndex, rate: f32, smooth: f32) -> Self {
        let mut line: Vec<BoneIndex> = skeleton.with_ancestors(bone).collect();
        line.reverse();
        let at = |time: f32| {
            line.iter().fold(Mat4::IDENTITY, |above, &bone| {
                let (own, track) = (&skeleton.bones[bone as usize], take.tracks.get(bone as usize));
                above
                    * to_parent(
                        own,
                        track.map_or_else(|| rest_pose(own), |track| sample_track(track, own, time)),
                    )
            })
        };
        let frames = (take.length * rate).max(0.0);
        let count = (frames.ceil() as usize).clamp(1, POINTS);
        let matrices: Vec<Mat4> =
            (0..=count).map(|step| at(take.start + take.length * step as f32 / count as f32)).collect();
        let places: Vec<Vec3> = matrices
            .iter()
            .map(|matrix| matrix.w_axis.truncate())
            .filter(|place| place.is_finite())
            .collect();
        let sigma = f64::from(smooth) * count as f64 / f64::from(frames.max(1.0));
        let turn = matrices.first().zip(matrices.last()).map_or(0.0, |(first, last)| {
            let turn =
                last.to_scale_rotation_translation().1 * first.to_scale_rotation_translation().1.inverse();
            let angle = 2.0 * turn.y.atan2(turn.w);
            if angle.is_finite() {
                (angle + std::f32::consts::PI).rem_euclid(std::f32::consts::TAU) - std::f32::consts::PI
            } else {
                0.0
            }
        });
        Self { smoothed: gaussian(&places, sigma), places, turn }
    }

    /// Returns the way from the first to the last place.
    fn way(&self) -> Vec3 {
        self.places.first().zip(self.places.last()).map_or(Vec3::ZERO, |(first, last)| *last - *first)
    }

    fn draw(&self, painter: &Painter, rect: Rect, theme: &Theme) {
        let mut low = Vec3::splat(f32::INFINITY);
        let mut high = Vec3::splat(f32::NEG_INFINITY);
        for place in self.places.iter().chain(&self.smoothed) {
            (low, high) = (low.min(*place), high.max(*place));
        }
        if !low.is_finite() {
            return;
        }
        let (middle, span) = (0.5 * (low + high), (high - low).max(Vec3::splat(1e-4)));
        let inner = rect.shrink(4.0 * GRID);
        let scale = (inner.width() / span.x).min(inner.height() / span.z);
        let at = |place: &Vec3| -> Pos2 {
            let off = (*place - middle) * scale;
            pos2(inner.center().x + off.x, inner.center().y + off.z)
        };
        let line = |places: &[Vec3], stroke: Stroke| {
            painter.line(places.iter().map(at).collect(), stroke);
        };
        line(&self.places, Stroke::new(1.0, theme.weak));
        line(&self.smoothed, Stroke::new(2.0, theme.accent));
        if let (Some(first), Some(last)) = (self.smoothed.first(), self.smoothed.last()) {
            painter.circle_stroke(at(first), 3.5, Stroke::new(1.5, theme.accent));
            painter.circle_filled(at(last), 3.5, theme.accent);
        }
    }
}

impl RootMotionDialog {
    /// Draws the dialog.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        ui.set_width(SIZE[0]);
        overlay_title::show(ui, "Root motion", requests);
        let theme = Theme::of(ui);
        let (Some(view), Some(take), Some(shown)) = (context.view, context.take(), context.playback.take)
        else {
            ui.label(RichText::new("Show a take first").color(theme.weak));
            return;
        };
        let skeleton = &view.loaded.model.animation.skeleton;
        self.follow(view, skeleton);
        self.bones(ui, context, skeleton, requests);
        let Some(hips) = self.hips else { return };
        self.draw_path(ui, context, (skeleton, take, shown), hips);
        self.options(ui);
        let travelling = self.travelling(take, hips);
        ui.add_space(GRID);
        let name = context.bone_name(travelling);
        ui.label(RichText::new(format!("{name} travels")).small().color(theme.weak));
        let take_ref = TakeRef::Index(shown);
        let kept = context.slot().is_some_and(|slot| slot.original.extras.get(TRAVEL).is_some());
        self.buttons(ui, (hips, travelling), kept, &take_ref, context.frame_rate as f32, requests);
    }

    /// Guesses the bones of another model. Where a root bone was added, it is the one that is to travel.
    fn follow(&mut self, view: &View, skeleton: &Skeleton) {
        let guessed = |hips: Option<BoneIndex>| hips.and_then(|hips| guess_root(skeleton, hips));
        match self.of.follow(Some(view)) {
            SkeletonChange::Same => {}
            SkeletonChange::Shifted(shift) => {
                self.hips = self.hips.and_then(|hips| shift.bone(hips));
                let kept = self.root.and_then(|root| shift.bone(root));
                let new = (shift.added() > 0 && self.hips.is_some()).then_some(0);
                self.root = new.or(kept).or_else(|| guessed(self.hips));
            }
            SkeletonChange::Replaced => {
                self.hips = guess_hips(skeleton);
                self.root = guessed(self.hips);
            }
        }
    }

    fn bones(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        skeleton: &Skeleton,
        requests: &mut Vec<Request>,
    ) {
        let names = names(context);
        let choice = |label| BoneChoice { names: &names, none: None, label, width: 0.5 * SIZE[0] - 60.0 };
        ui.horizontal(|ui| {
            ui.label("Hips");
            if let Some(Some(hips)) = choice("The bone that carries the body").show(ui, self.hips) {
                self.hips = Some(hips);
                self.root = guess_root(skeleton, hips);
            }
            ui.add_space(GRID);
            if self.root.is_some() {
                ui.label("Root");
                let chosen = choice("The bone above the hips that is to travel").show(ui, self.root);
                if let Some(Some(root)) = chosen {
                    self.root = Some(root);
                }
            }
        });
        let text = match (self.hips, self.root) {
            (None, _) => "No bone is called hips: choose the bone that carries the body.",
            (Some(_), None) => {
                "No bone is above the hips. A new root bone can travel instead of them; without one, their travel can be removed and put back."
            }
            (Some(_), Some(_)) => return,
        };
        ui.label(RichText::new(text).color(Theme::of(ui).warning));
        if self.hips.is_some() {
            let button = ui.button("Make a root bone");
            if button.clicked() {
                requests.push(Request::Command(Id::AddRootBone));
            }
            widgets::hint_beside(&button, commands::get(Id::AddRootBone).help);
        }
    }

    fn draw_path(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        (skeleton, take, shown): (&Skeleton, &Take, usize),
        hips: BoneIndex,
    ) {
        let generation = context.view.map_or(0, |view| view.generation);
        let key = (generation, shown, hips, (self.smooth * 100.0) as u32);
        let path = match &self.path {
            Some((of, path)) if *of == key => Arc::clone(path),
            Some(_) | None => {
                let rate = context.frame_rate as f32;
                Arc::new(GroundPath::of(skeleton, take, hips, rate, self.smooth))
            }
        };
        self.path = Some((key, Arc::clone(&path)));
        let theme = Theme::of(ui);
        let (rect, response) = ui.allocate_exact_size(vec2(SIZE[0], SIZE[1]), Sense::hover());
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 4.0, theme.sunken);
        painter.rect_stroke(rect, 4.0, Stroke::new(1.0, theme.line), StrokeKind::Inside);
        path.draw(&painter, rect, theme);
        let way = path.way();
        let text = format!(
            "x {:.2}, z {:.2}, height {:.2}, turn {:.0}°",
            way.x,
            way.z,
            way.y,
            path.turn.to_degrees()
        );
        response.on_hover_text("Path of the hips on the ground\nSeen from above, x to the right and z down; the travel after smoothing is bold");
        ui.label(RichText::new(text).small().color(theme.weak));
    }

    fn options(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            for part in TravelPart::ALL {
                let mut on = self.parts.contains(&part);
                if ui.checkbox(&mut on, title(part)).changed() {
                    self.parts.retain(|other| *other != part);
                    if on {
                        self.parts.push(part);
                    }
                }
            }
            ui.add_space(GRID);
            let label = ui.label("Smooth");
            let field = DragValue::new(&mut self.smooth).range(0.0..=100.0).speed(0.1).max_decimals(1);
            let field = ui.add(field.suffix(" frames"));
            field.labelled_by(label.id).on_hover_text("Standard deviation of the smoothing\nWhat it removes, such as the sway of the hips, stays in the bone");
        });
    }

    /// Returns the bone that travels now: the root if it has keys, otherwise the hips.
    fn travelling(&self, take: &Take, hips: BoneIndex) -> BoneIndex {
        let moves = |bone: &BoneIndex| {
            take.tracks.get(*bone as usize).is_some_and(|track| {
                let values = &track.translation.values;
                values.iter().any(|value| value.distance(values[0]) > 1e-5 * (1.0 + value.length()))
            })
        };
        self.root.filter(moves).unwrap_or(hips)
    }

    fn buttons(
        &self,
        ui: &mut Ui,
        (hips, travelling): (BoneIndex, BoneIndex),
        kept: bool,
        take: &TakeRef,
        rate: f32,
        requests: &mut Vec<Request>,
    ) {
        let (parts, smooth, rate) = (self.parts.clone(), self.smooth, Some(rate));
        let moved = |from, to| {
            let (from, to) = (BoneRef::Index(from), BoneRef::Index(to));
            Edit::MoveTravel(MoveTravel { take: take.clone(), from, to, parts: parts.clone(), smooth, rate })
        };
        let chosen = !self.parts.is_empty();
        let in_place = RemoveTravel {
            take: take.clone(),
            bone: BoneRef::Index(travelling),
            parts: parts.clone(),
            smooth,
            rate,
        };
        let root = self.root;
        let rows = [
            (
                "Move to root",
                "Lets the root travel instead of the hips; the figure looks the same",
                root.filter(|_| chosen).map(|root| moved(hips, root)),
            ),
            (
                "Move to hips",
                "Lets the hips travel instead of the root; the figure looks the same",
                root.filter(|_| chosen).map(|root| moved(root, hips)),
            ),
            (
                "In place",
                "Removes the travel, and keeps it with the take so that it can be put back",
                chosen.then_some(Edit::RemoveTravel(in_place)),
            ),
            (
                "Put back",
                "Puts back the travel that was removed last",
                kept.then(|| Edit::RestoreTravel(RestoreTravel { take: take.clone() })),
            ),
        ];
        ui.horizontal(|ui| {
            for (title, help, edit) in rows {
                let button = ui.add_enabled(edit.is_some(), Button::new(title));
                if let Some(edit) = edit.filter(|_| button.clicked()) {
                    requests.push(Request::Change(Change::Edit(edit, None)));
                }
                widgets::hint_beside(&button, help);
            }
        });
    }
}

/// Returns the title of a part.
fn title(part: TravelPart) -> &'static str {
    match part {
        TravelPart::X => "X",
        TravelPart::Z => "Z",
        TravelPart::Height => "Height",
        TravelPart::Yaw => "Turn",
    }
}
