//! What a rendered EXR file says about its making.

use ::exr::meta::attribute::{AttributeValue, Text};
use std::collections::HashMap;

use super::Chromaticities;

/// How an image was made: enough to make it again. Nothing depends on the time of day, so two files of the same render differ in
/// `render_seconds` only.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageMetadata {
    /// `lucerna:seed`, as a decimal string: EXR has no 64-bit integers.
    pub seed: u64,
    /// `lucerna:spp`, samples a pixel.
    pub spp: i32,
    /// `lucerna:integrator`, its name on the command line.
    pub integrator: String,
    /// `lucerna:backend`, its name on the command line.
    pub backend: String,
    /// `lucerna:version` of the program.
    pub version: String,
    /// `lucerna:render_seconds`, wall time of the render.
    pub render_seconds: f64,
    /// `lucerna:scene_hash`, of the scene description, in hexadecimal.
    pub scene_hash: String,
    /// Chromaticities (x, y) of red, green, blue and white, the standard attribute `chromaticities`: what colour space R, G and B are in.
    pub chromaticities: Chromaticities,
    /// Whether there are channels of radiance by wavelength, which the attributes `spectralLayoutVersion` and `emissiveUnits` say
    /// (Fichet, Pacanowski and Wilkie 2021).
    pub is_spectral: bool,
}

const SPECTRAL_LAYOUT: &str = "spectralLayoutVersion";
const EMISSIVE_UNITS: &str = "emissiveUnits";
const SEED: &str = "lucerna:seed";
const SPP: &str = "lucerna:spp";
const INTEGRATOR: &str = "lucerna:integrator";
const BACKEND: &str = "lucerna:backend";
const VERSION: &str = "lucerna:version";
const RENDER_SECONDS: &str = "lucerna:render_seconds";
const SCENE_HASH: &str = "lucerna:scene_hash";

impl ImageMetadata {
    /// The EXR attributes.
    pub(super) fn to_attributes(&self) -> HashMap<Text, AttributeValue> {
        let text = |string: &str| AttributeValue::Text(latin1(string));
        let mut attributes: HashMap<Text, AttributeValue> = [
            (SEED, text(&self.seed.to_string())),
            (SPP, AttributeValue::I32(self.spp)),
            (INTEGRATOR, text(&self.integrator)),
            (BACKEND, text(&self.backend)),
            (VERSION, text(&self.version)),
            (RENDER_SECONDS, AttributeValue::F64(self.render_seconds)),
            (SCENE_HASH, text(&self.scene_hash)),
        ]
        .map(|(name, value)| (latin1(name), value))
        .into();
        if self.is_spectral {
            attributes.insert(latin1(SPECTRAL_LAYOUT), text("1.0"));
            attributes.insert(latin1(EMISSIVE_UNITS), text("W.m^-2.sr^-1"));
        }
        attributes
    }

    /// The metadata among a file's attributes; `None` unless all of it is there with the right types.
    pub(super) fn from_attributes(
        attributes: &HashMap<Text, AttributeValue>,
        chromaticities: Chromaticities,
    ) -> Option<Self> {
        let value = |name: &str| attributes.get(&latin1(name));
        let text = |name: &str| match value(name) {
            Some(AttributeValue::Text(text)) => Some(text.to_string()),
            _ => None,
        };
        let Some(&AttributeValue::I32(spp)) = value(SPP) else {
            return None;
        };
        let Some(&AttributeValue::F64(render_seconds)) = value(RENDER_SECONDS) else {
            return None;
        };
        Some(Self {
            seed: text(SEED)?.parse().ok()?,
            spp,
            integrator: text(INTEGRATOR)?,
            backend: text(BACKEND)?,
            version: text(VERSION)?,
            render_seconds,
            scene_hash: text(SCENE_HASH)?,
            chromaticities,
            is_spectral: text(SPECTRAL_LAYOUT).is_some(),
        })
    }
}

/// EXR text, one byte a character; a character that does not fit becomes `?`.
pub(super) fn latin1(string: &str) -> Text {
    let bytes = string.chars().map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?'));
    Text::from_bytes_unchecked(bytes.collect())
}
