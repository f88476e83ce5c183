//! Playing a mix: commands from the main thread, and the device that asks for samples in a thread of its own.

#[cfg(feature = "audio")]
mod device;
mod voice;

pub use voice::{OutputCommand, OutputVoice, SoundClock};

use flume::{Receiver, Sender};

/// Commands that may wait for the device, which takes them many times a second.
const WAITING: usize = 64;

/// Reasons why no sound is played.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum OutputError {
    /// The program was built without the feature `audio`.
    #[error("this program was built without sound output (feature \"audio\")")]
    NotBuilt,
    /// There is no device, or it cannot be used.
    #[error("{0}")]
    Device(String),
}

/// An audio device that follows commands. It stops when this is dropped.
pub struct SoundOutput {
    commands: Sender<OutputCommand>,
    /// Mixes that the device no longer plays: their memory is freed here, since freeing takes time that the device does not have.
    used: Receiver<OutputCommand>,
    failures: Receiver<String>,
    #[cfg(feature = "audio")]
    _device: Option<device::OpenDevice>,
}

impl std::fmt::Debug for SoundOutput {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "SoundOutput({} commands wait)", self.commands.len())
    }
}

impl SoundOutput {
    /// Opens the default device of the system, silent until the first command.
    ///
    /// # Errors
    ///
    /// There is no device, or the program has no sound output.
    pub fn open() -> Result<Self, OutputError> {
        #[cfg(feature = "audio")]
        {
            let (output, voice, fail) = Self::connected();
            let device = device::OpenDevice::open(voice, fail)?;
            Ok(Self { _device: Some(device), ..output })
        }
        #[cfg(not(feature = "audio"))]
        Err(OutputError::NotBuilt)
    }

    /// Returns an output without a device, and the voice that the caller asks for samples instead.
    pub fn without_device() -> (Self, OutputVoice) {
        let (output, voice, _) = Self::connected();
        (output, voice)
    }

    fn connected() -> (Self, OutputVoice, Sender<String>) {
        let (commands, waiting) = flume::bounded(WAITING);
        let (freed, used) = flume::bounded(WAITING);
        let (fail, failures) = flume::bounded(1);
        let output = Self {
            commands,
            used,
            failures,
            #[cfg(feature = "audio")]
            _device: None,
        };
        (output, OutputVoice::new(waiting, freed), fail)
    }

    /// Sends a command. Returns the reason where the device no longer works; it is never asked twice.
    ///
    /// # Errors
    ///
    /// The device was unplugged, or does not take commands any more.
    pub fn send(&self, command: OutputCommand) -> Result<(), OutputError> {
        self.used.try_iter().for_each(drop);
        if let Ok(reason) = self.failures.try_recv() {
            return Err(OutputError::Device(reason));
        }
        self.commands
            .try_send(command)
            .map_err(|_| OutputError::Device("the device does not answer".to_owned()))
    }
}
