//! Asks the graphics thread for the pictures of the shots of a scene, one after the other, while nothing is dragged, typed or played.

use crate::panels::State;
use crate::panels::keys::TimeWindow;
use crate::panels::scene::ShotKey;
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_picture::{Thumbnail, ThumbnailOrder, between};
use egui::ColorImage;
use std::sync::Arc;

/// Height of a picture in pixels: that of a bar on a screen of twice the usual density.
const HEIGHT: u32 = 80;
/// Largest width of a picture in relation to its height.
const WIDEST: f32 = 2.5;

/// Asks for the pictures of the shots that are in sight.
#[derive(Debug, Default)]
pub struct ThumbnailLoader {
    /// The shot whose picture was asked for and has not arrived.
    asked: Option<ShotKey>,
    /// The plan whose shots were looked at last.
    plan: Option<Arc<StagePlan>>,
    /// The part of time all of whose shots of that plan have their pictures.
    complete: Option<TimeWindow>,
}

impl ThumbnailLoader {
    /// Returns the order for the next picture, unless one is being drawn or the user is busy.
    pub fn update(&mut self, state: &mut State) -> Option<ThumbnailOrder> {
        let read = state.read();
        let is_busy = self.asked.is_some() || read.dragging.open().is_some() || read.playback.moves(read.now);
        let scene = read.scene().filter(|scene| !is_busy && scene.errors.is_empty())?;
        let (script, plan) = scene.script.clone().zip(scene.plan.clone())?;
        let lanes = Arc::clone(read.scene_editing.lanes());
        let window = read.scene_editing.window();
        if !self.plan.as_ref().is_some_and(|known| Arc::ptr_eq(known, &plan)) {
            state.thumbnails().keep_shots(&script, &lanes);
            (self.plan, self.complete) = (Some(Arc::clone(&plan)), None);
        }
        if self.complete == Some(window) {
            return None;
        }
        let Some(shot) = state.thumbnails().wanted((&script, &plan), &lanes, window) else {
            self.complete = Some(window);
            return None;
        };
        let [width, height] = script.size().map(|side| side.max(1) as f32);
        let width = (HEIGHT as f32 * between(width / height, 1.0 / WIDEST, WIDEST)).round() as u32;
        let (camera, time) = (Arc::clone(&shot.camera), shot.begin.seconds());
        self.asked = Some(shot);
        Some(ThumbnailOrder { camera, time, size: [width, HEIGHT] })
    }

    /// Receives a picture. Returns whether it is of a shot that was asked for.
    pub fn receive(&mut self, state: &mut State, thumbnail: Thumbnail) -> bool {
        let Thumbnail { order, plan, picture } = thumbnail;
        let is_asked = |shot: &mut ShotKey| {
            shot.camera == order.camera && shot.begin == StageTime::from_seconds(order.time)
        };
        let Some(shot) = self.asked.take_if(is_asked) else { return false };
        let image = picture.map(|picture| {
            let size = [picture.width() as usize, picture.height() as usize];
            Arc::new(ColorImage::from_rgba_unmultiplied(size, picture.as_raw()))
        });
        // The graphics thread may have had no scene yet: then it is asked again with the next frame.
        if let Some(plan) = plan {
            state.thumbnails().receive(shot, plan, image);
        }
        true
    }
}
