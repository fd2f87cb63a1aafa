//! Rays through a row of spherical surfaces.

use super::stop::Stop;
use crate::desc::RealisticDesc;
use crate::math::{DVec2, DVec3};

/// A surface, in metres.
#[derive(Clone, Copy, Debug)]
struct Surface {
    /// Of curvature, positive if convex seen from the scene; 0 for the aperture stop.
    radius: f64,
    /// Along the axis to the next surface towards the film.
    thickness: f64,
    /// Index of refraction between those two.
    eta: f64,
    /// Of the opening.
    aperture: f64,
}

/// Surfaces from the scene to the film.
#[derive(Clone, Debug)]
pub(super) struct Lens {
    surfaces: Vec<Surface>,
}

/// Where rays that come parallel to the axis cross it, and where they seem to be bent: z on the way back from the film.
struct CardinalPoints {
    focus: f64,
    principal: f64,
}

impl Lens {
    pub fn new(desc: &RealisticDesc) -> Self {
        let surface = |surface: &crate::desc::LensSurface| Surface {
            radius: surface.radius * 1e-3,
            thickness: surface.thickness * 1e-3,
            eta: if surface.eta == 0.0 { 1.0 } else { surface.eta },
            aperture: 0.5 * surface.diameter * 1e-3,
        };
        Self {
            surfaces: desc.surfaces.iter().map(surface).collect(),
        }
    }

    /// The distance of the rear lens from the film.
    pub fn rear_z(&self) -> f64 {
        self.surfaces.last().map_or(0.0, |surface| surface.thickness)
    }

    /// The radius of the rear lens.
    pub fn rear_radius(&self) -> f64 {
        self.surfaces.last().map_or(0.0, |surface| surface.aperture)
    }

    fn front_z(&self) -> f64 {
        self.surfaces.iter().map(|surface| surface.thickness).sum()
    }

    /// Moves the lenses so that things at a distance from the film are sharp, by the thick lens that they are for rays near the axis (pbrt
    /// 4th ed., section 5.4.2 online); the distance from the film to where they then are.
    ///
    /// # Errors
    /// A message if that cannot be.
    pub fn focus(&mut self, distance: f64, film_diagonal: f64) -> Result<f64, String> {
        let height = 1e-3 * film_diagonal;
        let [scene, film] = self
            .cardinal_points(height)
            .ok_or("no ray along the axis comes through these lenses: is the aperture too small?")?;
        let f = scene.focus - scene.principal;
        let span = film.principal + distance - scene.principal;
        let c = span * (span - 4.0 * f);
        if !(f.is_finite() && c > 0.0) {
            return Err(format!(
                "these lenses, of the focal length {:.4} m, cannot be focused at {distance}, which is too near",
                f.abs()
            ));
        }
        let shift = 0.5 * (film.principal + distance + scene.principal - c.sqrt());
        if let Some(rear) = self.surfaces.last_mut() {
            rear.thickness += shift;
        }
        if self.rear_z() <= 0.0 {
            return Err("focused, the lenses would be behind the film".to_owned());
        }
        Ok(shift - scene.principal)
    }

    /// For parallel rays from the scene, and from the film.
    fn cardinal_points(&self, height: f64) -> Option<[CardinalPoints; 2]> {
        let of = |(o, d): (DVec3, DVec3)| {
            let at_height = |x: f64| -(o.z + (x - o.x) / d.x * d.z);
            CardinalPoints {
                focus: at_height(0.0),
                principal: at_height(height),
            }
        };
        let scene = self.trace_from_scene(DVec3::new(height, 0.0, self.front_z() + 1.0), -DVec3::Z)?;
        let film = self.trace_from_film(DVec3::new(height, 0.0, self.rear_z() - 1.0), DVec3::Z, &Stop::ROUND)?;
        Some([of(scene), of((film.0, film.1))])
    }

    /// Follows a ray from the film to the scene: where it leaves the front lens, its direction there, and the share of light that
    /// the stop lets through. `None` if it does not come through.
    pub fn trace_from_film(&self, origin: DVec3, direction: DVec3, stop: &Stop) -> Option<(DVec3, DVec3, f64)> {
        let (mut o, mut d) = (origin, direction.normalize());
        let (mut z, mut passed) = (0.0, 1.0);
        for (i, surface) in self.surfaces.iter().enumerate().rev() {
            z += surface.thickness;
            let (hit, n) = surface.meet(o, d, z)?;
            o = hit;
            let within = hit.truncate() / surface.aperture;
            let Some(n) = n else {
                passed *= stop.transmittance(within);
                if passed == 0.0 {
                    return None;
                }
                continue;
            };
            if !is_open(within) {
                return None;
            }
            let beyond = if i > 0 { self.surfaces[i - 1].eta } else { 1.0 };
            d = refract(d, n, surface.eta / beyond)?;
        }
        Some((o, d, passed))
    }

