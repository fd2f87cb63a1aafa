//! A report as one page with plots that needs no other file.

mod plots;
mod svg;

use std::fmt::Write;

use self::plots::{Line, Ratio, Style, class};
use self::svg::{escaped, short};
use super::contenders::{Family, USUAL};
use super::report::{CaseReport, RateReport, Report, StreamReport, geometric_mean};
use super::table::{row_name, rows};

const STYLE: &str = include_str!("style.css");

/// The page.
pub fn html(report: &Report) -> String {
    let parts = [
        head(report),
        summary(report),
        ratios(report),
        growth(report),
        report.cases.iter().map(|case| one_case(case, report)).collect(),
        method(report),
    ];
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Rays a second: Lucerna's BVH and Embree</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
        parts.concat()
    )
}

fn head(report: &Report) -> String {
    let m = &report.machine;
    let key: String = families(report)
        .map(|family| format!("<li><i class=\"{}\"></i>{}</li>", class(family), title(family)))
        .collect();
    format!(
        "<h1>Rays a second</h1>\n<p class=\"quiet\">Lucerna's BVH and Embree {} on the same rays, side by side. {}, {}.</p>\n\
         <ul class=\"key\">{key}</ul>\n",
        escaped(m.embree),
        escaped(&m.processor),
        m.date()
    )
}

fn families(report: &Report) -> impl Iterator<Item = Family> {
    let builds = report.cases.iter().flat_map(|case| &case.builds);
    let there: Vec<Family> = builds.map(|build| build.family).collect();
    Family::ALL.into_iter().filter(move |family| there.contains(family))
}

fn title(family: Family) -> &'static str {
    match family {
        Family::EmbreeFast => "Embree, fast (not watertight)",
        Family::EmbreeRobust => "Embree, robust",
        Family::Bvh => "Lucerna's BVH (watertight)",
    }
}

fn figure(name: &str, note: &str, svg: &str) -> String {
    let (name, note) = (escaped(name), escaped(note));
    format!("<figure><figcaption><h3>{name}</h3><small>{note}</small></figcaption>\n{svg}</figure>\n")
}

fn section(name: &str, text: &str, plots: &str) -> String {
    if plots.is_empty() {
        return String::new();
    }
    format!(
        "<h2>{}</h2>\n<p class=\"quiet\">{}</p>\n<div class=\"plots\">\n{plots}</div>\n",
        escaped(name),
        escaped(text)
    )
}

/// Over all cases, our rate of a kind of ray over that of a family by its best call.
fn mean_ratio(report: &Report, kind: &str, family: Family) -> Option<f64> {
    geometric_mean(report.cases.iter().filter_map(|case| report.ratio(case, kind, family)))
}

/// The means in large figures.
fn summary(report: &Report) -> String {
    let mut tiles = String::new();
    for kind in report.kinds() {
        let Some(fast) = mean_ratio(report, &kind, Family::EmbreeFast) else {
            continue;
        };
        let robust = mean_ratio(report, &kind, Family::EmbreeRobust)
            .map_or(String::new(), |ratio| format!("; {ratio:.2} of its robust mode"));
        let _ = writeln!(
            tiles,
            "<div class=\"tile {}\"><small>{}</small><b>{fast:.2}</b><small>of Embree's fast mode{robust}</small></div>",
            if fast >= 1.0 { "good" } else { "bad" },
            escaped(&kind)
        );
    }
    if tiles.is_empty() {
        return tiles;
    }
    format!("<div class=\"tiles\">\n{tiles}</div>\n")
}

fn ratios(report: &Report) -> String {
    let mut figures = String::new();
    for kind in report.kinds() {
        let row = |case: &CaseReport| {
            report.ratio(case, &kind, Family::EmbreeFast).map(|ratio| Ratio {
                name: case.name.clone(),
                ratio,
                is_mean: false,
            })
        };
        let mut rows: Vec<_> = report.cases.iter().filter_map(row).collect();
        if rows.len() > 1 {
            rows.extend(mean_ratio(report, &kind, Family::EmbreeFast).map(|ratio| Ratio {
                name: "geometric mean".into(),
                ratio,
                is_mean: true,
            }));
        }
        if !rows.is_empty() {
            let what = format!("Rates of {kind} rays over Embree's");
            figures += &figure(
                &format!("{kind} rays"),
                "times Embree's fast mode",
                &plots::ratios(&rows, &what),
            );
        }
    }
    let text = "What a render gets from Lucerna's BVH, over the fastest of Embree's calls in its fast mode, builds of high quality. \
                Right of 1, Lucerna's is faster.";
    section("Against Embree's best call", text, &figures)
}

