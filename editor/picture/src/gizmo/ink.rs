//! Color and width of a drawn line.

/// Marks a vertex whose role is an ink.
const MARK: u32 = 1 << 31;

/// Number of steps of width in a point.
const STEPS: f32 = 4.0;

/// Color and width of a drawn line, in the bits of a role. WGSL twin: `is_ink` in `shaders/controls.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineInk(u32);

impl LineInk {
    /// Returns the ink of a color, sRGB from 0 to 255, and a width in points from 0.25 to 31.75; others count as the nearest one, and one that
    /// is no number as 3.
    pub fn new([red, green, blue]: [u8; 3], width: f32) -> Self {
        let width = if width.is_finite() { width } else { 3.0 };
        let steps = (width * STEPS).round().clamp(1.0, 127.0) as u32;
        Self(MARK | steps << 24 | u32::from(red) << 16 | u32::from(green) << 8 | u32::from(blue))
    }

    /// Returns the bits.
    pub(super) fn bits(self) -> u32 {
        self.0
    }
}

impl Default for LineInk {
    fn default() -> Self {
        Self::new([0xff, 0x40, 0x40], 3.0)
    }
}
