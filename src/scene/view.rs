//! One picture of a scene: camera, film, filter, sampler.

use std::ops::Range;
use std::path::PathBuf;

use super::shapes::animated;
use super::{Scene, media};
use crate::camera::{Camera, CameraSpec, Projection, RasterDomain, Realistic, RealisticSpec};
use crate::desc::{CameraKind, FilmDesc, FilmKind, GBufferSpace, MeasureDesc, SceneDesc, SensorDesc, ViewDesc};
use crate::error::{Error, Result, Severity};
use crate::film::{Film, PixelFilter, PixelRect, Sensor, SensorSpec};
use crate::math::{DAffine3, Vec3};
use crate::medium::MediumId;
use crate::sampling::{Sampler, SamplerKind};
use crate::spectrum::{ColorMode, ColorSpace, Outside, SampledSpectrum, Spectrum, Wavelengths, sensor_curves};

/// Everything about a picture that is not the scene.
#[derive(Clone, Debug)]
pub struct View {
    /// Distinct among the views of a scene.
    pub name: String,
    /// Where from.
    pub camera: Camera,
    /// What the camera stands in; `None` is the vacuum.
    pub medium: Option<MediumId>,
    /// Pixels of the whole picture.
    pub resolution: [u32; 2],
    /// The pixels that are rendered.
    pub crop: PixelRect,
    /// How much of its surroundings a pixel sees.
    pub filter: PixelFilter,
    /// What the film records of light.
    pub sensor: Sensor,
    /// What the picture's red, green and blue are.
    pub color_space: ColorSpace,
    /// The source of random numbers, with the number of samples a pixel.
    pub sampler: Sampler,
    /// Which of the samples of each pixel are rendered; within the number that the sampler plans for.
    pub samples: Range<u32>,
    /// The output that the scene names.
    pub filename: Option<PathBuf>,
    /// What the film keeps beside colours.
    pub film_kind: FilmKind,
}

