//! The option `--shot`: the frames of a shot of a scene.

use super::super::Failure;
use super::super::choice::plain;
use crate::movie_render::MovieFrames;
use dragonfly_anim::stage::time::{StageRate, StageTime};
use dragonfly_document::LoadedScene;

/// Returns the frames of the shot called `wanted`: from its begin until the next shot, or the end of the scene.
///
/// # Errors
///
/// The scene has no such shot, or no frame shows it.
pub(super) fn shot_frames(
    scene: &LoadedScene,
    wanted: &str,
    rate: StageRate,
) -> Result<MovieFrames, Failure> {
    let refused = |reason: String| Failure::input(&scene.title, format_args!("--shot: {reason}"));
    let times = scene.plan.schedule().times();
    let is_shot = |action: &usize| scene.script.element(*action).row.name == "shot";
    let mut shots: Vec<(StageTime, usize)> = (0..times.len().min(scene.script.actions().len()))
        .filter(is_shot)
        .map(|action| (times[action].begin, action))
        .collect();
    shots.sort_unstable();
    let value = |action: usize, name: &str| scene.script.element(action).value(name);
    let named = shots.iter().position(|&(_, action)| value(action, "id") == Some(wanted));
    let numbered = || wanted.parse().ok().filter(|&at: &usize| at < shots.len());
    let Some(at) = named.or_else(numbered) else {
        let name = |(at, &(_, action)): (usize, &(StageTime, usize))| match value(action, "id") {
            Some(id) => format!("{at} \"{}\"", plain(id)),
            None => format!("{at} ({})", plain(value(action, "who").unwrap_or_default())),
        };
        let names: Vec<String> = shots.iter().enumerate().map(name).collect();
        let there = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        return Err(refused(format!("no shot is called \"{}\"; there is {there}", plain(wanted))));
    };
    let length = scene.plan.length();
    let begin = shots[at].0;
    let end = shots.get(at + 1).map_or(length, |next| next.0.min(length));
    MovieFrames::between(begin, end, rate)
        .ok_or_else(|| refused(format!("no frame shows the shot \"{}\"", plain(wanted))))
}
