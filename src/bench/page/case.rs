//! The part of the page about one world.

use std::fmt::Write;

use super::plots::{self, Line, Style};
use super::svg::{escaped, short};
use super::{families, figure, section, usual};
use crate::bench::contenders::{Family, USUAL};
use crate::bench::report::{BuildReport, CaseReport, RateReport, Report, geometric_mean};
use crate::bench::table::{row_name, rows};

/// Its section.
pub fn one_case(case: &CaseReport, report: &Report) -> String {
    let mut figures = String::new();
    for stream in &case.streams {
        let threads = stream.results.iter().map(|r| r.threads).min();
        let best: &str = if stream.results.iter().any(|r| r.quality == "high") {
            "high"
        } else {
            "medium"
        };
        let shown: Vec<_> = stream
            .results
            .iter()
            .filter(|r| Some(r.threads) == threads && r.quality == best)
            .collect();
        if shown.is_empty() {
            continue;
        }
        let hits = shown[0].hits as f64 / stream.rays.max(1) as f64;
        let note = format!(
            "million rays a second, {best} quality; {} rays, {:.0} % hit",
            short(stream.rays as f64),
            100.0 * hits
        );
        figures += &figure(&format!("{} rays", stream.kind), &note, &plots::bars(stream, &shown));
    }
    figures += &build_plot(case, report);
    figures += &memory_note(case);
    figures += &threads_plots(case, report);
    let instances = if case.instances > 0 {
        format!(
            ", {} with each of {} instances counted",
            case.instanced_primitives, case.instances
        )
    } else {
        String::new()
    };
    let mut text = format!("{} primitives{instances}.", case.primitives);
    if case.one_at_a_time {
        text += " Builds were measured one at a time, as they do not fit into half of the free memory together.";
        if let Some(drift) = case.drift {
            let _ = write!(
                text,
                " The first, measured again at the end, had {drift:.3} of its rates."
            );
        }
    }
    section(&case.name, &text, &figures) + &full_table(case)
}

/// Speed over build time, a line a family from low to high quality.
fn build_plot(case: &CaseReport, report: &Report) -> String {
    let of_family = |family: Family| {
        let builds = case.builds.iter().filter(|build| build.family == family);
        let point = |build: &BuildReport| {
            let rates = case
                .streams
                .iter()
                .filter_map(|stream| usual(stream, family, build.quality));
            let mean = geometric_mean(rates.map(|rate| rate.mrays))?;
            let text = format!(
                "{}: {:.3} s, {mean:.2} million rays a second",
                build.quality, build.seconds
            );
            Some(([build.seconds * 1e3, mean], text))
        };
        let mut points: Vec<_> = builds.filter_map(point).collect();
        points.reverse();
        Line { family, points }
    };
    let lines: Vec<_> = families(report)
        .map(of_family)
        .filter(|line| line.points.len() > 1)
        .collect();
    if lines.is_empty() {
        return String::new();
    }
    let style = Style {
        log_x: true,
        x: "milliseconds to build",
        y: "million rays a second, mean over the kinds of ray",
        marks: None,
        proportional: false,
        labels: true,
    };
    figure(
        "Build time against speed",
        "low, medium and high quality, as renders trace",
        &plots::lines(&lines, &style),
    )
}

fn memory_note(case: &CaseReport) -> String {
    let rows: String = case
        .builds
        .iter()
        .map(|build| {
            format!(
                "<tr><td>{} {}</td><td>{} s</td><td>{:.1}</td></tr>",
                build.family.name(),
                build.quality,
                short(build.seconds),
                build.bytes_per_primitive
            )
        })
        .collect();
    let threads = case.builds.first().map_or(1, |build| build.threads);
    format!(
        "<figure><figcaption><h3>Builds</h3><small>on {threads} thread{}</small></figcaption>\
         <table><tr><th></th><th>time</th><th>bytes a primitive</th></tr>{rows}</table></figure>\n",
        if threads == 1 { "" } else { "s" }
    )
}

/// Rates over the number of threads.
fn threads_plots(case: &CaseReport, report: &Report) -> String {
    let mut figures = String::new();
    for stream in &case.streams {
        let of_family = |family: Family| {
            let results = stream
                .results
                .iter()
                .filter(|r| r.family == family && r.quality == "high" && r.way == USUAL);
            let point = |r: &RateReport| {
                let text = format!("{:.2} million rays a second on {} threads", r.mrays, r.threads);
                ([r.threads as f64, r.mrays], text)
            };
            let mut points: Vec<_> = results.map(point).collect();
            points.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
            Line { family, points }
        };
        let lines: Vec<_> = families(report)
            .map(of_family)
            .filter(|line| line.points.len() > 1)
            .collect();
        let Some(first) = lines.first() else { continue };
        let style = Style {
            log_x: false,
            x: "threads",
            y: "million rays a second",
            marks: Some(first.points.iter().map(|point| point.0[0]).collect()),
            proportional: true,
            labels: false,
        };
        figures += &figure(
            &format!("{} rays over threads", stream.kind),
            "dashed: in proportion",
            &plots::lines(&lines, &style),
        );
    }
    figures
}

/// Every number.
fn full_table(case: &CaseReport) -> String {
    let mut body = String::from("<tr><th>contender</th>");
    for stream in &case.streams {
        let _ = write!(
            body,
            "<th>{}</th><th>spread</th><th>differ (wrong)</th>",
            escaped(&stream.kind)
        );
    }
    body += "</tr>\n";
    for row in rows(case) {
        let _ = write!(body, "<tr><td>{}</td>", escaped(&row));
        for stream in &case.streams {
            let Some(result) = stream.results.iter().find(|result| row_name(result) == row) else {
                body += "<td></td><td></td><td></td>";
                continue;
            };
            let best = stream.best(result.family, result.quality, result.threads);
            let is_best = best.is_some_and(|best| std::ptr::eq(best, result));
            let difference = match (result.difference.count(), result.difference.wrong) {
                (0, _) => "0".to_owned(),
                (count, wrong) => format!("{count} ({wrong})"),
            };
            let _ = write!(
                body,
                "<td{}>{:.2}</td><td>{:.2} to {:.2}</td><td>{difference}</td>",
                if is_best { " class=\"best\"" } else { "" },
                result.mrays,
                result.least,
                result.most
            );
        }
        body += "</tr>\n";
    }
    format!(
        "<details><summary>All numbers of {}</summary><div class=\"scroll\"><table>{body}</table></div></details>\n",
        escaped(&case.name)
    )
}
