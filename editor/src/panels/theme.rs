//! All colors of the program, for the light and the dark theme. No other file defines colors.

use dragonfly_picture::gizmo::GizmoRole;
use egui::Color32;

/// The colors of one theme. One accent: the green of a dragonfly's thorax.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Theme {
    /// Whether this is the dark theme.
    pub dark: bool,
    /// Gaps between panels.
    pub gap: Color32,
    /// Background of panels.
    pub panel: Color32,
    /// Menu bar, panel headers, status line.
    pub bar: Color32,
    /// Number fields, search fields, the timeline's bed.
    pub sunken: Color32,
    /// Menus, sheets, cards.
    pub raised: Color32,
    /// Fine lines.
    pub line: Color32,
    /// Buttons under the pointer, rows under the pointer.
    pub hover: Color32,
    /// Buttons being pressed.
    pub pressed: Color32,
    /// Primary text.
    pub text: Color32,
    /// Secondary text.
    pub weak: Color32,
    /// Least important text and lines: hints, ticks.
    pub faint: Color32,
    /// Selection, playhead, focus.
    pub accent: Color32,
    /// Background of a selected row.
    pub accent_soft: Color32,
    /// Text and icons on the accent color.
    pub on_accent: Color32,
    /// Warnings.
    pub warning: Color32,
    /// Errors.
    pub error: Color32,
    /// Axis letters, keys of a channel: X, Y, Z.
    pub axes: [Color32; 3],
    /// A key in the timeline.
    pub key: Color32,
    /// Background of overlays on the viewport.
    pub glass: Color32,
    /// Border of overlays on the viewport.
    pub glass_line: Color32,
    /// Background of the viewport: top and bottom of a gradient.
    pub sky: [Color32; 2],
    /// The ground grid.
    pub grid: Color32,
    /// Bones that are not selected.
    pub bone: Color32,
    /// Shadow of cards.
    pub shadow: Color32,
    /// Dims the window under a dialog.
    pub backdrop: Color32,
}

/// The dark theme, for dim rooms.
pub const DARK: Theme = Theme {
    dark: true,
    gap: Color32::from_rgb(12, 15, 16),
    panel: Color32::from_rgb(26, 30, 31),
    bar: Color32::from_rgb(20, 24, 25),
    sunken: Color32::from_rgb(16, 19, 20),
    raised: Color32::from_rgb(35, 40, 42),
    line: Color32::from_rgb(46, 53, 55),
    hover: Color32::from_rgb(44, 51, 53),
    pressed: Color32::from_rgb(56, 65, 67),
    text: Color32::from_rgb(222, 229, 227),
    weak: Color32::from_rgb(148, 160, 158),
    faint: Color32::from_rgb(98, 110, 109),
    accent: Color32::from_rgb(46, 201, 164),
    accent_soft: Color32::from_rgb(24, 68, 60),
    on_accent: Color32::from_rgb(4, 27, 22),
    warning: Color32::from_rgb(232, 182, 84),
    error: Color32::from_rgb(240, 113, 103),
    axes: [
        Color32::from_rgb(233, 113, 107),
        Color32::from_rgb(140, 197, 98),
        Color32::from_rgb(98, 160, 236),
    ],
    key: Color32::from_rgb(186, 199, 196),
    glass: Color32::from_rgba_premultiplied(17, 20, 21, 226),
    glass_line: Color32::from_rgba_premultiplied(60, 68, 70, 255),
    sky: [Color32::from_rgb(60, 69, 72), Color32::from_rgb(27, 31, 33)],
    grid: Color32::from_rgb(98, 110, 114),
    bone: Color32::from_rgb(205, 212, 214),
    shadow: Color32::from_rgba_premultiplied(0, 0, 0, 110),
    backdrop: Color32::from_black_alpha(120),
};

