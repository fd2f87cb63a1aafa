//! What stands before `WorldBegin`: cameras, film, filter, sampler, integrator; and media, which cameras may stand in.

use super::Writer;
use std::sync::Arc;

use super::entity::{Entity, quoted};
use crate::desc::{
    ApertureDesc, CameraDesc, CameraKind, CoefficientsDesc, CropDesc, Distribution, FilmDesc, FilmKind, FilterDesc,
    FilterKind, GBufferSpace, Heuristic, IntegratorKind, LightSamplerKind, MeasureDesc, MediumDesc, PhotonFilter,
    RealisticDesc, SamplerDesc, SamplerKind, SensorDesc, StopShape, Strategy, Termination, ViewDesc,
};
use crate::error::{Error, Result};
use crate::sampling::SphereMap;

impl Writer<'_> {
    pub(super) fn options(&mut self) -> Result<()> {
        let desc = self.desc;
        let [start, end] = desc.transform_times;
        if [start, end] != [0.0, 1.0] {
            self.line(&format!("TransformTimes {start} {end}"));
        }
        let Some(first) = desc.views.first() else {
            return Err(Error::Usage("a scene without a view cannot be written".to_owned()));
        };
        for view in &desc.views {
            let is_like_first =
                view.film.is_like(&first.film) && view.filter == first.filter && view.sampler == first.sampler;
            if !is_like_first {
                let message = format!(
                    "the views `{}` and `{}` have films, filters or samplers of their own, which one file cannot say",
                    first.name, view.name
                );
                return Err(Error::Usage(message));
            }
            self.camera(view, desc.views.len() > 1)?;
        }
        self.film(&first.film)?;
        self.filter(&first.filter)?;
        self.sampler(&first.sampler)?;
        self.integrator()
    }

    fn camera(&mut self, view: &ViewDesc, is_one_of_several: bool) -> Result<()> {
        let camera = &view.camera;
        self.line("Identity");
        self.motion(&camera.camera_from_world);
        let medium = camera
            .medium
            .map_or("", |id| &self.desc.media[id.0 as usize].name)
            .to_owned();
        if !self.desc.media.is_empty() {
            self.line(&format!("MediumInterface \"\" {}", quoted(&medium)));
        }
        let mut entity = match &camera.kind {
            CameraKind::Perspective { fov, near_clip } => {
                let mut entity = Entity::new("Camera", "perspective");
                entity.float("fov", *fov);
                if *near_clip != 0.0 {
                    entity.float("nearclip", *near_clip);
                    self.note("Camera \"float nearclip\"");
                }
                self.screen_and_lens(&mut entity, camera);
                entity
            }
            CameraKind::Orthographic => {
                let mut entity = Entity::new("Camera", "orthographic");
                self.screen_and_lens(&mut entity, camera);
                entity
            }
            CameraKind::Spherical(map) => {
                let mut entity = Entity::new("Camera", "spherical");
                entity.string(
                    "mapping",
                    match map {
                        SphereMap::EqualArea => "equalarea",
                        SphereMap::LatLong => "equirectangular",
                    },
                );
                entity
            }
            CameraKind::Realistic(lenses) => self.lenses(lenses)?,
        };
        entity.float("shutteropen", camera.shutter[0]);
        entity.float("shutterclose", camera.shutter[1]);
        if is_one_of_several || view.name != "camera" {
            entity.string("name", &view.name);
            self.note("Camera \"string name\"");
        }
        if is_one_of_several {
            self.note("several cameras");
        }
        self.put(entity)
    }

    fn screen_and_lens(&mut self, entity: &mut Entity, camera: &CameraDesc) {
        if let Some(window) = camera.screen {
            entity.floats("screenwindow", &window);
        }
        if let Some(aspect) = camera.frame_aspect {
            entity.float("frameaspectratio", aspect);
        }
        entity
            .float("lensradius", camera.lens_radius)
            .float("focaldistance", camera.focal_distance);
        if let ApertureDesc::Polygon { blades, rotation } = camera.aperture {
            entity.integer("blades", blades.into()).float("bladerotation", rotation);
            self.note("Camera \"integer blades\"");
        }
    }

    fn lenses(&mut self, lenses: &Arc<RealisticDesc>) -> Result<Entity> {
        let mut entity = Entity::new("Camera", "realistic");
        entity
            .string("lensfile", &self.parts.lenses(lenses)?)
            .float("focusdistance", lenses.focus_distance);
        if let Some(stop) = lenses.surfaces.iter().find(|surface| surface.radius == 0.0) {
            entity.float("aperturediameter", stop.diameter);
        }
        let shape = match &lenses.shape {
            StopShape::Round => return Ok(entity),
            StopShape::Gaussian => "gaussian",
            StopShape::Square => "square",
            StopShape::Pentagon => "pentagon",
            StopShape::Star => "star",
            StopShape::Image(image) => &self.parts.image(image)?,
        };
        entity.string("aperture", shape);
        Ok(entity)
    }

    fn film(&mut self, film: &FilmDesc) -> Result<()> {
        let mut entity = match film.kind {
            FilmKind::Rgb => Entity::new("Film", "rgb"),
            FilmKind::GBuffer(space) => {
                let mut entity = Entity::new("Film", "gbuffer");
                entity.string(
                    "coordinatesystem",
                    match space {
                        GBufferSpace::Camera => "camera",
                        GBufferSpace::World => "world",
                    },
                );
                entity
            }
            FilmKind::Spectral(bins) => {
                let mut entity = Entity::new("Film", "spectral");
                entity
                    .single("lambdamin", bins.range[0])
                    .single("lambdamax", bins.range[1])
                    .integer("nbuckets", bins.count.into());
                entity
            }
        };
        entity.float("diagonal", film.diagonal);
        let [width, height] = film.resolution;
        entity
            .integer("xresolution", width.into())
            .integer("yresolution", height.into());
        match film.crop {
            CropDesc::Full => {}
            CropDesc::Pixels(rect) => {
                let bounds = [rect.x0, rect.x1, rect.y0, rect.y1];
                entity.integers("pixelbounds", bounds.into_iter().map(i64::from));
            }
            CropDesc::Window(window) => {
                entity.singles("float", "cropwindow", window.into_iter());
            }
        }
        if let Some(name) = &film.filename {
            entity.string("filename", &name.to_string_lossy());
        }
        entity.float("iso", film.iso);
        match &film.sensor {
            SensorDesc::Cie1931 => {}
            SensorDesc::Named(name) => {
                entity.string("sensor", name);
            }
            SensorDesc::Curves(rows) => {
                let file = self.parts.responses(rows)?;
                entity.string("sensor", &file);
                self.note("Film \"string sensor\" with a file of responses");
            }
        }
        if let Some(kelvin) = film.white_balance {
            entity.float("whitebalance", kelvin);
        }
        if film.max_component.is_finite() {
            entity.float("maxcomponentvalue", film.max_component);
        }
        if film.measure == MeasureDesc::Irradiance {
            entity.string("measure", "irradiance");
            self.note("Film \"string measure\"");
        }
        self.in_space(film.color_space);
        let (_, _, text) = entity.finish();
        self.line(&text);
        Ok(())
    }

    fn filter(&mut self, filter: &FilterDesc) -> Result<()> {
        let name = match filter.kind {
            FilterKind::Box => "box",
            FilterKind::Triangle => "triangle",
            FilterKind::Gaussian { .. } => "gaussian",
            FilterKind::Mitchell { .. } => "mitchell",
            FilterKind::LanczosSinc { .. } => "sinc",
            FilterKind::BlackmanHarris => {
                self.note("PixelFilter \"blackmanharris\"");
                "blackmanharris"
            }
        };
        let mut entity = Entity::new("PixelFilter", name);
        entity
            .float("xradius", filter.radius[0])
            .float("yradius", filter.radius[1]);
        match filter.kind {
            FilterKind::Gaussian { sigma } => {
                entity.float("sigma", sigma);
            }
            FilterKind::Mitchell { b, c } => {
                entity.float("B", b).float("C", c);
            }
            FilterKind::LanczosSinc { tau } => {
                entity.float("tau", tau);
            }
            FilterKind::Box | FilterKind::Triangle | FilterKind::BlackmanHarris => {}
        }
        self.put(entity)
    }

    fn sampler(&mut self, sampler: &SamplerDesc) -> Result<()> {
        let name = match sampler.kind {
            SamplerKind::Independent => "independent",
            SamplerKind::Stratified(_) => "stratified",
            SamplerKind::Halton => "halton",
            SamplerKind::Sobol => "sobol",
            SamplerKind::ZSobol => "zsobol",
        };
        let mut entity = Entity::new("Sampler", name);
        if let SamplerKind::Stratified(strata) = sampler.kind {
            entity
                .integer("xsamples", strata.columns.into())
                .integer("ysamples", strata.rows.into())
                .boolean("jitter", strata.jitter);
        } else {
            entity.integer("pixelsamples", sampler.pixel_samples.into());
        }
        self.put(entity)
    }

    fn integrator(&mut self) -> Result<()> {
        let integrator = &self.desc.integrator;
        let heuristic = |heuristic| match heuristic {
            Heuristic::Balance => "balance",
            Heuristic::Power => "power",
        };
        let filter = |filter| match filter {
            PhotonFilter::Cone => "cone",
            PhotonFilter::Gaussian => "gaussian",
            PhotonFilter::Constant => "constant",
        };
        let name = match integrator.kind {
            IntegratorKind::Path(_) => "path",
            IntegratorKind::Kajiya(_) => "kajiya",
            IntegratorKind::Bdpt(_) => "bdpt",
            IntegratorKind::LightTracer => "lightpath",
            IntegratorKind::Photon(_) => "photon",
            IntegratorKind::Sppm(_) => "sppm",
            IntegratorKind::Occlusion(_) => "ambientocclusion",
        };
        let name = if name == "path" && !self.desc.media.is_empty() {
            "volpath"
        } else {
            name
        };
        let mut entity = Entity::new("Integrator", name);
        if let IntegratorKind::Occlusion(occlusion) = integrator.kind {
            entity
                .boolean("cossample", occlusion.cosine)
                .single("maxdistance", occlusion.max_distance.unwrap_or(0.0));
            return self.put(entity);
        }
        entity.integer("maxdepth", integrator.max_depth.map_or(-1, i64::from));
        if integrator.max_depth.is_none() {
            self.note("Integrator \"integer maxdepth\" -1");
        }
        if !matches!(integrator.kind, IntegratorKind::Kajiya(_) | IntegratorKind::LightTracer) {
            let name = match integrator.light_sampler {
                LightSamplerKind::Bvh => "bvh",
                LightSamplerKind::Power => "power",
                LightSamplerKind::Uniform => "uniform",
            };
            entity.string("lightsampler", name);
        }
        match integrator.kind {
            IntegratorKind::Path(path) => {
                let strategy = match path.strategy {
                    Strategy::Bsdf => "bsdf",
                    Strategy::Light => "light",
                    Strategy::Mis => "mis",
                };
                if path != Default::default() {
                    entity
                        .string("strategy", strategy)
                        .string("heuristic", heuristic(path.heuristic))
                        .integer("splitting", path.splitting.into());
                    self.note("Integrator \"path\" with a strategy, a heuristic or splitting");
                }
            }
            IntegratorKind::Kajiya(kajiya) => {
                match kajiya.termination {
                    Termination::Constant(alpha) => entity.string("termination", "constant").single("alpha", alpha),
                    Termination::Albedo => entity.string("termination", "albedo"),
                };
                let distribution = match kajiya.distribution {
                    Distribution::Uniform => "uniform",
                    Distribution::Cosine => "cosine",
                    Distribution::Bsdf => "bsdf",
                };
                entity
                    .integer("branching", kajiya.branching.into())
                    .string("distribution", distribution);
                self.note("Integrator \"kajiya\"");
            }
            IntegratorKind::Bdpt(weights) => {
                entity.string("heuristic", heuristic(weights));
            }
            IntegratorKind::LightTracer | IntegratorKind::Occlusion(_) => {}
            IntegratorKind::Photon(photon) => {
                let count = |count: Option<u32>| count.map_or(-1, i64::from);
                entity
                    .integer("causticphotons", count(photon.caustic_photons))
                    .integer("globalphotons", count(photon.global_photons))
                    .integer("nused", photon.used.into())
                    .single("maxdist", photon.max_distance.unwrap_or(0.0))
                    .integer("finalgathersamples", photon.final_gather_samples.into())
                    .integer("passes", photon.passes.into())
                    .string("filter", filter(photon.filter));
                self.note("Integrator \"photon\"");
            }
            IntegratorKind::Sppm(sppm) => {
                entity
                    .integer("photonsperiteration", sppm.photons.map_or(-1, i64::from))
                    .single("radius", sppm.radius.unwrap_or(0.0))
                    .string("filter", filter(sppm.filter));
            }
        }
        self.put(entity)
    }

    pub(super) fn media(&mut self) -> Result<()> {
        for medium in &self.desc.media {
            self.medium(medium)?;
        }
        Ok(())
    }

    fn medium(&mut self, medium: &MediumDesc) -> Result<()> {
        let mut entity = Entity::new("MakeNamedMedium", &medium.name);
        entity.string("type", "homogeneous");
        let [(first, a), (second, b)] = match &medium.coefficients {
            CoefficientsDesc::Parts { sigma_a, sigma_s } => [("sigma_a", sigma_a), ("sigma_s", sigma_s)],
            CoefficientsDesc::Whole { sigma_t, albedo } => {
                self.note("\"sigma_t\" and \"albedo\" of a medium");
                [("sigma_t", sigma_t), ("albedo", albedo)]
            }
        };
        entity
            .spectrum(first, a)
            .spectrum(second, b)
            .float("scale", medium.scale)
            .float("g", medium.g);
        if let Some(le) = &medium.le {
            entity.spectrum("Le", le).float("Lescale", medium.le_scale);
        }
        self.put(entity)
    }
}
