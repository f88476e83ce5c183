//! The waveform of a sound as triangles, rebuilt only when something that they depend on changed.

use super::keys::TimeScale;
use dragonfly_document::SoundPeaks;
use egui::{Color32, Mesh, Painter, Rect, Shape, pos2};
use std::sync::Arc;

/// Largest number of columns.
const MOST: usize = 20_000;

/// Everything that the triangles of a waveform depend on.
#[derive(Clone, Debug)]
pub(super) struct WaveformLook {
    pub(super) peaks: Arc<SoundPeaks>,
    /// Start of the sound, seconds on the scale.
    pub(super) start: f64,
    /// Number of repetitions of the sound from its start on; 1 for once.
    pub(super) times: f64,
    pub(super) scale: TimeScale,
    /// The columns, from the smallest sample of the sound to the largest.
    pub(super) rect: Rect,
    pub(super) pixels_per_point: f32,
    pub(super) color: Color32,
}

/// A waveform that is drawn in each frame.
#[derive(Debug, Default)]
pub(super) struct Waveform {
    look: Option<WaveformLook>,
    mesh: Arc<Mesh>,
}

impl Waveform {
    /// Draws the waveform.
    pub(super) fn show(&mut self, painter: &Painter, look: WaveformLook) {
        if !self.look.as_ref().is_some_and(|old| old.is_same(&look)) {
            self.mesh = Arc::new(look.mesh());
            self.look = Some(look);
        }
        painter.add(Shape::Mesh(Arc::clone(&self.mesh)));
    }
}

impl WaveformLook {
    /// Compares without reading the peaks.
    fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.peaks, &other.peaks)
            && (self.start, self.times, self.scale) == (other.start, other.times, other.scale)
            && (self.rect, self.pixels_per_point, self.color)
                == (other.rect, other.pixels_per_point, other.color)
    }

    /// Returns a bar from the least to the greatest sample in every column of pixels.
    fn mesh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let (middle, half) = (self.rect.center().y, self.rect.height() / 2.0);
        let step = 1.0 / self.pixels_per_point.max(0.1);
        let columns = (self.rect.width() / step).max(0.0) as usize;
        for column in 0..columns.min(MOST) {
            let x = self.rect.left() + column as f32 * step;
            let [from, to] = [x, x + step].map(|x| f64::from(self.scale.time_at(x)) - self.start);
            let Some([low, high]) = self.peak(from, to) else { continue };
            let thin = (0.5 - half * (high - low) / 2.0).max(0.0);
            let (top, bottom) = (middle - half * high - thin, middle - half * low + thin);
            mesh.add_colored_rect(Rect::from_min_max(pos2(x, top), pos2(x + step, bottom)), self.color);
        }
        mesh
    }

    /// Returns the least and the greatest sample between two times after the start; `None` outside of the sound.
    fn peak(&self, from: f64, to: f64) -> Option<[f32; 2]> {
        let length = self.peaks.seconds();
        if self.times == 1.0 {
            return self.peaks.between(from, to);
        }
        if !(length > 0.0 && from >= 0.0 && from < length * self.times) {
            return None;
        }
        let start = from - (from / length).floor() * length;
        self.peaks.between(start, start + (to - from).max(0.0))
    }
}