/// What a command line changes of a view.
#[derive(Clone, Copy, Debug, Default)]
pub struct ViewOverrides {
    /// Pixels of the whole picture.
    pub resolution: Option<[u32; 2]>,
    /// The pixels to render.
    pub crop: Option<PixelRect>,
    /// Samples a pixel.
    pub spp: Option<u32>,
    /// What that number is rounded up to a multiple of, whoever gives it; 0 leaves it as it is.
    pub spp_multiple: u32,
    /// Kind of sampler.
    pub sampler: Option<SamplerKind>,
    /// Only this sample of each pixel.
    pub sample: Option<u32>,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl View {
    /// The view that `view` of `desc` describes, for transport in `color`.
    ///
    /// # Errors
    /// [`Error::Scene`] for a camera, filter or sensor that cannot be had, [`Error::Usage`] for an override that makes no sense.
    pub fn build(desc: &SceneDesc, view: &ViewDesc, color: ColorMode, overrides: &ViewOverrides) -> Result<Self> {
        let problem =
            |message: String| Error::Scene(vec![desc.sources.diagnostic(Severity::Error, view.span, message)]);
        let resolution = overrides.resolution.unwrap_or(view.film.resolution);
        let crop = overrides.crop.unwrap_or_else(|| view.film.crop.pixels(resolution));
        if crop.x0 >= crop.x1 || crop.y0 >= crop.y1 || crop.x1 > resolution[0] || crop.y1 > resolution[1] {
            let [width, height] = resolution;
            return Err(Error::Usage(format!(
                "the pixels {},{} to {},{} (exclusive) are not all in the picture of {width}x{height}",
                crop.x0, crop.y0, crop.x1, crop.y1
            )));
        }
        let filter = PixelFilter::new(view.filter.kind, view.filter.radius)
            .ok_or_else(|| problem("this pixel filter is zero or integrates to zero".to_owned()))?;
        let kind = overrides.sampler.unwrap_or(view.sampler.kind);
        let spp = overrides.spp.unwrap_or(view.sampler.pixel_samples);
        let spp = spp.checked_next_multiple_of(overrides.spp_multiple).unwrap_or(spp);
        if let Some(sample) = overrides.sample.filter(|&sample| sample >= spp) {
            return Err(Error::Usage(format!(
                "there is no sample {sample}: a pixel has {spp}, counted from 0"
            )));
        }
        Ok(Self {
            name: view.name.clone(),
            camera: camera(desc, view, resolution).map_err(problem)?,
            medium: view.camera.medium.map(media::id),
            resolution,
            crop,
            filter,
            sensor: Sensor::new(color, &sensor_spec(&view.film)).map_err(problem)?,
            color_space: view.film.color_space,
            sampler: Sampler::new(kind, overrides.seed, spp),
            samples: overrides.sample.map_or(0..spp, |sample| sample..sample + 1),
            filename: view.film.filename.clone(),
            film_kind: view.film.kind,
        })
    }

    /// How much finer than a pixel textures are filtered, as many samples together see the pixel: 1 / sqrt(samples), at least 1/8,
    /// as in pbrt-v4. It is that of all samples that are planned, whichever of them are rendered.
    pub fn detail_scale(&self) -> f32 {
        (1.0 / (self.sampler.samples_per_pixel() as f32).sqrt()).max(0.125)
    }

    /// What a light path brings to the picture, for a unit area of film: see [`Sensor::splat_to_rgb`].
    #[inline]
    pub fn splat_to_rgb(&self, l: SampledSpectrum, lambda: &Wavelengths) -> [f32; 3] {
        let [width, height] = self.resolution;
        self.sensor.splat_to_rgb(l, lambda, width as f32 * height as f32)
    }

    /// The film positions that its pixels see; light paths reach the camera there.
    pub fn domain(&self) -> RasterDomain {
        RasterDomain::new(self.resolution, self.filter.radius())
    }

    /// An empty film for it.
    pub fn film(&self) -> Film {
        Film::new(self.resolution, self.crop)
    }

    /// `film`, one for this view, with what it is to keep of `scene` beside colours.
    pub fn with_layers(&self, film: Film, scene: &Scene) -> Film {
        let corners = scene.bounds().corners().map(Vec3::as_dvec3);
        let at = |time: f32| match self.film_kind {
            FilmKind::GBuffer(GBufferSpace::Camera) => self.camera.camera_from_world(time),
            _ => DAffine3::IDENTITY,
        };
        // Twice as far as at some times, for what moves in between.
        let reach = [0.0, 0.25, 0.5, 0.75, 1.0]
            .map(at)
            .iter()
            .flat_map(|transform| corners.map(|corner| 2.0 * transform.transform_point3(corner).abs().max_element()))
            .fold(0.0, f64::max);
        film.of_kind(self.film_kind, reach)
    }
}

fn sensor_spec(film: &FilmDesc) -> SensorSpec {
    SensorSpec {
        curves: match &film.sensor {
            SensorDesc::Cie1931 => None,
            // The parser knows the names.
            SensorDesc::Named(name) => sensor_curves(name),
            SensorDesc::Curves(rows) => Some([1, 2, 3].map(|channel| {
                let points = rows.iter().map(|row| (row[0], row[channel])).collect();
                Spectrum::tabulated(points, Outside::Zero)
            })),
        },
        white_balance: film.white_balance,
        color_space: film.color_space,
        imaging_ratio: film.imaging_ratio(),
        max_component: film.max_component,
    }
}

/// The camera of a view, or what is wrong with it.
fn camera(desc: &SceneDesc, view: &ViewDesc, resolution: [u32; 2]) -> Result<Camera, String> {
    let camera = &view.camera;
    let [start, end] = desc.transform_times;
    let shutter = camera.shutter.map(|time| (time - start) / (end - start));
    let world_from_camera = animated(&camera.world_from_camera())?;
    let projection = match &camera.kind {
        &CameraKind::Perspective { fov, near_clip } => Projection::Perspective { fov, near_clip },
        CameraKind::Orthographic => Projection::Orthographic,
        CameraKind::Spherical(_) | CameraKind::Realistic(_) if view.film.measure == MeasureDesc::Irradiance => {
            return Err("only a camera with a flat screen measures irradiance".to_owned());
        }
        CameraKind::Spherical(map) => {
            return Ok(Camera::spherical(*map, resolution, shutter, &world_from_camera));
        }
        CameraKind::Realistic(lenses) => {
            let spec = RealisticSpec {
                desc: lenses,
                film_diagonal: view.film.diagonal * 1e-3,
                resolution,
            };
            return Ok(Camera::realistic(Realistic::new(&spec)?, shutter, &world_from_camera));
        }
    };
    Ok(Camera::new(&CameraSpec {
        projection,
        screen_window: camera.screen_window(resolution),
        resolution,
        lens_radius: camera.lens_radius,
        focal_distance: camera.focal_distance,
        aperture: camera.aperture,
        measure: view.film.measure,
        shutter,
        world_from_camera,
    }))
}
