//! From a point of a surface to the coordinates that a texture looks at.

use std::f32::consts::{FRAC_1_PI, PI};

use super::TextureContext;
use crate::math::{DAffine3, Mat2, Vec2, Vec3};

/// Coordinates (s, t), and how they change along the axes of the footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates2 {
    /// The coordinates.
    pub st: Vec2,
    /// Their change along the long axis.
    pub dstdx: Vec2,
    /// Their change along the short axis.
    pub dstdy: Vec2,
}

/// A point in texture space, and how it moves along the axes of the footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coordinates3 {
    /// The point.
    pub p: Vec3,
    /// Its change along the long axis.
    pub dpdx: Vec3,
    /// Its change along the short axis.
    pub dpdy: Vec3,
}

/// The space of a texture: the current transform at its definition.
#[derive(Clone, Copy, Debug)]
pub struct TextureSpace {
    texture_from_world: DAffine3,
}

/// A mapping to two coordinates.
#[derive(Clone, Copy, Debug)]
pub enum Mapping2 {
    /// Those of the surface, times `scale` plus `delta`.
    Uv {
        /// Factors.
        scale: Vec2,
        /// Added after.
        delta: Vec2,
    },
    /// Those of the surface, times `matrix` plus `delta`.
    Affine {
        /// Turns and shears.
        matrix: Mat2,
        /// Added after.
        delta: Vec2,
    },
    /// (polar angle / pi, azimuth / 2 pi) around the origin of texture space.
    Spherical(TextureSpace),
    /// ((pi + azimuth) / 2 pi, z) around the z axis of texture space.
    Cylindrical(TextureSpace),
    /// The dot products with two vectors, in texture space, plus `delta`.
    Planar {
        /// The space of the vectors.
        space: TextureSpace,
        /// For s and t.
        vectors: [Vec3; 2],
        /// Added.
        delta: Vec2,
    },
}

impl TextureSpace {
    /// The space that `world_from_texture`, which must be invertible, leads out of.
    pub fn new(world_from_texture: &DAffine3) -> Self {
        Self {
            texture_from_world: world_from_texture.inverse(),
        }
    }

    /// The point and its footprint in texture space.
    pub fn map(&self, context: &TextureContext) -> Coordinates3 {
        let vector = |v: Vec3| self.texture_from_world.transform_vector3(v.as_dvec3()).as_vec3();
        Coordinates3 {
            p: self.texture_from_world.transform_point3(context.p.as_dvec3()).as_vec3(),
            dpdx: vector(context.dpdx),
            dpdy: vector(context.dpdy),
        }
    }
}

impl Mapping2 {
    /// The coordinates for a context.
    pub fn map(&self, context: &TextureContext) -> Coordinates2 {
        match self {
            Self::Uv { scale, delta } => Coordinates2 {
                st: *scale * context.uv + *delta,
                dstdx: *scale * context.duvdx,
                dstdy: *scale * context.duvdy,
            },
            Self::Affine { matrix, delta } => Coordinates2 {
                st: *matrix * context.uv + *delta,
                dstdx: *matrix * context.duvdx,
                dstdy: *matrix * context.duvdy,
            },
            Self::Spherical(space) => spherical(&space.map(context)),
            Self::Cylindrical(space) => cylindrical(&space.map(context)),
            Self::Planar { space, vectors, delta } => {
                let c = space.map(context);
                let dots = |v: Vec3| Vec2::new(v.dot(vectors[0]), v.dot(vectors[1]));
                Coordinates2 {
                    st: dots(c.p) + *delta,
                    dstdx: dots(c.dpdx),
                    dstdy: dots(c.dpdy),
                }
            }
        }
    }
}

/// s is the polar angle over pi, t the azimuth in [0, 2 pi) over 2 pi, as in pbrt-v4; but the changes are those of these
/// coordinates, where pbrt-v4 has them the other way round.
fn spherical(c: &Coordinates3) -> Coordinates2 {
    let p = c.p;
    let (r2, across2) = (p.length_squared(), p.x * p.x + p.y * p.y);
    let across = across2.sqrt();
    let ds = Vec3::new(p.x * p.z / across, p.y * p.z / across, -across) / (PI * r2);
    let azimuth = p.y.atan2(p.x);
    let azimuth = if azimuth < 0.0 { azimuth + 2.0 * PI } else { azimuth };
    Coordinates2 {
        st: Vec2::new(across.atan2(p.z) * FRAC_1_PI, azimuth * (0.5 * FRAC_1_PI)),
        dstdx: finite(Vec2::new(ds.dot(c.dpdx), azimuth_change(p, c.dpdx))),
        dstdy: finite(Vec2::new(ds.dot(c.dpdy), azimuth_change(p, c.dpdy))),
    }
}

fn cylindrical(c: &Coordinates3) -> Coordinates2 {
    Coordinates2 {
        st: Vec2::new((PI + c.p.y.atan2(c.p.x)) * (0.5 * FRAC_1_PI), c.p.z),
        dstdx: finite(Vec2::new(azimuth_change(c.p, c.dpdx), c.dpdx.z)),
        dstdy: finite(Vec2::new(azimuth_change(c.p, c.dpdy), c.dpdy.z)),
    }
}

