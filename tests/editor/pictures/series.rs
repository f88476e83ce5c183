//! A case in all its pictures: both themes, 1x and 2x.

use super::compare::PANELS;
use super::drawing;
use super::reference::{self, HOW_TO_UPDATE};
use crate::workbench::{Window, Workbench};
use dragonfly::panels::style;
use egui::{Order, Rect, Theme, Vec2, pos2};

/// Part of the window that a case shows.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Crop {
    /// Everything between the menu bar and the status line.
    Middle,
    /// The menu bar.
    Bar,
    /// The status line.
    Line,
    /// The question or overlay that is open above the panels.
    Above,
    /// The menu that was opened last.
    Newest,
    /// Everything.
    Whole,
}

/// A part of the window in one state.
pub(super) struct PictureCase {
    /// Folder and name of its pictures, without theme and scale.
    pub(super) name: String,
    /// Size of the window in points.
    pub(super) size: Vec2,
    /// The part of it that is shown.
    pub(super) crop: Crop,
    /// The state before anything is clicked.
    pub(super) bench: Box<dyn Fn() -> Workbench>,
    /// The input that leads to what is shown.
    pub(super) act: Box<dyn Fn(&mut Window)>,
    /// Whether it is drawn at 2x as well.
    pub(super) twice: bool,
}

/// Themes and scales in which each case is drawn.
const VARIANTS: [(Theme, &str, f32, &str); 4] = [
    (Theme::Dark, "dark", 1.0, "1x"),
    (Theme::Light, "light", 1.0, "1x"),
    (Theme::Dark, "dark", 2.0, "2x"),
    (Theme::Light, "light", 2.0, "2x"),
];

impl PictureCase {
    /// Returns the names of its pictures.
    pub(super) fn names(&self) -> Vec<String> {
        self.variants().map(|(_, theme, _, scale)| format!("{}-{theme}-{scale}", self.name)).collect()
    }

    fn variants(&self) -> impl Iterator<Item = (Theme, &'static str, f32, &'static str)> + use<> {
        let twice = self.twice;
        VARIANTS.into_iter().filter(move |(_, _, scale, _)| twice || *scale == 1.0)
    }

    /// Draws the picture of a theme at a scale; skips the test where nothing can be drawn.
    pub(super) fn draw(&self, theme: Theme, scale: f32) -> Option<image::RgbaImage> {
        let device = drawing::device()?;
        let mut window = drawing::window((self.bench)(), self.size, scale, theme, device);
        (self.act)(&mut window);
        window.run_steps(4);
        let part = self.part(&window);
        Some(drawing::picture(&mut window, part))
    }

    fn part(&self, window: &Window) -> Rect {
        let whole = Rect::from_min_size(pos2(0.0, 0.0), self.size);
        let (top, bottom) = (style::BAR, self.size.y - STATUS);
        match self.crop {
            Crop::Middle => Rect::from_x_y_ranges(whole.x_range(), top..=bottom),
            Crop::Whole => whole,
            Crop::Bar => Rect::from_x_y_ranges(whole.x_range(), 0.0..=top),
            Crop::Line => Rect::from_x_y_ranges(whole.x_range(), bottom..=self.size.y),
            Crop::Above => self.above(window).into_iter().reduce(Rect::union).expect("something is open"),
            // A menu opens at the right of the one that it belongs to.
            Crop::Newest => {
                let newest = self.above(window).into_iter().max_by(|a, b| a.left().total_cmp(&b.left()));
                newest.expect("a menu is open")
            }
        }
    }

    /// Returns the areas that are open above the panels.
    fn above(&self, window: &Window) -> Vec<Rect> {
        window.ctx.memory(|memory| {
            let layers = memory.areas().visible_layer_ids();
            let above = layers.into_iter().filter(|layer| layer.order >= Order::Foreground);
            let areas = above.filter_map(|layer| memory.area_rect(layer.id));
            // The backdrop of a question is as large as the window.
            areas
                .filter(|area| area.width() < self.size.x - 1.0 || area.height() < self.size.y - 1.0)
                .collect()
        })
    }
}

/// Height of the status line.
pub(super) const STATUS: f32 = 24.0;

/// Draws all pictures of the cases and fails with a list of those that differ from the stored ones.
#[track_caller]
pub(super) fn compare(cases: impl IntoIterator<Item = PictureCase>) {
    let mut complaints = Vec::new();
    for case in cases {
        for ((theme, _, scale, _), name) in case.variants().zip(case.names()) {
            let Some(picture) = case.draw(theme, scale) else { return };
            complaints.extend(reference::compare(&name, &picture, PANELS));
        }
    }
    assert!(complaints.is_empty(), "\n  {}\n{HOW_TO_UPDATE}", complaints.join("\n  "));
}
