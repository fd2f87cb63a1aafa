//! Numbers, lists of numbers and spectra in attributes.

use super::xml::{Attribute, Element, XmlReader};
use crate::desc::{bytes, report::Report};
use crate::error::Span;

/// A `<spectrum>` without a type.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Spectrum {
    /// The same everywhere.
    Constant(f64),
    /// (wavelength in nm, value), by increasing wavelength, two at least.
    Samples(Vec<(f32, f32)>),
}

/// A number, finite.
pub(super) fn number(attribute: &Attribute, report: &mut Report) -> Option<f64> {
    let parsed = parse(&attribute.value);
    if parsed.is_none() {
        let message = format!("`{}` is no number", attribute.value.trim());
        report.error(attribute.span, message);
    }
    parsed
}

/// A finite number.
fn parse(text: &str) -> Option<f64> {
    let text = text.trim();
    let number: f64 = fast_float2::parse(text.strip_prefix('+').unwrap_or(text)).ok()?;
    number.is_finite().then_some(number)
}

/// Numbers between commas or spaces, as many as one of `counts` says.
pub(super) fn numbers(attribute: &Attribute, counts: &[usize], report: &mut Report) -> Option<Vec<f64>> {
    let mut values = Vec::new();
    for word in words(&attribute.value) {
        match parse(word) {
            Some(value) => values.push(value),
            None => {
                report.error(attribute.span, format!("`{word}` is no number"));
                return None;
            }
        }
    }
    if counts.contains(&values.len()) {
        return Some(values);
    }
    let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
    let message = format!("expected {} numbers, found {}", counts.join(" or "), values.len());
    report.error(attribute.span, message);
    None
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| c == ',' || c.is_whitespace())
        .filter(|word| !word.is_empty())
}

/// The longest file of a spectrum that is read.
const LONGEST: u64 = 1 << 26;

/// A `<spectrum>`: one number, `nm: value` pairs, or a file of pairs.
pub(super) fn spectrum(element: &Element, xml: &mut XmlReader) -> Option<Spectrum> {
    if !element.check(&mut xml.report, &["name"], &["value", "filename"]) {
        return None;
    }
    match (element.attribute("value"), element.attribute("filename")) {
        (Some(value), None) => {
            if !value.value.contains(':') {
                return number(value, &mut xml.report).map(Spectrum::Constant);
            }
            let pairs: Option<Vec<_>> = value
                .value
                .split(',')
                .flat_map(split_pairs)
                .map(|pair| {
                    let (nm, value) = pair.split_once(':')?;
                    Some((parse(nm)?, parse(value)?))
                })
                .collect();
            increasing(pairs, value.span, "expected `nm: value` pairs", xml)
        }
        (None, Some(name)) => {
            let path = xml.resolve(&name.value);
            let text = match bytes::read(&path, LONGEST) {
                Ok(text) => text,
                Err(e) => {
                    let message = format!("cannot read the spectrum {}: {e}", path.display());
                    xml.report.error(name.span, message);
                    return None;
                }
            };
            xml.count(&text);
            let pairs = pairs_of_lines(&String::from_utf8_lossy(&text));
            increasing(pairs, name.span, "expected two numbers a line", xml)
        }
        _ => {
            let message = "<spectrum> needs either the attribute `value` or `filename`";
            xml.report.error(element.span, message);
            None
        }
    }
}

/// The words of a piece between commas as pairs: `400: 0.1 500:0.2` are two.
fn split_pairs(piece: &str) -> impl Iterator<Item = String> {
    let mut pairs: Vec<String> = Vec::new();
    for word in piece.split_whitespace() {
        match pairs.last_mut() {
            Some(last) if last.ends_with(':') || word.starts_with(':') => last.push_str(word),
            _ => pairs.push(word.to_owned()),
        }
    }
    pairs.into_iter()
}

/// `nm value` lines; `#` begins a comment.
fn pairs_of_lines(text: &str) -> Option<Vec<(f64, f64)>> {
    text.lines()
        .map(|line| line.split('#').next().unwrap_or_default())
        .filter(|line| !line.trim().is_empty())
        .map(|line| {
            let mut numbers = words(line).map(parse);
            match (numbers.next(), numbers.next(), numbers.next()) {
                (Some(nm), Some(value), None) => Some((nm?, value?)),
                _ => None,
            }
        })
        .collect()
}

fn increasing(pairs: Option<Vec<(f64, f64)>>, span: Span, expected: &str, xml: &mut XmlReader) -> Option<Spectrum> {
    let Some(pairs) = pairs else {
        xml.report.error(span, format!("this is no spectrum: {expected}"));
        return None;
    };
    samples(pairs, span, &mut xml.report)
}

/// A spectrum of samples, in single precision.
pub(super) fn samples(pairs: Vec<(f64, f64)>, span: Span, report: &mut Report) -> Option<Spectrum> {
    let samples: Vec<(f32, f32)> = pairs.into_iter().map(|(nm, value)| (nm as f32, value as f32)).collect();
    let problem = if samples.len() < 2 {
        Some("a spectrum has two samples at least")
    } else if samples.windows(2).any(|pair| pair[0].0 >= pair[1].0) {
        Some("the wavelengths of a spectrum increase")
    } else if samples.iter().any(|(nm, value)| !nm.is_finite() || !value.is_finite()) {
        Some("a number does not fit into single precision")
    } else {
        None
    };
    match problem {
        Some(problem) => {
            report.error(span, problem);
            None
        }
        None => Some(Spectrum::Samples(samples)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_split_whatever_the_spaces() {
        let pairs: Vec<String> = "400:0.1, 500 : 0.2 ,600: 0.3 700:0.4"
            .split(',')
            .flat_map(split_pairs)
            .collect();
        assert_eq!(pairs, ["400:0.1", "500:0.2", "600:0.3", "700:0.4"]);
        assert_eq!(
            pairs_of_lines("# c\n400 1\n 500, 2 # x\n\n"),
            Some(vec![(400.0, 1.0), (500.0, 2.0)])
        );
        assert_eq!(pairs_of_lines("400 1 2"), None);
    }
}
