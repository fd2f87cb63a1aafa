//! Where something was measured: the machine, the program and what it was built with.

use std::fs;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

/// A machine at a time, and this program.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// The name of the processor.
    pub processor: String,
    /// How many may run at once.
    pub processors: usize,
    /// Instruction sets beyond the base that it has and this program uses.
    pub instructions: Vec<&'static str>,
    /// The operating system's kernel.
    pub system: String,
    /// Bytes.
    pub memory: u64,
    /// Whether large allocations get large pages.
    pub huge_pages: String,
    /// Processes that wanted to run in the last minute, on average, when the measurement began.
    pub load: String,
    /// Of this program.
    pub version: &'static str,
    /// The Embree that it was built with.
    pub embree: &'static str,
    /// The compiler and its flags.
    pub compiler: &'static str,
    /// Seconds since 1970.
    pub time: u64,
}

impl Machine {
    /// This one, now. What the system does not tell is empty or 0.
    pub fn here() -> Self {
        let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
        let field = |text: &str, name: &str| {
            let line = text.lines().find(|line| line.starts_with(name));
            line.and_then(|line| line.split_once(':'))
                .map(|(_, value)| value.trim().to_owned())
        };
        let memory = field(&read("/proc/meminfo"), "MemTotal").unwrap_or_default();
        let kilobytes: u64 = memory.trim_end_matches("kB").trim().parse().unwrap_or(0);
        let chosen = |text: &str| {
            let inner = text.split_once('[').and_then(|(_, rest)| rest.split_once(']'));
            inner.map(|(word, _)| word.to_owned()).unwrap_or_default()
        };
        Self {
            processor: field(&read("/proc/cpuinfo"), "model name").unwrap_or_default(),
            processors: std::thread::available_parallelism().map_or(1, usize::from),
            instructions: instructions(),
            system: read("/proc/sys/kernel/osrelease").trim().to_owned(),
            memory: kilobytes * 1024,
            huge_pages: chosen(&read("/sys/kernel/mm/transparent_hugepage/enabled")),
            load: read("/proc/loadavg").split(' ').next().unwrap_or_default().to_owned(),
            version: env!("CARGO_PKG_VERSION"),
            embree: env!("LUCERNA_EMBREE_VERSION"),
            compiler: env!("LUCERNA_COMPILER"),
            time: SystemTime::now()
                .duration_since(UNIX_EPOCH)
                .map_or(0, |time| time.as_secs()),
        }
    }

    /// The day, as 2026-11-22 (by the algorithm of Hinnant, "chrono-Compatible Low-Level Date Algorithms", 2014).
    pub fn date(&self) -> String {
        let days = (self.time / 86_400) as i64 + 719_468;
        let (era, day_of_era) = (days / 146_097, days % 146_097);
        let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
        let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
        let shifted = (5 * day_of_year + 2) / 153;
        let day = day_of_year - (153 * shifted + 2) / 5 + 1;
        let month = if shifted < 10 { shifted + 3 } else { shifted - 9 };
        let year = year_of_era + era * 400 + i64::from(month <= 2);
        format!("{year}-{month:02}-{day:02}")
    }
}

fn instructions() -> Vec<&'static str> {
    let mut all = Vec::new();
    #[cfg(target_arch = "x86_64")]
    {
        let mut add = |name, has| {
            if has {
                all.push(name);
            }
        };
        add("AVX2", std::arch::is_x86_feature_detected!("avx2"));
        add("FMA", std::arch::is_x86_feature_detected!("fma"));
        add("AVX-512", std::arch::is_x86_feature_detected!("avx512f"));
    }
    all.shrink_to_fit();
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_have_dates() {
        let date = |time| {
            Machine {
                time,
                ..Machine::here()
            }
            .date()
        };
        assert_eq!(date(0), "1970-01-01");
        assert_eq!(date(951_782_400), "2000-02-29");
        assert_eq!(date(1_798_761_599), "2026-12-31");
        assert_eq!(date(1_798_761_600), "2027-01-01");
    }
}
