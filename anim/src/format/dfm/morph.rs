//! Morph targets: offsets of vertices.

use super::code::DFM_VALUE;
use super::part::DfmPart;
use super::reader::DfmReader;
use super::record::only_bits;
use super::writer::DfmWriter;
use crate::data::MorphTarget;
use crate::format::ImportError;
use glam::Vec3;

/// Bits of the columns that a target has: positions, normals, tangents.
const COLUMNS: [u32; 3] = [1, 2, 4];

/// Writes the targets of one primitive.
pub(super) fn write_targets(targets: &[MorphTarget], writer: &mut DfmWriter) {
    for target in targets {
        let columns = [&target.positions, &target.normals, &target.tangents];
        let present = columns.iter().zip(COLUMNS).filter(|(column, _)| !column.is_empty());
        let flags: u32 = present.map(|(_, bit)| bit).sum();
        writer.text(&target.name);
        writer.put(DfmPart::MorphTargets, &flags);
        for column in columns {
            writer.put_all(DfmPart::Differences, column);
        }
    }
}

/// Reads the `count` targets of a primitive with this number of `vertices`.
pub(super) fn read_targets(
    reader: &mut DfmReader<'_, '_>,
    count: usize,
    vertices: usize,
) -> Result<Vec<MorphTarget>, ImportError> {
    let mut targets = reader.vec(DfmPart::MorphTargets, 0, count)?;
    for _ in 0..count {
        let name = reader.text()?;
        let flags: u32 = reader.get(DfmPart::MorphTargets)?;
        only_bits(flags, 7).map_err(|reason| reader.wrong(DFM_VALUE, reason))?;
        let mut columns: [Vec<Vec3>; 3] = [const { Vec::new() }; 3];
        for (column, bit) in columns.iter_mut().zip(COLUMNS) {
            if flags & bit != 0 {
                *column = reader.list(DfmPart::Differences, vertices)?;
            }
        }
        let [positions, normals, tangents] = columns;
        targets.push(MorphTarget { name, positions, normals, tangents });
    }
    Ok(targets)
}
