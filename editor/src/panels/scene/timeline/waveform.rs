//! The waveforms of sounds on their bars.

use super::sheet::SceneSheet;
use crate::panels::scene::SceneSound;
use crate::panels::waveform::{Waveform, WaveformLook};
use dragonfly_anim::stage::lanes::SceneBar;
use dragonfly_anim::stage::script::StageRepeat;
use egui::{Color32, Painter, Rect, vec2};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Distance of the waveform from the edges of its bar, points.
const MARGIN: f32 = 2.0;

/// The waveforms that were drawn last, by the actions.
#[derive(Debug, Default)]
pub(super) struct SceneWaveforms {
    drawn: BTreeMap<usize, Waveform>,
    /// Those of the frame before.
    before: BTreeMap<usize, Waveform>,
}

/// Returns what is known of the sound of a bar; `None` for other bars, and before it is asked for.
pub(super) fn sound_of<'a>(sheet: &SceneSheet<'a>, bar: &SceneBar) -> Option<&'a SceneSound> {
    let script = sheet.scene.script.as_ref().filter(|_| bar.kind == "sound")?;
    script.actions().get(bar.action)?;
    sheet.context.scene_editing.sounds().get(script.element(bar.action).value("src")?)
}

impl SceneWaveforms {
    /// Begins a frame: waveforms that it does not draw are forgotten.
    pub(super) fn begin_frame(&mut self) {
        self.before = std::mem::take(&mut self.drawn);
    }

    /// Draws the waveform of the part of a bar that is in sight.
    pub(super) fn show(
        &mut self,
        painter: &Painter,
        sheet: &SceneSheet<'_>,
        bar: &SceneBar,
        rect: Rect,
        color: Color32,
    ) {
        let Some(SceneSound::Read(peaks)) = sound_of(sheet, bar) else { return };
        let seen = rect.intersect(sheet.canvas).x_range();
        let look = WaveformLook {
            peaks: Arc::clone(peaks),
            start: bar.begin.seconds(),
            times: match bar.repeat {
                StageRepeat::Fill => f64::INFINITY,
                StageRepeat::Times(times) => times.to_f64(),
            },
            scale: *sheet.scale,
            rect: Rect::from_x_y_ranges(seen, rect.y_range()).shrink2(vec2(0.0, MARGIN)),
            pixels_per_point: painter.ctx().pixels_per_point(),
            color,
        };
        let mut waveform = self.before.remove(&bar.action).unwrap_or_default();
        waveform.show(painter, look);
        self.drawn.insert(bar.action, waveform);
    }
}
