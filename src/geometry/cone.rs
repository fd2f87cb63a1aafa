//! How wide a ray is taken to be.

/// A cone around a path's ray, for the filtering of textures (Akenine-Möller et al. 2019, "Texture Level of Detail Strategies for
/// Real-Time Ray Tracing"). Scattering does not change how it widens, so that its width is that of a pixel seen over the whole
/// length of the path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RayCone {
    /// At the ray's origin, in scene units.
    pub width: f32,
    /// Growth over a unit of distance.
    pub spread: f32,
}

impl RayCone {
    /// The cone from the point at `distance` on.
    #[inline]
    #[must_use]
    pub fn after(self, distance: f32) -> Self {
        Self {
            width: self.width + self.spread * distance,
            ..self
        }
    }
}
