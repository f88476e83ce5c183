//! Falloff: how much of an offset the keys around the chosen ones get.

/// The curve by which an offset fades out, as in Blender's proportional editing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FalloffShape {
    /// In proportion to the distance.
    Linear,
    /// Flat at both ends: `3 x² - 2 x³`.
    #[default]
    Smooth,
    /// A quarter of a circle, flat at the chosen keys: `√(2 x - x²)`.
    Sphere,
    /// Flat where it ends: `x²`.
    Sharp,
}

impl FalloffShape {
    /// All shapes, in the order of menus.
    pub const ALL: [Self; 4] = [Self::Linear, Self::Smooth, Self::Sphere, Self::Sharp];

    /// Returns the part of an offset at a nearness `x`: 1 at the chosen keys, 0 where the falloff ends.
    pub fn weight(self, x: f32) -> f32 {
        let x = if x > 0.0 { x.min(1.0) } else { 0.0 };
        match self {
            Self::Linear => x,
            Self::Smooth => x * x * (3.0 - 2.0 * x),
            Self::Sphere => (x * (2.0 - x)).max(0.0).sqrt(),
            Self::Sharp => x * x,
        }
    }
}

/// The distance and the curve by which an offset fades out around the chosen keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Falloff {
    /// Distance at which nothing of it is left, seconds.
    pub seconds: f32,
    /// The curve of the weights.
    pub shape: FalloffShape,
}

impl Falloff {
    /// Returns the part of an offset at a distance in seconds.
    pub fn weight(&self, distance: f32) -> f32 {
        if self.seconds > 0.0 && distance < self.seconds {
            self.shape.weight(1.0 - distance / self.seconds)
        } else {
            0.0
        }
    }
}

/// The part of an offset that a key gets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeyWeight {
    /// Index of the key.
    pub key: u32,
    /// 0 to 1.
    pub weight: f32,
}

/// Returns the weights of the keys of a channel of which some are chosen: 1 for these, less for the keys near them. `times` and
/// `chosen`, indices of keys, ascend; keys without weight are left out.
pub fn weights_of_keys(times: &[f32], chosen: &[u32], falloff: Option<Falloff>) -> Vec<KeyWeight> {
    let whole = |&key: &u32| KeyWeight { key, weight: 1.0 };
    let Some(falloff) = falloff.filter(|_| !chosen.is_empty()) else {
        return chosen.iter().map(whole).collect();
    };
    let mut next = 0;
    let weight = |(key, &time): (usize, &f32)| {
        while chosen.get(next).is_some_and(|&chosen| (chosen as usize) < key) {
            next += 1;
        }
        let around = [next.checked_sub(1), Some(next)];
        let around = around.into_iter().flatten().filter_map(|at| chosen.get(at).copied());
        let distance = |chosen: u32| {
            if chosen as usize == key {
                0.0
            } else {
                times.get(chosen as usize).map_or(f32::INFINITY, |other| (other - time).abs())
            }
        };
        let nearest = around.map(distance).fold(f32::INFINITY, f32::min);
        let weight = if nearest == 0.0 { 1.0 } else { falloff.weight(nearest) };
        (weight > 0.0).then_some(KeyWeight { key: key as u32, weight })
    };
    times.iter().enumerate().filter_map(weight).collect()
}

/// Returns the weights of the keys of a channel for a range of time, ends included: 1 inside, less for the keys near it. Keys
/// without weight are left out.
pub fn weights_of_range(times: &[f32], [from, to]: [f32; 2], falloff: Option<Falloff>) -> Vec<KeyWeight> {
    let reach = falloff.map_or(0.0, |falloff| falloff.seconds.max(0.0));
    let first = times.partition_point(|&time| time < from - reach);
    let near = times.iter().enumerate().skip(first).take_while(|(_, time)| **time <= to + reach);
    let weight = |(key, &time): (usize, &f32)| {
        let distance = (from - time).max(time - to).max(0.0);
        let weight = match falloff {
            _ if distance == 0.0 => 1.0,
            Some(falloff) => falloff.weight(distance),
            None => 0.0,
        };
        (weight > 0.0).then_some(KeyWeight { key: key as u32, weight })
    };
    near.filter_map(weight).collect()
}
