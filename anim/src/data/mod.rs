//! The data of a model: plain structures, no behavior beyond assembling views of themselves.
//!
//! Big arrays are `Arc<[T]>`, so that an editor can share unchanged ones and threads can read them without a copy.

mod avatar;
mod bone;
mod channel;
mod extras;
mod geometry;
mod material;
mod model;
mod take;
mod transform;

pub use avatar::{Avatar, ExpressionBind, FaceExpression, HumanBone};
pub use bone::{Bone, BoneIndex, Skeleton, Skin};
pub use channel::{Channel, Interpolation};
pub use extras::TakeExtras;
pub use geometry::{Influence, MAX_INFLUENCES, Mesh, MeshInstance, MorphTarget, Primitive, Vertex, Vertices};
pub use material::{AlphaMode, Filter, Image, Material, Metallic, Phong, TextureRef, TextureTransform, Wrap};
pub use model::{AnimationData, ModelData};
pub use take::{Keyframe, MorphTrack, Take, Track};
pub use transform::Transform;
