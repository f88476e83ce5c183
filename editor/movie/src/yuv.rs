//! Pictures in Y′CbCr of BT.709, limited range, with a quarter of the color samples, as movies have them.
//!
//! Integers only, so that the same frame gives the same bytes on every processor. A color sample is between two rows and on the left one of
//! two columns, where decoders of H.264 expect it.

/// Fixed point: 1 in the coefficients below.
const ONE: i32 = 1 << 16;

/// Shares of red, green and blue in the luma.
const LUMA: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Coefficients of Y′, Cb and Cr for red, green and blue, with the largest values 219 and 224 of limited range.
const MATRIX: [[i32; 3]; 3] = {
    let (blue, red) = (224.0 / (2.0 * (1.0 - LUMA[2])), 224.0 / (2.0 * (1.0 - LUMA[0])));
    [
        [fixed(LUMA[0] * 219.0), fixed(LUMA[1] * 219.0), fixed(LUMA[2] * 219.0)],
        [fixed(-LUMA[0] * blue), fixed(-LUMA[1] * blue), fixed((1.0 - LUMA[2]) * blue)],
        [fixed((1.0 - LUMA[0]) * red), fixed(-LUMA[1] * red), fixed(-LUMA[2] * red)],
    ]
};

const fn fixed(value: f64) -> i32 {
    let scaled = value / 255.0 * ONE as f64;
    (if scaled < 0.0 { scaled - 0.5 } else { scaled + 0.5 }) as i32
}

/// A picture of three planes.
#[derive(Clone, Debug)]
pub(crate) struct YuvPicture {
    size: [usize; 2],
    planes: [Vec<u8>; 3],
    /// Sums of two rows, with a column more than the picture.
    sums: Vec<[i32; 3]>,
}

impl YuvPicture {
    /// Creates a black picture of `width × height` pixels.
    pub(crate) fn new(size: [u32; 2]) -> Self {
        let size = size.map(|side| side as usize);
        let color = size[0].div_ceil(2) * size[1].div_ceil(2);
        let planes = [vec![16; size[0] * size[1]], vec![128; color], vec![128; color]];
        Self { size, planes, sums: vec![[0; 3]; size[0] + 1] }
    }

    /// Returns Y′, Cb and Cr.
    pub(crate) fn planes(&self) -> &[Vec<u8>; 3] {
        &self.planes
    }

    /// Sets the picture to pixels of red, green and blue; a picture that is larger than `from` repeats its last column and row.
    pub(crate) fn set(&mut self, rgb: &[u8], from: [u32; 2]) {
        let [width, height] = self.size;
        let [from_width, from_height] = from.map(|side| side as usize);
        let [luma, color @ ..] = &mut self.planes;
        let pixels = rgb.as_chunks::<3>().0;
        let row = |y: usize| &pixels[y.min(from_height - 1) * from_width..][..from_width];
        for (y, out) in luma.chunks_exact_mut(width).enumerate() {
            let row = row(y);
            for (out, pixel) in out.iter_mut().zip(row) {
                *out = coded::<1, 16>(MATRIX[0], pixel.map(i32::from));
            }
            let last = out[from_width - 1];
            out[from_width..].fill(last);
        }
        let half = width.div_ceil(2);
        let [blue, red] = color;
        let sums = &mut self.sums;
        for y in 0..height.div_ceil(2) {
            let rows = [row(2 * y), row((2 * y + 1).min(height - 1))];
            for ((sum, upper), lower) in sums.iter_mut().zip(rows[0]).zip(rows[1]) {
                *sum = [0, 1, 2].map(|channel: usize| i32::from(upper[channel]) + i32::from(lower[channel]));
            }
            let last = sums[from_width - 1];
            sums[from_width..].fill(last);
            let mut before = sums[0];
            let pairs = sums[..2 * half].as_chunks::<2>().0;
            let outs = blue[y * half..].iter_mut().zip(&mut red[y * half..]);
            for ((blue, red), [here, after]) in outs.zip(pairs) {
                let sum =
                    [0, 1, 2].map(|channel: usize| before[channel] + 2 * here[channel] + after[channel]);
                *blue = coded::<8, 128>(MATRIX[1], sum);
                *red = coded::<8, 128>(MATRIX[2], sum);
                before = *after;
            }
        }
    }
}

/// Returns the sum of channels by their coefficients, divided by `BY` and rounded, from `ZERO` up.
fn coded<const BY: i32, const ZERO: i32>(by: [i32; 3], channels: [i32; 3]) -> u8 {
    let sum = by[0] * channels[0] + by[1] * channels[1] + by[2] * channels[2];
    // Shifted to be positive, so that the division rounds to the nearest on both sides of zero.
    ((sum + BY * (ZERO * ONE + ONE / 2)) / (BY * ONE)) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_become_the_levels_of_the_standard() {
        let coded = |pixel: [u8; 3]| {
            let mut picture = YuvPicture::new([2, 2]);
            picture.set(&pixel.repeat(4), [2, 2]);
            picture.planes().clone().map(|plane| plane[0])
        };
        assert_eq!(coded([0, 0, 0]), [16, 128, 128]);
        assert_eq!(coded([255, 255, 255]), [235, 128, 128]);
        // The bars of 100 % in ITU-R BT.709.
        assert_eq!(coded([255, 0, 0]), [63, 102, 240]);
        assert_eq!(coded([0, 255, 0]), [173, 42, 26]);
        assert_eq!(coded([0, 0, 255]), [32, 240, 118]);
    }

    #[test]
    fn an_odd_picture_repeats_its_last_column_and_row() {
        let mut picture = YuvPicture::new([4, 2]);
        let red = [255, 0, 0];
        picture.set(&[[0, 0, 0], [0, 0, 0], red].concat(), [3, 1]);
        assert_eq!(picture.planes()[0], [16, 16, 63, 63, 16, 16, 63, 63]);
        assert_eq!(picture.planes()[2], [128, 212]);
    }
}