/// The change of azimuth / 2 pi with a step `dp`.
fn azimuth_change(p: Vec3, dp: Vec3) -> f32 {
    (p.x * dp.y - p.y * dp.x) / (2.0 * PI * (p.x * p.x + p.y * p.y))
}

/// On the axis the coordinates have no derivative; there all of the texture is within the footprint.
fn finite(change: Vec2) -> Vec2 {
    if change.is_finite() { change } else { Vec2::ONE }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DVec3;

    fn context(p: Vec3, uv: Vec2) -> TextureContext {
        TextureContext {
            p,
            dpdx: Vec3::new(0.3, -0.2, 0.1) * 1e-3,
            dpdy: Vec3::new(-0.1, 0.25, 0.2) * 1e-3,
            n: Vec3::Z,
            uv,
            duvdx: Vec2::new(0.01, 0.02),
            duvdy: Vec2::new(-0.03, 0.04),
            place: None,
        }
    }

    fn space() -> TextureSpace {
        let turned = DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 0.7);
        TextureSpace::new(&(DAffine3::from_translation(DVec3::new(0.5, -1.0, 2.0)) * turned))
    }

    #[test]
    fn uv_is_scaled_then_moved() {
        let mapping = Mapping2::Uv {
            scale: Vec2::new(2.0, -3.0),
            delta: Vec2::new(0.5, 1.0),
        };
        let c = mapping.map(&context(Vec3::ZERO, Vec2::new(0.25, 0.5)));
        assert_eq!(c.st, Vec2::new(1.0, -0.5));
        assert_eq!((c.dstdx, c.dstdy), (Vec2::new(0.02, -0.06), Vec2::new(-0.06, -0.12)));
    }

    #[test]
    fn known_points_have_known_coordinates() {
        let identity = TextureSpace::new(&DAffine3::IDENTITY);
        let spherical = |p| Mapping2::Spherical(identity).map(&context(p, Vec2::ZERO)).st;
        let cylindrical = |p| Mapping2::Cylindrical(identity).map(&context(p, Vec2::ZERO)).st;
        for (p, s, t) in [
            (Vec3::X, 0.5, 0.0),
            (Vec3::Y * 3.0, 0.5, 0.25),
            (-Vec3::Y, 0.5, 0.75),
            (Vec3::new(1.0, 0.0, 1.0), 0.25, 0.0),
            (Vec3::new(0.0, 0.0, -1.0), 1.0, 0.0),
        ] {
            assert!(
                (spherical(p) - Vec2::new(s, t)).length() < 1e-6,
                "{p}: {}",
                spherical(p)
            );
        }
        for (p, s, t) in [(Vec3::X, 0.5, 0.0), (Vec3::new(0.0, -2.0, 7.0), 0.25, 7.0)] {
            assert!((cylindrical(p) - Vec2::new(s, t)).length() < 1e-6);
        }
        let planar = Mapping2::Planar {
            space: TextureSpace::new(&DAffine3::from_translation(DVec3::new(1.0, 2.0, 3.0))),
            vectors: [Vec3::new(0.0, 0.0, 2.0), Vec3::X],
            delta: Vec2::new(0.1, 0.2),
        };
        let c = planar.map(&context(Vec3::new(2.0, 0.0, 4.0), Vec2::ZERO));
        assert!((c.st - Vec2::new(2.1, 1.2)).length() < 1e-6);
    }

    #[test]
    fn changes_are_the_derivatives() {
        let planar = Mapping2::Planar {
            space: space(),
            vectors: [Vec3::new(1.0, 0.5, 0.0), Vec3::Y],
            delta: Vec2::ZERO,
        };
        for mapping in [Mapping2::Spherical(space()), Mapping2::Cylindrical(space()), planar] {
            for p in [Vec3::new(1.7, -0.4, 2.9), Vec3::new(-0.3, -2.0, 1.1)] {
                let here = context(p, Vec2::ZERO);
                let c = mapping.map(&here);
                // Central differences, over many footprints: in single precision one is too small.
                for (step, expected) in [(here.dpdx, c.dstdx), (here.dpdy, c.dstdy)] {
                    let at = |far: f32| mapping.map(&context(p + step * far, Vec2::ZERO)).st;
                    let found = (at(32.0) - at(-32.0)) / 64.0;
                    let error = (found - expected).length();
                    assert!(
                        error < 2e-3 * expected.length(),
                        "{mapping:?} at {p}: {found} and {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn nothing_is_infinite_on_the_axis() {
        let identity = TextureSpace::new(&DAffine3::IDENTITY);
        for mapping in [Mapping2::Spherical(identity), Mapping2::Cylindrical(identity)] {
            for p in [Vec3::ZERO, Vec3::Z] {
                let c = mapping.map(&context(p, Vec2::ZERO));
                assert!(c.st.is_finite() && c.dstdx.is_finite() && c.dstdy.is_finite());
            }
        }
    }
}
