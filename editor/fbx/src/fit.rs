//! Keys that follow a motion: at the times of the keys of the file exactly, between them within a tolerance.
//!
//! Two kinds of keys are made, and the shorter list is taken: keys that are interpolated linearly (rotations: slerp), and
//! keys of a cubic spline. The cubic curves of most files are followed by splines without any further key. Where a span
//! between two keys is not followed, it is divided in the middle.

use glam::{DQuat, DVec3};

/// Shortest span that is divided, in seconds.
const SHORTEST: f64 = 1.0 / 4000.0;

/// Places within a span at which a line is checked.
const ON_LINES: [f64; 5] = [0.125, 0.375, 0.5, 0.625, 0.875];

/// Places within a span at which a spline is checked that passes through 0, 1/3, 2/3 and 1.
const ON_SPLINES: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];

/// A value that is fitted.
pub(crate) trait FitValue: Clone {
    /// Returns the value between two, as a sampler computes it.
    fn between(&self, next: &Self, part: f64) -> Self;
    /// Returns the weighted sum, component by component.
    fn sum(values: [&Self; 4], weights: [f64; 4]) -> Self;
    /// Makes a sum a value of this kind.
    fn settled(self) -> Self;
    /// Returns the value, or its equal that is nearer to `other` component by component.
    fn near(self, other: &Self) -> Self;
    /// Returns the difference of two values; for rotations an angle.
    fn distance(&self, other: &Self) -> f64;
}

impl FitValue for DVec3 {
    fn between(&self, next: &Self, part: f64) -> Self {
        self.lerp(*next, part)
    }

    fn sum([a, b, c, d]: [&Self; 4], weights: [f64; 4]) -> Self {
        *a * weights[0] + *b * weights[1] + *c * weights[2] + *d * weights[3]
    }

    fn settled(self) -> Self {
        self
    }

    fn near(self, _other: &Self) -> Self {
        self
    }

    fn distance(&self, other: &Self) -> f64 {
        (*self - *other).length()
    }
}

impl FitValue for DQuat {
    fn between(&self, next: &Self, part: f64) -> Self {
        self.slerp(*next, part)
    }

    fn sum([a, b, c, d]: [&Self; 4], weights: [f64; 4]) -> Self {
        *a * weights[0] + *b * weights[1] + *c * weights[2] + *d * weights[3]
    }

    fn settled(self) -> Self {
        if self.length_squared() > 1e-12 { self.normalize() } else { Self::IDENTITY }
    }

    fn near(self, other: &Self) -> Self {
        if self.dot(*other) < 0.0 { -self } else { self }
    }

    fn distance(&self, other: &Self) -> f64 {
        // The chord of half the angle; a half turn is the largest.
        2.0 * (self.near(other) - *other).length()
    }
}

/// Weights of several shapes.
impl FitValue for Vec<f64> {
    fn between(&self, next: &Self, part: f64) -> Self {
        self.iter().zip(next).map(|(a, b)| a + (b - a) * part).collect()
    }

    fn sum(values: [&Self; 4], weights: [f64; 4]) -> Self {
        let at = |index: usize| values.iter().zip(weights).map(|(value, weight)| value[index] * weight).sum();
        (0..values[0].len()).map(at).collect()
    }

    fn settled(self) -> Self {
        self
    }

    fn near(self, _other: &Self) -> Self {
        self
    }

    fn distance(&self, other: &Self) -> f64 {
        self.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}

/// A time of a key: when the motion is evaluated, and the time that the key gets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct KeyTime {
    pub(crate) at: f64,
    pub(crate) key: f32,
}

/// How the keys are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum FitKind {
    /// Every value holds until the next key: no key is added.
    Step,
    /// Lines or splines, whichever needs fewer keys.
    Smooth,
    /// Lines only.
    Lines,
    /// The given times only, with lines between them.
    Given,
}

/// The keys of one channel.
pub(crate) struct FittedKeys<V> {
    pub(crate) times: Vec<f32>,
    pub(crate) values: Vec<V>,
    /// In- and out-tangents of each key in units per second; empty unless the keys are those of a spline.
    pub(crate) tangents: Vec<[V; 2]>,
    /// Whether some span is not followed within the tolerance.
    pub(crate) is_coarse: bool,
}

/// A key, and the tangent at its time in the spans before and after it.
struct MadeKey<V> {
    time: KeyTime,
    value: V,
    tangents: [Option<V>; 2],
}

/// Samples a motion at a time; `None` when the work of the import is used up.
pub(crate) type SampleMotion<'a, V, E> = dyn FnMut(f64) -> Result<Option<V>, E> + 'a;

