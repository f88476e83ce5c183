//! Morph targets: offsets of vertices.

use super::code::DFM_VALUE;
use super::part::Part;
use super::reader::Reader;
use super::record::only_bits;
use super::writer::Writer;
use crate::data::MorphTarget;
use crate::format::ImportError;
use glam::Vec3;

/// Bits of the columns that a target has: positions, normals, tangents.
const COLUMNS: [u32; 3] = [1, 2, 4];

/// Writes the targets of one primitive.
pub(super) fn write_targets(targets: &[MorphTarget], writer: &mut Writer) {
    for target in targets {
        let columns = [&target.positions, &target.normals, &target.tangents];
        let present = columns.iter().zip(COLUMNS).filter(|(column, _)| !column.is_empty());
        let flags: u32 = present.map(|(_, bit)| bit).sum();
        writer.text(&target.name);
        writer.put(Part::MorphTargets, &flags);
        for column in columns {
            writer.put_all(Part::Differences, column);
        }
    }
}

/// Reads the `count` targets of a primitive with this number of `vertices`.
pub(super) fn read_targets(
    reader: &mut Reader<'_, '_>,
    count: usize,
    vertices: usize,
) -> Result<Vec<MorphTarget>, ImportError> {
    let mut targets = reader.vec(Part::MorphTargets, 0, count)?;
    for _ in 0..count {
        let name = reader.text()?;
        let flags: u32 = reader.get(Part::MorphTargets)?;
        only_bits(flags, 7).map_err(|reason| reader.wrong(DFM_VALUE, reason))?;
        let mut columns: [Vec<Vec3>; 3] = [const { Vec::new() }; 3];
        for (column, bit) in columns.iter_mut().zip(COLUMNS) {
            if flags & bit != 0 {
                *column = reader.list(Part::Differences, vertices)?;
            }
        }
        let [positions, normals, tangents] = columns;
        targets.push(MorphTarget { name, positions, normals, tangents });
    }
    Ok(targets)
}
