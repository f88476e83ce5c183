//! Text of a step of the history: what it did, by how much, to which bones of which take, at which frame.

use super::number_text::Digits;
use dragonfly_document::{HistoryView, PoseChange, StepAmount};
use glam::{Quat, Vec3};

/// Returns the label of a step with its amount, and the text about its target: `Rotate Z +20°` and `Head  ·  Walk  ·  frame 7`.
pub(super) fn step_text(history: &HistoryView, step: usize, frame_rate: u32) -> (String, String) {
    let mut label = history.steps.get(step).copied().unwrap_or_default().to_owned();
    let mut about = history.about.get(step).map_or(String::new(), ToString::to_string);
    let amount = history.amounts.get(step).copied().flatten().unwrap_or_default();
    if let Some(change) = amount.change {
        label.push(' ');
        label.push_str(&change_text(change));
    }
    if let Some(frame) = frame_text(amount, frame_rate) {
        about = if about.is_empty() { frame } else { format!("{about}  ·  {frame}") };
    }
    (label, about)
}

fn frame_text(amount: StepAmount, frame_rate: u32) -> Option<String> {
    let frame = f64::from(amount.time?) * f64::from(frame_rate);
    // Times are stored in single precision, so that a whole frame is nearly one.
    let whole = (frame - frame.round()).abs() < 0.02;
    Some(if whole { format!("frame {}", frame.round()) } else { format!("frame {frame:.1}") })
}

/// Returns the change as text, with its axis where it is along one.
fn change_text(change: PoseChange) -> String {
    match change {
        PoseChange::Translation(by) => match along(by) {
            Some((axis, by)) => format!("{axis} {} m", signed(by)),
            None => format!("{} m", number(by.length())),
        },
        PoseChange::Rotation(by) => {
            let by = turn(by);
            match along(by) {
                Some((axis, by)) => format!("{axis} {}°", signed(rounded(by))),
                None => format!("{}°", number(rounded(by.length()))),
            }
        }
        PoseChange::Scale(by) => {
            let same = (by - by.x).abs().max_element() <= 1e-3 * by.x.abs();
            match along(by - Vec3::ONE) {
                _ if same => format!("×{}", number(by.x)),
                Some((axis, by)) => format!("{axis} ×{}", number(1.0 + by)),
                None => format!("×{}, {}, {}", number(by.x), number(by.y), number(by.z)),
            }
        }
    }
}

/// Returns the axis times the angle in degrees, at most 180.
fn turn(by: Quat) -> Vec3 {
    let near = if by.w < 0.0 { -by } else { by };
    near.to_scaled_axis() * 180.0 / std::f32::consts::PI
}

/// Returns the axis that a vector is along, and its length there; `None` where it is between axes or zero.
fn along(by: Vec3) -> Option<(char, f32)> {
    let axes = [('X', by.x), ('Y', by.y), ('Z', by.z)];
    let (axis, most) = axes.into_iter().max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()))?;
    let sideways = (by.length_squared() - most * most).max(0.0).sqrt();
    (most != 0.0 && sideways <= 2e-3 * most.abs()).then_some((axis, most))
}

/// Returns degrees to a tenth.
fn rounded(degrees: f32) -> f32 {
    (degrees * 10.0).round() / 10.0
}

fn signed(by: f32) -> String {
    let text = number(by);
    if by > 0.0 { format!("+{text}") } else { text }
}

/// Returns at most three decimals, without zeros at the end.
fn number(value: f32) -> String {
    let text = Digits::Fixed(if value.abs() >= 10.0 { 1 } else { 3 }).text(value.into());
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_along_an_axis_names_it() {
        let turned = |degrees: f32| PoseChange::Rotation(Quat::from_rotation_z(degrees.to_radians()));
        assert_eq!(change_text(turned(20.0)), "Z +20°");
        assert_eq!(change_text(turned(-7.5)), "Z −7.5°");
        assert_eq!(change_text(turned(8.876)), "Z +8.9°");
        assert_eq!(change_text(turned(270.0)), "Z −90°");
        assert_eq!(change_text(PoseChange::Translation(Vec3::new(0.0, 0.25, 0.0))), "Y +0.25 m");
        assert_eq!(change_text(PoseChange::Scale(Vec3::new(1.0, 1.0, 2.0))), "Z ×2");
    }

    #[test]
    fn a_change_between_axes_tells_its_size() {
        let slanted = Quat::from_axis_angle(Vec3::ONE.normalize(), 0.5);
        assert_eq!(change_text(PoseChange::Rotation(slanted)), "28.6°");
        assert_eq!(change_text(PoseChange::Translation(Vec3::new(3.0, 4.0, 0.0))), "5 m");
        assert_eq!(change_text(PoseChange::Scale(Vec3::splat(1.2))), "×1.2");
        assert_eq!(change_text(PoseChange::Scale(Vec3::new(1.0, 2.0, 3.0))), "×1, 2, 3");
    }

    #[test]
    fn a_time_between_frames_has_a_decimal() {
        let at = |time| StepAmount { time, change: None };
        assert_eq!(frame_text(at(Some(7.0 / 24.0)), 24).as_deref(), Some("frame 7"));
        assert_eq!(frame_text(at(Some(7.5 / 24.0)), 24).as_deref(), Some("frame 7.5"));
        assert_eq!(frame_text(at(None), 24), None);
    }
}
