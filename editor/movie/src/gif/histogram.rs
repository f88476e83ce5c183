//! Colors of a whole movie, counted in a bounded table.

use std::collections::BTreeSet;

/// Number of colors that a movie may have to be kept as they are: an index of the palette is for pixels that do not change.
pub(crate) const MOST_COLORS: usize = 255;

/// Colors that are alike, to 5, 6 and 5 bits.
#[derive(Clone, Copy, Debug, Default)]
struct ColorBin {
    count: u64,
    sum: [u64; 3],
}

/// Numbers of pixels with each color.
#[derive(Clone, Debug)]
pub(crate) struct ColorHistogram {
    bins: Vec<ColorBin>,
    /// All colors, while they are few.
    few: Option<BTreeSet<[u8; 3]>>,
}

/// The mean of colors that are alike, and the number of pixels that have them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CountedColor {
    pub(crate) color: [f32; 3],
    pub(crate) count: f32,
}

impl ColorHistogram {
    pub(crate) fn new() -> Self {
        Self { bins: vec![ColorBin::default(); 1 << 16], few: Some(BTreeSet::new()) }
    }

    /// Counts pixels of red, green and blue.
    pub(crate) fn add(&mut self, rgb: &[u8]) {
        let mut last = None;
        for &[red, green, blue] in rgb.as_chunks::<3>().0 {
            let at = usize::from(red >> 3) << 11 | usize::from(green >> 2) << 5 | usize::from(blue >> 3);
            let bin = &mut self.bins[at];
            bin.count += 1;
            let color = [red, green, blue];
            bin.sum.iter_mut().zip(color).for_each(|(sum, channel)| *sum += u64::from(channel));
            if let Some(few) = &mut self.few
                && last != Some(color)
            {
                few.insert(color);
                if few.len() > MOST_COLORS {
                    self.few = None;
                }
            }
            last = Some(color);
        }
    }

    /// Returns all colors of the movie if they fit into a palette.
    pub(crate) fn few_colors(&self) -> Option<Vec<[u8; 3]>> {
        self.few.as_ref().map(|few| few.iter().copied().collect())
    }

    /// Returns the colors that occur.
    pub(crate) fn colors(&self) -> Vec<CountedColor> {
        let used = self.bins.iter().filter(|bin| bin.count > 0);
        used.map(|bin| CountedColor {
            color: bin.sum.map(|sum| (sum as f64 / bin.count as f64) as f32),
            count: bin.count as f32,
        })
        .collect()
    }
}
