//! What stands before `WorldBegin`: cameras, film, sampler, filter, integrator; assembled into views.

use super::camera::{self, NamedCamera};
use super::files::Context;
use super::film;
use super::integrator;
use super::params::Param;
use super::reader::ParamReader;
use super::report::Report;
use super::sampler;
use crate::desc::{FilmDesc, FilterDesc, IntegratorDesc, MediumId, MotionDesc, SamplerDesc, ViewDesc};
use crate::error::Span;

/// A directive that is allowed only before `WorldBegin` and has a type and parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OptionKind {
    Accelerator,
    Camera,
    Film,
    Integrator,
    PixelFilter,
    Sampler,
}

impl OptionKind {
    const ALL: [(&'static str, Self); 6] = [
        ("Accelerator", Self::Accelerator),
        ("Camera", Self::Camera),
        ("Film", Self::Film),
        ("Integrator", Self::Integrator),
        ("PixelFilter", Self::PixelFilter),
        ("Sampler", Self::Sampler),
    ];

    /// By the name of the directive.
    pub fn of_directive(word: &str) -> Option<Self> {
        Self::ALL.iter().find(|&&(name, _)| name == word).map(|&(_, kind)| kind)
    }

    /// The name of the directive.
    pub fn directive(self) -> &'static str {
        Self::ALL
            .iter()
            .find(|&&(_, kind)| kind == self)
            .map_or("", |&(name, _)| name)
    }
}

/// What a camera is placed by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surroundings {
    /// The current transform.
    pub ctm: MotionDesc,
    /// What fills the space around it.
    pub medium: Option<MediumId>,
}

/// The options read so far.
#[derive(Debug)]
pub(super) struct Options {
    pub transform_times: [f64; 2],
    cameras: Vec<NamedCamera>,
    film: Option<FilmDesc>,
    filter: Option<FilterDesc>,
    sampler: Option<SamplerDesc>,
    integrator: Option<IntegratorDesc>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            transform_times: [0.0, 1.0],
            cameras: Vec::new(),
            film: None,
            filter: None,
            sampler: None,
            integrator: None,
        }
    }
}

impl Options {
    /// Reads the option `kind` of type `name`.
    pub fn read(
        &mut self,
        context: &mut Context,
        kind: OptionKind,
        (name, name_span): (&str, Span),
        params: Vec<Param>,
        span: Span,
        around: Surroundings,
    ) {
        let class = kind.directive().to_lowercase();
        let reader = ParamReader::new(context, &class, name, name_span, params, &[]);
        let replaced = match kind {
            OptionKind::Accelerator => {
                let message = "`Accelerator` has no effect: choose one on the command line, by --backend";
                context.report.warning(span, message);
                false
            }
            OptionKind::Camera => {
                self.cameras.push(camera::read(reader, name, around));
                false
            }
            OptionKind::Film => self.film.replace(film::read_film(reader, name)).is_some(),
            OptionKind::PixelFilter => self.filter.replace(film::read_filter(reader, name)).is_some(),
            OptionKind::Sampler => self.sampler.replace(sampler::read(reader, name)).is_some(),
            OptionKind::Integrator => self.integrator.replace(integrator::read(reader, name)).is_some(),
        };
        if replaced {
            let message = format!("this `{}` replaces the one before", kind.directive());
            context.report.warning(span, message);
        }
    }

    /// The views: one for each camera, and one from the origin if there is none. `ctm` and `file` are those of the main file.
    pub fn views(&self, report: &mut Report, file: Span) -> Vec<ViewDesc> {
        let default = [NamedCamera {
            name: None,
            camera: camera::default_camera(MotionDesc::IDENTITY),
            span: file,
        }];
        let cameras = if self.cameras.is_empty() {
            &default[..]
        } else {
            &self.cameras[..]
        };
        let mut views: Vec<ViewDesc> = Vec::new();
        for (i, camera) in cameras.iter().enumerate() {
            let name = match &camera.name {
                Some((name, _)) => name.clone(),
                None if cameras.len() == 1 => "camera".to_owned(),
                None => format!("camera{}", i + 1),
            };
            if views.iter().any(|v| v.name == name) {
                let span = camera.name.as_ref().map_or(camera.span, |&(_, span)| span);
                report.error(span, format!("there is a view `{name}` already"));
            }
            let [open, close] = camera.camera.shutter;
            let exposure_time = close - open;
            let mut film = self.film.clone().unwrap_or_else(|| film::default_film(file));
            if report.is_old() {
                // The exposure of pbrt-v3 does not go by the shutter.
                film.iso /= exposure_time;
            }
            views.push(ViewDesc {
                name,
                camera: camera.camera.clone(),
                film: FilmDesc { exposure_time, ..film },
                filter: self.filter.unwrap_or(if report.is_old() {
                    film::OLD_DEFAULT_FILTER
                } else {
                    film::DEFAULT_FILTER
                }),
                sampler: self.sampler.unwrap_or(if report.is_old() {
                    sampler::OLD_DEFAULT
                } else {
                    sampler::DEFAULT
                }),
                span: camera.span,
            });
        }
        views
    }

    /// The integrator; by default path tracing with 5 bounces.
    pub fn integrator(&self) -> IntegratorDesc {
        self.integrator.clone().unwrap_or_default()
    }
}

/// `Option`: pbrt's settings of a run. The names count without case, `-` and `_`.
pub(super) fn render_option(report: &mut Report, name: &str, value: &str, span: Span) {
    const INERT: [(&str, &str); 7] = [
        ("seed", "give the seed on the command line, by --seed"),
        ("disabletexturefiltering", "textures are always filtered as they say"),
        ("displacementedgescale", "displacements bend normals, not surfaces"),
        ("msereferenceimage", "see `lucerna compare`"),
        ("msereferenceout", "see `lucerna compare`"),
        ("pixelstats", "see --stats"),
        ("wavefront", "rendering always goes in waves"),
    ];
    const UNSUPPORTED: [&str; 3] = ["disablepixeljitter", "disablewavelengthjitter", "forcediffuse"];
    let plain: String = name
        .chars()
        .filter(|c| !matches!(c, '-' | '_'))
        .collect::<String>()
        .to_lowercase();
    let is_flag = plain.starts_with("disable") || matches!(plain.as_str(), "forcediffuse" | "pixelstats" | "wavefront");
    if is_flag && !matches!(value, "true" | "false") {
        report.error(span, format!("the option `{name}` is `true` or `false`, not `{value}`"));
    } else if let Some((_, why)) = INERT.iter().find(|&&(known, _)| known == plain) {
        report.warning(span, format!("the option `{name}` has no effect: {why}"));
    } else if UNSUPPORTED.contains(&plain.as_str()) {
        if value != "false" {
            report.unsupported(span, format!("the option `{name}` is not supported"), "it is ignored");
        }
    } else if plain == "rendercoordsys" {
        report.warning(
            span,
            format!("the option `{name}` has no effect: rendering is in world space"),
        );
    } else {
        let known: Vec<&str> = INERT.iter().map(|&(known, _)| known).chain(UNSUPPORTED).collect();
        let message = format!("unknown option `{name}`");
        report.unknown(span, message, "it is ignored", &plain, &known);
    }
}
