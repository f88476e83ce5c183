//! FABRIK: forward and backward reaching, on points.
//!
//! With `p` the joints, `l` the lengths between them, one sweep is
//!
//! ```text
//! backward:  p_n = target;  p_i     = p_(i+1) + l_i (p_i - p_(i+1)) / |p_i - p_(i+1)|,   i = n-1 … 0
//! forward:   p_0 = base;    p_(i+1) = p_i     + l_i (p_(i+1) - p_i) / |p_(i+1) - p_i|,   i = 0 … n-1
//! ```
//!
//! (A. Aristidou, J. Lasenby: "FABRIK: A fast, iterative solver for the Inverse Kinematics problem", Graphical Models
//! 73, 2011.)

use super::turn::arc_between;
use glam::DVec3;

/// Joints and the lengths between them; `lengths[i]` is between joints i and i+1.
pub(super) struct Points<'a> {
    pub(super) joints: &'a mut [DVec3],
    pub(super) lengths: &'a [f64],
}

impl Points<'_> {
    /// Returns the total length.
    fn total(&self) -> f64 {
        self.lengths.iter().sum()
    }

    /// Returns the distance from the last joint to `target`.
    fn error(&self, target: DVec3) -> f64 {
        self.joints.last().map_or(0.0, |last| last.distance(target))
    }

    /// Moves the joints so that the last one reaches `target`, or comes as near as the lengths allow, in at most
    /// `sweeps` sweeps; the first one stays. Returns the number of sweeps.
    pub(super) fn reach(&mut self, target: DVec3, sweeps: u32, tolerance: f64) -> u32 {
        let Some(&base) = self.joints.first() else { return 0 };
        let total = self.total();
        let distance = target.distance(base);
        if distance >= total {
            self.straighten((target - base).normalize_or_zero());
            return 1;
        }
        let target = self.nearest_to(target);
        self.unalign(target);
        let mut made = 0;
        while made < sweeps && self.error(target) > tolerance {
            self.sweep(base, target);
            made += 1;
        }
        made
    }

    /// Returns the point nearest to `target` that the last joint can reach.
    fn nearest_to(&self, target: DVec3) -> DVec3 {
        let (base, total) = (self.joints[0], self.total());
        let longest = self.lengths.iter().copied().fold(0.0, f64::max);
        // One link longer than all others together keeps the end away from the base.
        let least = (2.0 * longest - total).max(0.0);
        let distance = target.distance(base);
        let clamped = distance.max(least).min(total);
        if clamped == distance { target } else { base + self.direction(target) * clamped }
    }

    /// Returns the direction from the base to `target`; where they coincide, to the last joint.
    fn direction(&self, target: DVec3) -> DVec3 {
        let (base, last) = (self.joints[0], self.joints[self.joints.len() - 1]);
        let direction = (target - base).try_normalize().or_else(|| (last - base).try_normalize());
        direction.unwrap_or(DVec3::X)
    }

    /// Puts all joints on one line along unit vector `direction`; does nothing where it is not finite.
    fn straighten(&mut self, direction: DVec3) {
        if direction != DVec3::ZERO {
            for (index, &length) in self.lengths.iter().enumerate() {
                self.joints[index + 1] = self.joints[index] + direction * length;
            }
        }
    }

    /// Bends joints that are on the line to the target: a sweep would leave them there.
    fn unalign(&mut self, target: DVec3) {
        let (base, along, total) = (self.joints[0], self.direction(target), self.total());
        let (mut bow, mut largest) = (DVec3::ZERO, 0.0);
        for joint in self.joints.iter() {
            let side = (*joint - base).reject_from_normalized(along);
            if side.length() > largest {
                (bow, largest) = (side, side.length());
            }
        }
        if largest > 1e-3 * total {
            return;
        }
        let bow = if largest > 1e-9 * total { bow / largest } else { along.any_orthonormal_vector() };
        let mut distance = 0.0;
        for (joint, length) in self.joints.iter_mut().skip(1).zip(self.lengths) {
            distance += length;
            *joint += bow * (0.3 * total * libm::sin(std::f64::consts::PI * distance / total));
        }
    }

    /// Makes one backward and one forward pass.
    fn sweep(&mut self, base: DVec3, target: DVec3) {
        let last = self.joints.len() - 1;
        self.joints[last] = target;
        for index in (0..last).rev() {
            let next = self.joints[index + 1];
            let direction = (self.joints[index] - next).try_normalize().unwrap_or(DVec3::X);
            self.joints[index] = next + direction * self.lengths[index];
        }
        self.joints[0] = base;
        for index in 0..last {
            let direction = (self.joints[index + 1] - self.joints[index]).try_normalize().unwrap_or(DVec3::X);
            self.joints[index + 1] = self.joints[index] + direction * self.lengths[index];
        }
    }

    /// Closes the remaining gap when sweeps converge slowly, which they do near full reach and near the nearest point.
    ///
    /// Near full reach every link's direction u is turned towards the direction d to the target, `u' = normalize((1 -
    /// λ) u + λ d)`; λ = 1 is straight, so some λ between 0 and 1 has the right distance. It is found by bisection.
    /// Near the nearest point the joints are placed on the circle in which the links and the line to the target are
    /// chords: such a circle exists for every distance that can be reached.
    pub(super) fn finish(&mut self, target: DVec3) {
        let target = self.nearest_to(target);
        let (base, last) = (self.joints[0], self.joints.len() - 1);
        let wanted = target.distance(base);
        if self.joints[last].distance(base) <= wanted {
            self.unfold(wanted, self.direction(target));
        } else {
            self.place_on_circle(wanted, self.direction(target));
        }
        let turn = arc_between(self.joints[last] - base, target - base);
        for joint in self.joints.iter_mut().skip(1) {
            *joint = base + turn * (*joint - base);
        }
    }

    fn unfold(&mut self, wanted: f64, towards: DVec3) {
        let link = |joints: &[DVec3], index: usize, mix: f64| {
            let own = (joints[index + 1] - joints[index]).normalize_or_zero();
            (own * (1.0 - mix) + towards * mix).try_normalize().unwrap_or(towards)
        };
        let reach = |joints: &[DVec3], mix: f64| {
            let links = self.lengths.iter().enumerate();
            links.map(|(index, &length)| link(joints, index, mix) * length).sum::<DVec3>().length()
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if reach(self.joints, middle) < wanted { low = middle } else { high = middle }
        }
        let mut old = self.joints[0];
        for (index, &length) in self.lengths.iter().enumerate() {
            // The joint is overwritten, but the next link's direction needs its old position.
            let own = (self.joints[index + 1] - old).normalize_or_zero();
            old = self.joints[index + 1];
            let direction = (own * (1.0 - high) + towards * high).try_normalize().unwrap_or(towards);
            self.joints[index + 1] = self.joints[index] + direction * length;
        }
    }

    fn place_on_circle(&mut self, wanted: f64, towards: DVec3) {
        let base = self.joints[0];
        let side = self.joints.iter().map(|joint| (*joint - base).reject_from_normalized(towards));
        let side = side.fold(DVec3::ZERO, |a, b| if b.length() > a.length() { b } else { a });
        let side = side.try_normalize().unwrap_or_else(|| towards.any_orthonormal_vector());
        let longest = self.lengths.iter().copied().fold(wanted, f64::max);
        let half = |chord: f64, radius: f64| libm::asin((0.5 * chord / radius).clamp(0.0, 1.0));
        let rest = |radius: f64| {
            let all: f64 = self.lengths.iter().map(|&length| half(length, radius)).sum();
            all + half(wanted, radius) - half(longest, radius)
        };
        let smallest = 0.5 * longest;
        if smallest <= 0.0 {
            return;
        }
        let pi = std::f64::consts::PI;
        // Whether the center is inside the polygon of chords.
        let inside = rest(smallest) >= 0.5 * pi;
        let open = |radius: f64| {
            let own = half(longest, radius);
            if inside { rest(radius) - (pi - own) } else { own - rest(radius) }
        };
        let (mut low, mut high) = (smallest, 1e7 * smallest);
        for _ in 0..100 {
            let middle = (low * high).sqrt();
            if open(middle) > 0.0 { low = middle } else { high = middle }
        }
        let radius = low;
        let mut angle = 0.0;
        let mut outlier = !inside && longest > wanted;
        for (index, &length) in self.lengths.iter().enumerate() {
            let step = 2.0 * half(length, radius);
            // The one long link closes the circle from the other side.
            let back = outlier && length == longest;
            angle += if back { -step } else { step };
            outlier &= !back;
            self.joints[index + 1] =
                base + towards * (radius * libm::sin(angle)) + side * (radius * (1.0 - libm::cos(angle)));
        }
    }
}
