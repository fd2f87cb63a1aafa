//! `--pin`: which processors this process runs on.

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

use crate::error::{Error, Result};

/// Confines this process, which has one thread so far, to processors.
///
/// # Errors
/// [`Error::Usage`] if any of them is not there.
pub fn pin(wanted: &str) -> Result<()> {
    let there = allowed();
    let refused = || {
        let there = there.as_deref().map_or(String::new(), |list| format!(": {list}"));
        Error::Usage(format!(
            "--pin {wanted}: expected processors, as in 0,2-3, of those that there are{there}"
        ))
    };
    let set = numbers(wanted).ok_or_else(refused)?;
    let pid = std::process::id().to_string();
    let output = Command::new("taskset").args(["-c", "-p", wanted, &pid]).output();
    let output = output.map_err(|error| Error::Usage(format!("--pin needs `taskset` (of util-linux): {error}")))?;
    // Of processors some of which are there the system takes those, and says nothing.
    let is_whole = allowed().is_none_or(|list| numbers(&list) == Some(set));
    if output.status.success() && is_whole {
        Ok(())
    } else {
        Err(refused())
    }
}

/// The processors that this process may run on, as in `0,2-3`; `None` where the system does not tell.
fn allowed() -> Option<String> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let list = status
        .lines()
        .find_map(|line| line.strip_prefix("Cpus_allowed_list:"))?;
    Some(list.trim().to_owned())
}

/// The numbers of a list of numbers and ranges, these with a step if they have one, as in `0-6:2`.
fn numbers(list: &str) -> Option<BTreeSet<u32>> {
    /// More than any machine has.
    const LARGEST: u32 = 1 << 16;
    let number = |text: &str| text.parse::<u32>().ok().filter(|&n| n <= LARGEST);
    let mut all = BTreeSet::new();
    for part in list.split(',') {
        let (range, step) = part.split_once(':').unwrap_or((part, "1"));
        let (first, last) = range.split_once('-').unwrap_or((range, range));
        let (first, last, step) = (number(first)?, number(last)?, number(step)?);
        if first > last || step == 0 {
            return None;
        }
        all.extend((first..=last).step_by(step as usize));
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::numbers;

    #[test]
    fn lists_of_processors_are_numbers_ranges_and_steps() {
        let set = |list| numbers(list).map(Vec::from_iter);
        assert_eq!(set("3"), Some(vec![3]));
        assert_eq!(set("0,2-3,3"), Some(vec![0, 2, 3]));
        assert_eq!(set("1-6:2,0"), Some(vec![0, 1, 3, 5]));
        for bad in ["", "a", "3-1", "0-", "-1", "0-4:0", "0-4294967295"] {
            assert_eq!(set(bad), None, "{bad}");
        }
    }
}
