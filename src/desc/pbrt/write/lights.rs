//! Lights.

use super::Writer;
use glam::DVec3;

use super::entity::Entity;
use crate::desc::{AreaLightDesc, AreaSpread, LightDesc, LightKind, SpectrumDesc, SpotFalloff};
use crate::error::Result;

impl Writer<'_> {
    pub(super) fn lights(&mut self) -> Result<()> {
        for light in &self.desc.lights {
            self.block(|writer| {
                writer.motion(&light.world_from_light);
                let entity = writer.light(light)?;
                writer.put(entity)
            })?;
        }
        Ok(())
    }

    fn light(&mut self, light: &LightDesc) -> Result<Entity> {
        let (name, spectrum, photometric) = match &light.kind {
            LightKind::Point { .. } => ("point", "I", "power"),
            LightKind::Spot { .. } => ("spot", "I", "power"),
            LightKind::Goniometric { .. } => ("goniometric", "I", "power"),
            LightKind::Projection { .. } => ("projection", "I", "power"),
            LightKind::Distant { .. } => ("distant", "L", "illuminance"),
            LightKind::Infinite { .. } => ("infinite", "L", "illuminance"),
        };
        let mut entity = Entity::new("LightSource", name);
        let e = &mut entity;
        match &light.kind {
            LightKind::Point { from } => {
                e.point("point3", "from", *from);
            }
            LightKind::Spot {
                from,
                to,
                angle,
                delta,
                falloff,
            } => {
                if *falloff == SpotFalloff::Linear {
                    e.string("falloff", "linear");
                    self.note("LightSource \"spot\" \"string falloff\"");
                }
                e.point("point3", "from", *from)
                    .point("point3", "to", *to)
                    .float("coneangle", *angle)
                    .float("conedeltaangle", *delta);
            }
            LightKind::Goniometric { image } => {
                e.string("filename", &self.parts.image(image)?);
            }
            LightKind::Projection { image, fov } => {
                e.string("filename", &self.parts.image(image)?).float("fov", *fov);
            }
            LightKind::Distant { from, to } => {
                e.point("point3", "from", *from).point("point3", "to", *to);
            }
            LightKind::Infinite { image, portal } => {
                if let Some(image) = image {
                    e.string("filename", &self.parts.image(image)?);
                }
                if let Some(corners) = portal {
                    let corners: Vec<f64> = corners.iter().flat_map(DVec3::to_array).collect();
                    e.numbers("point3", "portal", &corners);
                }
            }
        }
        put_emission(e, spectrum, light.spectrum.as_ref(), light.scale);
        if let Some(value) = light.photometric {
            e.single(photometric, value);
        }
        Ok(entity)
    }

    pub(super) fn area_light(&mut self, light: &AreaLightDesc) -> Result<()> {
        let mut entity = Entity::new("AreaLightSource", "diffuse");
        if let Some(image) = &light.image {
            entity.string("filename", &self.parts.image(image)?);
        }
        put_emission(&mut entity, "L", light.l.as_ref(), light.scale);
        if let Some(power) = light.power {
            entity.single("power", power);
        }
        entity.boolean("twosided", light.two_sided);
        if light.spread == AreaSpread::Normal {
            entity.string("spread", "normal");
            self.note("AreaLightSource \"string spread\"");
        }
        self.put(entity)
    }
}

fn put_emission(entity: &mut Entity, name: &str, spectrum: Option<&SpectrumDesc>, scale: f32) {
    if let Some(spectrum) = spectrum {
        entity.spectrum(name, spectrum);
    }
    entity.single("scale", scale);
}
