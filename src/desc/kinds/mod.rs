//! Every kind of material, medium, light, texture, sampler and integrator with its parameters: the reader goes by these tables, and
//! `lucerna list` prints them.

pub(super) mod integrators;
pub(super) mod lights;
pub(super) mod materials;
pub(super) mod media;
mod parameter;
pub(super) mod samplers;
pub(super) mod textures;

use super::texture::TextureClass;

pub use integrators::INTEGRATORS;
pub use lights::LIGHTS;
pub use materials::MATERIALS;
pub use media::MEDIA;
pub use parameter::{FloatRange, Parameter, ParameterDefault, ParameterKind};
pub use samplers::SAMPLERS;
pub use textures::TEXTURES;

/// A kind of something that a scene file may use.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The directive: `Material`, `MakeNamedMedium`, `LightSource`, `AreaLightSource`, `Texture`, `Sampler` or `Integrator`.
    pub directive: &'static str,
    /// As in a scene file.
    pub name: &'static str,
    /// Of which classes there are textures of this kind; none of anything else.
    pub classes: &'static [TextureClass],
    /// What it is, in a sentence without a full stop.
    pub doc: &'static str,
    /// Its parameters, of distinct names.
    pub parameters: &'static [&'static Parameter],
}

impl Entry {
    const fn new(
        directive: &'static str,
        name: &'static str,
        doc: &'static str,
        parameters: &'static [&'static Parameter],
    ) -> Self {
        Self {
            directive,
            name,
            classes: &[],
            doc,
            parameters,
        }
    }

    const fn of_classes(self, classes: &'static [TextureClass]) -> Self {
        Self { classes, ..self }
    }

    /// Whether it has a parameter of this name.
    pub fn has(&self, parameter: &str) -> bool {
        self.parameters.iter().any(|known| known.name == parameter)
    }
}
