//! Read-only list of the mirror pairs of bones, with the evidence for each pair.

use super::context::PanelContext;
use super::request::Request;
use super::style::{GRID, ROW};
use super::theme::Theme;
use super::widgets;
use dragonfly_anim::data::Skeleton;
use dragonfly_document::LoadedModel;
use dragonfly_document::bones::{Choice, MirrorPairs};
use egui::{Rect, RichText, ScrollArea, TextStyle, Ui, pos2};
use std::sync::Arc;

/// Draws the list; a click on a pair selects both bones.
pub(super) fn show(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    ui.set_width(520.0);
    ui.label(RichText::new("Mirror pairs").heading());
    let Some(loaded) = context.loaded() else {
        ui.label(RichText::new("No model is open").color(Theme::of(ui).weak));
        return;
    };
    let pairs = found(ui, loaded);
    let theme = Theme::of(ui);
    let alone = pairs.unpaired.iter().filter(|alone| alone.side.is_some()).count();
    let facts = [
        widgets::count(pairs.pairs.len(), "pair", "pairs"),
        format!("{} in the middle", widgets::grouped(pairs.unpaired.len() - alone)),
        format!("{} without a counterpart", widgets::grouped(alone)),
    ];
    ui.label(RichText::new(widgets::dot_separated(&facts)).small().color(theme.weak));
    ui.add_space(GRID);
    if pairs.pairs.is_empty() {
        ui.label(RichText::new("No bone name indicates a left or right side").color(theme.weak));
        return;
    }
    ui.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical().max_height(14.0 * ROW).auto_shrink([false, true]).show_rows(
        ui,
        ROW,
        pairs.pairs.len(),
        |ui, rows| {
            for pair in &pairs.pairs[rows] {
                let [left, right] = [pair.left, pair.right].map(|bone| context.bone_name(bone));
                let both = [pair.left, pair.right].iter().all(|&bone| context.selection.contains(bone));
                let name = format!("{left} and {right}, {}", pair.guess.title());
                let (rect, response) = widgets::row(ui, &name, both, false);
                if ui.is_rect_visible(rect) {
                    let column = (rect.width() - 4.0 * GRID) / 12.0;
                    let start = rect.left() + 2.0 * GRID;
                    let cell = |from: f32, to: f32| {
                        Rect::from_min_max(
                            pos2(start + column * from, rect.top()),
                            pos2(start + column * to - GRID, rect.bottom()),
                        )
                    };
                    widgets::text_in(ui, cell(0.0, 4.5), &left, &TextStyle::Body, theme.text);
                    widgets::text_in(ui, cell(4.5, 9.0), &right, &TextStyle::Body, theme.text);
                    widgets::text_in(ui, cell(9.0, 12.0), pair.guess.title(), &TextStyle::Small, theme.faint);
                }
                let response = response.on_hover_text(format!("{left}\n{right}\n{}", pair.guess.title()));
                if response.clicked() {
                    requests.push(Request::SelectBones(vec![pair.left, pair.right], Choice::Replace));
                }
            }
        },
    );
}

/// Returns the mirror pairs, guessed when the list is opened and kept while it is open.
fn found(ui: &Ui, loaded: &LoadedModel) -> Arc<MirrorPairs> {
    let skeleton = &loaded.model.animation.skeleton;
    let id = egui::Id::unique("mirror pairs");
    match ui.data(|data| data.get_temp::<(Arc<Skeleton>, Arc<MirrorPairs>)>(id)) {
        Some((of, found)) if Arc::ptr_eq(&of, skeleton) => found,
        _ => {
            let found = Arc::new(MirrorPairs::of(skeleton));
            ui.data_mut(|data| data.insert_temp(id, (Arc::clone(skeleton), Arc::clone(&found))));
            found
        }
    }
}
