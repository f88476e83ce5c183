//! MP4 with H.264, which every player and browser shows.

use crate::error::MovieError;
use crate::error::refused;
use crate::frame::{LARGEST_SIDE, MovieFrame};
use crate::h264::{BT709, H264Encoder, ParameterSets};
use crate::mp4::{MovieLabel, Mp4File, plain_box, unencoded};
use crate::report::MovieReport;
use crate::settings::{GROUP, MovieSettings};
use crate::sound::MovieSound;
use crate::srgb::SrgbTable;
use crate::target::MovieTarget;
use crate::writer::{EndProgress, MovieFormat, MovieWriter};
use crate::yuv::YuvPicture;
use shiguredo_mp4::bitstream::h264::{H264SampleEntryConfig, LengthSize, build_avc1_box};
use shiguredo_mp4::boxes::SampleEntry;

pub(super) const MP4: MovieFormat = MovieFormat {
    name: "mp4",
    title: "MP4",
    extensions: &["mp4", "m4v"],
    has_alpha: false,
    is_linear: false,
    has_sound: true,
    is_sequence: false,
    can_stream: false,
    side: LARGEST_SIDE,
    begin: |settings, target, sound| Ok(Box::new(Mp4Writer::begin(settings, target, sound)?)),
};

struct Mp4Writer {
    file: Mp4File,
    encoder: H264Encoder,
    table: SrgbTable,
    rgb: Vec<u8>,
    picture: YuvPicture,
    notices: Vec<String>,
}

impl Mp4Writer {
    fn begin(
        settings: &MovieSettings,
        target: MovieTarget,
        sound: Option<MovieSound>,
    ) -> Result<Self, MovieError> {
        let wrong = |reason| MovieError::Settings { format: MP4.title, reason };
        let (files, path) = target.into_path(MP4.title)?;
        // Two columns and two rows share a sample of color.
        let size = settings.size.map(|side| side.next_multiple_of(2));
        let encoder = H264Encoder::new(size, settings).map_err(wrong)?;
        let mut notices = Vec::new();
        if size != settings.size {
            notices.push(format!(
                "{} × {} pixels became {} × {}: MP4 has even sizes, and the last column or row is repeated",
                settings.size[0], settings.size[1], size[0], size[1]
            ));
        }
        let label = MovieLabel {
            first: settings.first,
            group: GROUP,
            coarseness: settings.coarseness,
            tag: settings.tag.clone(),
        };
        Ok(Self {
            file: Mp4File::create(files, &path, label, settings.rate, sound)?,
            encoder,
            table: SrgbTable::new(),
            rgb: Vec::new(),
            picture: YuvPicture::new(size),
            notices,
        })
    }
}

impl MovieWriter for Mp4Writer {
    fn frame(&mut self, frame: MovieFrame<'_>, number: u64) -> Result<(), MovieError> {
        frame.to_opaque(&self.table, &mut self.rgb);
        self.picture.set(&self.rgb, frame.size());
        let encoded = self.encoder.picture(&self.picture, number).map_err(refused(number))?;
        let Self { file, encoder, .. } = self;
        file.picture(&encoded.bytes, encoded.is_whole, || {
            let parameters = encoder.parameters();
            let parameters = parameters.ok_or_else(|| refused(number)("it has no parameters".to_owned()))?;
            picture_entry(parameters).map_err(unencoded)
        })
    }

    fn end(self: Box<Self>, _: EndProgress<'_>) -> Result<MovieReport, MovieError> {
        self.file.end_with_room(self.notices)
    }
}

/// Returns the description of pictures with their color.
fn picture_entry(parameters: &ParameterSets) -> Result<SampleEntry, shiguredo_mp4::Error> {
    let config = H264SampleEntryConfig { length_size: LengthSize::FourBytes };
    let ParameterSets { sequence, pictures } = parameters;
    let mut entry = build_avc1_box(std::slice::from_ref(sequence), std::slice::from_ref(pictures), &config)?;
    // Primaries, transfer and matrix of BT.709, in limited range.
    let mut color = b"nclx".to_vec();
    (0..3).for_each(|_| color.extend(u16::from(BT709).to_be_bytes()));
    color.push(0);
    entry.unknown_boxes.push(plain_box(*b"colr", color));
    Ok(SampleEntry::Avc1(entry))
}
