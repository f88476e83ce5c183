//! Levels of H.264: limits for decoders on the size and rate of a movie.

use dragonfly_anim::stage::time::StageRate;

/// Level, and its largest numbers of macroblocks in a second, in a picture, and in the pictures that are kept.
const LEVELS: [(u8, u64, u64, u64); 16] = [
    (11, 3_000, 396, 900),
    (12, 6_000, 396, 2_376),
    (13, 11_880, 396, 2_376),
    (21, 19_800, 792, 4_752),
    (22, 20_250, 1_620, 8_100),
    (30, 40_500, 1_620, 8_100),
    (31, 108_000, 3_600, 18_000),
    (32, 216_000, 5_120, 20_480),
    (40, 245_760, 8_192, 32_768),
    (42, 522_240, 8_704, 34_816),
    (50, 589_824, 22_080, 110_400),
    (51, 983_040, 36_864, 184_320),
    (52, 2_073_600, 36_864, 184_320),
    (60, 4_177_920, 139_264, 696_320),
    (61, 8_355_840, 139_264, 696_320),
    (62, 16_711_680, 139_264, 696_320),
];

/// Returns the lowest level that permits pictures of a size and rate, of which `kept` are referred to; `None` if none does.
pub(super) fn level([width, height]: [u32; 2], rate: StageRate, kept: u32) -> Option<u8> {
    let [columns, rows] = [width, height].map(|side| u64::from(side.div_ceil(16)));
    let blocks = columns * rows;
    let (frames, seconds) = rate.fraction();
    let fits = |level: &&(u8, u64, u64, u64)| {
        let (_, in_second, in_picture, in_kept) = **level;
        let longest_side = columns.max(rows);
        blocks * u64::from(frames) <= in_second * u64::from(seconds)
            && blocks <= in_picture
            && longest_side * longest_side <= 8 * in_picture
            && blocks * u64::from(kept) <= in_kept
    };
    LEVELS.iter().find(fits).map(|level| level.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_movies_have_the_levels_that_other_encoders_give_them() {
        let level = |size, text| level(size, StageRate::parse(text).unwrap(), 3);
        assert_eq!(level([1280, 720], "30"), Some(31));
        assert_eq!(level([1920, 1080], "24000/1001"), Some(40));
        assert_eq!(level([1920, 1080], "60"), Some(42));
        assert_eq!(level([3840, 2160], "30"), Some(51));
        assert_eq!(level([16_384, 64], "24"), Some(60));
        assert_eq!(level([8192, 4352], "24"), Some(60));
        assert_eq!(level([8192, 4368], "24"), None);
        assert_eq!(level([1920, 1080], "1000"), Some(61));
    }
}
