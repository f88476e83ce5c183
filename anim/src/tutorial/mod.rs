//! An animated model from scratch, in ten steps, for readers who have never built one.
//!
//! The model is an arm of two bones that bends at the elbow. Every step has the code, its formula, and the
//! section of the thesis that explains it. The result is everything that a game or an editor does each frame to
//! move a character; a real one only has more bones.
//!
//! The steps are one program: each continues the one before. The lines that begin with `assert` are not
//! needed; they show the results.
//!
//! # Step 1: bones, a tree written as a list
//!
//! A skeleton is a tree. It is stored as a list, and each bone has only the number of its parent (thesis §2.1.2.2): a
//! number can be saved and sent to a shader as it is, a pointer cannot. Vertices and animations refer to bones by the
//! same numbers (§2.1.3). Parents come before their children, so that one pass through the list visits them first.
//!
//! `rest` is the pose of the bone when nothing moves it, *relative to its parent*. Our arm points along x. The upper
//! bone starts at the origin, the lower one a meter further on, at the elbow.
//!
//! ```
//! use dragonfly_anim::data::{Bone, Skeleton, Transform};
//! use glam::{Mat4, Vec3};
//!
//! let bone = |name: &str, parent: Option<u32>, translation: Vec3| Bone {
//!     name: name.to_owned(),
//!     parent,
//!     rest: Transform { translation, ..Transform::IDENTITY },
//!     rest_matrix: None,
//!     offset: Mat4::IDENTITY, // step 3
//!     node: None,
//! };
//! let mut skeleton = Skeleton {
//!     bones: vec![bone("upper", None, Vec3::ZERO), bone("lower", Some(0), Vec3::X)],
//! };
//!
//! assert_eq!(skeleton.find("lower"), Some(1));
//! assert_eq!(skeleton.children(Some(0)).collect::<Vec<_>>(), [1]);
//! # assert_eq!(skeleton, dragonfly_anim::tutorial::arm::without_offsets());
//! ```
//!
//! # Step 2: from the parent to the root
//!
//! A pose relative to the parent becomes a matrix, `to_parent`: scale first, then rotation, then translation.
//! Multiplied by the matrices of all ancestors it becomes `to_root`, the pose of the bone in the scene (§2.1.5.1):
//!
//! ```text
//! to_parent = translation * rotation * scale
//! to_root   = to_root of the parent * to_parent          thesis: ToRoot_i = ToParent_i · ToRoot_p
//! ```
//!
//! The thesis writes vectors as rows, this library as columns, so the factors of its products are in the opposite
//! order. The numbers are the same.
//!
//! ```
//! # use dragonfly_anim::{data::Transform, tutorial::arm};
//! # use glam::{Mat4, Vec3};
//! # let skeleton = arm::without_offsets();
//! use dragonfly_anim::animation::to_root;
//!
//! let rest: Vec<Transform> = skeleton.bones.iter().map(|bone| bone.rest).collect();
//! let mut rest_to_root = [Mat4::IDENTITY; 2];
//! to_root(&skeleton, &rest, &mut rest_to_root);
//!
//! // The elbow is at one meter along x.
//! assert_eq!(rest_to_root[1].transform_point3(Vec3::ZERO), Vec3::X);
//! ```
//!
//! # Step 3: offsets
//!
//! Geometry is modeled once, around the skeleton in its *bind pose*. The offset of a bone (inverse bind matrix)
//! transforms a point from there to the bone's own space; it never changes (§2.1.2.2). When the bind pose is the rest
//! pose, it is the inverse of `to_root`:
//!
//! ```text
//! offset = (to_root in the bind pose)⁻¹
//! ```
//!
//! ```
//! # use dragonfly_anim::tutorial::arm;
//! # use glam::Vec3;
//! # let mut skeleton = arm::without_offsets();
//! # let rest_to_root = arm::to_root(&skeleton, None, 0.0);
//! for (bone, to_root) in skeleton.bones.iter_mut().zip(rest_to_root) {
//!     bone.offset = to_root.inverse();
//! }
//!
//! // In its own space, the elbow is the origin.
//! assert_eq!(skeleton.bones[1].offset.transform_point3(Vec3::X), Vec3::ZERO);
//! # assert_eq!(skeleton, arm::skeleton());
//! ```
//!
//! # Step 4: vertices, and which bones move them
//!
//! A vertex lists the bones that move it and their weights (§2.1.2.1): four influences per vertex, the strongest
//! first, the weights summing to 1. Three vertices are enough for an arm: shoulder, elbow, hand. The elbow belongs to
//! both bones.
//!
//! A vertex refers to *joints*, which are positions in the list of a [`Skin`](crate::data::Skin); the skin contains the
//! bone of each, and the offsets. So several meshes can share a skeleton.
//!
//! ```
//! # use dragonfly_anim::tutorial::arm;
//! # use glam::Vec3;
//! # let skeleton = arm::skeleton();
//! use dragonfly_anim::data::{Influence, Primitive, Skin, Vertices};
//!
//! let influences = |joints: &[(u16, f32)]| {
//!     let mut four = [Influence::default(); 4];
//!     for (slot, &(joint, weight)) in four.iter_mut().zip(joints) {
//!         *slot = Influence { joint, weight };
//!     }
//!     four
//! };
//! let vertices = Vertices {
//!     positions: vec![Vec3::ZERO, Vec3::X, 2.0 * Vec3::X],
//!     influences: [influences(&[(0, 1.0)]), influences(&[(0, 0.5), (1, 0.5)]), influences(&[(1, 1.0)])].concat(),
//!     influences_per_vertex: 4,
//!     ..Vertices::default()
//! };
//! let arm = Primitive { vertices, indices: vec![0, 1, 2], ..Primitive::default() };
//! let skin = Skin {
//!     name: "arm".to_owned(),
//!     bones: vec![0, 1],
//!     offsets: skeleton.bones.iter().map(|bone| bone.offset).collect(),
//! };
//!
//! assert_eq!(arm.vertices.influences_of(1)[1], Influence { joint: 1, weight: 0.5 });
//! # assert_eq!((arm, skin), (arm::primitive(), arm::skin()));
//! ```
//!
//! # Step 5: keys, tracks, a take
//!
//! A key is a value at a time. The keys of one property of one bone are a
//! [`Channel`](crate::data::Channel); the channels of a bone are its [`Track`](crate::data::Track); a track for every
//! bone is a [`Take`](crate::data::Take), in other programs a clip (§2.1.2.3, §3.1.2). Each bone has its own keys, and
//! one that does not move needs none: our upper bone has an empty track, and keeps its rest pose.
//!
//! In one second the lower bone turns by a right angle.
//!
//! ```
//! use dragonfly_anim::data::{Channel, Interpolation, Take, Track};
//! use glam::Quat;
//! use std::f32::consts::FRAC_PI_2;
//!
//! let quarter_turn = || Channel::new(
//!     [0.0, 1.0],
//!     [Quat::IDENTITY, Quat::from_rotation_z(FRAC_PI_2)],
//!     Interpolation::Linear,
//! );
//! let bend = Take {
//!     name: "bend".to_owned(),
//!     start: 0.0,
//!     length: 1.0,
//!     tracks: vec![
//!         Track { bone: 0, ..Track::default() },
//!         Track { bone: 1, rotation: quarter_turn(), ..Track::default() },
//!     ],
//!     ..Take::default()
//! };
//!
//! assert_eq!((bend.keys(), bend.moving_tracks()), (2, 1));
//! # assert_eq!(bend, dragonfly_anim::tutorial::arm::bend());
//! ```
//!
//! # Step 6: between two keys
//!
//! At half a second there is no key. The one before, the one after, and the fraction of the time between them are
//! found; then both are combined (§2.1.5.2: `0.5 * K1 + 0.5 * K2`). Rotations turn from one to the other at constant
//! speed.
//!
//! ```text
//! mix   = (time - before) / (after - before)
//! value = (1 - mix) * K1 + mix * K2
//! ```
//!
//! The three properties together are the temporary key-frame of the thesis: the pose of the bone at that time.
//!
//! ```
//! # use dragonfly_anim::{data::Transform, tutorial::arm};
//! # use glam::Quat;
//! # use std::f32::consts::FRAC_PI_2;
//! # let (skeleton, bend) = (arm::skeleton(), arm::bend());
//! use dragonfly_anim::sample::{find_keys, sample_take};
//!
//! let time = 0.5;
//! let mut poses = [Transform::IDENTITY; 2];
//! sample_take(Some(&bend), &skeleton, time, &mut poses);
//!
//! let keys = find_keys(&bend.tracks[1].rotation.times, time).unwrap();
//! assert_eq!((keys.before, keys.after, keys.mix), (0, 1, 0.5));
//! assert!(poses[1].rotation.angle_between(Quat::from_rotation_z(FRAC_PI_2 / 2.0)) < 1e-6);
//! assert_eq!(poses[0], skeleton.bones[0].rest);
//! ```
//!
//! # Step 7: the pose in the scene
//!
//! The formula of step 2 again, now with the poses at this time (§2.1.5.1). These matrices also draw the skeleton.
//!
//! ```text
//! to_root = to_root of the parent * to_parent
//! ```
//!
//! ```
//! # use dragonfly_anim::{animation::to_root, data::Transform, sample::sample_take, tutorial::arm};
//! # use glam::{Mat4, Vec3};
//! # let (skeleton, mut poses) = (arm::skeleton(), [Transform::IDENTITY; 2]);
//! # sample_take(Some(&arm::bend()), &skeleton, 0.5, &mut poses);
//! let mut now_to_root = [Mat4::IDENTITY; 2];
//! to_root(&skeleton, &poses, &mut now_to_root);
//!
//! // A point one meter along the lower bone has left the x axis; the elbow has not moved.
//! let hand = now_to_root[1].transform_point3(Vec3::X);
//! let slope = std::f32::consts::FRAC_1_SQRT_2;
//! assert!(hand.distance(Vec3::new(1.0 + slope, slope, 0.0)) < 1e-6);
//! assert_eq!(now_to_root[1].transform_point3(Vec3::ZERO), Vec3::X);
//! ```
//!
//! # Step 8: final poses
//!
//! Vertices are stored in the bind pose. To move one, it is first transformed to the bone's space, then by the bone's
//! current `to_root` (§2.1.5.1). Both together are the final pose (skinning matrix), one matrix per joint, and all that
//! a graphics card needs.
//!
//! ```text
//! final = to_root * offset                                thesis: Final_i = Offset_i · ToRoot_i
//! ```
//!
//! ```
//! # use dragonfly_anim::tutorial::arm;
//! # use glam::Mat4;
//! # let (skeleton, skin) = (arm::skeleton(), arm::skin());
//! # let rest_to_root = arm::to_root(&skeleton, None, 0.0);
//! # let now_to_root = arm::to_root(&skeleton, Some(&arm::bend()), 0.5);
//! use dragonfly_anim::animation::final_poses;
//!
//! let mut finals = [Mat4::IDENTITY; 2];
//! final_poses(&skin, &now_to_root, &mut finals);
//!
//! // In the bind pose every final pose is the identity: nothing moves.
//! let mut at_rest = [Mat4::ZERO; 2];
//! final_poses(&skin, &rest_to_root, &mut at_rest);
//! assert_eq!(at_rest, [Mat4::IDENTITY; 2]);
//! ```
//!
//! # Step 9: the skin
//!
//! Each bone moves the vertex as if it were the only one; the results are summed by weight (§2.1.4).
//!
//! ```text
//! position = Σ final_i * stored position * weight_i
//! ```
//!
//! On the screen a shader does this, for each vertex in each frame. [`skin_positions`](crate::skin::skin_positions)
//! does the same on the CPU.
//!
//! ```
//! # use dragonfly_anim::{animation::final_poses, tutorial::arm};
//! # use glam::{Mat4, Vec3};
//! # let now_to_root = arm::to_root(&arm::skeleton(), Some(&arm::bend()), 0.5);
//! # let (arm, skin, mut finals) = (arm::primitive(), arm::skin(), [Mat4::IDENTITY; 2]);
//! # final_poses(&skin, &now_to_root, &mut finals);
//! # let slope = std::f32::consts::FRAC_1_SQRT_2;
//! use dragonfly_anim::skin::{Movement, skin_positions};
//!
//! let mut positions = [Vec3::ZERO; 3];
//! skin_positions(&arm, Movement::Skin(&finals), &[], &mut positions);
//!
//! assert_eq!(positions[0], Vec3::ZERO);
//! assert!(positions[1].distance(Vec3::X) < 1e-6, "the elbow is where both bones agree");
//! assert!(positions[2].distance(Vec3::new(1.0 + slope, slope, 0.0)) < 1e-6);
//! ```
//!
//! # Step 10: two takes at once
//!
//! Several takes are combined for each bone, *before* the skin, because there are far fewer bones than vertices
//! (§2.1.4.1). Each take is sampled by itself; [`blend`](crate::blend::blend()) makes one pose of them, bone by bone:
//!
//! ```text
//! translation = Σ weight_i * translation_i        scale too
//! rotation    = Σ weight_i * rotation_i, divided by its length
//! ```
//!
//! Where the weights of a bone sum to less than 1, the pose that is given first, usually the rest pose, gets the
//! remainder; where they sum to more than 1, they are divided by their sum. Here a second take lifts the upper bone,
//! and both have the weight 0.5. From the combined poses on, everything is as before.
//!
//! ```
//! # use dragonfly_anim::{animation::{final_poses, to_root}, data::Transform, sample::sample_take};
//! # use dragonfly_anim::{skin::{Movement, skin_positions}, tutorial::arm};
//! # use glam::{Mat4, Vec3};
//! # let (skeleton, bend, poses) = (arm::skeleton(), arm::bend(), [Transform::IDENTITY; 2]);
//! # let (arm, skin) = (arm::primitive(), arm::skin());
//! # let (mut now_to_root, mut finals, mut positions) = ([Mat4::ZERO; 2], [Mat4::ZERO; 2], [Vec3::ZERO; 3]);
//! # let slope = std::f32::consts::FRAC_1_SQRT_2;
//! use dragonfly_anim::blend::{Layer, blend};
//!
//! let mut raise = bend.clone();
//! raise.tracks.swap(0, 1);
//! let (mut of_bend, mut of_raise, mut both) = (poses, poses, poses);
//! sample_take(Some(&bend), &skeleton, 1.0, &mut of_bend);
//! sample_take(Some(&raise), &skeleton, 1.0, &mut of_raise);
//! let rest: Vec<Transform> = skeleton.bones.iter().map(|bone| bone.rest).collect();
//! let layers = [Layer::new(&of_bend, 0.5), Layer::new(&of_raise, 0.5)];
//! blend(&rest, &layers, &mut both);
//! to_root(&skeleton, &both, &mut now_to_root);
//! final_poses(&skin, &now_to_root, &mut finals);
//! skin_positions(&arm, Movement::Skin(&finals), &[], &mut positions);
//!
//! // Half a right angle at the shoulder, another half at the elbow.
//! assert!(positions[1].distance(Vec3::new(slope, slope, 0.0)) < 1e-6);
//! assert!(positions[2].distance(Vec3::new(slope, slope + 1.0, 0.0)) < 1e-6);
//! ```
//!
//! # Where to go from here
//!
//! * [`explain`](crate::explain::explain()) shows all of these steps with their numbers, for any bone or vertex of any
//!   model.
//! * [`Animation`](crate::animation::Animation) and [`Evaluator`](crate::evaluator::Evaluator) do steps 6 to 9 in one
//!   call and keep their memory, so that playing allocates nothing.
//! * [`format::read`](crate::format::read) reads a model from a file instead of steps 1 to 5.
//! * [`blend`](mod@crate::blend) also has masks, additive animation, and fades from take to take; [`ik`](crate::ik)
//!   makes an arm like this one reach for a target; [`motion`](crate::motion) extracts root motion, and
//!   [`retarget`](crate::retarget) transfers a take to another skeleton.
//! * [`format::dfm`](crate::format::dfm) saves the model.
//! * [`reduce`](crate::reduce::reduce()) removes redundant keys.

#[doc(hidden)]
pub mod arm;
