//! Every rule that is checked before a value is used, under its name in the Khronos glTF validator.
//!
//! A file that breaks a rule is refused if nothing sensible can be shown; otherwise the value is corrected or left out,
//! with a warning. The names are the codes of [`ImportError::Invalid`](crate::format::ImportError::Invalid) and
//! [`Warning`](crate::format::Warning).

/// One rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Check {
    /// Name in the validator, or a name of this crate where the validator has none.
    pub code: &'static str,
    /// Consequence of breaking the rule.
    pub answer: Consequence,
    /// Description of a violation.
    pub meaning: &'static str,
}

/// Consequence of breaking a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Consequence {
    /// The file is not read.
    Refuse,
    /// The file is read, with a warning.
    Warn,
    /// The file is refused where the value is needed; otherwise it is read, with a warning.
    Either,
}

/// Defines the name of each rule as a constant, and the list of all rules.
macro_rules! checks {
    ($($answer:ident $code:ident $meaning:literal;)*) => {
        $(#[doc = $meaning] pub const $code: &str = stringify!($code);)*

        /// All rules.
        pub const CHECKS: &[Check] =
            &[$(Check { code: $code, answer: Consequence::$answer, meaning: $meaning }),*];
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
    Warn GLB_CHUNK_LENGTH_UNALIGNED "A chunk's length is not a multiple of four.";
    Warn GLB_DUPLICATE_CHUNK "There is a second JSON chunk.";
    Warn GLB_UNEXPECTED_BIN_CHUNK "A binary chunk is not the second chunk.";
    Warn GLB_UNKNOWN_CHUNK_TYPE "A chunk is of unknown kind.";

    Refuse INVALID_JSON "The JSON text breaks the rules of JSON.";
    Refuse TYPE_MISMATCH "A JSON value is of the wrong type.";
    Refuse UNDEFINED_PROPERTY "A JSON object lacks a member it must have.";
    Refuse DUPLICATE_PROPERTY "A JSON object has a member twice.";
    Refuse INVALID_INDEX "An index or an enumerated number does not fit 32 bits.";
    Refuse VALUE_NOT_IN_RANGE "A number is not finite or out of its range.";
    Either VALUE_NOT_IN_LIST "A word or number is not one of those allowed.";
    Either UNRESOLVED_REFERENCE "An index is out of range.";
    Either EMPTY_ENTITY "A list that must have an element is empty.";
    Warn DUPLICATE_ELEMENTS "A list contains the same index twice.";
    Either UNSUPPORTED_EXTENSION "The file uses an extension that is not supported.";

    Refuse BUFFER_BYTE_LENGTH_MISMATCH "A buffer has fewer bytes than its byteLength.";
    Warn BUFFER_GLB_CHUNK_TOO_BIG "A buffer or binary chunk has more bytes than its byteLength.";
    Either BUFFER_MISSING_GLB_DATA "A buffer has no URI, and the file has no binary chunk for it.";
    Refuse INVALID_URI "A URI cannot be decoded, or leads outside of the folder.";
    Refuse IO_ERROR "A referenced file is missing or may not be read.";
    Refuse BUFFER_VIEW_TOO_LONG "A buffer view reaches past the end of its buffer.";
    Refuse MESHOPT_INVALID "The compressed data of a buffer view cannot be decoded.";
    Refuse DRACO_INVALID "The compressed data of a primitive cannot be decoded.";
    Warn BUFFER_VIEW_INVALID_BYTE_STRIDE "A byte stride is outside 4..252 or not a multiple of 4.";

    Refuse ACCESSOR_TOO_LONG "An accessor reaches past the end of its buffer view.";
    Refuse ACCESSOR_SMALL_BYTESTRIDE "A byte stride is smaller than the element.";
    Warn ACCESSOR_OFFSET_ALIGNMENT "An accessor's offset is not a multiple of its component's size.";
    Warn ACCESSOR_NORMALIZED_INVALID "Only integers of 8 and 16 bits can be normalized.";
    Refuse ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE "A sparse accessor replaces more elements than it has.";
    Refuse ACCESSOR_SPARSE_INDEX_OOB "A sparse accessor replaces an element past its end.";
    Warn ACCESSOR_SPARSE_INDICES_NON_INCREASING "The indices of a sparse accessor do not increase.";
    Refuse ACCESSOR_INVALID_FLOAT "An accessor contains NaN or infinity.";

    Refuse MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT "A vertex attribute has a format that is not allowed.";
    Refuse MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT "The attributes of a primitive differ in length.";
    Warn MESH_PRIMITIVE_INVALID_ATTRIBUTE "An attribute has an unknown name.";
    Warn MESH_PRIMITIVE_NO_POSITION "A primitive has no positions.";
    Warn MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH "A primitive has joints without weights, or weights without joints.";
    Refuse MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT "Indices are not unsigned integers.";
    Refuse ACCESSOR_INDEX_OOB "An index is not below the number of vertices.";
    Warn MESH_PRIMITIVE_INCOMPATIBLE_MODE "The indices do not make whole triangles.";
    Warn MESH_PRIMITIVE_MODE_NOT_SHOWN "Points and lines are not shown.";
    Refuse MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT "A morph target does not have one value per vertex.";
    Warn MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT "The primitives of a mesh differ in their number of morph targets.";
    Warn MESH_INVALID_WEIGHTS_COUNT "A mesh does not have one weight per morph target.";
    Warn ACCESSOR_VECTOR3_NON_UNIT "Normals or tangents are not of unit length.";
    Warn ACCESSOR_INVALID_SIGN "The w of a tangent is neither 1 nor -1.";
    Warn ACCESSOR_NON_CLAMPED "A color is outside 0..1.";
    Warn ACCESSOR_WEIGHTS_NEGATIVE "A weight is negative or not a number.";
    Warn ACCESSOR_WEIGHTS_NON_NORMALIZED "The weights of a vertex do not add up to one.";
    Warn ACCESSOR_WEIGHTS_ZERO "All weights of a vertex are zero.";
    Warn ACCESSOR_JOINTS_INDEX_DUPLICATE "A vertex has the same joint twice.";
    Refuse ACCESSOR_JOINTS_INDEX_OOB "A vertex refers to a joint that its skin does not have.";
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
    Warn NODE_WEIGHTS_INVALID "A node does not have one weight per morph target of its mesh.";
    Warn SCENE_NON_ROOT_NODE "A root node of a scene has a parent.";
    Warn NODE_NOT_IN_SCENE "A mesh is not in the scene that is shown.";
    Warn VRM_INVALID "A VRM names a bone, node or morph target that is not there.";
    Warn CAMERA_NOT_SHOWN "The file has a camera, which is not used.";

    Refuse ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT "Key times are not single floats.";
    Refuse ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT "Key values have a format that is not allowed.";
    Refuse ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT "The number of key values does not match the number of key times.";
    Warn ACCESSOR_ANIMATION_INPUT_NEGATIVE "A key time is negative.";
    Warn ACCESSOR_ANIMATION_INPUT_NON_INCREASING "Key times do not increase.";
    Warn ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION "A key's rotation is not of unit length.";
    Warn ANIMATION_TANGENT_NOT_FINITE "A tangent is not finite.";
    Warn ANIMATION_DUPLICATE_TARGETS "Two channels of an animation animate the same property.";
    Warn ANIMATION_CHANNEL_TARGET_NODE_MATRIX "A node with a matrix is animated.";
    Warn ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS "Weights of a mesh without morph targets are animated.";
    Warn ANIMATION_CHANNEL_TARGET_UNKNOWN "A channel animates something that is not shown.";

    Warn IMAGE_DATA_INVALID "An image cannot be read; it is left empty.";
    Warn IMAGE_TOO_LARGE "An image has too many pixels; it is left empty.";
    Warn IMAGE_MIME_TYPE_INVALID "The type of an image is not the one declared.";
    Warn TEXTURE_NO_SOURCE "A texture has no image that can be shown, or not the one it prefers.";
    Warn TEXTURE_COORDINATES "A texture uses a third or later set of coordinates.";
}
