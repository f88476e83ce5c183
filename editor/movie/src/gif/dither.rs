//! Pixels in colors of a palette, mixed where a color is between those of the palette.
//!
//! A color is mixed of a few colors of the palette whose mean is nearest to it; a threshold that depends only on the position of the pixel
//! chooses among them. So a pixel that keeps its color keeps its index, and nothing flickers (Knoll's ordered dither).

/// Number of colors that a color is mixed of.
const MIXED: usize = 8;

/// Number of colors whose mixtures are remembered.
const REMEMBERED: usize = 1 << 14;

/// Largest error of a channel that later colors of a mixture correct.
const MOST_ERROR: i32 = 40;

/// Chooses an index of the palette for each pixel.
#[derive(Clone, Debug)]
pub(crate) struct DitherTable {
    /// Red, green and blue of the palette, each by itself.
    palette: [Vec<i32>; 3],
    luma: Vec<i32>,
    /// A color and its mixture, sorted by luma. A color is remembered at one place, where it replaces another.
    mixtures: Vec<([u8; 3], [u8; MIXED])>,
    /// The number in the mixture for each pixel.
    thresholds: Vec<u8>,
}

impl DitherTable {
    pub(crate) fn new(palette: &[[u8; 3]], size: [u32; 2]) -> Self {
        let channel =
            |channel: usize| palette.iter().map(|color| i32::from(color[channel])).collect::<Vec<_>>();
        let luma = palette.iter().map(|color| luma(*color)).collect();
        let [width, height] = size;
        let positions = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let thresholds = positions.map(|(x, y)| threshold(x, y)).collect();
        let mut table = Self { palette: [0, 1, 2].map(channel), luma, mixtures: Vec::new(), thresholds };
        // Every place holds black at first, which is remembered at one of them.
        let black = ([0; 3], table.mix([0; 3]));
        table.mixtures = vec![black; REMEMBERED];
        table
    }

    /// Writes the index of each pixel of red, green and blue into `out`.
    pub(crate) fn indexes(&mut self, rgb: &[u8], out: &mut Vec<u8>) {
        out.clear();
        for (at, &color) in rgb.as_chunks::<3>().0.iter().enumerate() {
            let place = place(color);
            if self.mixtures[place].0 != color {
                self.mixtures[place] = (color, self.mix(color));
            }
            out.push(self.mixtures[place].1[usize::from(self.thresholds[at])]);
        }
    }

    fn mix(&self, color: [u8; 3]) -> [u8; MIXED] {
        let color = color.map(i32::from);
        let mut error = [0_i32; 3];
        let mut mixture = [0; MIXED];
        for chosen in &mut mixture {
            let wanted = [0, 1, 2].map(|channel| color[channel] + error[channel]);
            let nearest = self.nearest(wanted);
            *chosen = nearest as u8;
            for channel in 0..3 {
                let left = error[channel] + color[channel] - self.palette[channel][nearest];
                error[channel] = left.clamp(-MOST_ERROR, MOST_ERROR);
            }
        }
        mixture.sort_by_key(|index| (self.luma[usize::from(*index)], *index));
        mixture
    }

    /// Returns the index of the color nearest to one that may be outside of what bytes can be.
    fn nearest(&self, [red, green, blue]: [i32; 3]) -> usize {
        let [reds, greens, blues] = &self.palette;
        let distances = reds.iter().zip(greens).zip(blues).map(|((&r, &g), &b)| {
            let [r, g, b] = [r - red, g - green, b - blue];
            2 * r * r + 4 * g * g + 3 * b * b
        });
        distances
            .enumerate()
            .min_by_key(|(index, distance)| (*distance, *index))
            .map_or(0, |(index, _)| index)
    }
}

fn luma([red, green, blue]: [u8; 3]) -> i32 {
    2126 * i32::from(red) + 7152 * i32::from(green) + 722 * i32::from(blue)
}

/// Returns the place at which the mixture of a color is remembered.
fn place([red, green, blue]: [u8; 3]) -> usize {
    let color = u32::from(red) << 16 | u32::from(green) << 8 | u32::from(blue);
    (color.wrapping_mul(0x9E37_79B1) >> 18) as usize % REMEMBERED
}

/// Returns a number below [`MIXED`] for a position: even everywhere and without a pattern that shows (interleaved gradient noise, Jimenez).
fn threshold(x: u32, y: u32) -> u8 {
    let slope = 0.067_110_56 * f64::from(x) + 0.005_837_15 * f64::from(y);
    let noise = (52.982_918_9 * slope.fract()).fract();
    (noise * MIXED as f64) as u8
}
