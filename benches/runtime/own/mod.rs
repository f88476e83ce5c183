//! Features that only our runtime has: flavors of addresses, registers, the trace and the watchdog, spinning.

pub mod addresses;
pub mod observed;
pub mod peer;
pub mod registers;
pub mod spin;

use crate::Study;

/// Measures every case.
pub fn all(study: &mut Study) {
    spin::all(study);
    addresses::all(study);
    registers::all(study);
    observed::all(study);
}
