//! ozz-animation and ACL, measured in turns with this library.
//!
//! `DRAGONFLY_RIVALS` names a folder with their sources and drivers, or with an archive of both (`rivals.tar.xz`). The
//! script `build` in this folder compiles them into the target folder. Each rival then runs as one process that waits for
//! lines "case calls" and answers with the nanoseconds that the calls took.

use crate::case::{BenchCase, RunCase};
use std::cell::RefCell;
use std::env;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::rc::Rc;

/// Environment variable with the folder of the rivals.
pub(crate) const FOLDER: &str = "DRAGONFLY_RIVALS";

/// Variant, task of this bench, and name of the case in the driver of the rival.
///
/// `ozz` plays takes whose keys were reduced with an error of 1 mm at 10 cm, `ozz/every_key` takes with every key, `ACL`
/// takes compressed to 0.1 mm at 3 cm.
const CASES: [(&str, &str, &str); 33] = [
    ("ozz", "sample/pab/walk/forward", "sample_fwd60/walk.opt"),
    ("ozz", "sample/pab/walk/random", "sample_rand/walk.opt"),
    ("ozz", "sample/pab/atlas/forward", "sample_fwd60/atlas.opt"),
    ("ozz", "sample/pab/atlas/backward", "sample_bwd60/atlas.opt"),
    ("ozz", "sample/pab/atlas/random", "sample_rand/atlas.opt"),
    ("ozz/every_key", "sample/pab/walk/forward", "sample_fwd60/walk.full"),
    ("ozz/every_key", "sample/pab/atlas/forward", "sample_fwd60/atlas.full"),
    ("ozz/every_key", "sample/pab/atlas/random", "sample_rand/atlas.full"),
    ("ozz", "to_root/pab", "ltm"),
    ("ozz", "final/pab", "skin_matrices(per mesh joint)"),
    ("ozz", "blend/pab/2/whole", "blend2"),
    ("ozz", "blend/pab/4/whole", "blend4"),
    ("ozz", "blend/pab/2/masked", "blend2_masked"),
    ("ozz", "blend/pab/4/masked", "blend4_masked"),
    ("ozz", "two_bone/pab", "ik_two_bone(per solve)"),
    ("ozz", "skin/pab/1", "skin_PN_1inf(per vertex)"),
    ("ozz", "skin/pab/2", "skin_PN_2inf(per vertex)"),
    ("ozz", "skin/pab/4", "skin_PN_4inf(per vertex)"),
    ("ozz", "skin_by_matrix/pab/1", "skin_PN_1inf(per vertex)"),
    ("ozz", "skin_by_matrix/pab/2", "skin_PN_2inf(per vertex)"),
    ("ozz", "skin_by_matrix/pab/4", "skin_PN_4inf(per vertex)"),
    ("ozz", "pipeline/pab/1", "pipeline1(per char)/walk.opt"),
    ("ozz/every_key", "pipeline/pab/1", "pipeline1(per char)/walk.full"),
    ("ozz", "pipeline/pab/100", "crowd100(per char)/opt"),
    ("ozz", "pipeline/pab/1000", "crowd1000(per char)/opt"),
    ("ACL", "sample/pab/walk/forward", "acl_fwd60/walk"),
    ("ACL", "sample/pab/walk/random", "acl_rand/walk"),
    ("ACL", "sample/pab/atlas/forward", "acl_fwd60/atlas"),
    ("ACL", "sample/pab/atlas/random", "acl_rand/atlas"),
    ("ACL", "to_root/pab", "rtm_ltm_3x4"),
    ("ACL", "pipeline/pab/1", "acl_pipeline1(per char)/walk"),
    ("ACL", "pipeline/pab/100", "acl_crowd100(per char)"),
    ("ACL", "pipeline/pab/1000", "acl_crowd1000(per char)"),
];

/// The built programs of the rivals.
pub(crate) struct Rivals {
    folder: PathBuf,
}

/// Size and error of one take compressed by a rival.
pub(crate) struct RivalSize {
    pub(crate) take: String,
    pub(crate) setting: String,
    pub(crate) codec: String,
    pub(crate) bytes: f64,
    /// Largest error at any key, in millimeters.
    pub(crate) error: f64,
    /// Time to compress, in seconds.
    pub(crate) seconds: f64,
}

impl Rivals {
    /// Builds the rivals in the folder that [`FOLDER`] names; `None` if the variable is not set.
    pub(crate) fn build() -> Result<Option<Self>, String> {
        let Some(sources) = env::var_os(FOLDER) else { return Ok(None) };
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        // Cargo runs a bench in the folder of its package, so a relative path is also tried from the root of the
        // repository.
        let sources =
            [Path::new(&sources).to_owned(), root.join(&sources)].into_iter().find(|path| path.is_dir());
        let sources = sources.ok_or_else(|| format!("{FOLDER} names no folder"))?;
        let folder = target()?.join("rivals");
        let built = Command::new(root.join("benches/anim/rivals/build")).arg(sources).arg(&folder).status();
        match built {
            Ok(status) if status.success() => Ok(Some(Self { folder })),
            Ok(status) => Err(format!("the rivals cannot be built: {status}")),
            Err(error) => Err(format!("the rivals cannot be built: {error}")),
        }
    }

    /// Starts the rivals and returns their cases.
    pub(crate) fn cases(&self) -> Result<Vec<BenchCase>, String> {
        let ozz = RivalProcess::start(&self.folder, "ozz_turns", &["data", "--serve"])?;
        let acl = RivalProcess::start(&self.folder, "acl_turns", &["bench", "data", "--serve"])?;
        CASES.iter().map(|case| case_of(case, if case.0 == "ACL" { &acl } else { &ozz })).collect()
    }

