//! The default audio device of the system, by the crate `cpal`.

use super::{OutputError, OutputVoice};
use cpal::traits::{DeviceTrait, HostTrait, StreamTrait};
use cpal::{BufferSize, FromSample, SampleFormat, SizedSample, StreamConfig, SupportedBufferSize};
use flume::Sender;
use std::time::Instant;

/// Frames that the device asks for at once, where it can: 21 ms at 48 kHz.
const BUFFER: u32 = 1024;
/// Frames that are computed at once.
const FRAMES: usize = 1024;

/// A device that asks for samples until this is dropped.
pub(super) struct OpenDevice {
    _stream: cpal::Stream,
}

impl OpenDevice {
    /// Opens the device; a failure after that goes to `fail`.
    pub(super) fn open(voice: OutputVoice, fail: Sender<String>) -> Result<Self, OutputError> {
        let device = cpal::default_host()
            .default_output_device()
            .ok_or_else(|| OutputError::Device("there is no audio device".to_owned()))?;
        let supported = device.default_output_config().map_err(failed)?;
        let (format, size) = (supported.sample_format(), *supported.buffer_size());
        let mut config = StreamConfig::from(supported);
        // Devices may have buffers of seconds, and the sound would follow the playhead that late.
        if let SupportedBufferSize::Range { min, max } = size
            && min <= max
        {
            config.buffer_size = BufferSize::Fixed(BUFFER.clamp(min, max));
        }
        let stream = match format {
            SampleFormat::F32 => stream::<f32>(&device, config, voice, fail),
            SampleFormat::I16 => stream::<i16>(&device, config, voice, fail),
            SampleFormat::I32 => stream::<i32>(&device, config, voice, fail),
            SampleFormat::U8 => stream::<u8>(&device, config, voice, fail),
            SampleFormat::U16 => stream::<u16>(&device, config, voice, fail),
            other => return Err(OutputError::Device(format!("the device wants samples as {other}"))),
        }?;
        stream.play().map_err(failed)?;
        Ok(Self { _stream: stream })
    }
}

fn failed(error: cpal::Error) -> OutputError {
    OutputError::Device(error.to_string())
}

fn stream<T: SizedSample + FromSample<f32>>(
    device: &cpal::Device,
    config: StreamConfig,
    mut voice: OutputVoice,
    fail: Sender<String>,
) -> Result<cpal::Stream, OutputError> {
    let (channels, rate) = (usize::from(config.channels).max(1), config.sample_rate);
    let mut frames = vec![[0.0; 2]; FRAMES];
    let fill = move |out: &mut [T], about: &cpal::OutputCallbackInfo| {
        let times = about.timestamp();
        let ahead = times.playback.duration_since(times.callback);
        let mut at = Instant::now() + ahead;
        for part in out.chunks_mut(FRAMES * channels) {
            let count = part.len().div_ceil(channels);
            voice.fill(at, rate, &mut frames[..count]);
            for (out, [left, right]) in part.chunks_mut(channels).zip(&frames) {
                let mono = [T::from_sample((left + right) / 2.0)];
                let sides = [T::from_sample(*left), T::from_sample(*right)];
                let heard: &[T] = if channels == 1 { &mono } else { &sides };
                for (number, sample) in out.iter_mut().enumerate() {
                    *sample = heard.get(number).copied().unwrap_or(T::EQUILIBRIUM);
                }
            }
            at += std::time::Duration::from_secs_f64(count as f64 / f64::from(rate.max(1)));
        }
    };
    let report = move |error: cpal::Error| {
        // Gaps end by themselves.
        if !matches!(error.kind(), cpal::ErrorKind::Xrun | cpal::ErrorKind::RealtimeDenied) {
            let _ = fail.try_send(error.to_string());
        }
    };
    device.build_output_stream(config, fill, report, None).map_err(failed)
}