/// The light theme, for bright rooms.
pub const LIGHT: Theme = Theme {
    dark: false,
    gap: Color32::from_rgb(207, 214, 212),
    panel: Color32::from_rgb(246, 248, 247),
    bar: Color32::from_rgb(233, 237, 236),
    sunken: Color32::from_rgb(255, 255, 255),
    raised: Color32::from_rgb(255, 255, 255),
    line: Color32::from_rgb(211, 218, 216),
    hover: Color32::from_rgb(222, 230, 227),
    pressed: Color32::from_rgb(205, 216, 212),
    text: Color32::from_rgb(27, 36, 34),
    weak: Color32::from_rgb(90, 104, 101),
    faint: Color32::from_rgb(138, 151, 148),
    accent: Color32::from_rgb(10, 138, 110),
    accent_soft: Color32::from_rgb(205, 236, 227),
    on_accent: Color32::from_rgb(255, 255, 255),
    warning: Color32::from_rgb(156, 101, 0),
    error: Color32::from_rgb(190, 50, 44),
    axes: [Color32::from_rgb(192, 57, 50), Color32::from_rgb(74, 132, 32), Color32::from_rgb(36, 104, 196)],
    key: Color32::from_rgb(84, 100, 96),
    glass: Color32::from_rgba_premultiplied(238, 241, 240, 240),
    glass_line: Color32::from_rgba_premultiplied(200, 208, 206, 255),
    sky: [Color32::from_rgb(216, 223, 224), Color32::from_rgb(184, 194, 196)],
    grid: Color32::from_rgb(128, 140, 142),
    bone: Color32::from_rgb(150, 160, 163),
    shadow: Color32::from_rgba_premultiplied(0, 0, 0, 50),
    backdrop: Color32::from_black_alpha(60),
};

/// Colors of curves by bone and component, in the dark theme.
const DARK_HUES: [[[u8; 3]; 3]; 6] = [
    [[206, 233, 253], [123, 199, 253], [50, 161, 230]],
    [[254, 165, 121], [221, 122, 70], [181, 86, 29]],
    [[205, 232, 122], [167, 193, 83], [131, 155, 39]],
    [[226, 154, 238], [187, 116, 199], [148, 81, 160]],
    [[41, 215, 184], [6, 173, 147], [12, 132, 112]],
    [[254, 192, 228], [235, 137, 198], [195, 100, 160]],
];

/// Colors of curves by bone and component, in the light theme.
const LIGHT_HUES: [[[u8; 3]; 3]; 6] = [
    [[45, 112, 190], [6, 82, 158], [1, 50, 102]],
    [[202, 93, 114], [168, 62, 85], [128, 23, 53]],
    [[116, 120, 5], [87, 90, 8], [55, 57, 1]],
    [[149, 125, 220], [120, 95, 187], [87, 59, 148]],
    [[2, 150, 160], [15, 117, 124], [8, 79, 85]],
    [[150, 71, 144], [118, 42, 113], [81, 2, 78]],
];

impl Theme {
    /// Returns the theme that `ui` is drawn in.
    pub fn of(ui: &egui::Ui) -> &'static Self {
        Self::get(ui.visuals().dark_mode)
    }

    /// Returns the color of a component of the curve of a bone, with the position `at` of the bone among those that are shown: a hue for
    /// each bone, lighter for X and darker for Z. Neighboring bones differ in lightness, too, so that color-blind users can distinguish
    /// them.
    pub fn bone_hue(&self, at: usize, component: usize) -> Color32 {
        let hues = if self.dark { &DARK_HUES } else { &LIGHT_HUES };
        let [red, green, blue] = hues[at % hues.len()][component.min(2)];
        Color32::from_rgb(red, green, blue)
    }

    /// Returns the color of the letters at the ends of the axes.
    pub fn on_axis(&self) -> Color32 {
        if self.dark { Color32::from_rgb(20, 24, 25) } else { Color32::from_rgb(255, 255, 255) }
    }

    /// Returns the color of a part of a gizmo or path.
    pub fn role(&self, role: GizmoRole) -> Color32 {
        let by_theme = |dark: [u8; 3], light: [u8; 3]| {
            let [red, green, blue] = if self.dark { dark } else { light };
            Color32::from_rgb(red, green, blue)
        };
        match role {
            GizmoRole::X => self.axes[0],
            GizmoRole::Y => self.axes[1],
            GizmoRole::Z => self.axes[2],
            GizmoRole::View => self.key,
            GizmoRole::Hover | GizmoRole::Active => by_theme([255, 226, 138], [214, 132, 0]),
            GizmoRole::Past => by_theme([236, 138, 112], [186, 78, 52]),
            GizmoRole::Future => by_theme([104, 196, 204], [20, 120, 134]),
            GizmoRole::Selected => self.accent,
        }
    }

    /// Returns the dark or the light theme.
    pub fn get(dark: bool) -> &'static Self {
        if dark { &DARK } else { &LIGHT }
    }
}

/// Converts a color to linear RGB, as the graphics thread expects it.
pub fn linear(color: Color32) -> [f32; 3] {
    let rgba = egui::Rgba::from(color.to_opaque());
    [rgba.r(), rgba.g(), rgba.b()]
}
