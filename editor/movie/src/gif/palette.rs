//! One palette for a whole movie: the colors are split at their means (median cut) and moved to the centers of what is near them (k-means), in
//! OKLab, where distances are as people see them.

use super::histogram::{ColorHistogram, CountedColor, MOST_COLORS};
use crate::srgb::SrgbTable;

/// Rounds in which the colors of the palette are moved.
const ROUNDS: usize = 6;

/// A color of the movie in both spaces, with its weight.
#[derive(Clone, Copy, Debug)]
struct WeightedColor {
    lab: [f32; 3],
    rgb: [f32; 3],
    weight: f32,
}

/// Returns at most [`MOST_COLORS`] colors for a movie, at least one; the same for the same histogram on every processor.
pub(crate) fn palette(histogram: &ColorHistogram, table: &SrgbTable) -> Vec<[u8; 3]> {
    if let Some(few) = histogram.few_colors() {
        return if few.is_empty() { vec![[0; 3]] } else { few };
    }
    let mut colors: Vec<WeightedColor> =
        histogram.colors().iter().map(|color| weighted(color, table)).collect();
    let mut groups = split(&mut colors);
    for _ in 0..ROUNDS {
        let centers: Vec<[f32; 3]> = groups.iter().map(|group| group.lab).collect();
        let mut sums = vec![ColorSum::default(); centers.len()];
        for color in &colors {
            sums[nearest(&centers, color.lab)].add(color);
        }
        groups = sums.iter().filter_map(ColorSum::mean).collect();
    }
    let mut palette: Vec<[u8; 3]> =
        groups.iter().map(|group| group.rgb.map(|channel| (channel + 0.5) as u8)).collect();
    palette.sort_unstable();
    palette.dedup();
    palette
}

fn weighted(color: &CountedColor, table: &SrgbTable) -> WeightedColor {
    // Small things that matter have few pixels, and the background has most.
    let rgb = color.color;
    WeightedColor { lab: oklab(rgb.map(|channel| decoded(channel, table))), rgb, weight: color.count.sqrt() }
}

/// Returns the linear light of an encoded value between two bytes.
fn decoded(value: f32, table: &SrgbTable) -> f32 {
    let below = value as u8;
    let (from, to) = (table.decode(below), table.decode(below.saturating_add(1)));
    from + (to - from) * (value - f32::from(below))
}

/// Returns a color of linear light in OKLab.
fn oklab([red, green, blue]: [f32; 3]) -> [f32; 3] {
    let cone = |by: [f32; 3]| libm::cbrtf(by[0] * red + by[1] * green + by[2] * blue);
    let long = cone([0.412_221_46, 0.536_332_55, 0.051_445_995]);
    let medium = cone([0.211_903_5, 0.680_699_5, 0.107_396_96]);
    let short = cone([0.088_302_46, 0.281_718_85, 0.629_978_7]);
    [
        0.210_454_26 * long + 0.793_617_8 * medium - 0.004_072_047 * short,
        1.977_998_5 * long - 2.428_592_2 * medium + 0.450_593_7 * short,
        0.025_904_037 * long + 0.782_771_77 * medium - 0.808_675_77 * short,
    ]
}

/// Sums over a group of colors.
#[derive(Clone, Copy, Debug, Default)]
struct ColorSum {
    lab: [f64; 3],
    squares: [f64; 3],
    rgb: [f64; 3],
    weight: f64,
}

impl ColorSum {
    fn of(colors: &[WeightedColor]) -> Self {
        let mut sum = Self::default();
        colors.iter().for_each(|color| sum.add(color));
        sum
    }

    fn add(&mut self, color: &WeightedColor) {
        let weight = f64::from(color.weight);
        for axis in 0..3 {
            let lab = f64::from(color.lab[axis]);
            self.lab[axis] += weight * lab;
            self.squares[axis] += weight * lab * lab;
            self.rgb[axis] += weight * f64::from(color.rgb[axis]);
        }
        self.weight += weight;
    }

    fn mean(&self) -> Option<WeightedColor> {
        let mean = |sum: [f64; 3]| sum.map(|sum| (sum / self.weight) as f32);
        (self.weight > 0.0).then(|| WeightedColor {
            lab: mean(self.lab),
            rgb: mean(self.rgb),
            weight: self.weight as f32,
        })
    }

    /// Returns the axis on which the colors differ most, and how much.
    fn widest(&self) -> (usize, f64) {
        let spread = |axis: usize| self.squares[axis] - self.lab[axis] * self.lab[axis] / self.weight;
        (0..3)
            .map(|axis| (axis, spread(axis)))
            .fold((0, 0.0), |most, now| if now.1 > most.1 { now } else { most })
    }
}

/// Splits the colors into at most [`MOST_COLORS`] groups: always the group that differs most. Returns the means.
fn split(colors: &mut [WeightedColor]) -> Vec<WeightedColor> {
    let mut groups = vec![(0..colors.len(), ColorSum::of(colors))];
    while groups.len() < MOST_COLORS {
        let spreads = groups.iter().map(|(_, sum)| sum.widest()).enumerate();
        let widest = spreads.fold((0, (0, 0.0)), |most, now| if now.1.1 > most.1.1 { now } else { most });
        let (number, (axis, spread)) = widest;
        if spread <= 0.0 {
            break;
        }
        let (range, sum) = groups[number].clone();
        let middle = (sum.lab[axis] / sum.weight) as f32;
        let group = &mut colors[range.clone()];
        group.sort_by(|one, other| one.lab[axis].total_cmp(&other.lab[axis]));
        let below = group.partition_point(|color| color.lab[axis] < middle).clamp(1, group.len().max(2) - 1);
        if below >= group.len() {
            // A single color, whose spread is the rounding of its square.
            groups[number].1.squares = [0.0; 3];
            continue;
        }
        let (low, high) = group.split_at(below);
        let sums = [ColorSum::of(low), ColorSum::of(high)];
        groups[number] = (range.start..range.start + below, sums[0]);
        groups.push((range.start + below..range.end, sums[1]));
    }
    groups.iter().filter_map(|(_, sum)| sum.mean()).collect()
}

fn nearest(centers: &[[f32; 3]], lab: [f32; 3]) -> usize {
    let mut best = (0, f32::INFINITY);
    for (number, center) in centers.iter().enumerate() {
        let distance: f32 = center.iter().zip(lab).map(|(center, lab)| (center - lab) * (center - lab)).sum();
        if distance < best.1 {
            best = (number, distance);
        }
    }
    best.0
}
