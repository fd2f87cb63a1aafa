//! How much memory there is.

use std::fs;

/// Memory that can be had without swapping: what the system says is available, or what the process's control group leaves if that is
/// less. `None` where neither is told.
pub fn available_bytes() -> Option<u64> {
    let system = fs::read_to_string("/proc/meminfo").ok().and_then(|text| {
        let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
        line.trim().trim_end_matches("kB").trim().parse::<u64>().ok()
    });
    let system = system.map(|kilobytes| kilobytes * 1024);
    [system, left_in_group()].into_iter().flatten().min()
}

/// What the control group (version 2) has left; `None` if it sets no limit.
fn left_in_group() -> Option<u64> {
    let read = |file: &str| {
        let text = fs::read_to_string(format!("/sys/fs/cgroup/{file}")).ok()?;
        text.trim().parse::<u64>().ok()
    };
    Some(read("memory.max")?.saturating_sub(read("memory.current")?))
}

/// So many bytes, for people.
pub fn in_words(bytes: u64) -> String {
    const GIB: u64 = 1 << 30;
    if bytes >= GIB {
        format!("{:.1} GiB", bytes as f64 / GIB as f64)
    } else {
        format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
    }
}
