//! The dialog for the size of the model: how many meters one unit of the file is.

use super::context::PanelContext;
use super::length_unit::METERS;
use super::overlay_title;
use super::request::Request;
use super::style::GRID;
use super::theme::Theme;
use super::widgets;
use egui::{Button, DragValue, RichText, Ui};

/// Width of the dialog, points.
const WIDTH: f32 = 420.0;

/// Units that are offered: name and meters.
const UNITS: [(&str, f32); 4] =
    [("Meters", 1.0), ("Centimeters", 0.01), ("Millimeters", 0.001), ("Inches", 0.0254)];

/// Draws the dialog.
pub(super) fn show(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    ui.set_width(WIDTH);
    overlay_title::show(ui, "Size of the model", requests);
    let theme = Theme::of(ui);
    if context.loaded().is_none() {
        ui.label(RichText::new("No model is open").color(theme.weak));
        return;
    }
    let (unit, size) = (context.unit, context.unit.by_size().size);
    let text = format!("The figure is {} from end to end.", length(size * unit.meters()));
    ui.label(text);
    let more = match (unit.chosen(), unit.by_size().is_of_file()) {
        (Some(_), _) => "The unit was set by hand.".to_owned(),
        (None, true) => "One unit of the model is a meter.".to_owned(),
        (None, false) => {
            format!("By its file it would be {}, which no figure is: another unit is assumed.", length(size))
        }
    };
    ui.label(RichText::new(more).small().color(theme.weak));
    ui.add_space(2.0 * GRID);
    ui.horizontal(|ui| {
        let label = ui.label("Meters per unit");
        let mut meters = unit.meters();
        let speed = 0.01 * f64::from(meters);
        let field = DragValue::new(&mut meters).range(METERS).speed(speed).max_decimals(6);
        if ui.add(field).labelled_by(label.id).changed() {
            requests.push(Request::LengthUnit(Some(meters)));
        }
        let by_size = ui.add_enabled(unit.chosen().is_some(), Button::new("By the size"));
        widgets::hint_beside(&by_size, "Uses the unit guessed from the size of the figure again");
        if by_size.clicked() {
            requests.push(Request::LengthUnit(None));
        }
    });
    ui.horizontal(|ui| {
        for (name, meters) in UNITS {
            if ui.add(Button::selectable(unit.meters() == meters, name)).clicked() {
                requests.push(Request::LengthUnit(Some(meters)));
            }
        }
    });
    ui.add_space(2.0 * GRID);
    let text = "Nothing of the model changes. Contacts, foot slide, problems, loops, key reduction and differences are measured with this unit, which is remembered for this file.";
    ui.label(RichText::new(text).small().color(theme.weak));
}

/// Returns a length in meters as text.
fn length(meters: f32) -> String {
    if meters < 0.1 { format!("{:.1} cm", 100.0 * meters) } else { format!("{meters:.2} m") }
}