    /// Compresses the takes of the bench rig with the rivals.
    pub(crate) fn sizes(&self) -> Result<Vec<RivalSize>, String> {
        let output =
            Command::new(self.folder.join("acl_sizes")).current_dir(&self.folder).arg("data").output();
        let output = output.map_err(|error| format!("acl_sizes does not start: {error}"))?;
        let text = String::from_utf8_lossy(&output.stdout);
        let size = |line: &str| {
            let [take, setting, codec, bytes, error, seconds] = line.split('\t').collect::<Vec<_>>()[..]
            else {
                return Err(format!("acl_sizes printed: {line}"));
            };
            let number = |text: &str| text.parse::<f64>().map_err(|error| format!("{line}: {error}"));
            Ok(RivalSize {
                take: take.to_owned(),
                setting: setting.to_owned(),
                codec: codec.to_owned(),
                bytes: number(bytes)?,
                error: number(error)?,
                seconds: number(seconds)?,
            })
        };
        text.lines().map(size).collect()
    }

    /// Returns names and values of what the results of the rivals depend on: versions, compiler, flags.
    pub(crate) fn versions(&self) -> Vec<(String, String)> {
        let text = std::fs::read_to_string(self.folder.join("versions")).unwrap_or_default();
        text.lines()
            .filter_map(|line| line.split_once(": "))
            .map(|(a, b)| (a.to_owned(), b.to_owned()))
            .collect()
    }
}

/// Returns the target folder, in which this program was built.
pub(crate) fn target() -> Result<PathBuf, String> {
    // target/release/deps/anim-…
    let program = env::current_exe().map_err(|error| format!("the bench does not find itself: {error}"))?;
    program
        .ancestors()
        .nth(3)
        .map(Path::to_owned)
        .ok_or_else(|| "the bench is in no target folder".to_owned())
}

fn case_of(
    &(variant, task, name): &(&str, &str, &str),
    process: &Rc<RefCell<RivalProcess>>,
) -> Result<BenchCase, String> {
    let all = &process.borrow().cases;
    let index =
        all.iter().position(|(other, _)| other == name).ok_or_else(|| format!("no rival has {name}"))?;
    let unit = unit_of(task);
    let shared = Rc::clone(process);
    let case = BenchCase::with(variant, task, all[index].1, unit, move || {
        Box::new(RivalCase { process: shared, index }) as Box<dyn RunCase>
    });
    // The playback orders of one take (forward, backward, random) form one group, as for this library.
    let group = task.starts_with("sample/").then(|| task.rsplit_once('/').map(|(group, _)| group.to_owned()));
    Ok(match group.flatten() {
        Some(group) => case.among(group),
        None => case,
    })
}

/// Returns the unit of a task of the rivals.
fn unit_of(task: &str) -> &'static str {
    match task.split('/').next() {
        Some("final") => "joint",
        Some("two_bone") => "solve",
        Some("skin" | "skin_by_matrix") => "vertex",
        Some("pipeline") => "character",
        Some(_) | None => "bone",
    }
}

/// Returns variant, task and unit of each case whose driver calls it `name`.
pub(crate) fn tasks_of(name: &str) -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
    CASES.iter().filter(move |case| case.2 == name).map(|&(variant, task, _)| (variant, task, unit_of(task)))
}

thread_local! {
    static PROCESSES: RefCell<Vec<u32>> = const { RefCell::new(Vec::new()) };
}

/// Returns the ids of the processes of the rivals.
pub(crate) fn processes() -> Vec<u32> {
    PROCESSES.with_borrow(Vec::clone)
}

/// A running rival, and the names and units of its cases.
struct RivalProcess {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    cases: Vec<(String, usize)>,
}

impl RivalProcess {
    fn start(folder: &Path, program: &str, arguments: &[&str]) -> Result<Rc<RefCell<Self>>, String> {
        let mut command = Command::new(folder.join(program));
        command.args(arguments).current_dir(folder).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().map_err(|error| format!("{program} does not start: {error}"))?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(format!("{program} has no pipes"));
        };
        PROCESSES.with_borrow_mut(|all| all.push(child.id()));
        let mut process = Self { child, input, output: BufReader::new(output), cases: Vec::new() };
        loop {
            let line = process.line()?;
            let Some((name, units)) = line.trim_end().split_once('\t') else { break };
            let units = units.parse().map_err(|error| format!("{program} printed {line}: {error}"))?;
            process.cases.push((name.to_owned(), units));
        }
        Ok(Rc::new(RefCell::new(process)))
    }

    fn line(&mut self) -> Result<String, String> {
        let mut line = String::new();
        match self.output.read_line(&mut line) {
            Ok(0) => Err("a rival has ended".to_owned()),
            Ok(_) => Ok(line),
            Err(error) => Err(format!("a rival cannot be read: {error}")),
        }
    }

    fn run(&mut self, index: usize, calls: usize) -> Result<f64, String> {
        writeln!(self.input, "{index} {calls}")
            .map_err(|error| format!("a rival cannot be written to: {error}"))?;
        let line = self.line()?;
        line.trim_end().parse().map_err(|error| format!("a rival printed {line}: {error}"))
    }
}

impl Drop for RivalProcess {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// One case of a rival.
struct RivalCase {
    process: Rc<RefCell<RivalProcess>>,
    index: usize,
}

impl RunCase for RivalCase {
    fn call(&mut self) {
        self.run(1);
    }

    fn run(&mut self, calls: usize) -> f64 {
        let time = self.process.borrow_mut().run(self.index, calls);
        time.expect("a rival runs as long as the bench")
    }
}
