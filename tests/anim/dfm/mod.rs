//! The `.dfm` format: the thesis's layout, extended to a complete model, without losses.

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
