//! The matrices `T · R · S` of bones: bone space → parent space.
//!
//! With the unit quaternion (x y z w), the scale (a b c) and the translation t:
//!
//! ```text
//!             ┌ a (1 - 2y² - 2z²)   b (2xy - 2zw)       c (2xz + 2yw)      tx ┐
//! to_parent = │ a (2xy + 2zw)       b (1 - 2x² - 2z²)   c (2yz - 2xw)      ty │
//!             └ a (2xz - 2yw)       b (2yz + 2xw)       c (1 - 2x² - 2y²)  tz ┘
//! ```

use super::simd::Many;

/// Returns the rows by columns, one bone or one character in each lane.
#[inline(always)]
pub(super) fn local_rows<M: Many>(
    [x, y, z, w]: [M; 4],
    [tx, ty, tz]: [M; 3],
    [a, b, c]: [M; 3],
) -> [[M; 4]; 3] {
    let (x2, y2, z2, one) = (x + x, y + y, z + z, M::all(1.0));
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (not_x, not_y) = (x.times_from(x2, one), y.times_from(y2, one));
    [
        [z.times_from(z2, not_y) * a, w.times_from(z2, xy) * b, w.times_plus(y2, xz) * c, tx],
        [w.times_plus(z2, xy) * a, z.times_from(z2, not_x) * b, w.times_from(x2, yz) * c, ty],
        [w.times_from(y2, xz) * a, w.times_plus(x2, yz) * b, y.times_from(y2, not_x) * c, tz],
    ]
}