/// Rates over the number of triangles, of kinds of worlds of which there are several sizes.
fn growth(report: &Report) -> String {
    let mut figures = String::new();
    let mut kinds: Vec<&String> = report.cases.iter().filter_map(|case| case.synthetic.as_ref()).collect();
    kinds.dedup();
    for world in kinds {
        let mut cases: Vec<_> = report
            .cases
            .iter()
            .filter(|case| case.synthetic.as_ref() == Some(world))
            .collect();
        cases.sort_by_key(|case| case.instanced_primitives);
        if cases.len() < 2 {
            continue;
        }
        for kind in report.kinds() {
            let of_family = |family: Family| {
                let point = |case: &&CaseReport| {
                    let stream = case.streams.iter().find(|stream| stream.kind == kind)?;
                    let best = usual(stream, family, "high")?;
                    let count = case.instanced_primitives;
                    let text = format!("{:.2} million rays a second, {count} triangles", best.mrays);
                    Some(([count as f64, best.mrays], text))
                };
                Line {
                    family,
                    points: cases.iter().filter_map(point).collect(),
                }
            };
            let lines: Vec<_> = families(report)
                .map(of_family)
                .filter(|line| line.points.len() > 1)
                .collect();
            if lines.is_empty() {
                continue;
            }
            let style = Style {
                log_x: true,
                x: "triangles",
                y: "million rays a second",
                marks: None,
                proportional: false,
                labels: false,
            };
            figures += &figure(&format!("{world}: {kind} rays"), "", &plots::lines(&lines, &style));
        }
    }
    section(
        "As the number of triangles grows",
        "As renders trace, builds of high quality.",
        &figures,
    )
}

/// The one that a render would be, on the fewest threads.
fn usual<'a>(stream: &'a StreamReport, family: Family, quality: &str) -> Option<&'a RateReport> {
    let threads = stream.results.iter().map(|r| r.threads).min()?;
    stream.usual(family, quality, threads)
}

fn one_case(case: &CaseReport, report: &Report) -> String {
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
        let point = |build: &super::report::BuildReport| {
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

fn method(report: &Report) -> String {
    let m = &report.machine;
    let pinned = report
        .pinned
        .as_ref()
        .map_or("any processor".to_owned(), |cpus| format!("processors {cpus}"));
    let facts = [
        (
            "Processor",
            format!(
                "{}, {} at once, with {}",
                m.processor,
                m.processors,
                m.instructions.join(", ")
            ),
        ),
        (
            "System",
            format!(
                "Linux {}, {:.1} GiB, huge pages {}",
                m.system,
                m.memory as f64 / f64::from(1 << 30),
                m.huge_pages
            ),
        ),
        ("Program", format!("lucerna {}, {}", m.version, m.compiler)),
        ("Embree", m.embree.to_owned()),
        (
            "Run on",
            format!(
                "{pinned}; {} turns; seed {}; load {} at the start",
                report.turns, report.seed, m.load
            ),
        ),
        ("Command", report.command.clone()),
    ];
    let facts: String = facts
        .iter()
        .map(|(name, value)| format!("<dt>{name}</dt><dd>{}</dd>\n", escaped(value)))
        .collect();
    format!(
        "<h2>How this was measured</h2>\n<p>The rays are those that a render asks about, in the calls in which it asks: recorded from a \
         render of each scene, or from paths through a synthetic world. After a pass over all of them, the contenders take turns of a few \
         calls each, traced once before they are timed, in an order that changes, so that other work on the machine disturbs all alike. The time of a call is the median of \
         its turns; whiskers show the quartiles. What it takes to repack rays for a call that wants \
         them otherwise than in packets of eight is counted.</p>\n<p>Answers are compared with those of Lucerna's BVH: a ray differs if it \
         hits where the other does not, or something else at another distance. Of these a judge in double precision looks at some and says \
         whether the answer is wrong however arithmetic rounds.</p>\n<dl>\n{facts}</dl>\n"
    )
}
