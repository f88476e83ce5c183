//! Time from left to right: transport, ruler, keys, playhead.

use super::context::PanelContext;
use super::dope::Dope;
use super::request::Request;
use super::style;
use super::theme::Theme;
use super::{Panel, PanelPlace, transport, widgets};
use egui::{CornerRadius, Ui};

/// Transport and dope sheet.
#[derive(Debug, Default)]
pub struct TimelinePanel {
    dope: Dope,
}

impl Panel for TimelinePanel {
    fn id(&self) -> &'static str {
        "timeline"
    }

    fn title(&self) -> &'static str {
        "Timeline"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Below
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        ui.spacing_mut().item_spacing.y = 0.0;
        transport::show(ui, context, requests);
        let rect = ui.available_rect_before_wrap();
        if rect.height() < 32.0 || rect.width() < 140.0 {
            return;
        }
        if context.take().is_none() {
            let text =
                if context.view.is_none() { "Keys appear here" } else { "The rest pose does not move" };
            ui.painter().rect_filled(rect, CornerRadius::ZERO, Theme::of(ui).sunken);
            widgets::empty(ui, text, "");
            return;
        }
        self.dope.show(ui, rect, context, requests);
    }
}

/// The height at which seven rows are visible.
pub(super) const HEIGHT: f32 = style::BAR + 32.0 + 24.0 + 8.0 + 7.0 * super::dope::ROW;
