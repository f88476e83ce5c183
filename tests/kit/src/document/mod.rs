//! Models made in code, and a document in its thread without a window.

pub mod arm;
pub mod fixture;
pub mod large;
pub mod made;
pub mod made_take;
pub mod new_version;
pub mod received;
pub mod test_document;
