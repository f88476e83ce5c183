//! The things of a scene that a click or a region means.

use super::{REACH, on_screen};
use crate::cast::PickedThing;
use crate::control::LineAppearance;
use crate::pick::Region;
use crate::scene::Scene;
use dragonfly_anim::stage::StagePath;
use glam::Vec2;

/// Number of straight pieces of which a path consists for the pointer.
const PIECES: usize = 128;

impl Scene {
    /// Returns the things of the scene of a script at a pixel of the window, nearest first, at the time prepared last: those whose surface
    /// is there, with the bone that moves it most; then, where helpers are drawn, those whose place is near the pixel, and paths
    /// that are drawn near it. None where a model is shown.
    pub fn pick_things(&mut self, position: [f32; 2]) -> Vec<PickedThing> {
        let Some((ray, pixel)) = self.ray(position) else { return Vec::new() };
        let is_surface = self.look.surface;
        let Some(cast) = self.cast_mut() else { return Vec::new() };
        let mut found = if is_surface { cast.pick(&ray) } else { Vec::new() };
        if self.look.helpers {
            found.extend(self.helpers_near(pixel));
        }
        found
    }

    /// Returns the first of [`Self::pick_things`].
    pub fn pick_thing(&mut self, position: [f32; 2]) -> Option<PickedThing> {
        let (ray, pixel) = self.ray(position)?;
        let is_surface = self.look.surface;
        let first = self.cast_mut().filter(|_| is_surface).and_then(|cast| cast.pick_first(&ray));
        match first {
            None if self.look.helpers => self.helpers_near(pixel).into_iter().next(),
            first => first,
        }
    }

    /// Returns the things of the scene of a script in a region of the viewport, given in points from its top left, in the order of the
    /// cast: those whose middle is inside. Things of which nothing is drawn count where helpers are drawn. None where a model is shown.
    pub fn things_in(&self, region: &Region<'_>) -> Vec<PickedThing> {
        let points = self.size() / self.look.pixels_per_point;
        let things = self.places(points);
        let inside = things.filter(|(_, place)| region.holds(*place));
        inside.filter_map(|(thing, _)| Some(self.cast()?.picked(thing, None))).collect()
    }

    /// Returns the things without a surface whose place is near a pixel, nearest first.
    fn helpers_near(&self, pixel: Vec2) -> Vec<PickedThing> {
        let Some(cast) = self.cast() else { return Vec::new() };
        let reach = REACH * self.look.pixels_per_point;
        let helpers = self.places(self.size()).filter(|(thing, _)| !cast.is_drawn(*thing));
        let mut near: Vec<(f32, usize)> = helpers
            .map(|(thing, place)| (place.distance(pixel), thing))
            .filter(|near| near.0 <= reach)
            .collect();
        near.extend(self.paths_near(pixel));
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        near.into_iter().map(|(_, thing)| cast.picked(thing, None)).collect()
    }

    /// Returns the paths near a pixel, with their distances from it. None while lines are not drawn.
    fn paths_near(&self, pixel: Vec2) -> Vec<(f32, usize)> {
        let draws_lines = self.appearances.get::<LineAppearance>().is_some_and(|look| !look.lines.is_empty());
        let Some(cast) = self.cast().filter(|_| draws_lines) else { return Vec::new() };
        let clip_from_world = self.clip_from_world(&self.bounds().sphere);
        let reach = REACH * self.look.pixels_per_point;
        let distance = |path: &StagePath| {
            let points = (0..=PIECES).map(|piece| {
                let at = path.at(path.length() * piece as f64 / PIECES as f64).position.as_vec3();
                on_screen(&clip_from_world, at, self.size())
            });
            let points: Vec<Option<Vec2>> = points.collect();
            let pieces = points.windows(2).filter_map(|pair| Some([pair[0]?, pair[1]?]));
            pieces.map(|piece| to_piece(pixel, piece)).fold(f32::INFINITY, f32::min)
        };
        let things = cast.plan().things().iter().enumerate().filter(|(thing, _)| !cast.is_hidden(*thing));
        let paths = things.filter_map(|(thing, planned)| Some((distance(planned.path.as_deref()?), thing)));
        paths.filter(|near| near.0 <= reach).collect()
    }

    /// Returns the middle of each thing that can be picked, in a viewport of this size; things that are not in front of the camera are left out.
    fn places(&self, size: Vec2) -> impl Iterator<Item = (usize, Vec2)> {
        let clip_from_world = self.clip_from_world(&self.bounds().sphere);
        let helpers = self.look.helpers;
        self.cast().into_iter().flat_map(move |cast| {
            let can_be_picked =
                move |thing: &usize| cast.is_drawn(*thing) || (helpers && cast.has_place(*thing));
            let things = (0..cast.plan().things().len()).filter(can_be_picked);
            things.filter_map(move |thing| {
                Some((thing, on_screen(&clip_from_world, cast.middle_of(thing), size)?))
            })
        })
    }
}

/// Returns the distance of a position from a straight piece.
fn to_piece(at: Vec2, [from, to]: [Vec2; 2]) -> f32 {
    let along = to - from;
    let square = along.length_squared();
    let share = if square > 0.0 { ((at - from).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
    at.distance(from + along * share)
}