/// Returns keys for the motion `sample`, at each of `times` and where else the tolerance needs them.
pub(crate) fn fit<V: FitValue, E>(
    times: &[KeyTime],
    kind: FitKind,
    tolerance: f64,
    sample: &mut SampleMotion<'_, V, E>,
) -> Result<FittedKeys<V>, E> {
    let mut base: Vec<MadeKey<V>> = Vec::with_capacity(times.len());
    for &time in times {
        let Some(value) = sample(time.at)? else { break };
        let value = match base.last() {
            Some(last) => value.near(&last.value),
            None => value,
        };
        base.push(MadeKey { time, value, tangents: [None, None] });
    }
    let only_lines = match kind {
        FitKind::Step | FitKind::Given => return Ok(plain(base, false)),
        FitKind::Lines => true,
        FitKind::Smooth => false,
    };
    let (lines, coarse) = divided(&base, tolerance, sample, line)?;
    if only_lines || lines.len() == base.len() {
        return Ok(plain(lines, coarse));
    }
    let (splines, coarse_splines) = divided(&base, tolerance, sample, spline)?;
    // Without work left, spans have no tangents.
    if splines.len() >= lines.len() || (coarse_splines && sample(base[0].time.at)?.is_none()) {
        return Ok(plain(lines, coarse));
    }
    let tangents = splines.iter().map(|key| {
        let zero = V::sum([&key.value; 4], [0.0; 4]);
        key.tangents.clone().map(|tangent| tangent.unwrap_or_else(|| zero.clone()))
    });
    let tangents = tangents.collect();
    Ok(FittedKeys { tangents, ..plain(splines, coarse_splines) })
}

fn plain<V>(keys: Vec<MadeKey<V>>, is_coarse: bool) -> FittedKeys<V> {
    let times = keys.iter().map(|key| key.time.key).collect();
    let values = keys.into_iter().map(|key| key.value).collect();
    FittedKeys { times, values, tangents: Vec::new(), is_coarse }
}

/// A span between two keys: what a way of interpolating makes of it.
struct FitSpan<V> {
    follows: bool,
    /// Tangents at its ends, per second.
    tangents: Option<[V; 2]>,
}

/// Divides the spans between keys until `follow` accepts each. Returns the keys, and whether some span was given up.
fn divided<V: FitValue, E>(
    base: &[MadeKey<V>],
    tolerance: f64,
    sample: &mut SampleMotion<'_, V, E>,
    follow: FollowSpan<V, E>,
) -> Result<(Vec<MadeKey<V>>, bool), E> {
    let copy =
        |key: &MadeKey<V>| MadeKey { time: key.time, value: key.value.clone(), tangents: [None, None] };
    let mut keys: Vec<MadeKey<V>> = base.iter().take(1).map(copy).collect();
    let mut is_coarse = false;
    for end in base.iter().skip(1) {
        // The ends of spans that are not yet accepted, the nearest last.
        let mut ends = vec![copy(end)];
        while let Some(end) = ends.pop() {
            let Some(start) = keys.last_mut() else { break };
            let distance = end.time.at - start.time.at;
            let middle = 0.5 * (start.time.at + end.time.at);
            let middle = KeyTime { at: middle, key: middle as f32 };
            let divides = distance > SHORTEST && middle.key > start.time.key && middle.key < end.time.key;
            let end = MadeKey { value: end.value.near(&start.value), ..end };
            // Both sides of a jump: whatever is between them takes no time.
            if !divides && distance < SHORTEST * 0.1 {
                keys.push(end);
                continue;
            }
            let span = follow(start, &end, tolerance, sample)?;
            let value = if span.follows || !divides { None } else { sample(middle.at)? };
            match value {
                Some(value) => {
                    let value = value.near(&start.value);
                    ends.push(end);
                    ends.push(MadeKey { time: middle, value, tangents: [None, None] });
                }
                None => {
                    is_coarse |= !span.follows;
                    let mut end = end;
                    if let Some([leaves, arrives]) = span.tangents {
                        start.tangents[1] = Some(leaves);
                        end.tangents[0] = Some(arrives);
                    }
                    keys.push(end);
                }
            }
        }
    }
    Ok((keys, is_coarse))
}

