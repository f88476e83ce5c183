//! Scenes of several roles, driven by a script in XML: which role plays which take, walks where, holds what, and what the camera sees.
//!
//! ```
//! # #[cfg(feature = "gltf")]
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use dragonfly_anim::format::{NoFiles, ReadOptions, read};
//! use dragonfly_anim::stage::script::StageScript;
//! use dragonfly_anim::stage::{StageAssets, StageModel, StagePlan};
//! use std::sync::Arc;
//! # let bytes: &[u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/gltf/Fox.glb"));
//!
//! let text = r#"<script version="1" fps="24">
//!   <cast>
//!     <role id="fox" model="Fox.glb" scale="0.01"/>
//!     <camera id="wide" at="0 1 6" look="fox"/>
//!     <path id="aisle" points="0 0 0  2 0 0  3 0 2" curve="smooth"/>
//!   </cast>
//!   <seq>
//!     <move who="fox" path="aisle" take="Walk"/>
//!     <play id="looks" who="fox" take="Survey" fade-in="0.3"/>
//!   </seq>
//!   <title text="The End" begin="looks.end-1" dur="2" fade-in="0.5"/>
//! </script>"#;
//!
//! // Once a model and once a text; errors have lines and columns.
//! let model = read("Fox.glb", bytes, &NoFiles, &ReadOptions::default())?.model;
//! let mut assets = StageAssets::default();
//! assets.add_model("Fox.glb", Arc::new(StageModel::new(Arc::new(model))));
//! let script = StageScript::read(text).map_err(|errors| errors[0].in_file("scene.xml"))?;
//! let plan = StagePlan::new(&script, &assets).map_err(|errors| errors[0].in_file("scene.xml"))?;
//!
//! // Any frame, in any order: a function of the plan and the frame.
//! let mut scene = plan.new_scene();
//! plan.frame(48, &mut scene);
//! let fox = &scene.things[0];
//! println!("at {} with {} bones", fox.transform.translation, fox.pose.as_ref().unwrap().pose.bones());
//! # assert_eq!(scene.time.seconds(), 2.0);
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "gltf"))]
//! # fn main() {}
//! ```
//!
//! # From text to scene
//!
//! | step | type | depends on |
//! |---|---|---|
//! | XML with the place of every element and attribute, checked against [`table`] | [`script::ScriptTree`] | the text |
//! | includes replaced, names resolved | [`script::StageScript`] | the text, the files that it includes |
//! | begins and ends | [`schedule::Schedule`] | the text, lengths of takes and ways |
//! | channels of every thing | [`StagePlan`] | the text, the models |
//! | places, poses, camera, lights, effects, titles, sounds | [`StageScene`] | the plan, a time |
//!
//! [`LiveStage`] does all of it for a text that someone is writing, and keeps the last plan that worked. [`table::schema`] returns the
//! vocabulary as a schema in RELAX NG. For editors: [`lanes`] has the bars of a timeline, [`gesture`] the texts after drags of them,
//! [`writing`] colors and completes a text that is being written.
//!
//! # The vocabulary
//!
//! A `<script>` has a `<cast>` of things (`role prop camera light effect path mark`) and then actions. Two of them contain others: `<par>`
//! begins all at once, `<seq>` one after the other. The script itself is a `par`. The others are `wait play move turn place look attach
//! detach shot run set change sound title include`. Every action may have `id begin end dur`; times are `1.5`, `1.5s`, `250ms`, `36f` (frames)
//! or `1:05.5`. [`table::ELEMENTS`] has every attribute with its meaning.
//!
//! # The rules of time
//!
//! 1. *Begin.* In a `seq` an action begins at the end of the one before, in a `par` at the start of the `par`. `begin="2"` is an offset to
//!    that; `begin="grab.touch-0.5"` replaces it by a moment of another action: its `begin`, its `end`, or an `<at>` of its take. `prev` is
//!    the action before.
//! 2. *End.* A `play` lasts as long as its part of the take, divided by its speed; a `move` as its way takes; the others last no time. `repeat`
//!    multiplies that, without what is before the `start` of the first repetition; `dur` or `end` replaces it. Without a `speed`, `dur` and
//!    `end` stretch a `move`; otherwise they cut.
//! 3. *Passive* is what has no length of its own: `look`, `run`, `shot` and `title` without `dur` or `end`, `repeat="fill"`, and everything
//!    whose `end` is the end of a container around it. It lasts to the start of the next action in its `seq` if that has a `begin` of its own,
//!    else to the end of the nearest `par`; a `shot` to the next shot anywhere. It lengthens nothing.
//! 4. *A container* ends with the last of its actions that is not passive. One with an end of its own stops what is inside at that time;
//!    references to the end of something inside still mean the end by these rules.
//! 5. *Who decides.* Of actions on the same channel of a thing, the one that began last decides; of those that began together, the last in
//!    the text. `fade-in` mixes with what was before and moves nothing in time. After its end an action holds its last state, unless it has
//!    `fill="release"` or fades out; `look`, layers, titles and effects are released. So a clip inside of another one gives the pose back to it only
//!    if it fades out or is released. The place is never given back: a thing stays where its last motion left it.
//!
//! Times are exact ([`time`]), and a time that depends on itself is an error that names every action in the loop.
//!
//! # Places and poses
//!
//! Position and direction are two channels. `move`, `place`, and takes that travel decide over both, `turn` over the direction; a thing
//! stays where the last of them left it. What is attached follows its holder until something moves it that began later. On a path a take
//! is played by distance, at the stride that its feet or its root motion have, and feet in contact are held where they are. A prop has a
//! `tilt` before its direction, except while something holds it.
//!
//! # Ground
//!
//! `ground="plane"` of a `move` gives its way the height 0, `ground="mesh"` that of the ground props of the cast, which have `ground="yes"`: of several surfaces over each other that of the one
//! nearest to the height of the way itself, 0 where there is none. What faces down is a ceiling; ground has half a meter of room under a ceiling, and no other ground right
//! over it. A ground prop has its place in the cast and the rest pose of its model for this; nothing may move it. Feet that are kept stand on the ground under
//! them and lean with it. What is detached with `drop="ground"` falls on the ground below it.
//!
//! # Shape keys
//!
//! Shape keys (morph targets) follow the takes as bones do: the same shares, fades and layers, and the weights of the model where a take has no keys of their mesh. A layer with
//! `bones` moves the shape keys that belong to them ([`StageShapes::bones`]).
//!
//! # Differences to the first design
//!
//! The rules are those of the prototype with these changes. An `end` at a container's end counts exactly, with its offset, in place of "the
//! nearest `par`". A title without a duration is passive; it would never be seen. A container with an end of its own stops what is inside. Points of a take
//! respect `from` and a negative `speed`. Ids may have `-` before a digit (`scene-1`); only names of moments may not, because `touch-0.5` has
//! an offset. Ends before begins take no time, with a note. `gap`, for a `move` to a thing, is the distance at which it stops, and `turn`, for `attach`, rotates. `repeat` is an
//! attribute of `play`, `move` and `sound` alone. `start`, for `play`, begins the first repetition in the middle of its part.
//!
//! # Scripts in scripts
//!
//! `<include src="intro.xml"/>` is a `par` of the actions of another script, which is a whole script by itself: its times in frames have its
//! own frame rate; its size and seed count not. Names of its actions are its own: outside, only those of the `include` are seen. Things
//! of the same id, kind and model are one thing, and the first one decides where that is at the start: that of the project, then of the script,
//! then of an earlier `include`. `src` is relative to the file that has it; so are the models and sounds of an included script, unless a
//! project says what they are relative to. This library opens no file: [`script::IncludedScripts`] has what the caller has read.
//!
//! # Limits
//!
//! A script has at most 8 MB and 500,000 nodes, together with everything that it includes. Each file has at most 64 levels by itself, and
//! files are included at most 8 deep. Document types and entities are refused. Elements and attributes of other namespaces are
//! kept and ignored.

mod assets;
mod ease;
pub mod gesture;
mod ground;
pub mod lanes;
pub mod line;
mod live;
mod model;
mod moment;
mod path;
mod plan;
pub mod project;
mod scene;
pub mod schedule;
pub mod script;
pub mod splice;
pub mod table;
pub mod time;
mod time_text;
pub mod writing;

pub use assets::StageAssets;
pub use ease::StageEase;
pub use ground::GROUND_TRIANGLES;
pub use live::LiveStage;
pub use model::{FootContact, StageFoot, StageModel, StageShapes, StageTake};
pub use path::{PathSpot, StagePath};
pub use plan::{
    Footprint, PathWalk, Placement, PlannedThing, RigidPlace, SoundCue, StagePlan, ThingHold, TitleCue,
};
pub use scene::{
    EffectState, LightState, PlayingSound, ShownTitle, StageCamera, StageScene, ThingPose, ThingState,
};
