//! What the operating system tells about the machine and this process.

use std::path::Path;

use crate::files::read_file;

/// Name of the processor, if the system tells it.
pub fn processor() -> String {
    let text = read_system_file("/proc/cpuinfo").unwrap_or_default();
    let line = text.lines().find(|line| line.starts_with("model name"));
    let name = line.and_then(|line| line.split_once(':'));
    let name = name.map_or("unknown processor", |(_, name)| name.trim());
    name.replace("(R)", "").replace("(TM)", "")
}

/// Resident memory of this process in bytes, if the system tells it.
pub fn resident_bytes() -> Option<u64> {
    let text = read_system_file("/proc/self/status")?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

fn read_system_file(path: &str) -> Option<String> {
    String::from_utf8(read_file(Path::new(path)).ok()?).ok()
}
