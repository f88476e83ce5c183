//! Every rule that is checked before a value is used, under the name it has in the Khronos glTF validator.
//!
//! What the file says is either refused, because nothing sensible can be shown, or mended or left out with a warning.
//! The names are the codes of [`ImportError::Invalid`](crate::format::ImportError::Invalid) and
//! [`Warning`](crate::format::Warning).

/// One rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Check {
    /// The validator's name; an own one where it has none.
    pub code: &'static str,
    /// What follows from breaking it.
    pub answer: Answer,
    /// What is wrong when it is broken.
    pub meaning: &'static str,
}

/// What follows from breaking a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// The file is not read.
    Refuse,
    /// The file is read, with a warning.
    Warn,
    /// Refused where it matters, else a warning.
    Either,
}

/// Writes each rule's name as a constant, and all of them as a list.
macro_rules! checks {
    ($($answer:ident $code:ident $meaning:literal;)*) => {
        $(#[doc = $meaning] pub const $code: &str = stringify!($code);)*

        /// All rules.
        pub const CHECKS: &[Check] =
            &[$(Check { code: $code, answer: Answer::$answer, meaning: $meaning }),*];
    };
}

checks! {
    Refuse GLB_UNEXPECTED_END_OF_HEADER "A container ends inside its header.";
    Refuse GLB_INVALID_MAGIC "A container does not begin with glTF.";
    Refuse GLB_LENGTH_TOO_SMALL "A container's length is less than its header.";
    Either GLB_LENGTH_MISMATCH "A container's length is not the file's.";
    Refuse GLB_UNEXPECTED_END_OF_CHUNK_HEADER "A container ends inside a chunk's header.";
    Refuse GLB_CHUNK_TOO_BIG "A chunk reaches past the end of the container.";
    Refuse GLB_UNEXPECTED_FIRST_CHUNK "The first chunk is not JSON.";
    Refuse GLB_EMPTY_CHUNK "The JSON chunk is empty.";
    Warn GLB_CHUNK_LENGTH_UNALIGNED "A chunk's length is no multiple of four.";
    Warn GLB_DUPLICATE_CHUNK "There is a second JSON chunk.";
    Warn GLB_UNEXPECTED_BIN_CHUNK "A binary chunk is not the second chunk.";
    Warn GLB_UNKNOWN_CHUNK_TYPE "A chunk is of unknown kind.";

    Refuse INVALID_JSON "The JSON text breaks the rules of JSON.";
    Refuse TYPE_MISMATCH "A JSON value is of the wrong type.";
    Refuse UNDEFINED_PROPERTY "A JSON object lacks a member it must have.";
    Refuse DUPLICATE_PROPERTY "A JSON object has a member twice.";
    Refuse INVALID_INDEX "An index or an enumerated number does not fit 32 bits.";
    Refuse VALUE_NOT_IN_RANGE "A number is not finite or out of its range.";
    Either VALUE_NOT_IN_LIST "A word or number is none of those allowed.";
    Either UNRESOLVED_REFERENCE "An index names nothing.";
    Either EMPTY_ENTITY "A list is empty that must not be.";
    Warn DUPLICATE_ELEMENTS "A list names something twice.";
    Either UNSUPPORTED_EXTENSION "An extension is used that is not shown.";

    Refuse BUFFER_BYTE_LENGTH_MISMATCH "A buffer holds fewer bytes than it announces.";
    Warn BUFFER_GLB_CHUNK_TOO_BIG "A buffer or binary chunk holds more bytes than it announces.";
    Either BUFFER_MISSING_GLB_DATA "A buffer has no URI, and there is no binary chunk for it.";
    Refuse INVALID_URI "A URI cannot be decoded, or is not followed.";
    Refuse IO_ERROR "A file beside this one is missing or may not be read.";
    Refuse BUFFER_VIEW_TOO_LONG "A buffer view reaches past the end of its buffer.";
    Warn BUFFER_VIEW_INVALID_BYTE_STRIDE "A byte stride is outside 4..252 or no multiple of 4.";

    Refuse ACCESSOR_TOO_LONG "An accessor reaches past the end of its buffer view.";
    Refuse ACCESSOR_SMALL_BYTESTRIDE "A byte stride is smaller than the element.";
    Warn ACCESSOR_OFFSET_ALIGNMENT "An accessor's offset is no multiple of its component's size.";
    Warn ACCESSOR_NORMALIZED_INVALID "Only integers of 8 and 16 bits can be normalised.";
    Refuse ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE "A sparse accessor replaces more elements than it has.";
    Refuse ACCESSOR_SPARSE_INDEX_OOB "A sparse accessor replaces an element past its end.";
    Warn ACCESSOR_SPARSE_INDICES_NON_INCREASING "The indices of a sparse accessor do not rise.";
    Refuse ACCESSOR_INVALID_FLOAT "An accessor holds NaN or infinity.";

    Refuse MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT "A vertex attribute has a format that it may not have.";
    Refuse MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT "The attributes of a primitive differ in length.";
    Warn MESH_PRIMITIVE_INVALID_ATTRIBUTE "An attribute has an unknown name.";
    Warn MESH_PRIMITIVE_NO_POSITION "A primitive has no positions.";
    Warn MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH "Joints stand without weights, or weights without joints.";
    Refuse MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT "Indices are not unsigned integers.";
    Refuse ACCESSOR_INDEX_OOB "An index is not below the number of vertices.";
    Warn MESH_PRIMITIVE_INCOMPATIBLE_MODE "The indices do not make whole triangles.";
    Warn MESH_PRIMITIVE_MODE_NOT_SHOWN "Points and lines are not shown.";
    Refuse MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT "A morph target has another length than its primitive.";
    Warn MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT "The primitives of a mesh differ in their number of morph targets.";
    Warn MESH_INVALID_WEIGHTS_COUNT "A mesh has another number of weights than of morph targets.";
    Warn ACCESSOR_VECTOR3_NON_UNIT "Normals or tangents are not of unit length.";
    Warn ACCESSOR_INVALID_SIGN "The w of a tangent is neither 1 nor -1.";
    Warn ACCESSOR_NON_CLAMPED "A colour is outside 0..1.";
    Warn ACCESSOR_WEIGHTS_NEGATIVE "A weight is negative or not a number.";
    Warn ACCESSOR_WEIGHTS_NON_NORMALIZED "The weights of a vertex do not add up to one.";
    Warn ACCESSOR_WEIGHTS_ZERO "All weights of a vertex are zero.";
    Warn ACCESSOR_JOINTS_INDEX_DUPLICATE "A vertex names a joint twice.";
    Refuse ACCESSOR_JOINTS_INDEX_OOB "A vertex names a joint that its skin does not have.";
    Warn HUGE_TRANSLATION "A length is too large for single precision.";

    Refuse SKIN_IBM_INVALID_FORMAT "Inverse bind matrices are not 4x4 matrices of floats.";
    Refuse INVALID_IBM_ACCESSOR_COUNT "There are fewer inverse bind matrices than joints.";
    Warn ACCESSOR_INVALID_IBM "An inverse bind matrix cannot be inverted, or its last row is not 0 0 0 1.";

    Refuse NODE_LOOP "A node is its own ancestor.";
    Refuse NODE_PARENT_OVERRIDE "A node has two parents.";
    Warn NODE_MATRIX_TRS "A node has a matrix and other transforms.";
    Warn NODE_MATRIX_NON_TRS "A matrix is sheared, or its last row is not 0 0 0 1.";
    Warn ROTATION_NON_UNIT "A rotation is not of unit length.";
    Refuse TRANSFORM_OVERFLOW "The transforms of a node and its ancestors multiply to infinity.";
    Warn NODE_SKIN_WITH_NON_SKINNED_MESH "A node has a skin, but its mesh has no joints.";
    Warn NODE_WEIGHTS_INVALID "A node has another number of weights than its mesh of morph targets.";
    Warn SCENE_NON_ROOT_NODE "A scene names a node that has a parent.";
    Warn NODE_NOT_IN_SCENE "A mesh stands outside the scene that is shown.";
    Warn CAMERA_NOT_SHOWN "Cameras of files are not used.";

    Refuse ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT "Key times are not single floats.";
    Refuse ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT "Key values have a format that they may not have.";
    Refuse ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT "There are more or fewer key values than key times need.";
    Warn ACCESSOR_ANIMATION_INPUT_NEGATIVE "A key time is negative.";
    Warn ACCESSOR_ANIMATION_INPUT_NON_INCREASING "Key times do not rise.";
    Warn ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION "A key's rotation is not of unit length.";
    Warn ANIMATION_TANGENT_NOT_FINITE "A tangent is not finite.";
    Warn ANIMATION_DUPLICATE_TARGETS "Two channels of an animation move the same thing.";
    Warn ANIMATION_CHANNEL_TARGET_NODE_MATRIX "A node with a matrix is animated.";
    Warn ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS "Weights of a mesh without morph targets are animated.";
    Warn ANIMATION_CHANNEL_TARGET_UNKNOWN "A channel moves something that is not shown.";

    Warn IMAGE_DATA_INVALID "An image cannot be read; it is left empty.";
    Warn IMAGE_TOO_LARGE "An image has too many pixels; it is left empty.";
    Warn IMAGE_MIME_TYPE_INVALID "An image is not of the type that it says.";
    Warn TEXTURE_NO_SOURCE "A texture has no image that can be shown.";
    Warn TEXTURE_COORDINATES "A texture uses a third or later set of coordinates.";
}
