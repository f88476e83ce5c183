//! Drawing a frame as the mean of its sub-frames.

use super::settings::SampledFrame;
use super::sum::FrameSum;
use crate::gpu::SceneEncoding;
use crate::guard::caught;
use crate::message::Shading;
use crate::pass::FrameCommands;
use crate::readback;
use crate::stage::{DrawMode, FrameOpening, RenderStage};
use image::{Rgba32FImage, RgbaImage};
use std::time::Instant;

impl RenderStage {
    /// Draws the scene as the mean of the sub-frames of `frame`, each at its own time, and develops the image. Nothing is drawn when the device
    /// is lost on the way: the caller tries again, and gets the same image.
    pub fn accumulate(&mut self, frame: &SampledFrame, now: Instant) -> FrameOpening {
        if let Some(stopped) = self.check(now) {
            return stopped;
        }
        if self.mode != DrawMode::All || !self.encode_as(SceneEncoding::Linear) {
            return FrameOpening::Nothing;
        }
        let playback = self.scene.playback;
        let drawn = caught(|| self.draw_sub_frames(frame, now));
        self.scene.set_sub_frame(None);
        self.scene.playback = playback;
        match drawn {
            Ok(true) => FrameOpening::Frame,
            Ok(false) => FrameOpening::Nothing,
            Err(panic) => {
                self.device.assume_lost(&panic);
                FrameOpening::Nothing
            }
        }
    }

    /// Reads the image that was developed last, sRGB with straight alpha.
    pub fn read_accumulated(&mut self) -> Result<RgbaImage, String> {
        let Some(sum) = &self.sum else { return Err("there is no frame".to_owned()) };
        let picture = caught(|| readback::read(self.device.gpu(), sum.developed()));
        picture.unwrap_or_else(|panic| {
            self.device.assume_lost(&panic);
            Err(panic)
        })
    }

    /// Reads the light of the same frame before the tone map: linear, multiplied by alpha.
    pub fn read_accumulated_light(&mut self) -> Result<Rgba32FImage, String> {
        let Some(sum) = &self.sum else { return Err("there is no frame".to_owned()) };
        let picture = caught(|| {
            let gpu = self.device.gpu();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let texture = sum.write_linear(&mut encoder);
            gpu.queue.submit([encoder.finish()]);
            readback::read_light(gpu, texture)
        });
        picture.unwrap_or_else(|panic| {
            self.device.assume_lost(&panic);
            Err(panic)
        })
    }

    /// Draws and adds all sub-frames. Returns `false` if that is not possible now.
    fn draw_sub_frames(&mut self, frame: &SampledFrame, now: Instant) -> bool {
        let gpu = self.device.gpu();
        let samples_per_pixel = gpu.samples;
        let [_, _, width, height] = self.scene.look.viewport;
        let size = [width, height].map(|side| side.min(gpu.max_side));
        if size.contains(&0) {
            return false;
        }
        let known = self.sum.take().filter(|sum| sum.size() == size);
        let mut sum = known.unwrap_or_else(|| FrameSum::new(gpu, size));
        sum.clear();
        let (losses, playback) = (self.device.losses(), self.scene.playback);
        let mut before = None;
        for index in 0..frame.count() {
            if self.device.parameters().faults.loses_device_in_frame(index) {
                self.device.lose();
            }
            // The sums of a device that was lost are lost with it.
            if self.check(now).is_some() || self.device.losses() != losses {
                return false;
            }
            let sub_frame = frame.sub_frame(index, samples_per_pixel);
            self.scene.playback.anchor_time = frame.seconds(&sub_frame);
            self.scene.set_sub_frame(Some(sub_frame));
            self.scene.prepare(now);
            let mut commands = self.record(sum.target(), |pass, scene| !pass.is_backdrop(scene));
            sum.add(&mut commands.encoder);
            before = Some(self.submit_after(commands, before));
        }
        // The backdrop is the same for every sub-frame, and in colors of the display.
        self.scene.playback = playback;
        self.scene.set_sub_frame(None);
        self.scene.prepare(now);
        let mut commands = self.record(sum.target(), |pass, scene| pass.is_backdrop(scene));
        let has_tone_map = self.scene.look.shading != Shading::Unlit;
        sum.develop(self.device.gpu(), &mut commands.encoder, has_tone_map);
        self.submit_after(commands, before);
        self.sum = Some(sum);
        true
    }

    /// Submits a sub-frame, and waits for the one before: the data of at most two of them is in memory.
    fn submit_after(
        &self,
        commands: FrameCommands,
        before: Option<wgpu::SubmissionIndex>,
    ) -> wgpu::SubmissionIndex {
        let gpu = self.device.gpu();
        let FrameCommands { encoder, before: first } = commands;
        let submitted = gpu.queue.submit(first.into_iter().chain([encoder.finish()]));
        if before.is_some() {
            // The next check, or reading the image, finds a device that was lost.
            let _ = gpu.device.poll(wgpu::PollType::Wait { submission_index: before, timeout: None });
        }
        submitted
    }
}
