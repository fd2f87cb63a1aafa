//! The plots.

use super::svg::{Anchor, Axis, Svg, short, tick};
use crate::bench::contenders::{Family, USUAL};
use crate::bench::report::{RateReport, StreamReport};

/// Width of a plot.
const WIDTH: f64 = 400.0;

/// The class of a family's color.
pub fn class(family: Family) -> &'static str {
    match family {
        Family::EmbreeFast => "embree-fast",
        Family::EmbreeRobust => "embree-robust",
        Family::EmbreeCompact => "embree-compact",
        Family::Bvh => "bvh",
    }
}

/// Bars of the rates of contenders, the fastest first, with the spread of turns. The ways that renders do not take are pale.
pub fn bars(stream: &StreamReport, results: &[&RateReport]) -> String {
    const ROW: f64 = 17.0;
    const LABEL: f64 = 172.0;
    let mut sorted = results.to_vec();
    sorted.sort_by(|a, b| b.mrays.total_cmp(&a.mrays));
    let height = ROW * sorted.len() as f64 + 24.0;
    let mut svg = Svg::new(WIDTH, height);
    let most = sorted.iter().map(|r| r.most).fold(0.0, f64::max);
    let axis = Axis::linear(most, [LABEL, WIDTH - 44.0], 4);
    let grid = axis.ticks.iter().map(|&x| axis.at(x));
    svg.lines(grid.map(|x| [[x, 0.0], [x, height - 18.0]]), "grid");
    for &x in &axis.ticks {
        svg.text(axis.at(x), height - 8.0, Anchor::Middle, "quiet", &tick(x));
    }
    let mut whiskers = Vec::with_capacity(3 * sorted.len());
    for (place, result) in sorted.iter().enumerate() {
        let y = ROW * place as f64;
        let middle = y + ROW / 2.0;
        let is_usual = result.way == USUAL;
        let family = class(result.family);
        let name = match (is_usual, result.family) {
            (true, Family::EmbreeFast) => "Embree fast, as in renders",
            (true, Family::EmbreeRobust) => "Embree robust, as in renders",
            (true, Family::EmbreeCompact) => "Embree compact, as in renders",
            (true, Family::Bvh) => "Lucerna's BVH, as in renders",
            _ => &result.way,
        };
        svg.text(
            LABEL - 8.0,
            middle,
            Anchor::End,
            if is_usual { "strong" } else { "quiet" },
            name,
        );
        let title = format!(
            "{}, {}: {:.2} ({:.2} to {:.2})",
            result.family.name(),
            result.way,
            result.mrays,
            result.least,
            result.most
        );
        let class = if is_usual {
            family.to_owned()
        } else {
            format!("{family} other")
        };
        let size = [axis.at(result.mrays) - LABEL, ROW - 5.0];
        svg.bar([LABEL, y + 2.5], size, &class, &title);
        let (low, high) = (axis.at(result.least), axis.at(result.most));
        whiskers.push([[low, middle], [high, middle]]);
        whiskers.extend([low, high].map(|x| [[x, middle - 3.0], [x, middle + 3.0]]));
        let weight = if is_usual { "strong" } else { "quiet" };
        svg.text(
            high.max(axis.at(result.mrays)) + 5.0,
            middle,
            Anchor::Start,
            weight,
            &short(result.mrays),
        );
    }
    svg.lines(whiskers, "whisker");
    svg.finish(&format!("Rates of {} rays by contender", stream.kind))
}

/// Points of a family that belong together, with what is said of each.
pub struct Line {
    /// Whose.
    pub family: Family,
    /// Places and texts.
    pub points: Vec<([f64; 2], String)>,
}

/// How a plot of lines looks.
pub struct Style<'a> {
    /// Whether places along x go by logarithms.
    pub log_x: bool,
    /// What x is.
    pub x: &'a str,
    /// What y is.
    pub y: &'a str,
    /// Numbers to be marked along x, if not those that are round.
    pub marks: Option<Vec<f64>>,
    /// Whether a line from the first point of each family shows y in proportion to x.
    pub proportional: bool,
    /// Whether points have their texts beside them.
    pub labels: bool,
}

