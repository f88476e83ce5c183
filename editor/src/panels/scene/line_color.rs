//! The colors that are offered for drawn lines.

/// A color with its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::panels) struct LineColor {
    /// Its name in menus.
    pub(in crate::panels) title: &'static str,
    /// Red, green and blue, sRGB.
    pub(in crate::panels) rgb: [u8; 3],
}

/// The offered colors. Lines without a color have the first one.
pub(in crate::panels) const LINE_COLORS: [LineColor; 6] = [
    LineColor { title: "Red", rgb: [0xff, 0x40, 0x40] },
    LineColor { title: "Orange", rgb: [0xff, 0x90, 0x20] },
    LineColor { title: "Yellow", rgb: [0xff, 0xe0, 0x40] },
    LineColor { title: "Green", rgb: [0x40, 0xc0, 0x60] },
    LineColor { title: "Blue", rgb: [0x40, 0x80, 0xff] },
    LineColor { title: "White", rgb: [0xff, 0xff, 0xff] },
];

/// Returns a color as files of lines have it.
pub(in crate::panels) fn color_text([red, green, blue]: [u8; 3]) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}
