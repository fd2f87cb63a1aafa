//! Points of lights for the eight lanes of a packet, computed together.

mod planes;
mod spheres;

use super::{Light, LightDensity, LightEnd, LightId, LightSample};
use crate::math::{Kernel, LANES, Lanes, Vec2, Vec3, Vec3Lanes, VectorLanes, Vectorizer};
use crate::spectrum::{SpectrumLanes, Wavelengths};
pub(super) use planes::PlaneLight;
use planes::Planes;
pub(super) use spheres::SphereLight;
use spheres::Spheres;

/// [`Light::sample_li`] of eight lanes: the same bits, several times faster for planes and spheres at rest that are alike all over. Made
/// once for the lights of a scene and used again and again.
#[derive(Clone, Debug, Default)]
pub struct LightLanes {
    vectorizer: Vectorizer,
    /// The light that was put into the lane last.
    held: [Option<Held>; LANES],
    /// The light that was asked for last in all lanes, and whether it is there, see [`Self::sample_one`].
    one: Option<(LightId, bool)>,
    plain: PlainLights,
    samples: LightSampleLanes,
}

/// What [`PlainLight`]s are, one for each lane.
#[derive(Clone, Debug, Default)]
struct PlainLights {
    planes: Planes,
    spheres: Spheres,
    two_sided: [bool; LANES],
    radiance: SpectrumLanes,
}

/// A light in a lane.
#[derive(Clone, Copy, Debug)]
struct Held {
    light: LightId,
    is_sphere: bool,
    /// Whether its radiance is the same at all wavelengths, and in its lane.
    has_radiance: bool,
}

/// A light at rest that sends out the same radiance everywhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlainLight {
    pub shape: PlainShape,
    pub two_sided: bool,
}

/// Its surface.
#[derive(Clone, Copy, Debug)]
pub(super) enum PlainShape {
    Plane(PlaneLight),
    Sphere(SphereLight),
}

/// What [`LightSample`] is of one lane.
#[derive(Clone, Copy, Debug, Default)]
pub struct LightSampleLanes {
    /// See [`LightSample::li`].
    pub li: SpectrumLanes,
    /// See [`LightSample::wi`].
    pub wi: Vec3Lanes,
    /// With respect to solid angle; 0 where nothing was found, 1 for a [`LightDensity::Delta`].
    pub pdf: Lanes,
    /// Whether it is a [`LightDensity::Delta`].
    pub is_delta: [bool; LANES],
    /// Whether it is at [`LightEnd::Infinity`].
    pub is_infinite: [bool; LANES],
    /// See [`LightEnd::Point`].
    pub p: Vec3Lanes,
    /// See [`LightEnd::Point`].
    pub error: Lanes,
    /// See [`LightEnd::Point`].
    pub ng: Vec3Lanes,
}

/// Points of surfaces.
#[derive(Clone, Copy, Debug, Default)]
struct Points {
    p: Vec3Lanes,
    error: Lanes,
    ng: Vec3Lanes,
    /// With respect to solid angle.
    pdf: Lanes,
}

/// The light that a lane samples, and the wavelengths of its path.
pub type ChosenLight<'a> = (LightId, &'a Light, &'a Wavelengths);

