//! The spectra that a scene may name: glasses, metals and illuminants, as in pbrt-v4; beyond these, metals that it does not have, and
//! glasses by the coefficients of their catalogues.

use std::borrow::Cow;
use std::sync::{Arc, LazyLock};

use super::cie::{self, DenseTable};
use super::description::{Outside, interpolate};

/// A table of (wavelength in nm, value), wavelengths increasing.
pub(super) struct Named {
    pub name: Cow<'static, str>,
    pub points: Arc<[(f32, f32)]>,
    pub outside: Outside,
}

/// Wavelengths and values.
type Points = Vec<(f32, f32)>;

static NAMED: LazyLock<Vec<Named>> = LazyLock::new(|| {
    let valid = "the table that is compiled in is valid";
    let mut tables: Vec<(&str, Points)> = Vec::new();
    for row in include_str!("data/pbrt_named_spectra.csv").lines().skip(1) {
        let mut fields = row.split(',');
        let name = fields.next().expect(valid);
        let [nm, value] = [(); 2].map(|()| fields.next().expect(valid).parse().expect(valid));
        match tables.last_mut() {
            Some((last, points)) if *last == name => points.push((nm, value)),
            _ => tables.push((name, vec![(nm, value)])),
        }
    }
    let of_pbrt = tables.into_iter().map(|(name, points)| finish(name, points));
    of_pbrt.chain(extra_metals()).chain(sellmeier_glasses()).collect()
});

/// The metals that pbrt-v4 does not have.
fn extra_metals() -> Vec<Named> {
    let valid = "the table that is compiled in is valid";
    let mut metals: Vec<(&str, [Points; 2])> = Vec::new();
    for row in include_str!("data/metals_n_k.csv").lines().skip(1) {
        let (metal, numbers) = row.split_once(',').expect(valid);
        let numbers: Vec<f32> = numbers.split(',').map(|field| field.parse().expect(valid)).collect();
        if metals.last().is_none_or(|(last, _)| *last != metal) {
            metals.push((metal, [Vec::new(), Vec::new()]));
        }
        if let Some((_, tables)) = metals.last_mut() {
            for (table, &value) in tables.iter_mut().zip(&numbers[1..]) {
                table.push((numbers[0], value));
            }
        }
    }
    let part = |metal: &str, part: &str, points: Points| Named {
        name: format!("metal-{metal}-{part}").into(),
        points: points.into(),
        outside: Outside::Constant,
    };
    let parts = metals
        .into_iter()
        .flat_map(|(metal, [n, k])| [part(metal, "eta", n), part(metal, "k", k)]);
    parts.collect()
}

/// Glasses by Sellmeier's equation, n² = 1 + Σ B λ² / (λ² - C) with λ in micrometres, in steps of 1 nm from 350 to 850.
fn sellmeier_glasses() -> impl Iterator<Item = Named> {
    let valid = "the table that is compiled in is valid";
    let rows = include_str!("data/glass_sellmeier.csv").lines();
    rows.filter(|row| !row.starts_with('#')).map(move |row| {
        let (glass, numbers) = row.split_once(',').expect(valid);
        let numbers: Vec<f64> = numbers.split(',').map(|field| field.parse().expect(valid)).collect();
        let index = |nm: i32| {
            let square = (f64::from(nm) * 1e-3).powi(2);
            let terms = numbers[..3].iter().zip(&numbers[3..]);
            (1.0 + terms.map(|(b, c)| b * square / (square - c)).sum::<f64>()).sqrt() as f32
        };
        Named {
            name: format!("sellmeier-{glass}").into(),
            points: (350..=850).map(|nm| (nm as f32, index(nm))).collect(),
            outside: Outside::Constant,
        }
    })
}

/// Refractive indices are as tabulated. Illuminants are scaled to the luminance of a constant 1: the integral with ȳ is
/// [`cie::y_integral`].
fn finish(name: &'static str, mut points: Points) -> Named {
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
        name: name.into(),
        points: points.into(),
        outside,
    }
}

pub(super) fn find(name: &str) -> Option<&'static Named> {
    NAMED.iter().find(|n| n.name == name)
}

/// Every name that [`Spectrum::named`](super::Spectrum::named) knows.
pub fn named_spectra() -> impl Iterator<Item = &'static str> {
    NAMED.iter().map(|n| &*n.name)
}

/// A named spectrum by nm; zero if there is none of that name.
pub(super) fn dense(name: &str) -> DenseTable {
    DenseTable::from_fn(|nm| find(name).map_or(0.0, |table| interpolate(&table.points, table.outside, nm)))
}

/// D65 by nm, with the luminance of a constant 1.
pub(super) fn d65() -> &'static Arc<DenseTable> {
    static D65: LazyLock<Arc<DenseTable>> = LazyLock::new(|| Arc::new(dense("stdillum-D65")));
    &D65
}
