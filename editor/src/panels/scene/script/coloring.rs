//! The layout of the script with its colors.

use crate::panels::theme::Theme;
use dragonfly_anim::stage::writing::{TokenKind, tokens};
use egui::text::{LayoutJob, TextFormat, TextWrapping};
use egui::{Color32, FontId, Galley, Ui};
use std::sync::Arc;

/// Size of the text, points.
pub(super) const SIZE: f32 = 12.5;

/// Largest text that is colored, bytes. A larger one is shown in one color, so that typing stays quick.
pub(super) const MOST_COLORED: usize = 256 << 10;

/// The layout of the last text.
#[derive(Debug, Default)]
pub(super) struct ScriptLayout {
    of: Option<LaidOut>,
}

#[derive(Debug)]
struct LaidOut {
    text: String,
    is_dark: bool,
    pixels: f32,
    galley: Arc<Galley>,
}

impl ScriptLayout {
    /// Returns the layout of a text: a line of the text is a line on the screen. The same text costs a comparison.
    pub(super) fn galley(&mut self, ui: &Ui, text: &str) -> Arc<Galley> {
        let (theme, pixels) = (Theme::of(ui), ui.ctx().pixels_per_point());
        if let Some(of) =
            self.of.as_ref().filter(|of| of.is_dark == theme.dark && of.pixels == pixels && of.text == text)
        {
            return Arc::clone(&of.galley);
        }
        let mut job = job(text, theme);
        job.wrap = TextWrapping::no_max_width();
        let galley = ui.painter().layout_job(job);
        self.of =
            Some(LaidOut { text: text.to_owned(), is_dark: theme.dark, pixels, galley: Arc::clone(&galley) });
        galley
    }
}

/// Returns a text with the colors of its parts.
fn job(text: &str, theme: &Theme) -> LayoutJob {
    let format = |color: Color32| TextFormat::simple(FontId::monospace(SIZE), color);
    let mut job = LayoutJob::default();
    let mut done = 0;
    let parts = if text.len() > MOST_COLORED { Vec::new() } else { tokens(text) };
    for token in parts {
        job.append(&text[done..token.range.start], 0.0, format(theme.text));
        job.append(&text[token.range.clone()], 0.0, format(color(token.kind, theme)));
        done = token.range.end;
    }
    job.append(&text[done..], 0.0, format(theme.text));
    job
}

fn color(kind: TokenKind, theme: &Theme) -> Color32 {
    match kind {
        TokenKind::Sign | TokenKind::Declaration => theme.weak,
        TokenKind::Element => theme.bone_hue(0, 1),
        TokenKind::Attribute => theme.bone_hue(4, 0),
        TokenKind::Value => theme.bone_hue(2, 1),
        TokenKind::Comment => theme.faint,
    }
}
