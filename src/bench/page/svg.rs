//! Drawing: the little of SVG that the plots need, and the ticks of axes.

use std::fmt::{self, Display, Formatter, Write};

/// Text that may stand in markup.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// A drawing under way. Lengths are in its own units, of which one is about a pixel.
pub struct Svg {
    body: String,
    width: f64,
    height: f64,
}

/// A length to a tenth, in as few characters as that takes.
struct Length(f64);

impl Display for Length {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        // Adding 0 makes -0 be 0.
        Display::fmt(&((10.0 * self.0).round() / 10.0 + 0.0), f)
    }
}

/// Where a text is, relative to its point.
#[derive(Clone, Copy, Debug)]
pub enum Anchor {
    /// It begins there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

impl Svg {
    /// An empty one.
    pub fn new(width: f64, height: f64) -> Self {
        Self {
            body: String::new(),
            width,
            height,
        }
    }

    fn push(&mut self, element: impl Display) {
        // Writing to a string does not fail.
        let _ = writeln!(self.body, "{element}");
    }

    /// A text on the line through `y`.
    pub fn text(&mut self, x: f64, y: f64, anchor: Anchor, class: &str, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => "middle ",
            Anchor::End => "end ",
        };
        let class = format!("{anchor}{class}");
        let (x, y, class, text) = (Length(x), Length(y + 3.8), class.trim_end(), escaped(text));
        if class.is_empty() {
            self.push(format_args!(r#"<text x="{x}" y="{y}">{text}</text>"#));
        } else {
            self.push(format_args!(r#"<text x="{x}" y="{y}" class="{class}">{text}</text>"#));
        }
    }

    /// A filled rectangle, with what is said when the pointer is on it.
    pub fn bar(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], class: &str, title: &str) {
        let [x, y, width, height] = [x, y, width.max(0.5), height].map(Length);
        let title = escaped(title);
        self.push(format_args!(
            r#"<rect x="{x}" y="{y}" width="{width}" height="{height}" class="{class}"><title>{title}</title></rect>"#
        ));
    }

    /// Lines that look alike, each along an axis: they are one element.
    pub fn lines(&mut self, lines: impl IntoIterator<Item = [[f64; 2]; 2]>, class: &str) {
        let mut d = String::new();
        for [from, to] in lines {
            let ([x, y], [to_x, to_y]) = (from.map(Length), to.map(Length));
            let _ = write!(d, "M{x} {y}");
            let _ = if from[0] == to[0] {
                write!(d, "V{to_y}")
            } else {
                write!(d, "H{to_x}")
            };
        }
        self.push(format_args!(r#"<path d="{d}" class="{class}"/>"#));
    }

    /// Lines from point to point.
    pub fn path(&mut self, points: &[[f64; 2]], class: &str) {
        let mut d = String::new();
        for (i, [x, y]) in points.iter().enumerate() {
            let _ = write!(d, "{}{} {}", if i == 0 { "M" } else { "L" }, Length(*x), Length(*y));
        }
        self.push(format_args!(r#"<path d="{d}" class="{class}"/>"#));
    }

    /// A dot, with what is said when the pointer is on it.
    pub fn dot(&mut self, [x, y]: [f64; 2], radius: f64, class: &str, title: &str) {
        let title = escaped(title);
        let [x, y] = [x, y].map(Length);
        self.push(format_args!(
            r#"<circle cx="{x}" cy="{y}" r="{radius}" class="{class}"><title>{title}</title></circle>"#
        ));
    }

    /// The element, described for those who do not see it.
    pub fn finish(self, description: &str) -> String {
        let Self { body, width, height } = self;
        let description = escaped(description);
        format!("<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{description}\">\n{body}</svg>\n")
    }
}

/// How numbers become places along an axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// The least and the greatest number.
    range: [f64; 2],
    /// Where they are.
    place: [f64; 2],
    /// Whether places are by logarithms.
    log: bool,
    /// Numbers to be marked.
    pub ticks: Vec<f64>,
}

impl Axis {
    /// From 0 to a round number of at least `most`.
    pub fn linear(most: f64, place: [f64; 2], ticks: usize) -> Self {
        let step = round_up(most.max(1e-9) / ticks as f64);
        let count = (most / step).ceil().max(1.0);
        Self {
            range: [0.0, step * count],
            place,
            log: false,
            ticks: (0..=count as usize).map(|i| step * i as f64).collect(),
        }
    }

    /// By logarithms, around positive numbers.
    pub fn log(values: impl Iterator<Item = f64> + Clone, place: [f64; 2]) -> Self {
        let least = values.clone().fold(f64::INFINITY, f64::min).max(1e-12);
        let most = values.fold(0.0, f64::max).max(least);
        let margin = (most / least).powf(0.06).max(1.12);
        let range = [least / margin, most * margin];
        let mut ticks = marks(range, &[1.0]);
        if ticks.len() < 3 {
            ticks = marks(range, &[1.0, 2.0, 5.0]);
        }
        if ticks.len() < 2 {
            ticks = marks(range, &[1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
        }
        Self {
            range,
            place,
            log: true,
            ticks,
        }
    }

    /// Where a number is.
    pub fn at(&self, value: f64) -> f64 {
        let share = |value: f64, [low, high]: [f64; 2]| (value - low) / (high - low);
        let share = if self.log {
            share(value.max(1e-12).ln(), self.range.map(f64::ln))
        } else {
            share(value, self.range)
        };
        self.place[0] + share * (self.place[1] - self.place[0])
    }
}

/// The least of 1, 2, 2.5 and 5 times a power of ten that is at least `x`.
fn round_up(x: f64) -> f64 {
    let power = 10f64.powf(x.log10().floor());
    let factors = [1.0, 2.0, 2.5, 5.0, 10.0];
    factors
        .into_iter()
        .find(|f| f * power >= x * (1.0 - 1e-9))
        .unwrap_or(10.0)
        * power
}

/// The products of `factors` and powers of ten within a range.
fn marks([low, high]: [f64; 2], factors: &[f64]) -> Vec<f64> {
    let powers = (low.log10().floor() as i32)..=(high.log10().ceil() as i32);
    let products = powers.flat_map(|power| factors.iter().map(move |factor| factor * 10f64.powi(power)));
    products.filter(|x| (low..=high).contains(x)).collect()
}

/// A number in few digits.
pub fn short(x: f64) -> String {
    let scaled = |x: f64, unit: &str| {
        let text = format!("{x:.1}");
        format!("{}{unit}", text.trim_end_matches('0').trim_end_matches('.'))
    };
    match x.abs() {
        0.0 => "0".into(),
        a if a >= 999_500.0 => scaled(x / 1e6, "M"),
        a if a >= 9_995.0 => scaled(x / 1e3, "k"),
        a if a >= 100.0 => format!("{x:.0}"),
        a if a >= 9.95 => format!("{x:.1}"),
        a if a >= 0.1 => format!("{x:.2}"),
        a if a >= 0.001 => format!("{x:.4}").trim_end_matches('0').to_owned(),
        _ => format!("{x:.1e}"),
    }
}

/// A mark of an axis.
pub fn tick(x: f64) -> String {
    let text = short(x);
    if text.contains('.') && !text.contains('e') && !text.ends_with(['k', 'M']) {
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_hold_their_numbers_and_have_marks() {
        for most in [0.003, 1.0, 7.3, 99.0, 12345.0] {
            let axis = Axis::linear(most, [10.0, 110.0], 4);
            assert!(
                (10.0..=110.0).contains(&axis.at(most)) && axis.at(most) > 60.0,
                "{most}"
            );
            assert!((2..=6).contains(&axis.ticks.len()), "{most}: {:?}", axis.ticks);
        }
        for values in [[1e-3, 5.0], [1.0, 1.1], [3.0, 3.0], [1e4, 1e8]] {
            let axis = Axis::log(values.into_iter(), [0.0, 1.0]);
            assert!(values.iter().all(|&v| (0.0..=1.0).contains(&axis.at(v))), "{values:?}");
            assert!(!axis.ticks.is_empty(), "{values:?}");
        }
    }

    #[test]
    fn elements_take_few_characters() {
        let mut svg = Svg::new(10.0, 10.0);
        svg.lines([[[1.0, 2.04], [1.0, 3.06]], [[0.25, 4.0], [5.0, 4.0]]], "grid");
        svg.text(1.0, 0.2, Anchor::End, "", "a");
        svg.text(-0.01, 0.2, Anchor::Start, "", "<");
        assert_eq!(
            svg.body,
            "<path d=\"M1 2V3.1M0.3 4H5\" class=\"grid\"/>\n<text x=\"1\" y=\"4\" class=\"end\">a</text>\n<text x=\"0\" y=\"4\">&lt;</text>\n"
        );
    }

    #[test]
    fn numbers_are_short() {
        let cases = [
            (0.0, "0"),
            (1.5, "1.50"),
            (12.34, "12.3"),
            (50_000.0, "50k"),
            (1e6, "1M"),
            (0.0123, "0.0123"),
        ];
        for (x, text) in cases {
            assert_eq!(short(x), text);
        }
        assert_eq!([tick(1.5), tick(20.0), tick(0.5)], ["1.5", "20", "0.5"]);
    }
}
