//! Times of keys as a list of a text file has them: sorted where they do not ascend.

/// Returns the numbers of the keys to use, in ascending order of their times, of equal times the last one; `None` where the
/// times ascend and every key is used.
pub(super) fn ascending(times: &[f32]) -> Option<Vec<u32>> {
    if times.windows(2).all(|pair| pair[0] < pair[1]) {
        return None;
    }
    let mut order: Vec<u32> = (0..times.len() as u32).collect();
    order.sort_by(|&a, &b| times[a as usize].total_cmp(&times[b as usize]));
    // Of equal keys the last one comes last, since the sort is stable.
    order.dedup_by(|next, kept| {
        let is_same = times[*next as usize] == times[*kept as usize];
        if is_same {
            *kept = *next;
        }
        is_same
    });
    Some(order)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_equal_times_the_last_key_is_used() {
        assert_eq!(ascending(&[]), None);
        assert_eq!(ascending(&[0.0, 1.0]), None);
        assert_eq!(ascending(&[0.0, 0.0]), Some(vec![1]));
        assert_eq!(ascending(&[2.0, 1.0, 2.0, 0.5, 1.0]), Some(vec![3, 4, 2]));
    }
}
