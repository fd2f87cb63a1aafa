//! A report as one page with plots that needs no other file.

mod case;
mod plots;
mod svg;

use std::fmt::Write;

use self::plots::{Line, Ratio, Style, class};
use self::svg::escaped;
use super::contenders::Family;
use super::report::{CaseReport, RateReport, Report, StreamReport, geometric_mean};

const STYLE: &str = include_str!("style.css");

/// The page.
pub fn html(report: &Report) -> String {
    let parts = [
        head(report),
        summary(report),
        ratios(report),
        growth(report),
        report.cases.iter().map(|one| case::one_case(one, report)).collect(),
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
        Family::EmbreeCompact => "Embree, robust and compact",
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
