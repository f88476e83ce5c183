//! Smooth random numbers over time.

/// Returns noise at `time`, between -1 and 1: the same for the same `seed` on every system.
///
/// At whole numbers of `time` it is random, between them it goes smoothly from one to the next (value noise, with the curve
/// `6t⁵ - 15t⁴ + 10t³` of Perlin 2002). Multiply the seconds by the frequency in Hz.
#[doc(alias("jitter", "perlin", "random"))]
pub fn noise_at(seed: u64, time: f64) -> f64 {
    let before = time.floor();
    let part = time - before;
    let mix = part * part * part * (part * (part * 6.0 - 15.0) + 10.0);
    let [from, to] = [before as i64, (before as i64).wrapping_add(1)].map(|at| random(seed, at));
    from + (to - from) * mix
}

/// Returns a random number between -1 and 1 for a whole number (SplitMix64).
fn random(seed: u64, at: i64) -> f64 {
    let mut bits = seed.wrapping_add((at as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    for (shift, factor) in [(30, 0xBF58_476D_1CE4_E5B9_u64), (27, 0x94D0_49BB_1331_11EB)] {
        bits = (bits ^ (bits >> shift)).wrapping_mul(factor);
    }
    bits ^= bits >> 31;
    (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}
