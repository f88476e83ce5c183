//! Ogg Vorbis, by the crate `lewton`.

use super::{Decoder, SoundFormat};
use lewton::VorbisError;
use lewton::inside_ogg::OggStreamReader;
use std::fs::File;
use std::io::BufReader;

pub(super) const VORBIS: SoundFormat = SoundFormat {
    title: "Ogg Vorbis",
    extensions: &["ogg", "oga"],
    sniff: |start| start.starts_with(b"OggS"),
    open: |reader| Ok(Box::new(Vorbis(OggStreamReader::new(reader).map_err(text)?))),
};

struct Vorbis(OggStreamReader<BufReader<File>>);

fn text(error: VorbisError) -> String {
    error.to_string()
}

impl Decoder for Vorbis {
    fn rate(&self) -> u32 {
        self.0.ident_hdr.audio_sample_rate
    }

    fn channels(&self) -> usize {
        usize::from(self.0.ident_hdr.audio_channels)
    }

    fn read(&mut self, out: &mut Vec<f32>) -> Result<bool, String> {
        let Some(packet) = self.0.read_dec_packet_itl().map_err(text)? else { return Ok(false) };
        out.extend(packet.into_iter().map(|sample| f32::from(sample) / 32768.0));
        Ok(true)
    }
}
