//! Views of the scene apart from the viewport: the second view, and small pictures of shots.

use super::gpu::SceneEncoding;
use super::guard::caught;
use super::pass::{FrameCommands, Pass, PassLayer, SharedPass};
use super::readback;
use super::scene::Scene;
use super::stage::{DrawMode, RenderStage};
use super::target::SceneTarget;
use super::thumbnail::{Thumbnail, ThumbnailOrder};
use std::sync::Arc;
use std::time::Instant;

impl RenderStage {
    /// Draws the second view, if there is one, before the frame: the passes prepare it and are then prepared for the viewport. Returns
    /// `false` when the device counts as lost.
    pub(super) fn draw_second(&mut self, now: Instant) -> bool {
        let Some([_, _, width, height]) = self.scene.look.second.as_ref().map(|second| second.viewport)
        else {
            self.second = None;
            return true;
        };
        let look = if width == 0 || height == 0 { None } else { self.scene.prepare_second(now) };
        let Some(look) = look else {
            self.second = None;
            return true;
        };
        let drawn = caught(|| {
            let gpu = self.device.gpu();
            let size = [width, height].map(|side| side.min(gpu.max_side));
            if self.second.as_ref().is_none_or(|target| target.size() != size) {
                self.second = Some(SceneTarget::new(gpu, size));
            }
            if let Some(target) = &self.second {
                self.draw_into(target);
            }
        });
        self.scene.look = look;
        self.keep(drawn.map(|()| None))
    }

    /// Draws a small picture, without handles and helpers. Returns `None` while images of its models are loaded: it is complete when the next
    /// frames have loaded them. The picture of the result is missing where no scene of a script is shown, or the device is lost.
    pub fn thumbnail(&mut self, order: &ThumbnailOrder, now: Instant) -> Option<Thumbnail> {
        let plan = self.scene.cast().map(|cast| Arc::clone(cast.plan()));
        let result = |picture| Some(Thumbnail { order: order.clone(), plan: plan.clone(), picture });
        let is_possible = self.mode == DrawMode::All && !self.device.awaits_surface();
        if !is_possible || plan.is_none() || order.size.contains(&0) {
            return result(None);
        }
        if !self.encode_as(SceneEncoding::Display) {
            return result(None);
        }
        let (look, playback) = self.scene.prepare_thumbnail(order, now);
        let drawn = caught(|| {
            let gpu = self.device.gpu();
            let target = SceneTarget::new(gpu, order.size.map(|side| side.min(gpu.max_side)));
            self.draw_into(&target);
            if self.is_loading() { Ok(None) } else { readback::read(gpu, target.texture()).map(Some) }
        });
        (self.scene.look, self.scene.playback) = (look, playback);
        self.scene.prepare(now);
        match drawn {
            Ok(Ok(None)) => {
                self.touch_scene();
                None
            }
            Ok(Ok(picture)) => result(picture),
            Ok(Err(reason)) => {
                tracing::warn!(reason, "no thumbnail");
                result(None)
            }
            Err(panic) => {
                self.device.assume_lost(&panic);
                result(None)
            }
        }
    }

    /// Draws the scene as it was prepared into a target of its own.
    fn draw_into(&self, target: &SceneTarget) {
        let FrameCommands { encoder, before } = self.record(target, |_, _| true);
        self.device.gpu().queue.submit(before.into_iter().chain([encoder.finish()]));
    }

    /// Records those passes of the scene that are `wanted`, as it was prepared, into a target of its own.
    pub(super) fn record(
        &self,
        target: &SceneTarget,
        wanted: impl Fn(&dyn Pass, &Scene) -> bool,
    ) -> FrameCommands {
        let gpu = self.device.gpu();
        gpu.write_frame(self.scene.uniform());
        let encoder = gpu.device.create_command_encoder(&Default::default());
        let mut commands = FrameCommands { encoder, before: Vec::new() };
        let around = self.surroundings(self.window_size);
        let is_recorded = |pass: &&SharedPass| {
            let pass = pass.borrow();
            pass.layer() == PassLayer::Scene && wanted(&*pass, &self.scene)
        };
        let recorded = || self.passes.list.iter().filter(is_recorded);
        recorded().for_each(|pass| pass.borrow_mut().prepare(&around, &mut commands));
        let mut open = target.begin(&mut commands.encoder);
        recorded().for_each(|pass| pass.borrow_mut().draw(&around, &mut open));
        drop(open);
        commands
    }
}
