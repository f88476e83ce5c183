//! A desktop's dialog for opening files (the portal `org.freedesktop.portal.FileChooser`), answered by the test, on a bus of
//! its own.

use dragonfly_kit::folder::Folder;
use std::collections::HashMap;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;
use zbus::message::Header;
use zbus::zvariant::{OwnedObjectPath, OwnedValue, Value};

/// Configuration without activatable services: a call to a service that does not run fails at once.
const CONFIGURATION: &str = r#"<busconfig>
    <type>session</type>
    <listen>unix:tmpdir=/tmp</listen>
    <auth>EXTERNAL</auth>
    <policy context="default">
        <allow send_destination="*"/>
        <allow receive_sender="*"/>
        <allow own="*"/>
    </policy>
</busconfig>
"#;

/// A message bus for one test.
pub(crate) struct Bus {
    daemon: Child,
    address: String,
}

impl Bus {
    pub(crate) fn new() -> Self {
        let folder = Folder::new("bus");
        let configuration = folder.join("bus.xml");
        std::fs::write(&configuration, CONFIGURATION).expect("a file");
        let mut daemon = Command::new("dbus-daemon")
            .arg(format!("--config-file={}", configuration.display()))
            .args(["--nofork", "--nopidfile", "--print-address=1"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("dbus-daemon (Debian: dbus-daemon) starts");
        let mut address = String::new();
        // The bus prints its address once it listens.
        let read = BufReader::new(daemon.stdout.take().expect("piped")).read_line(&mut address);
        read.expect("the address of the bus");
        Self { daemon, address: address.trim().to_owned() }
    }

    /// Returns the value of `DBUS_SESSION_BUS_ADDRESS` with which a program finds this bus.
    pub(crate) fn address(&self) -> &str {
        &self.address
    }
}

impl Drop for Bus {
    fn drop(&mut self) {
        let _ = self.daemon.kill();
        let _ = self.daemon.wait();
    }
}

/// A request of a program for a file.
pub(crate) struct Question {
    pub(crate) title: String,
    /// Names of the other options that were passed.
    pub(crate) options: Vec<String>,
    sender: String,
    handle: OwnedObjectPath,
}

/// The user's response to the dialog.
pub(crate) enum Answer {
    /// Chooses the file with this address.
    File(String),
    /// Closes the dialog without a file.
    Nothing,
}

/// The portal.
pub(crate) struct Portal {
    connection: zbus::Connection,
    asked: Receiver<Question>,
}

/// The object of the portal on the bus.
struct Chooser(SyncSender<Question>);

#[zbus::interface(name = "org.freedesktop.portal.FileChooser")]
impl Chooser {
    async fn open_file(
        &self,
        #[zbus(header)] header: Header<'_>,
        _parent_window: String,
        title: String,
        options: HashMap<String, OwnedValue>,
    ) -> zbus::fdo::Result<OwnedObjectPath> {
        let wrong = |what: &str| zbus::fdo::Error::InvalidArgs(what.to_owned());
        let sender = header.sender().ok_or_else(|| wrong("no sender"))?.to_string();
        let token = options.get("handle_token").and_then(|token| token.downcast_ref::<&str>().ok());
        let path = format!(
            "/org/freedesktop/portal/desktop/request/{}/{}",
            sender.trim_start_matches(':').replace('.', "_"),
            token.ok_or_else(|| wrong("no token"))?
        );
        let handle = OwnedObjectPath::try_from(path).map_err(|_| wrong("no path"))?;
        let options = options.keys().cloned().collect();
        // A request after the end of the test gets no answer, as from a dialog that stays open.
        let _ = self.0.send(Question { title, options, sender, handle: handle.clone() });
        Ok(handle)
    }
}

impl Portal {
    pub(crate) fn new(bus: &Bus) -> Self {
        let (sender, asked) = sync_channel(16);
        let build = async {
            zbus::connection::Builder::address(bus.address())?
                .serve_at("/org/freedesktop/portal/desktop", Chooser(sender))?
                .name("org.freedesktop.portal.Desktop")?
                .build()
                .await
        };
        Self { connection: pollster::block_on(build).expect("a portal on the bus"), asked }
    }

    /// Blocks until a program asks for a file.
    #[track_caller]
    pub(crate) fn question(&self, limit: Duration) -> Question {
        self.asked.recv_timeout(limit).expect("no program asked for a file")
    }

    /// Answers a question.
    pub(crate) fn answer(&self, question: &Question, answer: &Answer) {
        let response = match answer {
            Answer::File(address) => (0u32, HashMap::from([("uris", Value::from(vec![address.as_str()]))])),
            Answer::Nothing => (1, HashMap::new()),
        };
        let told = self.connection.emit_signal(
            Some(question.sender.as_str()),
            &question.handle,
            "org.freedesktop.portal.Request",
            "Response",
            &response,
        );
        pollster::block_on(told).expect("the bus takes an answer");
    }
}
