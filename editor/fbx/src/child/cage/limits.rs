//! Limits of the process, which every Unix system has.

use crate::child::CPU_SECONDS;
use rustix::process::{Resource, Rlimit, setrlimit};

/// Memory beyond that of the import: stacks, the allocator.
const SPARE_BYTES: u64 = 64 << 20;

/// Address space of the program when it cannot be measured.
const PROGRAM_BYTES: u64 = 1 << 30;

/// Sets all limits, for a program with `program` bytes of address space. Returns those that the system refused.
///
/// The address space is that of the program, and twice the memory of the import: the model, and its bytes in the
/// answer. No file can be written or opened, no process started, no memory image left.
pub(super) fn set(program: u64, memory: u64) -> Vec<String> {
    let space = program.saturating_add(memory.saturating_mul(2)).saturating_add(SPARE_BYTES);
    let limits = [
        ("memory", Resource::As, space, space),
        // One second between the signal that can be handled and the one that cannot.
        ("time", Resource::Cpu, CPU_SECONDS, CPU_SECONDS + 1),
        ("file size", Resource::Fsize, 0, 0),
        // Standard input, output and messages are open already.
        ("open files", Resource::Nofile, 3, 3),
        ("processes", Resource::Nproc, 0, 0),
        ("memory image", Resource::Core, 0, 0),
    ];
    let set = |(name, resource, current, maximum)| {
        let limit = Rlimit { current: Some(current), maximum: Some(maximum) };
        setrlimit(resource, limit).err().map(|error| format!("limit of {name}: {error}"))
    };
    limits.into_iter().filter_map(set).collect()
}

/// Returns the address space of this process.
pub(super) fn program_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let size = status.lines().find_map(|line| line.strip_prefix("VmSize:"));
    let kibibytes = size.and_then(|size| size.trim().strip_suffix("kB")?.trim().parse::<u64>().ok());
    kibibytes.map_or(PROGRAM_BYTES, |kibibytes| kibibytes * 1024)
}
