//! Queries about the scene that is open.

use super::PanelContext;
use dragonfly_anim::stage::time::{StageRate, StageTime};
use dragonfly_document::SceneView;
use dragonfly_picture::LineHandle;
use glam::Vec3;

impl<'a> PanelContext<'a> {
    /// Returns the scene that is open; `None` while a model is.
    pub fn scene(&self) -> Option<&'a SceneView> {
        self.view?.scene.as_deref()
    }

    /// Writes the points of the line that is being drawn, scene space.
    pub fn line_draft(&self, out: &mut Vec<Vec3>) {
        let mut points = Vec::new();
        self.tools.controls().line().add_draft(&mut points);
        out.clear();
        out.extend(points.iter().map(|point| point.as_vec3()));
    }

    /// Writes the points of paths and lines that can be dragged.
    pub fn line_handles(&self, out: &mut Vec<LineHandle>) {
        let points = self.tools.controls().points();
        out.clear();
        out.extend(points.points().iter().enumerate().map(|(index, point)| LineHandle {
            place: point.place.as_vec3(),
            arm: point.arm.map(|arm| arm.as_vec3()),
            is_marked: points.is_marked(index) || self.scene_editing.lines().is_point_selected(point),
        }));
    }

    /// Returns the exact time of the playhead in the scene.
    pub fn scene_time(&self) -> StageTime {
        self.scene_time_at(self.time())
    }

    /// Returns the least time of the playhead, seconds, at which a time of the scene has come. Rounded to the nearest number, the
    /// playhead could be before it.
    pub fn playhead_at(&self, time: StageTime) -> f32 {
        let nearest = time.seconds() as f32;
        // A playhead a little after a frame or a millisecond counts as being on it.
        let after = (time.seconds() + 2.0 * f64::from(f32::EPSILON) * time.seconds().max(1.0)) as f32;
        let has_come = |at: &f32| self.scene_time_at(*at) >= time;
        [nearest, nearest.next_up()].into_iter().find(has_come).unwrap_or(after)
    }

    fn scene_time_at(&self, playhead: f32) -> StageTime {
        let seconds = f64::from(playhead);
        match self.scene_rate() {
            Some(rate) => rate.time_of(seconds),
            None => StageTime::from_seconds(seconds),
        }
    }

    /// Returns the frame rate of the scene that is open; `None` while a model is, and before a script works.
    pub fn scene_rate(&self) -> Option<StageRate> {
        Some(self.scene()?.script.as_ref()?.rate())
    }

    /// Returns the frames per second of what is open.
    pub fn frames_per_second(&self) -> f64 {
        self.scene_rate().map_or(f64::from(self.frame_rate), StageRate::per_second)
    }

    /// Returns the id of the camera of the shot at the playhead; `None` where the cast has no camera.
    pub fn shot_camera(&self) -> Option<&'a str> {
        self.scene()?.plan.as_ref()?;
        self.stage.shown_camera()
    }

    /// Returns start and length of the scene, or of the part of it that its project shows, seconds; `None` while a model is open, and before a script works.
    pub fn scene_bounds(&self) -> Option<(f32, f32)> {
        let plan = self.scene()?.plan.as_ref()?;
        let length = plan.length();
        let [start, end] = self.scene()?.project.as_ref().map_or([None, None], |project| project.range());
        let [start, end] = [start.unwrap_or_default(), end.unwrap_or(length)];
        // A part that ends before it begins is none.
        let [start, end] = if start < end { [start, end] } else { [StageTime::ZERO, length] };
        Some((start.seconds() as f32, (end - start).seconds() as f32))
    }
}
