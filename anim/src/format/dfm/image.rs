//! Images: the data and file names of the thesis's materials, stored once for all materials.

use super::error::{WriteError, refuse};
use super::part::DfmPart;
use super::reader::DfmReader;
use super::record::{DfmRecord, Put, RecordFields, only_bits};
use super::writer::DfmWriter;
use crate::data::{Image, ModelData};
use crate::format::ImportError;
use crate::limits::{IMAGE_PIXELS, IMAGE_SIDE, IMAGES_PIXELS};

/// An image without names and bytes.
pub(super) struct ImageRecord {
    has_file_name: bool,
    width: u32,
    height: u32,
    bytes: u32,
}

impl DfmRecord for ImageRecord {
    const SIZE: usize = 16;

    fn put(&self, out: &mut Vec<u8>) {
        for number in [self.has_file_name.into(), self.width, self.height, self.bytes] {
            out.u32(number);
        }
    }

    fn get(fields: &mut RecordFields<'_>) -> Result<Self, String> {
        let has_file_name = only_bits(fields.u32(), 1)? == 1;
        Ok(Self { has_file_name, width: fields.u32(), height: fields.u32(), bytes: fields.u32() })
    }
}

/// Writes every image of `model`.
pub(super) fn write(model: &ModelData, writer: &mut DfmWriter) -> Result<(), WriteError> {
    for (number, image) in model.images.iter().enumerate() {
        writer.text(&image.name);
        if let Some(file_name) = &image.file_name {
            writer.text(file_name);
        }
        writer.text(&image.mime);
        let bytes = u32::try_from(image.bytes.len())
            .map_err(|_| refuse(format!("/images/{number}"), "more than 4 GiB".to_owned()))?;
        let has_file_name = image.file_name.is_some();
        let (width, height) = (image.width, image.height);
        writer.put(DfmPart::Images, &ImageRecord { has_file_name, width, height, bytes });
        writer.bytes(DfmPart::ImageBytes, &image.bytes);
    }
    Ok(())
}

/// Reads every image.
pub(super) fn read(reader: &mut DfmReader<'_, '_>) -> Result<Vec<Image>, ImportError> {
    let count = reader.count(DfmPart::Images);
    let mut images = reader.vec(DfmPart::Images, 0, count)?;
    let mut pixels = 0u64;
    for _ in 0..count {
        let name = reader.text()?;
        let record: ImageRecord = reader.get(DfmPart::Images)?;
        let side = record.width.max(record.height) as usize;
        let own = u64::from(record.width) * u64::from(record.height);
        pixels = pixels.saturating_add(own);
        reader.limit("pixels along one side", side, IMAGE_SIDE)?;
        reader.limit("pixels of one image", own, IMAGE_PIXELS)?;
        reader.limit("pixels of all images", pixels, IMAGES_PIXELS)?;
        let file_name = if record.has_file_name { Some(reader.text()?) } else { None };
        let mime = reader.text()?;
        let bytes = reader.bytes(DfmPart::ImageBytes, record.bytes as usize)?.into();
        images.push(Image { name, file_name, mime, bytes, width: record.width, height: record.height });
    }
    Ok(images)
}
