//! Media, and which of them are on the two sides of a shape.

use super::graph::{Object, ObjectIndex, Property, Value};
use super::loader::Loader;
use super::plugins::Class;
use super::props::Props;
use super::spectrum::Use;
use crate::desc::{CoefficientsDesc, MediumDesc, MediumId, MediumInterfaceDesc, SpectrumDesc, SpectrumValue};
use crate::error::Span;

/// The properties of a shape that are media.
const SIDES: [&str; 2] = ["interior", "exterior"];

impl<'g> Loader<'g> {
    /// Whether media are seen: in Mitsuba only two of its integrators see them, and without one this program does.
    pub fn sees_media(&self) -> bool {
        let integrators = self.graph.objects[0].properties.iter();
        let mut integrators = integrators.filter_map(|property| self.object_of(property, Class::Integrator));
        integrators.all(|(_, object)| !matches!(object.plugin.as_str(), "path" | "direct" | "ptracer"))
    }

    /// What is on the sides of a shape, if it has an `interior` or an `exterior`.
    pub fn media_of(&mut self, props: &mut Props<'g>) -> Option<MediumInterfaceDesc> {
        let [interior, exterior] = SIDES.map(|name| self.medium_by(props, name));
        let graph = self.graph;
        let has_no_side = |property: &Property| match property.value {
            Value::Object(index) => {
                graph.object(index).class == Class::Medium && !SIDES.contains(&property.name.as_str())
            }
            _ => false,
        };
        for property in props.objects(has_no_side) {
            let message = "a medium of a shape is named `interior` or `exterior`; this one has no effect";
            props.warning(property.span, message);
        }
        (interior.is_some() || exterior.is_some()).then(|| MediumInterfaceDesc {
            interior: interior.flatten(),
            exterior: exterior.flatten(),
        })
    }

    /// The one medium inside another object; none if there is none, or if nothing sees it.
    pub fn medium_inside(&mut self, props: &mut Props<'g>) -> Option<MediumId> {
        let (index, object) = self.child(props, Class::Medium)?;
        self.medium(index, object)
    }

    #[expect(
        clippy::option_option,
        reason = "whether there is one, and which; a medium that is left out is a vacuum"
    )]
    fn medium_by(&mut self, props: &mut Props<'g>, name: &'static str) -> Option<Option<MediumId>> {
        let property = props.take(name)?;
        let Some((index, object)) = self.object_of(property, Class::Medium) else {
            props.error(property.span, format!("`{name}` must be a medium"));
            return None;
        };
        Some(self.medium(index, object))
    }

    /// A medium, translated once; none if nothing sees it or if it is wrong, which is said.
    fn medium(&mut self, index: ObjectIndex, object: &'g Object) -> Option<MediumId> {
        if let Some(&id) = self.media_ids.get(&index) {
            return id;
        }
        let id = if self.sees_media() {
            self.translate_medium(object)
        } else {
            let message =
                "this medium is not seen: Mitsuba renders media with the integrators `volpath` and `volpathmis`";
            self.report().warning(object.span, message);
            None
        };
        self.media_ids.insert(index, id);
        id
    }

    fn translate_medium(&mut self, object: &'g Object) -> Option<MediumId> {
        if object.plugin != "homogeneous" {
            self.refuse(object, "a vacuum stands in");
            return None;
        }
        let mut props = Props::new(object);
        let sigma_t = self.coefficient(&mut props, "sigma_t", 1.0, Use::Unbounded);
        let albedo = self.coefficient(&mut props, "albedo", 0.75, Use::Albedo);
        let scale = props.float_in("scale", 1.0, "not negative", |v| v >= 0.0);
        // How light is looked for; the mean is the same.
        props.ignore(&["sample_emitters", "has_spectral_extinction"]);
        let phase = self.child(&mut props, Class::Phase);
        props.finish(self.report());
        let g = phase.map_or(0.0, |(_, phase)| self.asymmetry(phase));
        let taken = |name: &String| self.media.iter().any(|medium| medium.name == *name);
        let name = object.id.clone().filter(|id| !id.is_empty() && !taken(id));
        self.media.push(MediumDesc {
            name: name.unwrap_or_else(|| format!("medium{}", self.media.len() + 1)),
            coefficients: CoefficientsDesc::Whole { sigma_t, albedo },
            scale,
            g,
            le: None,
            le_scale: 1.0,
            span: object.span,
        });
        Some(MediumId(self.media.len() as u32 - 1))
    }

    /// A number, a spectrum, or a volume that is the same everywhere.
    fn coefficient(&mut self, props: &mut Props<'g>, name: &'static str, default: f32, usage: Use) -> SpectrumDesc {
        let span = props.object.span;
        let otherwise = constant(default, span);
        let Some(property) = props.take(name) else {
            return otherwise;
        };
        if let Some((_, volume)) = self.object_of(property, Class::Volume) {
            return self.uniform_volume(volume, usage).unwrap_or(otherwise);
        }
        if let Some((_, texture)) = self.texture_of(property) {
            let message = format!("`{name}` of a medium is a spectrum or a volume, not a texture");
            props.error(texture.span, message);
            return otherwise;
        }
        self.spectrum(property, usage).unwrap_or(otherwise)
    }

    fn uniform_volume(&mut self, object: &'g Object, usage: Use) -> Option<SpectrumDesc> {
        if object.plugin != "constvolume" {
            self.refuse(object, "a default stands in");
            return None;
        }
        let mut props = Props::new(object);
        let value = props.take("value");
        props.ignore(&["to_world"]);
        props.finish(self.report());
        match value {
            Some(value) => self.spectrum(value, usage),
            None => Some(constant(1.0, object.span)),
        }
    }

    /// The mean cosine of a phase function.
    fn asymmetry(&mut self, object: &'g Object) -> f64 {
        let mut props = Props::new(object);
        let g = match object.plugin.as_str() {
            "isotropic" => 0.0,
            "hg" => props.float_in("g", 0.8, "a number between -1 and 1", |g| g > -1.0 && g < 1.0),
            _ => {
                self.refuse(object, "light is scattered evenly");
                return 0.0;
            }
        };
        props.finish(self.report());
        g
    }
}

fn constant(value: f32, span: Span) -> SpectrumDesc {
    SpectrumDesc {
        value: SpectrumValue::Constant(value),
        span,
    }
}
