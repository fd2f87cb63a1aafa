//! The spectra that a scene may name: glasses, metals and illuminants, as in pbrt-v4.

use std::sync::{Arc, LazyLock};

use super::cie::{self, DenseTable};
use super::description::{Outside, interpolate};

/// A table of (wavelength in nm, value), wavelengths increasing.
pub(super) struct Named {
    pub name: &'static str,
    pub points: Arc<[(f32, f32)]>,
    pub outside: Outside,
}

static NAMED: LazyLock<Vec<Named>> = LazyLock::new(|| {
    let valid = "the table that is compiled in is valid";
    let mut tables: Vec<(&str, Vec<(f32, f32)>)> = Vec::new();
    for row in include_str!("data/pbrt_named_spectra.csv").lines().skip(1) {
        let mut fields = row.split(',');
        let name = fields.next().expect(valid);
        let [nm, value] = [(); 2].map(|()| fields.next().expect(valid).parse().expect(valid));
        match tables.last_mut() {
            Some((last, points)) if *last == name => points.push((nm, value)),
            _ => tables.push((name, vec![(nm, value)])),
        }
    }
    tables.into_iter().map(|(name, points)| finish(name, points)).collect()
});

/// Refractive indices are as tabulated. Illuminants are scaled to the luminance of a constant 1: the integral with ȳ is
/// [`cie::y_integral`].
fn finish(name: &'static str, mut points: Vec<(f32, f32)>) -> Named {
    let is_index = name.starts_with("glass-") || name.starts_with("metal-");
    let outside = if is_index { Outside::Constant } else { Outside::Zero };
    if !is_index {
        let luminance = cie::integrate_y(|nm| interpolate(&points, outside, nm));
        let scale = (f64::from(cie::y_integral()) / luminance) as f32;
        for (_, value) in &mut points {
            *value *= scale;
        }
    }
    Named {
        name,
        points: points.into(),
        outside,
    }
}

pub(super) fn find(name: &str) -> Option<&'static Named> {
    NAMED.iter().find(|n| n.name == name)
}

/// Every name that [`Spectrum::named`](super::Spectrum::named) knows.
pub fn named_spectra() -> impl Iterator<Item = &'static str> {
    NAMED.iter().map(|n| n.name)
}

/// D65 by nm, with the luminance of a constant 1.
pub(super) fn d65() -> &'static Arc<DenseTable> {
    static D65: LazyLock<Arc<DenseTable>> = LazyLock::new(|| {
        let d65 = find("stdillum-D65").expect("the tables have D65");
        Arc::new(DenseTable::from_fn(|nm| interpolate(&d65.points, d65.outside, nm)))
    });
    &D65
}