impl LightLanes {
    /// Samples a direction from `p` at `time` in each lane towards its light; nothing in lanes without one.
    #[inline]
    pub fn sample(&mut self, lights: &[Option<ChosenLight<'_>>; LANES], p: &Vec3Lanes, time: &Lanes, u: [&Lanes; 2]) {
        let (mut is_plane, mut is_sphere) = ([false; LANES], [false; LANES]);
        for (lane, chosen) in lights.iter().enumerate() {
            let Some((id, light, lambda)) = *chosen else { continue };
            let Some(held) = self.hold(lane, id, light) else {
                continue;
            };
            (is_plane[lane], is_sphere[lane]) = (!held.is_sphere, held.is_sphere);
            if !held.has_radiance {
                self.plain.radiance.set(lane, light.plain_radiance(lambda));
            }
        }
        if is_sphere != [false; LANES] {
            is_sphere = self.plain.spheres.fit(is_sphere, p);
        }
        match (is_plane != [false; LANES], is_sphere != [false; LANES]) {
            (false, false) => {}
            (true, false) => self.compute::<true, false>(is_sphere, p, u),
            (false, true) => self.compute::<false, true>(is_sphere, p, u),
            (true, true) => self.compute::<true, true>(is_sphere, p, u),
        }
        for (lane, chosen) in lights.iter().enumerate() {
            if is_plane[lane] || is_sphere[lane] {
                continue;
            }
            let sample = chosen.and_then(|(_, light, lambda)| {
                light.sample_li(p.get(lane), time[lane], Vec2::new(u[0][lane], u[1][lane]), lambda)
            });
            self.samples.set(lane, sample.as_ref());
        }
    }

    /// [`Self::sample`] of the same light in all lanes, without a look at each; false if it is not a plane whose radiance is the same at
    /// all wavelengths.
    #[inline]
    pub fn sample_one(&mut self, id: LightId, light: &Light, p: &Vec3Lanes, u: [&Lanes; 2]) -> bool {
        let is_held = match self.one {
            Some((one, is_held)) if one == id => is_held,
            _ => self.hold_everywhere(id, light),
        };
        if !is_held {
            return false;
        }
        self.compute::<true, false>([false; LANES], p, u);
        true
    }

    /// Samples the lights that are held, planes, or spheres, or both; which ones `is_sphere` says.
    #[inline]
    fn compute<const HAS_PLANES: bool, const HAS_SPHERES: bool>(
        &mut self,
        is_sphere: [bool; LANES],
        p: &Vec3Lanes,
        u: [&Lanes; 2],
    ) {
        // Not by the kernel, which would copy it by way of the stack.
        self.samples.li = self.plain.radiance;
        (self.samples.is_delta, self.samples.is_infinite) = ([false; LANES], [false; LANES]);
        self.vectorizer.run(Compute::<HAS_PLANES, HAS_SPHERES> {
            lights: &self.plain,
            is_sphere,
            p,
            u,
            samples: &mut self.samples,
        });
    }

    /// What was sampled last.
    #[inline]
    pub fn samples(&self) -> &LightSampleLanes {
        &self.samples
    }

    /// Puts a plane whose radiance is known into all lanes; false if it is none.
    #[inline(never)]
    fn hold_everywhere(&mut self, id: LightId, light: &Light) -> bool {
        let is_held = (0..LANES).all(|lane| {
            let held = self.hold(lane, id, light);
            held.is_some_and(|held| !held.is_sphere && held.has_radiance)
        });
        self.one = Some((id, is_held));
        is_held
    }

    /// Puts a light into a lane, unless it is there; `None` if it is not plain.
    #[inline]
    fn hold(&mut self, lane: usize, id: LightId, light: &Light) -> Option<Held> {
        if let Some(held) = self.held[lane]
            && held.light == id
        {
            return Some(held);
        }
        let radiance = light.known_radiance();
        let light = light.plain()?;
        match &light.shape {
            PlainShape::Plane(plane) => self.plain.planes.set(lane, plane),
            PlainShape::Sphere(sphere) => self.plain.spheres.set(lane, sphere),
        }
        self.plain.two_sided[lane] = light.two_sided;
        // What was everywhere is so no more.
        self.one = self.one.filter(|(_, is_held)| !is_held);
        if let Some(radiance) = radiance {
            self.plain.radiance.set(lane, radiance);
        }
        self.held[lane] = Some(Held {
            light: id,
            is_sphere: matches!(light.shape, PlainShape::Sphere(_)),
            has_radiance: radiance.is_some(),
        });
        self.held[lane]
    }
}

impl LightSampleLanes {
    fn set(&mut self, lane: usize, sample: Option<&LightSample>) {
        let Some(sample) = sample else {
            self.pdf[lane] = 0.0;
            return;
        };
        self.li.set(lane, sample.li);
        self.wi.set(lane, sample.wi);
        (self.is_delta[lane], self.pdf[lane]) = match sample.density {
            LightDensity::Delta => (true, 1.0),
            LightDensity::Continuous(pdf) => (false, pdf.0),
        };
        let (p, error, ng) = match sample.end {
            LightEnd::Point { p, error, ng } => (p, error, ng),
            LightEnd::Infinity => (Vec3::ZERO, 0.0, Vec3::ZERO),
        };
        self.is_infinite[lane] = matches!(sample.end, LightEnd::Infinity);
        self.p.set(lane, p);
        self.error[lane] = error;
        self.ng.set(lane, ng);
    }
}

/// See [`LightLanes::compute`].
struct Compute<'a, const HAS_PLANES: bool, const HAS_SPHERES: bool> {
    lights: &'a PlainLights,
    is_sphere: [bool; LANES],
    p: &'a Vec3Lanes,
    u: [&'a Lanes; 2],
    /// Written at the end: the compiler cannot know that they are apart from the others.
    samples: &'a mut LightSampleLanes,
}

impl<const HAS_PLANES: bool, const HAS_SPHERES: bool> Kernel for Compute<'_, HAS_PLANES, HAS_SPHERES> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let mut points = Points::default();
        if HAS_PLANES {
            points = self.lights.planes.points(self.p, self.u);
        }
        if HAS_SPHERES {
            let on_spheres = self.lights.spheres.points(self.p, self.u);
            points = on_spheres.or(self.is_sphere, &points);
        }
        let (mut wi, mut pdf) = (Vec3Lanes::default(), Lanes::default());
        for (i, pdf) in pdf.iter_mut().enumerate() {
            let (ng, density) = (points.ng.get(i), points.pdf[i]);
            let to_light = points.p.get(i) - self.p.get(i);
            let inverse_distance = 1.0 / to_light.length();
            let direction = to_light * inverse_distance;
            let is_found = (inverse_distance > 0.0)
                & (inverse_distance < f32::INFINITY)
                & (self.lights.two_sided[i] | (ng.dot(-direction) > 0.0))
                & (density > 0.0)
                & (density < f32::INFINITY)
                & !self.lights.radiance.get(i).is_black();
            wi.set(i, direction);
            *pdf = if is_found { density } else { 0.0 };
        }
        let samples = self.samples;
        (samples.wi, samples.pdf) = (wi, pdf);
        (samples.p, samples.error, samples.ng) = (points.p, points.error, points.ng);
    }
}

impl Points {
    /// These in some lanes, and `others` in the rest.
    #[inline(always)]
    fn or(&self, these: [bool; LANES], others: &Self) -> Self {
        let mut points = *others;
        for (i, this) in these.into_iter().enumerate() {
            let select = |a: f32, b: f32| if this { a } else { b };
            let select3 = |a: Vec3, b: Vec3| Vec3::new(select(a.x, b.x), select(a.y, b.y), select(a.z, b.z));
            points.p.set(i, select3(self.p.get(i), others.p.get(i)));
            points.error[i] = select(self.error[i], others.error[i]);
            points.ng.set(i, select3(self.ng.get(i), others.ng.get(i)));
            points.pdf[i] = select(self.pdf[i], others.pdf[i]);
        }
        points
    }
}
