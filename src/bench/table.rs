//! A report for terminals.

use std::fmt::{self, Write};

use super::contenders::Family;
use super::report::{CaseReport, RateReport, Report, StreamReport, geometric_mean};

/// Width of a column of rates.
const COLUMN: usize = 15;

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let m = &self.machine;
        writeln!(
            f,
            "{}, {} at once, {}",
            m.processor,
            m.processors,
            m.instructions.join(" ")
        )?;
        writeln!(f, "lucerna {} ({}), Embree {}", m.version, m.compiler, m.embree)?;
        let pinned = self
            .pinned
            .as_ref()
            .map_or(String::new(), |cpus| format!(", on processors {cpus}"));
        writeln!(
            f,
            "{} turns, seed {}{pinned}, load {} at the start",
            self.turns, self.seed, m.load
        )?;
        for case in &self.cases {
            self.write_case(f, case)?;
        }
        self.write_ratios(f)
    }
}

impl Report {
    fn write_case(&self, f: &mut fmt::Formatter<'_>, case: &CaseReport) -> fmt::Result {
        writeln!(f, "\n{}: {} primitives", case.name, case.instanced_primitives)?;
        if case.one_at_a_time {
            let drift = case.drift.map_or(String::new(), |drift| {
                format!("; the first, repeated at the end, had {drift:.3} of its rates")
            });
            writeln!(
                f,
                "  built and measured one at a time, as all together need too much memory{drift}"
            )?;
        }
        for build in &case.builds {
            let name = format!("{} {}", build.family.name(), build.quality);
            writeln!(
                f,
                "  {name:24}built in {:8.3} s on {} thread{}, {:6.1} bytes a primitive",
                build.seconds,
                build.threads,
                if build.threads == 1 { "" } else { "s" },
                build.bytes_per_primitive
            )?;
        }
        write!(f, "\n  {:46}", "million rays a second, half the quartiles' range")?;
        for stream in &case.streams {
            write!(f, "{:>COLUMN$}", stream.kind)?;
        }
        writeln!(f)?;
        for row in rows(case) {
            write!(f, "  {row:46}")?;
            for stream in &case.streams {
                let result = stream.results.iter().find(|result| row_name(result) == row);
                write!(
                    f,
                    "{:>COLUMN$}",
                    result.map_or(String::new(), |result| cell(stream, result))
                )?;
            }
            writeln!(f)?;
        }
        write_differences(f, case)
    }

    /// Our rates over those of Embree, by case and kind of ray.
    fn write_ratios(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kinds = self.kinds();
        for family in [Family::EmbreeFast, Family::EmbreeRobust] {
            let any = self
                .cases
                .iter()
                .any(|case| kinds.iter().any(|kind| self.ratio(case, kind, family).is_some()));
            if !any {
                continue;
            }
            write!(f, "\n{:48}", format!("bvh over {}, its best call", family.name()))?;
            kinds.iter().try_for_each(|kind| write!(f, "{kind:>COLUMN$}"))?;
            writeln!(f)?;
            let write_row = |f: &mut fmt::Formatter<'_>, name: &str, ratio: &dyn Fn(&str) -> Option<f64>| {
                write!(f, "  {name:46}")?;
                for kind in &kinds {
                    write!(
                        f,
                        "{:>COLUMN$}",
                        ratio(kind).map_or(String::new(), |ratio| format!("{ratio:.2}"))
                    )?;
                }
                writeln!(f)
            };
            for case in &self.cases {
                write_row(f, &case.name, &|kind| self.ratio(case, kind, family))?;
            }
            if self.cases.len() > 1 {
                let mean =
                    |kind: &str| geometric_mean(self.cases.iter().filter_map(|case| self.ratio(case, kind, family)));
                write_row(f, "geometric mean", &mean)?;
            }
        }
        Ok(())
    }
}

/// The name of a contender, with its threads.
pub fn row_name(result: &RateReport) -> String {
    let threads = if result.threads == 1 {
        String::new()
    } else {
        format!(" x{}", result.threads)
    };
    format!("{} {}, {}{threads}", result.family.name(), result.quality, result.way)
}

/// The contenders of a case, in order.
pub fn rows(case: &CaseReport) -> Vec<String> {
    let mut rows: Vec<String> = Vec::new();
    for result in case.streams.iter().flat_map(|stream| &stream.results) {
        let name = row_name(result);
        if !rows.contains(&name) {
            rows.push(name);
        }
    }
    rows
}

/// A rate, its spread in percent, and a star for the best of its family and threads.
fn cell(stream: &StreamReport, result: &RateReport) -> String {
    let spread = 50.0 * (result.most - result.least) / result.mrays;
    let is_best = stream
        .best(result.family, result.quality, result.threads)
        .is_some_and(|best| std::ptr::eq(best, result));
    let mut text = format!("{:.2}", result.mrays);
    let _ = write!(text, "{} ±{spread:2.0}%", if is_best { "*" } else { " " });
    text
}

/// Where contenders disagree with our BVH.
fn write_differences(f: &mut fmt::Formatter<'_>, case: &CaseReport) -> fmt::Result {
    for stream in &case.streams {
        let hits = stream.results.first().map_or(0, |result| result.hits);
        writeln!(
            f,
            "  {}: {hits} of {} rays in {} calls hit something",
            stream.kind, stream.rays, stream.waves
        )?;
        for result in &stream.results {
            let d = &result.difference;
            if d.count() > 0 {
                writeln!(
                    f,
                    "    {}: {} missed, {} more, {} others; of {} judged in double precision {} are wrong",
                    row_name(result),
                    d.missed,
                    d.extra,
                    d.other,
                    d.judged,
                    d.wrong
                )?;
            }
        }
    }
    Ok(())
}
