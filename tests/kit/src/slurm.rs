//! A Slurm cluster of one node, this machine, with its own controller and configuration.

use crate::eventually;
use crate::folder::Folder;
use crate::skip::{TestNeed, skip};
use std::fs::{self, File};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// How long the programs of Slurm may take for anything.
const LIMIT: Duration = Duration::from_secs(60);

/// A running cluster. Its programs end when the value is dropped.
#[derive(Debug)]
pub struct SlurmCluster {
    folder: Folder,
    programs: Vec<Child>,
}

impl SlurmCluster {
    /// Starts `slurmctld` and `slurmd`, and waits until the node takes jobs. Skips where they are not installed, or where
    /// only root may start them.
    pub fn start() -> Option<Self> {
        let missing = |program: &&str| Command::new(program).arg("-V").output().is_err();
        if let Some(program) = ["slurmctld", "slurmd", "sbatch"].iter().find(|program| missing(program)) {
            skip(TestNeed::Farm, format!("the command {program} is not installed"));
            return None;
        }
        #[cfg(unix)]
        if !rustix::process::geteuid().is_root() {
            skip(TestNeed::Root, "slurmd starts jobs as root only");
            return None;
        }
        let folder = Folder::new("slurm");
        let host = output(Command::new("hostname").arg("-s"));
        let host = host.trim();
        fs::write(folder.join("slurm.conf"), configuration(&folder, host)).expect("a file");
        let mut cluster = Self { folder, programs: Vec::new() };
        cluster.launch("slurmctld", &[]);
        cluster.launch("slurmd", &["-N", host]);
        eventually(LIMIT, || {
            output(cluster.command("sinfo").args(["--noheader", "--format=%t"])).trim() == "idle"
        });
        Some(cluster)
    }

    /// Returns a command of Slurm for this cluster, for example `sbatch`.
    pub fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.folder.join("slurm.conf"));
        command
    }

    fn launch(&mut self, program: &str, arguments: &[&str]) {
        let log = File::create(self.folder.join(&format!("{program}.log"))).expect("a file");
        let configuration = self.folder.join("slurm.conf");
        let mut command = self.command(program);
        command.arg("-D").arg("-f").arg(configuration).args(arguments);
        let copy = log.try_clone().expect("a handle");
        command.stdin(Stdio::null()).stdout(log).stderr(copy);
        self.programs.push(command.spawn().expect("a program of Slurm"));
    }
}

impl Drop for SlurmCluster {
    fn drop(&mut self) {
        // The node first, so that it does not look for its controller.
        for program in self.programs.iter_mut().rev() {
            let _ = program.kill();
            let _ = program.wait();
        }
    }
}

/// Returns the configuration of a cluster whose state is in `folder`. There is no authentication: it only listens on this
/// machine.
fn configuration(folder: &Folder, host: &str) -> String {
    let state = folder.join("state");
    let spool = folder.join("spool");
    for path in [&state, &spool] {
        fs::create_dir_all(path).expect("a folder");
    }
    let [controller, node] = free_ports();
    let path = |path: &Path| path.display().to_string();
    format!(
        "ClusterName=test\nSlurmctldHost={host}(127.0.0.1)\nSlurmctldPort={controller}\nSlurmdPort={node}\n\
         AuthType=auth/none\nCredType=cred/none\nSlurmUser=root\nSlurmdUser=root\nMpiDefault=none\n\
         StateSaveLocation={}\nSlurmdSpoolDir={}\nSlurmctldPidFile={}\nSlurmdPidFile={}\n\
         ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nJobAcctGatherType=jobacct_gather/none\n\
         SelectType=select/cons_tres\nSelectTypeParameters=CR_CPU\nReturnToService=2\n\
         SchedulerParameters=sched_interval=1,batch_sched_delay=0\n\
         NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\n\
         PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n",
        path(&state),
        path(&spool),
        path(&folder.join("slurmctld.pid")),
        path(&folder.join("slurmd.pid")),
    )
}

/// Returns two ports that no program listens at now.
fn free_ports() -> [u16; 2] {
    let open = || TcpListener::bind("127.0.0.1:0").expect("a port");
    [open(), open()].map(|listener| listener.local_addr().expect("an address").port())
}

/// Returns what a command prints.
fn output(command: &mut Command) -> String {
    let done = command.output().expect("a program");
    String::from_utf8_lossy(&done.stdout).into_owned()
}
