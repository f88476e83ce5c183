//! Drawing primitives of the charts: text, lines and marks at pixels.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Width of every chart, in pixels.
pub(super) const WIDTH: i32 = 900;

/// Color of text.
pub(super) const INK: RGBColor = RGBColor(0x22, 0x28, 0x30);
/// Color of secondary text.
pub(super) const SOFT: RGBColor = RGBColor(0x5c, 0x66, 0x73);
/// Color of the grid.
pub(super) const GRID: RGBColor = RGBColor(0xe3, 0xe7, 0xec);
/// Color of our variant.
pub(super) const ACCENT: RGBColor = RGBColor(0xd5, 0x5e, 0x00);
/// Colors of our variants in a chart with several of them, which also differ in shape.
pub(super) const OURS: [RGBColor; 3] = [ACCENT, RGBColor(0xe6, 0x9f, 0x00), RGBColor(0x8c, 0x3a, 0x00)];
/// Color of all other variants in a chart with a label for each.
pub(super) const OTHERS: RGBColor = RGBColor(0x6b, 0x7d, 0x93);
/// Colors of all other variants in a chart with a legend, from Okabe and Ito: color-blind readers can distinguish
/// them.
pub(super) const PALETTE: [RGBColor; 7] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0xa6, 0x76, 0x1d),
    RGBColor(0x33, 0x33, 0x33),
    RGBColor(0x8a, 0x8f, 0x98),
];

/// Position of a text relative to its point.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    /// To the right of the point.
    Start,
    /// Centered at the point.
    Middle,
    /// To the left of the point.
    End,
}

/// Shape of the mark of a value.
#[derive(Clone, Copy)]
pub(super) enum MarkShape {
    Disc,
    Ring,
    Square,
    Diamond,
    Triangle,
    Cross,
}

/// All shapes, for charts with many variants.
pub(super) const SHAPES: [MarkShape; 6] = [
    MarkShape::Disc,
    MarkShape::Square,
    MarkShape::Diamond,
    MarkShape::Triangle,
    MarkShape::Ring,
    MarkShape::Cross,
];

/// An SVG drawing.
pub(super) struct SvgCanvas<'a>(DrawingArea<SVGBackend<'a>, Shift>);

/// Message for an impossible error: writing to a string does not fail.
const NEVER: &str = "a string takes all that is written to it";

/// Draws a chart with `draw` below its title and subtitle. Returns the text of the SVG.
pub(super) fn svg(height: i32, title: &str, under: &str, draw: impl FnOnce(&SvgCanvas<'_>)) -> String {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, (WIDTH as u32, height as u32)).into_drawing_area();
        area.fill(&WHITE).expect(NEVER);
        let canvas = SvgCanvas(area);
        canvas.text(title, 16, 26, 17.0, INK, Anchor::Start);
        canvas.text(under, 16, 47, 12.5, SOFT, Anchor::Start);
        draw(&canvas);
        canvas.0.present().expect(NEVER);
    }
    text
}

impl SvgCanvas<'_> {
    /// Draws text, vertically centered at `y`, with a font size in pixels.
    pub(super) fn text(&self, text: &str, x: i32, y: i32, size: f64, color: RGBColor, anchor: Anchor) {
        let across = match anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        // The backend divides the size by this factor.
        let font = ("Helvetica, Arial, sans-serif", size * 1.24).into_font();
        let style = font.color(&color).pos(Pos::new(across, VPos::Center));
        self.0.draw(&Text::new(text.to_owned(), (x, y), style)).expect(NEVER);
    }

    /// Draws a line through all of `points`.
    pub(super) fn line(&self, points: &[(i32, i32)], width: u32, color: RGBColor) {
        let path = PathElement::new(points.to_vec(), color.stroke_width(width));
        self.0.draw(&path).expect(NEVER);
    }

    /// Draws a filled rectangle.
    pub(super) fn bar(&self, from: (i32, i32), to: (i32, i32), color: RGBColor) {
        self.0.draw(&Rectangle::new([from, to], color.filled())).expect(NEVER);
    }

    /// Draws the mark of a value.
    pub(super) fn mark(&self, (x, y): (i32, i32), shape: MarkShape, color: RGBColor) {
        let filled = |points: &[(i32, i32)]| {
            let points: Vec<(i32, i32)> = points.iter().map(|(right, down)| (x + right, y + down)).collect();
            self.0.draw(&Polygon::new(points, color.filled())).expect(NEVER);
        };
        match shape {
            MarkShape::Disc => self.0.draw(&Circle::new((x, y), 5, color.filled())).expect(NEVER),
            MarkShape::Ring => {
                self.0.draw(&Circle::new((x, y), 5, WHITE.filled())).expect(NEVER);
                self.0.draw(&Circle::new((x, y), 4, color.stroke_width(2))).expect(NEVER);
            }
            MarkShape::Square => filled(&[(-4, -4), (4, -4), (4, 4), (-4, 4)]),
            MarkShape::Diamond => filled(&[(0, -6), (6, 0), (0, 6), (-6, 0)]),
            MarkShape::Triangle => filled(&[(0, -5), (6, 5), (-6, 5)]),
            MarkShape::Cross => {
                self.line(&[(x - 4, y - 4), (x + 4, y + 4)], 2, color);
                self.line(&[(x - 4, y + 4), (x + 4, y - 4)], 2, color);
            }
        }
    }
}
