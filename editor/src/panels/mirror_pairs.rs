//! The dialog that mirrors a take: the mirror pairs of bones with the evidence for each, which can be corrected, and what is
//! mirrored.

use super::bone_choice::{BoneChoice, add_left, names};
use super::context::PanelContext;
use super::overlay_title;
use super::request::Request;
use super::shown_skeleton::{ShownSkeleton, SkeletonChange};
use super::style::{GRID, ROW};
use super::theme::Theme;
use super::widgets;
use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_document::Change;
use dragonfly_document::bones::{BodySide, Choice, MirrorPairs};
use dragonfly_document::edit::{BoneRef, Edit, MirrorTake};
use egui::{Button, RichText, ScrollArea, TextStyle, Ui};
use std::sync::Arc;

/// Width of the dialog, points.
const WIDTH: f32 = 560.0;

/// State of the dialog: the corrections and the options.
#[derive(Debug, Default)]
pub(super) struct MirrorDialog {
    /// The skeleton, its guessed pairs, and those with the corrections.
    found: Option<(Arc<Skeleton>, MirrorPairs, MirrorPairs)>,
    of: ShownSkeleton,
    /// Left and right bone; a bone without a counterpart is paired with itself.
    corrections: Vec<[BoneIndex; 2]>,
    side: Option<BodySide>,
    only_selected: bool,
    only_range: bool,
}

impl MirrorDialog {
    /// Draws the dialog. A click on a left bone selects both bones.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        ui.set_width(WIDTH);
        overlay_title::show(ui, "Mirror", requests);
        let theme = Theme::of(ui);
        let Some(loaded) = context.loaded() else {
            ui.label(RichText::new("No model is open").color(theme.weak));
            return;
        };
        let skeleton = &loaded.model.animation.skeleton;
        match self.of.follow(context.view) {
            SkeletonChange::Same => {}
            SkeletonChange::Shifted(shift) => {
                let pair = |[left, right]: [BoneIndex; 2]| Some([shift.bone(left)?, shift.bone(right)?]);
                self.corrections = self.corrections.iter().filter_map(|corrected| pair(*corrected)).collect();
            }
            SkeletonChange::Replaced => self.corrections.clear(),
        }
        if !self.found.as_ref().is_some_and(|(of, ..)| Arc::ptr_eq(of, skeleton)) {
            let guessed = MirrorPairs::of(skeleton);
            let pairs = guessed.clone().corrected(&self.corrections);
            self.found = Some((Arc::clone(skeleton), guessed, pairs));
        }
        let Some((_, guessed, pairs)) = &self.found else { return };
        let guessed = guessed.clone();
        let alone = pairs.unpaired.iter().filter(|alone| alone.side.is_some()).count();
        let facts = [
            widgets::count(pairs.pairs.len(), "pair", "pairs"),
            format!("{} in the middle", widgets::grouped(pairs.unpaired.len() - alone)),
            format!("{} without a counterpart", widgets::grouped(alone)),
        ];
        ui.label(RichText::new(widgets::dot_separated(&facts)).small().color(theme.weak));
        ui.add_space(GRID);
        let corrected = self.rows(ui, context, requests);
        if let Some([left, right]) = corrected {
            self.corrections.retain(|pair| !pair.contains(&left));
            self.corrections.push([left, right]);
        }
        ui.add_space(GRID);
        ui.horizontal(|ui| self.scope(ui, context));
        ui.horizontal(|ui| {
            self.mirror(ui, context, requests);
            let able = !self.corrections.is_empty();
            let reset = ui.add_enabled(able, Button::new("Guess again"));
            if reset.clicked() {
                self.corrections.clear();
            }
            widgets::hint_beside(&reset, "Removes all corrections");
        });
        let now = guessed.corrected(&self.corrections);
        if let Some((_, _, pairs)) = &mut self.found {
            *pairs = now;
        }
    }

    /// Draws the pairs. Returns the correction that was made.
    fn rows(
        &self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) -> Option<[BoneIndex; 2]> {
        let (_, _, pairs) = self.found.as_ref()?;
        let theme = Theme::of(ui);
        let names = names(context);
        let mut rows: Vec<(BoneIndex, Option<BoneIndex>, &str)> =
            pairs.pairs.iter().map(|pair| (pair.left, Some(pair.right), pair.guess.title())).collect();
        let lonely = pairs.unpaired.iter().filter(|alone| alone.side.is_some());
        rows.extend(lonely.map(|alone| (alone.bone, None, "without a counterpart")));
        if rows.is_empty() {
            ui.label(RichText::new("No bone name indicates a left or right side").color(theme.weak));
        }
        let mut corrected = None;
        let area = ScrollArea::vertical().max_height(12.0 * ROW).auto_shrink([false, true]);
        area.show_rows(ui, ROW, rows.len(), |ui, shown| {
            for &(left, right, reason) in &rows[shown] {
                ui.horizontal(|ui| {
                    ui.set_height(ROW);
                    let both: Vec<BoneIndex> = std::iter::once(left).chain(right).collect();
                    let selected = both.iter().all(|&bone| context.selection.contains(bone));
                    let text = widgets::cut_in_middle(ui, &names[left as usize], 170.0, &TextStyle::Body);
                    let name = format!("{}, {reason}", names[left as usize]);
                    let button = add_left(ui, Button::selectable(selected, text), 190.0).on_hover_text(name);
                    if button.clicked() {
                        requests.push(Request::SelectBones(both, Choice::Replace));
                    }
                    let label = format!("The bone that mirrors {}", names[left as usize]);
                    let choice = BoneChoice {
                        names: &names,
                        none: Some("in the middle"),
                        label: &label,
                        width: 190.0,
                    };
                    if let Some(chosen) = choice.show(ui, right) {
                        corrected = Some([left, chosen.unwrap_or(left)]);
                    }
                    ui.label(RichText::new(reason).small().color(theme.faint));
                });
            }
        });
        corrected
    }

    /// Draws what is mirrored.
    fn scope(&mut self, ui: &mut Ui, context: &PanelContext<'_>) {
        for (side, title) in [
            (None, "Both sides"),
            (Some(BodySide::Left), "Left to right"),
            (Some(BodySide::Right), "Right to left"),
        ] {
            ui.radio_value(&mut self.side, side, title);
        }
        let (selected, range) = (context.selection.bones(), context.keys.range());
        ui.add_enabled(!selected.is_empty(), egui::Checkbox::new(&mut self.only_selected, "Selected bones"))
            .on_hover_text("Only selected bones\nMirrors only the motion of the selected bones");
        ui.add_enabled(range.is_some(), egui::Checkbox::new(&mut self.only_range, "Play range"))
            .on_hover_text("Only the play range\nMirrors only the motion in the play range");
    }

    /// Draws the button.
    fn mirror(&self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let (selected, range) = (context.selection.bones(), context.keys.range());
        let take = context.take_ref();
        let button = ui.add_enabled(take.is_some(), Button::new("Mirror take"));
        let Some(take) = take.filter(|_| button.clicked()) else { return };
        let chosen = if self.only_selected { selected } else { &[] };
        let bones = chosen.iter().map(|&bone| BoneRef::Index(bone)).collect();
        let pairs = self.corrections.iter().map(|pair| pair.map(BoneRef::Index)).collect();
        let range = range.filter(|_| self.only_range);
        let (from, to) = (range.map(|[from, _]| from), range.map(|[_, to]| to));
        let edit = Edit::MirrorTake(MirrorTake { take, bones, side: self.side, pairs, from, to });
        requests.push(Request::Change(Change::Edit(edit, None)));
    }
}
