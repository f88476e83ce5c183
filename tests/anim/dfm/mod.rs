//! The `.dfm` format: the thesis's layout, with everything a model has, and nothing lost.

mod damage;
mod frame;
pub(crate) mod golden;
mod hostile;
mod import;
mod made;
mod refused;
mod round_trip;
mod thesis;
mod versions;
