//! Type, spacing and the look of egui's own widgets: a grid of four points, one corner radius, no frames in frames.

use super::theme::Theme;
use dragonfly_picture::TitleLook;
use egui::epaint::text::{FontData, FontDefinitions};
use egui::style::{ScrollStyle, WidgetVisuals};
use egui::{Context, CornerRadius, FontFamily, FontId, Margin, Shadow, Stroke, TextStyle, Vec2, vec2};
use std::sync::Arc;

/// The unit of all distances.
pub const GRID: f32 = 4.0;
/// Height of a row of a list.
pub const ROW: f32 = 24.0;
/// Height of buttons and fields.
pub const CONTROL: f32 = 24.0;
/// Height of the menu bar, the panel headers and the status line.
pub const BAR: f32 = 28.0;
/// Corners of buttons and fields.
pub const RADIUS: u8 = 4;
/// Corners of cards and menus.
pub const CARD_RADIUS: u8 = 8;

/// Size of ordinary text.
pub const BODY: f32 = 13.0;
/// Size of numbers in columns.
pub const NUMBER: f32 = 12.0;
/// Size of captions and ticks.
pub const SMALL: f32 = 11.0;

/// Installs the fonts, both themes, and the plugin for navigation with Tab.
pub fn install(context: &Context) {
    context.add_plugin(super::tab::TabGoesOn::default());
    context.set_fonts(fonts());
    for theme in [egui::Theme::Dark, egui::Theme::Light] {
        context.style_mut_of(theme, |style| apply(style, Theme::get(theme == egui::Theme::Dark)));
    }
    context.options_mut(|options| {
        // The scale is a setting of the program, which its own commands change.
        options.zoom_with_keyboard = false;
        options.quit_shortcuts.clear();
    });
}

/// Returns the font of the titles of a scene.
pub(super) fn title_font() -> FontFamily {
    FontFamily::Name("title".into())
}

/// Returns the fonts: Inter for text, Hack for numbers (digits of one width, so that columns do not jitter while
/// playing).
fn fonts() -> FontDefinitions {
    let mut fonts = FontDefinitions::default();
    // Titles look as in movies.
    let titles = TitleLook::fonts().families.remove(&FontFamily::Proportional).unwrap_or_default();
    fonts.families.insert(title_font(), titles);
    let inter = FontData::from_static(include_bytes!("../../fonts/Inter-Medium.otf"));
    fonts.font_data.insert("Inter".to_owned(), Arc::new(inter));
    fonts.families.entry(FontFamily::Proportional).or_default().insert(0, "Inter".to_owned());
    fonts
}

fn apply(style: &mut egui::Style, theme: &Theme) {
    style.text_styles = [
        (TextStyle::Small, FontId::proportional(SMALL)),
        (TextStyle::Body, FontId::proportional(BODY)),
        (TextStyle::Button, FontId::proportional(BODY)),
        (TextStyle::Heading, FontId::proportional(16.0)),
        (TextStyle::Monospace, FontId::monospace(12.0)),
    ]
    .into();
    style.drag_value_text_style = TextStyle::Monospace;
    style.animation_time = 0.08;
    style.interaction.selectable_labels = false;
    style.interaction.tooltip_delay = 0.4;

    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(2.0 * GRID, GRID);
    spacing.button_padding = vec2(2.0 * GRID, 3.0);
    spacing.menu_margin = Margin::same(6);
    spacing.window_margin = Margin::same(16);
    spacing.interact_size = vec2(32.0, CONTROL);
    spacing.indent = 4.0 * GRID;
    spacing.menu_width = 240.0;
    spacing.tooltip_width = 320.0;
    spacing.icon_width = 16.0;
    spacing.scroll = ScrollStyle {
        bar_width: 8.0,
        floating_width: 4.0,
        bar_inner_margin: 2.0,
        // Scroll bars stay visible, so that users see that there is more to scroll to.
        dormant_handle_opacity: 0.35,
        ..ScrollStyle::floating()
    };

    let visuals = &mut style.visuals;
    visuals.dark_mode = theme.dark;
    visuals.panel_fill = theme.panel;
    visuals.window_fill = theme.raised;
    visuals.window_stroke = Stroke::new(1.0, theme.line);
    visuals.window_corner_radius = CornerRadius::same(CARD_RADIUS);
    visuals.menu_corner_radius = CornerRadius::same(CARD_RADIUS);
    visuals.window_shadow = Shadow { offset: [0, 8], blur: 28, spread: 0, color: theme.shadow };
    visuals.popup_shadow = Shadow { offset: [0, 4], blur: 16, spread: 0, color: theme.shadow };
    visuals.extreme_bg_color = theme.sunken;
    visuals.text_edit_bg_color = Some(theme.sunken);
    visuals.faint_bg_color = theme.bar;
    visuals.code_bg_color = theme.sunken;
    visuals.weak_text_color = Some(theme.weak);
    visuals.hyperlink_color = theme.accent;
    visuals.warn_fg_color = theme.warning;
    visuals.error_fg_color = theme.error;
    visuals.selection.bg_fill = theme.accent_soft;
    visuals.selection.stroke = Stroke::new(1.0, theme.accent);
    visuals.slider_trailing_fill = true;
    visuals.disabled_alpha = 0.45;

    let widgets = &mut visuals.widgets;
    widgets.noninteractive = look(theme.panel, theme.line, theme.text);
    widgets.inactive = look(theme.sunken, theme.line, theme.text);
    widgets.hovered = look(theme.hover, theme.faint, theme.text);
    widgets.active = look(theme.pressed, theme.accent, theme.text);
    widgets.open = look(theme.hover, theme.line, theme.text);
}

/// Returns the style of a widget in one state. States differ in color, never in size.
fn look(fill: egui::Color32, line: egui::Color32, text: egui::Color32) -> WidgetVisuals {
    WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, line),
        corner_radius: CornerRadius::same(RADIUS),
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    }
}

/// Returns the size of a square button with an icon.
pub fn icon_size() -> Vec2 {
    Vec2::splat(CONTROL)
}
