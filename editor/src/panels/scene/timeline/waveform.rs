//! The waveform of a sound on its bar.

use super::sheet::SceneSheet;
use crate::panels::scene::SceneSound;
use dragonfly_anim::stage::lanes::SceneBar;
use dragonfly_anim::stage::script::StageRepeat;
use dragonfly_document::SoundPeaks;
use egui::{Color32, Mesh, Painter, Rect, Shape, pos2};

/// Largest number of columns of a bar.
const MOST: usize = 8_000;

/// Returns what is known of the sound of a bar; `None` for other bars, and before it is asked for.
pub(super) fn sound_of<'a>(sheet: &SceneSheet<'a>, bar: &SceneBar) -> Option<&'a SceneSound> {
    let sounds = sheet.scene.plan.as_ref()?.sounds();
    let cue = sounds.iter().find(|sound| sound.action() == bar.action)?;
    sheet.context.scene_editing.sounds().get(&cue.source)
}

/// Draws the waveform of the part of a bar that is in sight, from the least to the greatest sample in every column of pixels.
pub(super) fn show(painter: &Painter, sheet: &SceneSheet<'_>, bar: &SceneBar, rect: Rect, color: Color32) {
    let Some(SceneSound::Read(peaks)) = sound_of(sheet, bar) else { return };
    let seen = rect.intersect(sheet.canvas);
    let step = 1.0 / painter.ctx().pixels_per_point().max(0.1);
    let columns = ((seen.width() / step).max(0.0) as usize).min(MOST);
    let (middle, half) = (rect.center().y, rect.height() / 2.0 - 2.0);
    let mut mesh = Mesh::default();
    for column in 0..columns {
        let x = seen.left() + column as f32 * step;
        let [from, to] = [x, x + step].map(|x| f64::from(sheet.scale.time_at(x)) - bar.begin.seconds());
        let Some([low, high]) = peak(peaks, bar.repeat, from, to) else { continue };
        let thin = (0.5 - half * (high - low) / 2.0).max(0.0);
        let (top, bottom) = (middle - half * high - thin, middle - half * low + thin);
        mesh.add_colored_rect(Rect::from_min_max(pos2(x, top), pos2(x + step, bottom)), color);
    }
    painter.add(Shape::mesh(mesh));
}

/// Returns the least and the greatest sample between two times after the start of a sound that repeats; `None` after its end.
fn peak(peaks: &SoundPeaks, repeat: StageRepeat, from: f64, to: f64) -> Option<[f32; 2]> {
    let length = peaks.seconds();
    let times = match repeat {
        StageRepeat::Fill => f64::INFINITY,
        StageRepeat::Times(times) => times.to_f64(),
    };
    if !(length > 0.0 && from >= 0.0 && from < length * times) {
        return None;
    }
    let start = from - (from / length).floor() * length;
    peaks.between(start, start + (to - from).max(0.0))
}
