//! Codes of the errors and warnings of this format.

/// The bytes are not an FBX file, or a broken one.
pub const FBX_INVALID: &str = "FBX_INVALID";
/// The file ends too early.
pub const FBX_TRUNCATED: &str = "FBX_TRUNCATED";
/// The process that parsed the file crashed, hung, or gave a wrong answer.
pub const FBX_PARSER: &str = "FBX_PARSER";
/// Numbers that are not finite were replaced.
pub const FBX_NUMBER: &str = "FBX_NUMBER";
/// Content that is not shown or not animated.
pub const FBX_NOT_SHOWN: &str = "FBX_NOT_SHOWN";
/// Weights of vertices were corrected.
pub const FBX_WEIGHTS: &str = "FBX_WEIGHTS";
/// A texture could not be read.
pub const FBX_TEXTURE: &str = "FBX_TEXTURE";
/// Motion between two keys is not followed exactly.
pub const FBX_KEYS: &str = "FBX_KEYS";
/// Text in an unknown encoding was replaced.
pub const FBX_TEXT: &str = "FBX_TEXT";
/// A message of the parser.
pub const FBX_FOUND: &str = "FBX_FOUND";

/// Content of a model that a written file does not contain.
pub const NOT_IN_FBX: &str = "NOT_IN_FBX";

/// All codes that the child may use.
const CODES: &[&str] = &[
    FBX_INVALID,
    FBX_TRUNCATED,
    FBX_PARSER,
    FBX_NUMBER,
    FBX_NOT_SHOWN,
    FBX_WEIGHTS,
    FBX_TEXTURE,
    FBX_KEYS,
    FBX_TEXT,
    FBX_FOUND,
    "MORE",
];

/// Returns the code of this name.
pub(crate) fn known(name: &str) -> Option<&'static str> {
    CODES.iter().copied().find(|code| *code == name)
}
