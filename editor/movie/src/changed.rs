//! The part of a frame that differs from the frame before.

/// A rectangle of pixels, never empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ChangedRect {
    /// Left edge.
    pub(crate) x: u32,
    /// Top edge.
    pub(crate) y: u32,
    /// Width.
    pub(crate) width: u32,
    /// Height.
    pub(crate) height: u32,
}

impl ChangedRect {
    /// Returns the whole of a frame.
    pub(crate) fn whole(size: [u32; 2]) -> Self {
        Self { x: 0, y: 0, width: size[0], height: size[1] }
    }

    /// Returns the smallest rectangle outside of which two frames are equal: one pixel where nothing differs. `even` moves its left and top edge
    /// to even numbers.
    pub(crate) fn between<P: PartialEq>(before: &[P], now: &[P], size: [u32; 2], even: bool) -> Self {
        let width = size[0] as usize;
        let rows = || before.chunks_exact(width).zip(now.chunks_exact(width));
        let Some(top) = rows().position(|(before, now)| before != now) else {
            return Self { x: 0, y: 0, width: 1, height: 1 };
        };
        let bottom = rows().rposition(|(before, now)| before != now).unwrap_or(top);
        let (mut left, mut right) = (width, 0);
        for (before, now) in rows().skip(top).take(bottom + 1 - top) {
            let differs = |at: &usize| before[*at] != now[*at];
            left = (0..left).find(differs).unwrap_or(left);
            right = (right..width).rev().find(differs).map_or(right, |last| right.max(last + 1));
        }
        let (left, top) = if even { (left & !1, top & !1) } else { (left, top) };
        let [x, y, width, height] = [left, top, right - left, bottom + 1 - top].map(|value| value as u32);
        Self { x, y, width, height }
    }

    /// Copies the pixels of the rectangle out of a frame, row by row.
    pub(crate) fn cut<P: Copy>(self, frame: &[P], size: [u32; 2], out: &mut Vec<P>) {
        out.clear();
        let (x, width) = (self.x as usize, self.width as usize);
        let rows = frame.chunks_exact(size[0] as usize).skip(self.y as usize).take(self.height as usize);
        out.extend(rows.flat_map(|row| &row[x..x + width]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rectangle_encloses_every_changed_pixel_and_no_more() {
        let before = [0_u8; 20];
        let changed = |pixels: &[usize], even| {
            let mut now = before;
            pixels.iter().for_each(|at| now[*at] = 1);
            let ChangedRect { x, y, width, height } = ChangedRect::between(&before, &now, [5, 4], even);
            [x, y, width, height]
        };
        assert_eq!(changed(&[], false), [0, 0, 1, 1]);
        assert_eq!(changed(&[7], false), [2, 1, 1, 1]);
        assert_eq!(changed(&[8, 11], false), [1, 1, 3, 2]);
        assert_eq!(changed(&[8, 11], true), [0, 0, 4, 3]);
        assert_eq!(changed(&[4, 15], false), [0, 0, 5, 4]);
        let mut cut = Vec::new();
        ChangedRect { x: 1, y: 2, width: 2, height: 2 }.cut(
            &std::array::from_fn::<usize, 20, _>(|at| at),
            [5, 4],
            &mut cut,
        );
        assert_eq!(cut, [11, 12, 16, 17]);
    }
}
