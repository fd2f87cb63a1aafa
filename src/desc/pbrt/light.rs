//! `LightSource` and `AreaLightSource`.

use std::sync::Arc;

use glam::DVec3;

use super::images::check_color_space;
use super::params::{ParamType, Values};
use super::reader::{ParamReader, unknown_type};
use super::report::Report;
use super::spectrum::Use;
use crate::desc::kinds::lights::{
    AREA_IMAGE, CONE_ANGLE, CONE_DELTA, FALLOFF, FOV, FROM, GONIOMETRIC_IMAGE, ILLUMINANCE, INFINITE_IMAGE, INTENSITY,
    IRRADIANCE, PORTAL, POWER, PROJECTION_IMAGE, RADIANCE, SCALE, SPREAD, TO, TWO_SIDED,
};
use crate::desc::{
    AreaLightDesc, AreaSpread, ColorSpace, Entry, LIGHTS, LightDesc, LightKind, MotionDesc, Parameter, ParameterKind,
    SpectrumDesc, SpectrumValue, SpotFalloff,
};
use crate::image_io::{self, Encoding, Image};
use crate::sampling::SphereMap;
use crate::spectrum::{Outside, Spectrum, cie};

/// Reads a light; none if its type is not known or something essential is wrong with it.
pub(super) fn read(mut reader: ParamReader<'_>, kind: &str, world_from_light: MotionDesc) -> Option<LightDesc> {
    let span = reader.span;
    let Some(entry) = of_directive("LightSource").find(|entry| entry.name == kind) else {
        let known: Vec<_> = of_directive("LightSource").map(|entry| entry.name).collect();
        unknown_type(reader.report(), "light", kind, span, (&known, &[]), "it is left out");
        return None;
    };
    let r = &mut reader;
    let (kind, spectrum, photometric) = match entry.name {
        "point" => {
            let from = r.point_by(&FROM);
            (Some(LightKind::Point { from }), r.emission(&INTENSITY), &POWER)
        }
        "spot" => (Some(spot(r)), r.emission(&INTENSITY), &POWER),
        "goniometric" => {
            let image = r.light_image(&GONIOMETRIC_IMAGE, true, |[width, height]| {
                (width != height).then_some("square (equal-area octahedral)")
            });
            let kind = image.map(|image| LightKind::Goniometric { image });
            (kind, r.emission(&INTENSITY), &POWER)
        }
        "projection" => {
            let image = r.light_image(&PROJECTION_IMAGE, true, |_| None);
            let fov = r.float_by(&FOV);
            (image.map(|image| LightKind::Projection { image, fov }), None, &POWER)
        }
        "distant" => {
            let (from, to) = from_to(r);
            let kind = LightKind::Distant { from, to };
            (Some(kind), r.emission(&IRRADIANCE), &ILLUMINANCE)
        }
        _ => {
            let (kind, spectrum) = infinite(r);
            (Some(kind), spectrum, &ILLUMINANCE)
        }
    };
    let photometric = reader.photometric(photometric);
    let scale = reader.float_by(&SCALE) as f32 * old_luminance(reader.report(), spectrum.as_ref());
    reader.finish_by(entry);
    Some(LightDesc {
        span,
        kind: kind?,
        spectrum,
        scale,
        photometric,
        world_from_light,
    })
}