/// Lines through points.
pub fn lines(lines: &[Line], style: &Style<'_>) -> String {
    const HEIGHT: f64 = 230.0;
    let frame = [42.0, WIDTH - 18.0, HEIGHT - 40.0, 20.0];
    let points = lines.iter().flat_map(|line| line.points.iter().map(|point| point.0));
    let most = points.clone().map(|p| p[1]).fold(0.0, f64::max);
    let mut x_axis = if style.log_x {
        Axis::log(points.map(|p| p[0]), [frame[0], frame[1]])
    } else {
        Axis::linear(points.map(|p| p[0]).fold(0.0, f64::max), [frame[0], frame[1]], 4)
    };
    if let Some(marks) = &style.marks {
        x_axis.ticks.clone_from(marks);
    }
    let y_axis = Axis::linear(most, [frame[2], frame[3]], 4);
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let grid = y_axis.ticks.iter().map(|&y| y_axis.at(y));
    svg.lines(grid.map(|y| [[frame[0], y], [frame[1], y]]), "grid");
    for &y in &y_axis.ticks {
        svg.text(frame[0] - 6.0, y_axis.at(y), Anchor::End, "quiet", &tick(y));
    }
    let marks = x_axis.ticks.iter().map(|&x| x_axis.at(x));
    let marks = marks.map(|x| [[x, frame[2]], [x, frame[2] + 4.0]]);
    svg.lines(marks.chain([[[frame[0], frame[2]], [frame[1], frame[2]]]]), "axis");
    for &x in &x_axis.ticks {
        svg.text(x_axis.at(x), frame[2] + 13.0, Anchor::Middle, "quiet", &tick(x));
    }
    svg.text(frame[1], HEIGHT - 9.0, Anchor::End, "quiet", style.x);
    svg.text(2.0, 8.0, Anchor::Start, "quiet", style.y);
    for line in lines {
        let family = class(line.family);
        let place = |[x, y]: [f64; 2]| [x_axis.at(x), y_axis.at(y)];
        if let (true, Some(([x, y], _))) = (style.proportional, line.points.first()) {
            let ideal = line.points.iter().map(|([to, _], _)| [*to, y / x * to]);
            let within = ideal.filter(|point| point[1] <= *y_axis.ticks.last().unwrap_or(&most));
            svg.path(&within.map(place).collect::<Vec<_>>(), "ideal");
        }
        let places: Vec<_> = line.points.iter().map(|point| place(point.0)).collect();
        svg.path(&places, family);
        for (at, (_, text)) in places.iter().zip(&line.points) {
            svg.dot(*at, 3.5, family, &format!("{}: {text}", line.family.name()));
            if style.labels {
                let word = text.split(':').next().unwrap_or_default();
                svg.text(at[0] + 6.0, at[1] - 8.0, Anchor::Middle, "quiet", word);
            }
        }
    }
    svg.finish(&format!("{} against {}", style.y, style.x))
}

/// One row of [`ratios`].
pub struct Ratio {
    /// A scene.
    pub name: String,
    /// Our rate over another.
    pub ratio: f64,
    /// Whether it stands for all others.
    pub is_mean: bool,
}

/// Ratios as dots left and right of one.
pub fn ratios(rows: &[Ratio], what: &str) -> String {
    const ROW: f64 = 22.0;
    const LABEL: f64 = 130.0;
    let height = ROW * rows.len() as f64 + 26.0;
    let mut svg = Svg::new(WIDTH, height);
    let values = rows.iter().map(|row| row.ratio).chain([0.8, 1.25]);
    let mut axis = Axis::log(values, [LABEL, WIDTH - 40.0]);
    if !axis.ticks.contains(&1.0) {
        axis.ticks.push(1.0);
    }
    for &x in &axis.ticks {
        let class = if x == 1.0 { "axis" } else { "grid" };
        svg.lines([[[axis.at(x), 0.0], [axis.at(x), height - 20.0]]], class);
        svg.text(axis.at(x), height - 9.0, Anchor::Middle, "quiet", &tick(x));
    }
    for (place, row) in rows.iter().enumerate() {
        let middle = ROW * place as f64 + ROW / 2.0;
        let class = if row.ratio >= 1.0 { "good" } else { "bad" };
        let (one, at) = (axis.at(1.0), axis.at(row.ratio));
        svg.bar(
            [one.min(at), middle - 2.0],
            [(at - one).abs(), 4.0],
            class,
            &format!("{}: {:.3}", row.name, row.ratio),
        );
        svg.dot(
            [at, middle],
            if row.is_mean { 6.5 } else { 4.5 },
            class,
            &format!("{}: {:.3}", row.name, row.ratio),
        );
        let weight = if row.is_mean { "strong" } else { "" };
        svg.text(LABEL - 10.0, middle, Anchor::End, weight, &row.name);
        svg.text(WIDTH - 2.0, middle, Anchor::End, weight, &format!("{:.2}", row.ratio));
    }
    svg.finish(what)
}
