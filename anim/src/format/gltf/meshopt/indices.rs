//! Mode 2, indices: differences to one of two earlier indices.

use super::stream::{MeshoptFault, MeshoptStream, put_index, unzigzag};

/// Decodes indices of `stride` bytes, 2 or 4, until `out` is full.
pub(super) fn decode(data: &[u8], stride: usize, out: &mut [u8]) -> Result<(), MeshoptFault> {
    let mut stream = MeshoptStream::new(data);
    if stream.byte()? != 0xd1 {
        return Err("it is no indices of version 1");
    }
    stream.take_last(4)?;
    let mut last = [0_u32; 2];
    for index in out.chunks_exact_mut(stride) {
        let number = stream.number()?;
        let baseline = &mut last[(number & 1) as usize];
        *baseline = baseline.wrapping_add(unzigzag(number >> 1));
        put_index(index, *baseline);
    }
    stream.finish()
}