    /// The other way round, through a round stop.
    fn trace_from_scene(&self, origin: DVec3, direction: DVec3) -> Option<(DVec3, DVec3)> {
        let (mut o, mut d) = (origin, direction.normalize());
        let mut z = self.front_z();
        let mut before = 1.0;
        for surface in &self.surfaces {
            let (hit, n) = surface.meet(o, d, z)?;
            o = hit;
            if !is_open(hit.truncate() / surface.aperture) {
                return None;
            }
            if let Some(n) = n {
                d = refract(d, n, before / surface.eta)?;
            }
            before = surface.eta;
            z -= surface.thickness;
        }
        Some((o, d))
    }

    /// Where the stop seems to be, seen from the film, and by how much it is enlarged: the z of the exit pupil and its radius, for rays
    /// near the axis. `None` if there is no stop or its image is at infinity.
    pub fn exit_pupil(&self) -> Option<[f64; 2]> {
        let index = self.surfaces.iter().position(|surface| surface.radius == 0.0)?;
        let behind = &self.surfaces[index + 1..];
        let z = behind.iter().map(|surface| surface.thickness).sum::<f64>() + self.surfaces[index].thickness;
        // A ray of slope 1 from the centre of the stop, by the formulas for small angles: height, and slope times index.
        let (mut eta, mut at) = (self.surfaces[index].eta, self.surfaces[index].thickness);
        let (mut height, mut slope) = (at, 1.0);
        let mut travelled = at;
        for surface in behind {
            // Towards the film: a surface convex to the scene has its centre ahead.
            slope = (eta * slope - height * (surface.eta - eta) / surface.radius) / surface.eta;
            eta = surface.eta;
            at = surface.thickness;
            height += slope * at;
            travelled += at;
        }
        // On the film: the ray comes from the axis at this distance before it.
        let distance = height / slope;
        let enlarged = self.surfaces[index].eta / (eta * slope);
        let radius = (self.surfaces[index].aperture * enlarged).abs();
        debug_assert!((travelled - z).abs() < 1e-9);
        (distance.is_finite() && radius.is_finite() && distance.abs() < 1e3).then_some([distance, radius])
    }
}

fn is_open(within: DVec2) -> bool {
    within.length_squared() <= 1.0
}

impl Surface {
    /// Where a ray meets the surface, whose vertex is at `z`, and its normal against the ray; none at the stop.
    fn meet(&self, o: DVec3, d: DVec3, z: f64) -> Option<(DVec3, Option<DVec3>)> {
        if self.radius == 0.0 {
            let t = (z - o.z) / d.z;
            return (t >= 0.0).then(|| (o + d * t, None));
        }
        let center = DVec3::new(0.0, 0.0, z - self.radius);
        let to_center = center - o;
        let middle = to_center.dot(d);
        let discriminant = self.radius * self.radius - (to_center - d * middle).length_squared();
        if discriminant < 0.0 {
            return None;
        }
        // The side of the sphere that the vertex is on: the far one if the centre lies on the way to it.
        let far = (d.z > 0.0) == (self.radius > 0.0);
        let root = discriminant.sqrt();
        let t = if far { middle + root } else { middle - root };
        let hit = o + d * t;
        let n = (hit - center) / self.radius.abs();
        let against = if n.dot(d) > 0.0 { -n } else { n };
        (t >= 0.0).then_some((hit, Some(against)))
    }
}

/// The direction beyond a surface with the normal `n` against `d`; `eta` is the index before it over that beyond. `None` if all is
/// reflected.
fn refract(d: DVec3, n: DVec3, eta: f64) -> Option<DVec3> {
    let cos = -d.dot(n);
    let sin_squared = eta * eta * (1.0 - cos * cos);
    (sin_squared < 1.0).then(|| (d * eta + n * (eta * cos - (1.0 - sin_squared).sqrt())).normalize())
}
