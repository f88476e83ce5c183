//! The questions to the user, one per file. A question covers everything else until it is answered.

mod changed;
mod exists;
mod find;
mod place;
mod plan;
mod recover;
mod unsaved;

use super::context::PanelContext;
use super::prompts::Question;
use super::request::Request;
use super::style::{GRID, RADIUS};
use super::theme::Theme;
use egui::{Button, CornerRadius, Frame, Id, Modal, Response, RichText, Stroke, Ui, vec2};

/// State of the controls in questions.
#[derive(Debug, Default)]
pub(super) struct Dialogs {
    path: String,
    chosen: usize,
    shown: Option<u64>,
    /// Whether the question was written to the log.
    told: bool,
}

impl Dialogs {
    /// Draws the question that is open.
    pub(super) fn show(&mut self, ui: &mut Ui, state: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let number = state.prompts.question_number();
        let fresh = self.shown != number;
        self.shown = number;
        let Some(question) = state.question() else { return };
        if fresh {
            self.told = false;
            // The keyboard focus arrives with the next frame.
            ui.ctx().request_repaint();
            self.chosen = 0;
            self.path = match question {
                Question::Find { offer, .. } => find::proposal(offer),
                question => place::proposal(state, matches!(question, Question::Where { copy: true, .. })),
            };
        }
        if !fresh && !std::mem::replace(&mut self.told, true) {
            tracing::info!(target: "dragonfly::question", "{}", question.name());
        }
        let modal = Modal::new(Id::unique(("question", format!("{:?}", std::mem::discriminant(question)))))
            .backdrop_color(Theme::of(ui).backdrop)
            .frame(Frame::popup(ui.style()).inner_margin(20));
        let response = modal.show(ui.ctx(), |ui| {
            ui.spacing_mut().item_spacing.y = 2.0 * GRID;
            let mut ask = Ask { ui, state, fresh, requests };
            match question {
                Question::Unsaved(then) => unsaved::show(&mut ask, then),
                Question::Changed(file, order) => changed::show(&mut ask, *file, order.as_ref()),
                Question::Exists(path, order) => exists::show(&mut ask, path, order),
                Question::Plan(lines, order) => plan::show(&mut ask, lines, order.as_ref()),
                Question::Recover { offers, lost } => {
                    recover::show(&mut ask, offers, *lost, &mut self.chosen)
                }
                Question::Find { offer, other } => {
                    find::show(&mut ask, offer, other.as_deref(), &mut self.path)
                }
                Question::Where { copy, then } => place::show(&mut ask, *copy, then.as_ref(), &mut self.path),
            }
        });
        if response.should_close() {
            requests.push(Request::Dismiss);
        }
    }
}

/// A question that is being drawn.
struct Ask<'a> {
    ui: &'a mut Ui,
    state: &'a PanelContext<'a>,
    /// Whether this is its first frame, in which the default button gets the focus.
    fresh: bool,
    requests: &'a mut Vec<Request>,
}

/// Style of a button.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Tone {
    /// The default button, which Enter presses.
    First,
    Plain,
    /// The button of a choice that discards something, or moves it where it is hard to find.
    Loses,
}

impl Ask<'_> {
    fn title(&mut self, text: &str) {
        self.ui.label(RichText::new(text).heading());
    }

    /// Draws a sentence.
    fn says(&mut self, text: impl Into<String>) {
        self.ui.label(text.into());
    }

    /// Draws a secondary sentence.
    fn adds(&mut self, text: impl Into<String>) {
        let weak = Theme::of(self.ui).weak;
        self.ui.label(RichText::new(text).color(weak));
    }

    /// Draws a warning.
    fn warns(&mut self, text: impl Into<String>) {
        let warning = Theme::of(self.ui).warning;
        self.ui.label(RichText::new(text).color(warning));
    }

    /// Draws the row of buttons: those that discard something on the left, the others on the right with the default one
    /// last. Returns the one that was pressed.
    fn buttons<T: Copy>(&mut self, choices: &[(&str, &str, Tone, T)]) -> Option<T> {
        self.ui.add_space(GRID);
        let mut pressed = None;
        let fresh = self.fresh;
        self.ui.horizontal(|ui| {
            for (title, help, tone, choice) in choices.iter().filter(|(_, _, tone, _)| *tone == Tone::Loses) {
                if button(ui, title, *tone, true).on_hover_text(*help).clicked() {
                    pressed = Some(*choice);
                }
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let rest = choices.iter().filter(|(_, _, tone, _)| *tone != Tone::Loses);
                for (title, help, tone, choice) in rest {
                    let response = button(ui, title, *tone, true).on_hover_text(*help);
                    if fresh && *tone == Tone::First {
                        response.request_focus();
                    }
                    if response.clicked() {
                        pressed = Some(*choice);
                    }
                }
            });
        });
        pressed
    }
}

/// Returns a frame for details in a question, with a line around it: in the light theme card and frame are both white.
fn inset(theme: &Theme) -> Frame {
    Frame::NONE.fill(theme.sunken).stroke(Stroke::new(1.0, theme.line)).corner_radius(RADIUS)
}

/// Draws a button of a question.
fn button(ui: &mut Ui, title: &str, tone: Tone, able: bool) -> Response {
    let theme = Theme::of(ui);
    let text = match tone {
        Tone::First => RichText::new(title).color(theme.on_accent),
        Tone::Plain => RichText::new(title),
        Tone::Loses => RichText::new(title).color(theme.error),
    };
    let mut button = Button::new(text).min_size(vec2(88.0, 28.0)).corner_radius(CornerRadius::same(RADIUS));
    if tone == Tone::First {
        button = button.fill(theme.accent);
    }
    let response = ui.add_enabled(able, button);
    super::widgets::focus_ring(ui, &response, response.rect.expand(2.0));
    response
}
