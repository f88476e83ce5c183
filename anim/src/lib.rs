//! Skeletal animation as plain data and functions: load a model, play a clip (here called a *take*), and get the
//! skinning matrices.
//!
//! ```
//! # #[cfg(feature = "gltf")]
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use dragonfly_anim::animation::Animation;
//! use dragonfly_anim::format::{NoFiles, ReadOptions, read};
//! use dragonfly_anim::sample::PlayMode;
//! # let bytes: &[u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/gltf/Fox.glb"));
//!
//! // `NoFiles`: the model is complete in this file.
//! let model = read("Fox.glb", bytes, &NoFiles, &ReadOptions::default())?.model;
//! let mut animation = Animation::of(&model);
//! let take = &model.animation.takes[0];
//!
//! // Every frame: `clock` is the number of seconds since the start.
//! let clock = 1.25;
//! animation.to_root_bone_poses(Some(0), PlayMode::Loop.map(take, clock));
//! for skin in &model.skins {
//!     let skinning_matrices: &[glam::Mat4] = animation.skin_poses(skin); // one per joint, for the GPU
//!     # assert_eq!(skinning_matrices.len(), skin.bones.len());
//! }
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "gltf"))]
//! # fn main() {}
//! ```
//!
//! A *model* is geometry with skinning information, a skeleton, and several takes. Each frame, for one take and one time:
//!
//! 1. [`sample`] finds the keys around the time and interpolates them: one [`data::Transform`] per bone, in its parent's
//!    space;
//! 2. [`animation::Animation`] multiplies them from the root to the children (`to_root`) and by the skin's offsets
//!    (`final_pose = to_root × offset`);
//! 3. [`skin`] moves every vertex by the final poses of the bones that influence it. A shader does the same.
//!
//! # Words
//!
//! | here | elsewhere |
//! |---|---|
//! | take | clip, animation, action |
//! | bone | joint |
//! | pose relative to the parent, to-parent | local space |
//! | to-root | model space, global transform |
//! | offset | inverse bind matrix |
//! | final pose | skinning matrix, joint matrix |
//!
//! Searching the documentation for the words on the right finds the items on the left.
//!
//! # Modules
//!
//! | task | module |
//! |---|---|
//! | learn how it works, in ten steps | [`tutorial`] |
//! | the data: skeletons, takes, meshes, materials | [`data`] |
//! | read and write files | [`format`](mod@format) |
//! | from keys to poses, to matrices, to vertices: the *open path* | [`sample`], [`animation`], [`skin`], [`evaluator`] |
//! | the same for eight bones at once: the *fast path* | [`fast`] |
//! | blending, additive layers, masks, cross-fades | [`blend`] |
//! | layers over a take, and the one take that they give | [`layers`] |
//! | rotate or move single bones on top of an animation | [`additional`] |
//! | attach objects to bones (sockets) | [`attach`] |
//! | inverse kinematics, with joint limits | [`ik`], [`joint`] |
//! | tangents of cubic splines; full turns and signs of rotation keys; keys repeated in cycles | [`tangents`], [`turns`], [`cycle`] |
//! | root motion; a root bone for it | [`motion`], [`root_bone`] |
//! | contacts of feet; loops; defects of a take | [`contact`], [`loops`], [`lint`] |
//! | the unit of length of a model whose file is in centimeters | [`model_unit`] |
//! | a take at its frames, and with keys at them | [`frames`], [`bake`] |
//! | play a take on another skeleton | [`retarget`] |
#![cfg_attr(
    feature = "stage",
    doc = "| scenes of several characters, driven by a script in XML | [`stage`] (feature `stage`) |"
)]
//! | change many keys by the same offset, with falloff | [`offset`] |
//! | remove redundant keys | [`reduce`] |
//! | in-betweens: blend keys with their neighbors, smooth curves | [`inbetween`] |
//! | compress takes | [`compressed`] |
//! | bounding volumes; ray and sphere queries | [`bounds`], [`hit`] |
//! | levels of detail | [`level`] |
//! | validate a model; measure the difference between two takes | [`check`], [`compare`] |
//! | show every intermediate value of a bone or a vertex | [`explain`] |
//! | the limits for imported files | [`limits`] |
//! | rotations with the same bits on every system | [`trig`] |
//!
//! # Conventions
//!
//! Matrices are glam's: column vectors, so a product reads right to left. The thesis on which this library is based
//! writes row vectors, so its `Final = Offset · ToRoot` is `to_root * offset` here; the numbers are the same.
//!
//! The library starts no thread and opens no file or window: importers read bytes and ask a [`format::AssetFs`] of the
//! caller for other files.

#![deny(unsafe_code)]

pub mod additional;
#[doc(alias("forward kinematics"))]
pub mod animation;
#[doc(alias("socket", "attachment"))]
pub mod attach;
mod axes;
pub mod bake;
#[doc(alias("blend tree"))]
pub mod blend;
pub mod bounds;
#[doc(alias("validate", "lint"))]
pub mod check;
mod checksum;
#[doc(alias("diff"))]
pub mod compare;
#[doc(alias("compression", "codec"))]
pub mod compressed;
#[doc(alias("foot contact", "foot lock", "foot slide", "foot plant"))]
pub mod contact;
#[doc(alias("extrapolation", "repeat", "oscillate"))]
pub mod cycle;
pub mod data;
pub mod evaluator;
pub mod explain;
pub mod fast;
pub mod format;
pub mod frames;
#[doc(alias("raycast", "picking", "BVH"))]
pub mod hit;
#[doc(alias("inverse kinematics"))]
pub mod ik;
#[doc(alias("tween", "smooth", "breakdown"))]
pub mod inbetween;
#[doc(alias("joint limits", "constraints"))]
pub mod joint;
#[doc(alias("animation layer", "additive layer"))]
pub mod layers;
#[doc(alias("LOD", "level of detail"))]
pub mod level;
pub mod limits;
#[doc(alias("quality", "defects"))]
pub mod lint;
#[doc(alias("cycle", "loop"))]
pub mod loops;
#[doc(alias("scale", "centimeters"))]
pub mod model_unit;
#[doc(alias("root motion"))]
pub mod motion;
#[doc(alias("additive edit", "proportional editing"))]
pub mod offset;
#[doc(alias("key reduction", "decimate keys"))]
pub mod reduce;
#[doc(alias("retargeting"))]
pub mod retarget;
#[doc(alias("add root", "reroot"))]
pub mod root_bone;
pub mod sample;
#[doc(alias("skinning"))]
pub mod skin;
#[cfg(feature = "stage")]
#[doc(alias("sequencer", "timeline", "SMIL", "screenplay"))]
pub mod stage;
#[doc(alias("trigonometry", "axis-angle"))]
#[doc(alias("handle", "Catmull-Rom", "auto clamped"))]
pub mod tangents;
pub mod trig;
#[doc(alias("Euler filter", "unroll"))]
pub mod turns;
pub mod tutorial;

/// Compiles and runs the example of `README.md`.
#[cfg(all(doctest, feature = "gltf"))]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
