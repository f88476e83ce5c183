//! The differences between the take that is shown and another one: over time as a strip of heat, and bone by bone in millimeters
//! and degrees. The viewport draws the other pose as a skeleton.

mod profile;
mod strip;

use super::commands::Id;
use super::compared::CompareWith;
use super::context::PanelContext;
use super::request::Request;
use super::style::{GRID, ROW};
use super::theme::Theme;
use super::{Panel, PanelPlace, widgets};
use egui::{Align, Button, Layout, Popup, Rect, RichText, ScrollArea, TextStyle, Ui, pos2};
use profile::ShownProfile;

/// The comparison.
#[derive(Debug, Default)]
pub struct DifferencesPanel {
    profile: ShownProfile,
}

impl Panel for DifferencesPanel {
    fn id(&self) -> &'static str {
        "differences"
    }

    fn title(&self) -> &'static str {
        "Differences"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::BelowRight
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let Some(now) = context.shown_take() else {
            return widgets::empty(ui, "Differences between takes appear here", "");
        };
        ui.add_space(GRID);
        ui.horizontal(|ui| {
            ui.add_space(2.0 * GRID);
            choose(ui, context, requests);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.add_space(2.0 * GRID);
                let text = self.profile.summary(context);
                let shown = context.compared_take().is_some();
                if let Some(text) = text.filter(|_| shown) {
                    ui.add(
                        egui::Label::new(RichText::new(text).small().color(Theme::of(ui).weak)).truncate(),
                    );
                }
            });
        });
        let Some(other) = context.compared_take() else {
            let (text, more) = match context.compared {
                CompareWith::Nothing => ("Nothing is compared", "Choose what to compare the take with"),
                CompareWith::Opened => ("This take was not in the file when it was opened", ""),
                CompareWith::Take(_) => ("The other take was deleted", ""),
                CompareWith::File(_) => ("The file has no such take", ""),
            };
            return widgets::empty(ui, text, more);
        };
        // While something is dragged, the takes change with every frame.
        if !context.dragging.is_open() {
            self.profile.update(now, other, context);
        }
        if context.compared_skeleton().is_some() && context.compared_file.is_unpaired() {
            let text = "No bone of the file has the name of a bone of this model";
            return widgets::empty(ui, text, "Bones of two files are compared by their names");
        }
        if self.profile.is_equal() {
            return widgets::empty(ui, "No difference", "");
        }
        strip::show(ui, context, &self.profile, requests);
        ui.spacing_mut().item_spacing.y = 0.0;
        ScrollArea::vertical().auto_shrink(false).show_rows(ui, ROW, self.profile.rows(), |ui, range| {
            for row in range {
                self.row(ui, context, row, requests);
            }
        });
    }
}

/// Draws the button with the choice of what is compared.
fn choose(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let slots = context.view.map_or(&[][..], |view| &view.slots);
    let name = |with: CompareWith| match with {
        CompareWith::Nothing => "nothing".to_owned(),
        CompareWith::Opened => "the take as opened".to_owned(),
        CompareWith::Take(id) => {
            let other = slots.iter().find(|slot| slot.id == id);
            other.map_or("a deleted take".to_owned(), |slot| widgets::shortened(&slot.result.name))
        }
        CompareWith::File(take) => context.compared_file.file().map_or(String::new(), |file| {
            let take = file.model.animation.takes.get(take).map_or("no take", |take| &take.name);
            widgets::shortened(&format!("{} – {take}", file.title))
        }),
    };
    let text = format!("Compare with: {}", name(context.compared));
    let button = widgets::choice_button(ui, &text);
    let button = button.on_hover_text("Compared take\nThe viewport shows its pose as a second skeleton");
    Popup::menu(&button).show(|ui| {
        ScrollArea::vertical().max_height(300.0).show(ui, |ui| {
            let own = context.slot().map(|slot| slot.id);
            let others = slots.iter().filter(|slot| Some(slot.id) != own);
            let others = others.map(|slot| CompareWith::Take(slot.id));
            let file = context.compared_file.file();
            let of_file = file.map_or(0, |file| file.model.animation.takes.len());
            let of_file = (0..of_file).map(CompareWith::File);
            for with in [CompareWith::Nothing, CompareWith::Opened].into_iter().chain(others).chain(of_file) {
                if ui.add(Button::selectable(with == context.compared, name(with))).clicked() {
                    requests.push(Request::CompareWith(with));
                    ui.close();
                }
            }
            if ui.add(Button::new("Another file…").frame_when_inactive(false)).clicked() {
                requests.push(Request::Command(Id::CompareFile));
                ui.close();
            }
        });
    });
}

impl DifferencesPanel {
    fn row(&self, ui: &mut Ui, context: &PanelContext<'_>, row: usize, requests: &mut Vec<Request>) {
        let Some(bone) = self.profile.bone(row) else { return };
        let theme = Theme::of(ui);
        let name = context.bone_name(bone.first);
        let numbers = format!(
            "{:.2} mm   {:.2}°",
            bone.distance.value * context.unit.millimeters(),
            bone.angle.value.to_degrees()
        );
        let selected = context.selection.bones().contains(&bone.first);
        let (rect, response) = widgets::row(ui, &format!("{name}, {numbers}"), selected, false);
        let width = widgets::text_width(ui, &numbers, &TextStyle::Small);
        let right = rect.right() - 12.0;
        let at = Rect::from_min_max(pos2(right - width, rect.top()), pos2(right + 1.0, rect.bottom()));
        widgets::text_in(ui, at, &numbers, &TextStyle::Small, theme.weak);
        let place =
            Rect::from_min_max(pos2(rect.left() + 12.0, rect.top()), pos2(at.left() - 8.0, rect.bottom()));
        let color = if selected { theme.accent } else { theme.text };
        widgets::text_in(ui, place, &name, &TextStyle::Body, color);
        if response.on_hover_text("Selects the bone and goes to its largest difference").clicked() {
            requests.push(Request::Select(Some(bone.first)));
            requests.push(Request::Seek(bone.distance.time));
        }
    }
}
