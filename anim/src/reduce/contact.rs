//! Detection of contacts: bones that do not move for a while.

use super::{Contact, ContactSearch};
use glam::Mat4;

/// Seconds over which a speed is measured: over less, the rounding of positions would look like movement.
const BASE: f32 = 0.005;

/// Returns every contact that `search` finds: bone by bone, in order of time. `matrices` are to-root, `frame * bones +
/// bone`.
pub(super) fn find_contacts(
    times: &[f32],
    matrices: &[Mat4],
    bones: usize,
    millimeters_per_unit: f64,
    search: &ContactSearch,
) -> Vec<Contact> {
    let mut contacts = Vec::new();
    let mut look_at = |bone: usize| {
        let origin = |frame: usize| matrices[frame * bones + bone].w_axis.truncate().as_dvec3();
        // The current contact: its first frame, and the last frame up to which the speed is known to be low. Each frame
        // is paired with a later one far enough away to measure a speed between the two.
        let mut start: Option<(usize, usize)> = None;
        let mut later = 0;
        for frame in 0..times.len() {
            while later < times.len() && times[later] - times[frame] < BASE {
                later += 1;
            }
            if later == times.len() {
                break;
            }
            let seconds = f64::from(times[later]) - f64::from(times[frame]);
            let speed = origin(later).distance(origin(frame)) * millimeters_per_unit / seconds;
            if speed < f64::from(search.speed) {
                start = Some((start.map_or(frame, |(from, _)| from), later));
            } else if let Some(run) = start.take() {
                contacts.extend(contact(bone, times, run, search));
            }
        }
        contacts.extend(start.and_then(|run| contact(bone, times, run, search)));
    };
    match &search.bones {
        None => (0..bones).for_each(&mut look_at),
        Some(listed) => {
            listed.iter().map(|&bone| bone as usize).filter(|&bone| bone < bones).for_each(&mut look_at);
        }
    }
    contacts
}

fn contact(bone: usize, times: &[f32], run: (usize, usize), search: &ContactSearch) -> Option<Contact> {
    let (from, to) = (times[run.0], times[run.1]);
    (to - from >= search.least).then_some(Contact { bone: bone as u32, from, to })
}