/// Checks one way of interpolating between two keys.
type FollowSpan<V, E> =
    fn(&MadeKey<V>, &MadeKey<V>, f64, &mut SampleMotion<'_, V, E>) -> Result<FitSpan<V>, E>;

fn line<V: FitValue, E>(
    start: &MadeKey<V>,
    end: &MadeKey<V>,
    tolerance: f64,
    sample: &mut SampleMotion<'_, V, E>,
) -> Result<FitSpan<V>, E> {
    for part in ON_LINES {
        let at = start.time.at + (end.time.at - start.time.at) * part;
        let Some(value) = sample(at)? else { return Ok(FitSpan { follows: false, tangents: None }) };
        if value.distance(&start.value.between(&end.value, part)) > tolerance {
            return Ok(FitSpan { follows: false, tangents: None });
        }
    }
    Ok(FitSpan { follows: true, tangents: None })
}

fn spline<V: FitValue, E>(
    start: &MadeKey<V>,
    end: &MadeKey<V>,
    tolerance: f64,
    sample: &mut SampleMotion<'_, V, E>,
) -> Result<FitSpan<V>, E> {
    let distance = end.time.at - start.time.at;
    let mut at =
        |part: f64| Ok(sample(start.time.at + distance * part)?.map(|value| value.near(&start.value)));
    let (Some(first), Some(second)) = (at(1.0 / 3.0)?, at(2.0 / 3.0)?) else {
        return Ok(FitSpan { follows: false, tangents: None });
    };
    let points = [&start.value, &first, &second, &end.value];
    // Derivatives at both ends of the cubic through the four points.
    let leaves = V::sum(points, [-5.5, 9.0, -4.5, 1.0]);
    let arrives = V::sum(points, [-1.0, 4.5, -9.0, 5.5]);
    let mut follows = true;
    for part in ON_SPLINES {
        let (square, cube) = (part * part, part * part * part);
        let weights = [
            2.0 * cube - 3.0 * square + 1.0,
            cube - 2.0 * square + part,
            -2.0 * cube + 3.0 * square,
            cube - square,
        ];
        let curve = V::sum([&start.value, &leaves, &end.value, &arrives], weights).settled();
        follows &= at(part)?.is_some_and(|value| value.distance(&curve) <= tolerance);
    }
    let per_second = 1.0 / (f64::from(end.time.key) - f64::from(start.time.key)).max(1e-9);
    let scaled = |tangent: V| V::sum([&tangent; 4], [per_second, 0.0, 0.0, 0.0]);
    Ok(FitSpan { follows, tangents: Some([scaled(leaves), scaled(arrives)]) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys_of(times: &[f64], tolerance: f64, motion: impl Fn(f64) -> DVec3) -> FittedKeys<DVec3> {
        let times: Vec<KeyTime> = times.iter().map(|&at| KeyTime { at, key: at as f32 }).collect();
        let mut sample = |at: f64| Ok::<_, ()>(Some(motion(at)));
        fit(&times, FitKind::Smooth, tolerance, &mut sample).expect("a motion that cannot fail")
    }

    #[test]
    fn a_line_needs_no_further_key() {
        let fitted = keys_of(&[0.0, 1.0, 3.0], 1e-9, |at| DVec3::new(at, 2.0 * at, -at));
        assert_eq!((fitted.times.len(), fitted.tangents.len()), (3, 0));
    }

    #[test]
    fn a_cubic_curve_is_a_spline_with_the_same_keys_and_its_own_derivatives() {
        let fitted = keys_of(&[0.0, 2.0], 1e-9, |at| DVec3::X * at * at * at);
        assert_eq!(fitted.times, [0.0, 2.0]);
        assert!((fitted.tangents[1][0].x - 12.0).abs() < 1e-9, "{:?}", fitted.tangents);
        assert!(fitted.tangents[0][1].x.abs() < 1e-9);
    }

    #[test]
    fn a_bend_gets_keys_until_the_tolerance_is_met() {
        let fitted = keys_of(&[0.0, 1.0], 1e-3, |at| DVec3::X * (at - 0.3).abs());
        assert!(!fitted.is_coarse && fitted.times.len() > 2 && fitted.times.len() < 20, "{:?}", fitted.times);
    }

    #[test]
    fn work_that_is_used_up_ends_the_division() {
        let mut left = 20;
        let mut sample = |at: f64| {
            left -= 1;
            Ok::<_, ()>((left > 0).then(|| DVec3::X * (50.0 * at).sin()))
        };
        let times = [0.0_f64, 1.0].map(|at| KeyTime { at, key: at as f32 });
        let fitted = fit(&times, FitKind::Smooth, 1e-6, &mut sample).expect("a motion that cannot fail");
        assert!(fitted.is_coarse);
    }
}
