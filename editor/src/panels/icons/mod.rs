//! Icons as strokes on a grid of sixteen, so that no font can lack them and they follow the color of the text.

mod table;

pub use table::Icon;

use egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, vec2};

/// Declares the enum of all icons and the table of their strokes; each icon is one row.
macro_rules! icons {
    ($($name:ident: [$($stroke:expr),+ $(,)?],)+) => {
        /// An icon.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs)] // The names say it.
        pub enum Icon { $($name,)+ }

        impl Icon {
            /// All icons.
            pub const ALL: &[Self] = &[$(Self::$name,)+];

            /// Returns the strokes of the icon, on a grid of sixteen by sixteen.
            pub(super) fn strokes(self) -> &'static [super::IconStroke] {
                const STROKES: &[&[super::IconStroke]] = &[$(&[$($stroke),+],)+];
                STROKES[self as usize]
            }
        }
    };
}
use icons;

/// One part of an icon. Positions, sizes and radii are in sixteenths of the icon.
#[derive(Clone, Copy, Debug, PartialEq)]
enum IconStroke {
    /// An open line.
    Line(&'static [(f32, f32)]),
    /// A closed line.
    Outline(&'static [(f32, f32)]),
    /// A filled convex polygon.
    Solid(&'static [(f32, f32)]),
    /// A filled rectangle: left, top, width, height.
    Bar(f32, f32, f32, f32),
    /// A circle: center, radius.
    Ring(f32, f32, f32),
    /// A filled circle: center, radius.
    Dot(f32, f32, f32),
    /// A filled diamond: center, distance of the corners from it.
    Diamond(f32, f32, f32),
}

/// Width of lines, points.
const WIDTH: f32 = 1.3;

impl Icon {
    /// Draws the icon into the middle of `rect`, 16 points large.
    pub fn paint(self, painter: &Painter, rect: Rect, color: Color32) {
        let origin = rect.center() - vec2(8.0, 8.0);
        painter.extend(self.strokes().iter().map(|stroke| stroke.shape(origin, color)));
    }
}

impl IconStroke {
    fn shape(&self, origin: Pos2, color: Color32) -> Shape {
        let at = |x: f32, y: f32| origin + vec2(x, y);
        let points = |points: &[(f32, f32)]| points.iter().map(|&(x, y)| at(x, y)).collect::<Vec<_>>();
        let line = Stroke::new(WIDTH, color);
        match *self {
            Self::Line(list) => Shape::line(points(list), line),
            Self::Outline(list) => Shape::closed_line(points(list), line),
            Self::Solid(list) => Shape::convex_polygon(points(list), color, Stroke::NONE),
            Self::Bar(x, y, width, height) => {
                Shape::rect_filled(Rect::from_min_size(at(x, y), vec2(width, height)), 0.5, color)
            }
            Self::Ring(x, y, radius) => Shape::circle_stroke(at(x, y), radius, line),
            Self::Dot(x, y, radius) => Shape::circle_filled(at(x, y), radius, color),
            Self::Diamond(x, y, radius) => {
                let corners = [(x, y - radius), (x + radius, y), (x, y + radius), (x - radius, y)];
                Shape::convex_polygon(points(&corners), color, Stroke::NONE)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_icon_stays_on_its_grid() {
        let inside = |x: f32, y: f32| (0.0..=16.0).contains(&x) && (0.0..=16.0).contains(&y);
        for &icon in Icon::ALL {
            assert!(!icon.strokes().is_empty(), "{icon:?} is empty");
            for stroke in icon.strokes() {
                let fits = match *stroke {
                    IconStroke::Line(list) | IconStroke::Outline(list) | IconStroke::Solid(list) => {
                        list.len() > 1 && list.iter().all(|&(x, y)| inside(x, y))
                    }
                    IconStroke::Bar(x, y, width, height) => inside(x, y) && inside(x + width, y + height),
                    IconStroke::Ring(x, y, radius)
                    | IconStroke::Dot(x, y, radius)
                    | IconStroke::Diamond(x, y, radius) => {
                        inside(x - radius, y - radius) && inside(x + radius, y + radius)
                    }
                };
                assert!(fits, "{icon:?} leaves its grid: {stroke:?}");
            }
        }
    }
}