/// Reads what shapes are to emit; nothing if the type is not known.
pub(super) fn read_area(mut reader: ParamReader<'_>, kind: &str) -> Option<AreaLightDesc> {
    let span = reader.span;
    let Some(entry) = of_directive("AreaLightSource").find(|entry| entry.name == kind) else {
        let known: Vec<_> = of_directive("AreaLightSource").map(|entry| entry.name).collect();
        unknown_type(
            reader.report(),
            "area light",
            kind,
            span,
            (&known, &[]),
            "nothing emits",
        );
        return None;
    };
    let l = reader.emission(&RADIANCE);
    let image = reader.light_image(&AREA_IMAGE, false, |_| None);
    reader.one_of(&RADIANCE, &AREA_IMAGE);
    let light = AreaLightDesc {
        span,
        scale: reader.float_by(&SCALE) as f32 * old_luminance(reader.report(), l.as_ref()),
        l,
        image,
        power: reader.photometric(&POWER),
        two_sided: reader.bool_by(&TWO_SIDED),
        spread: match reader.choice_by(&SPREAD) {
            "normal" => AreaSpread::Normal,
            _ => AreaSpread::Diffuse,
        },
    };
    reader.finish_by(entry);
    Some(light)
}

/// pbrt-v3 takes a spectrum as it is where pbrt-v4 scales it to a luminance of 1: what it is short of that.
fn old_luminance(report: &Report, spectrum: Option<&SpectrumDesc>) -> f32 {
    let spectrum = match spectrum.map(|desc| &desc.value) {
        Some(SpectrumValue::Samples(samples)) => Spectrum::tabulated(samples.clone(), Outside::Zero),
        Some(SpectrumValue::Blackbody(kelvin)) => Spectrum::blackbody(*kelvin),
        _ => return 1.0,
    };
    if report.is_old() {
        spectrum.photometric() / cie::y_integral()
    } else {
        1.0
    }
}

fn of_directive(directive: &str) -> impl Iterator<Item = &'static Entry> {
    LIGHTS.iter().filter(move |light| light.directive == directive)
}

fn from_to(reader: &mut ParamReader<'_>) -> (DVec3, DVec3) {
    let (from, to) = (reader.point_by(&FROM), reader.point_by(&TO));
    if from == to {
        let span = reader.span_of(TO.name);
        let message = format!("`from` and `to` of {} must differ", reader.entity);
        reader.report().error(span, message);
    }
    (from, to)
}

fn spot(reader: &mut ParamReader<'_>) -> LightKind {
    let (from, to) = from_to(reader);
    let (angle, delta) = (reader.float_by(&CONE_ANGLE), reader.float_by(&CONE_DELTA));
    if delta > angle {
        let range = format!("no more than `{}`, {angle}", CONE_ANGLE.name);
        reader.out_of_range(CONE_DELTA.name, &delta.to_string(), &range);
    }
    LightKind::Spot {
        from,
        to,
        angle,
        delta,
        falloff: match reader.choice_by(&FALLOFF) {
            "linear" => SpotFalloff::Linear,
            _ => SpotFalloff::Smooth,
        },
    }
}

fn infinite(reader: &mut ParamReader<'_>) -> (LightKind, Option<SpectrumDesc>) {
    let spectrum = reader.emission(&RADIANCE);
    let image = reader.light_image(&INFINITE_IMAGE, false, |[width, height]| {
        let known = SphereMap::of_size(width, height).is_some();
        (!known).then_some("square (equal-area octahedral) or twice as wide as high (latitude and longitude)")
    });
    reader.one_of(&RADIANCE, &INFINITE_IMAGE);
    let portal = reader.points4(&PORTAL);
    (LightKind::Infinite { image, portal }, spectrum)
}

impl ParamReader<'_> {
    /// A point by its table.
    fn point_by(&mut self, parameter: &'static Parameter) -> DVec3 {
        match parameter.kind {
            ParameterKind::Point(default) => self.point3(parameter.name, DVec3::from(default)),
            _ => DVec3::ZERO,
        }
    }

    /// Four points.
    fn points4(&mut self, parameter: &'static Parameter) -> Option<[DVec3; 4]> {
        let v = self.numbers(parameter.name, ParamType::Point3, 12)?;
        Some(std::array::from_fn(|i| {
            DVec3::new(v[3 * i], v[3 * i + 1], v[3 * i + 2])
        }))
    }

    /// The spectrum of a light. Unless RGB, it is normalised by its luminance, which must not be 0.
    fn emission(&mut self, parameter: &'static Parameter) -> Option<SpectrumDesc> {
        let name = parameter.name;
        let given = self.has(name);
        let Some(spectrum) = self.spectrum(name, Use::Emission) else {
            // The white of sRGB is what no spectrum stands for.
            let (space, span) = (self.context.color_space, self.span);
            let value = SpectrumValue::Rgb([1.0; 3], space);
            return (!given && space != ColorSpace::Srgb).then_some(SpectrumDesc { value, span });
        };
        let is_black = match &spectrum.value {
            SpectrumValue::Samples(samples) => samples.iter().all(|&(_, value)| value == 0.0),
            SpectrumValue::Constant(value) => *value == 0.0,
            _ => false,
        };
        if is_black {
            let message = format!(
                "`{name}` is 0 everywhere: it has no luminance to be scaled to (`\"rgb {name}\" [0 0 0]` is black)"
            );
            self.report().error(spectrum.span, message);
            return None;
        }
        Some(spectrum)
    }

    /// A power or an illuminance; as in pbrt-v4 it counts only if it is positive.
    fn photometric(&mut self, parameter: &'static Parameter) -> Option<f32> {
        let name = parameter.name;
        let value = self.float(name)?;
        if value > 0.0 {
            return Some(value as f32);
        }
        let span = self.span_of(name);
        self.report()
            .warning(span, format!("`{name}` has no effect: it is not positive"));
        None
    }

    /// Complains if two parameters are given that say the same thing.
    fn one_of(&mut self, first: &Parameter, second: &Parameter) {
        if self.has(first.name) && self.has(second.name) {
            let span = self.span_of(second.name);
            let message = format!("`{}` and `{}` exclude each other", first.name, second.name);
            self.report().error(span, message);
        }
    }

    /// The image in a file, finite and in colour; `refuse` says what its width and height should be if they will not do.
    fn light_image(
        &mut self,
        parameter: &'static Parameter,
        required: bool,
        refuse: impl Fn([usize; 2]) -> Option<&'static str>,
    ) -> Option<Arc<Image>> {
        let given = self.has(parameter.name);
        let Some(param) = self.take(parameter.name, &[ParamType::String]) else {
            if required && !given {
                let message = format!("this {} has no `\"string {}\"`", self.entity, parameter.name);
                let span = self.span;
                self.report().error(span, message);
            }
            return None;
        };
        let Values::Strings(names) = &param.values else {
            return None;
        };
        self.check_count(&param, names.len(), 1)?;
        let span = param.values_span;
        let path = self.context.resolve(&names[0], span);
        let read = std::fs::read(&path).map_err(|error| format!("cannot read {}: {error}", path.display()));
        let image = read.and_then(|content| {
            self.context.count(&content);
            let image = image_io::decode(&content, &path, Encoding::Srgb).map_err(|error| error.to_string())?;
            check_pixels(&image).map(|()| image)
        });
        let refused = image.and_then(|image| match refuse([image.width(), image.height()]) {
            Some(wanted) => Err(format!(
                "the image of {} must be {wanted}; this one has {} x {} pixels",
                self.entity,
                image.width(),
                image.height()
            )),
            None => Ok(image),
        });
        match refused {
            Ok(image) => {
                check_color_space(self.report(), span, &path, &image);
                Some(Arc::new(image))
            }
            Err(message) => {
                self.report().error(span, message);
                None
            }
        }
    }
}

/// Complains about an image that cannot emit.
fn check_pixels(image: &Image) -> Result<(), String> {
    let rgb = image
        .to_rgb()
        .ok_or("the image has neither the channels R, G and B nor Y")?;
    match rgb.iter().position(|pixel| !pixel.iter().all(|c| c.is_finite())) {
        None => Ok(()),
        Some(i) => Err(format!(
            "the image has a value that is not finite, in column {} of row {}",
            i % image.width(),
            i / image.width()
        )),
    }
}
