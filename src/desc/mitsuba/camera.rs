//! Sensors, with their films and samplers, to views.

use glam::{DAffine3, DVec3};

use super::film::Picture;
use super::graph::Object;
use super::loader::Loader;
use super::plugins::Class;
use super::props::Props;
use crate::desc::{ApertureDesc, CameraDesc, CameraKind, MotionDesc, SamplerDesc, SamplerKind, ViewDesc};
use crate::sampling::Strata;

impl<'g> Loader<'g> {
    /// Adds the view of a sensor, the `number`-th of `count`.
    pub fn sensor(&mut self, object: &'g Object, number: usize, count: usize) {
        let mut props = Props::new(object);
        let film = self.child(&mut props, Class::Film);
        let sampler = self.child(&mut props, Class::Sampler);
        let medium = self.medium_inside(&mut props);
        if let Some(srf) = props.take("srf") {
            props.unsupported(
                srf.span,
                "a response function of a sensor is not supported",
                "it is ignored",
            );
        }
        let picture = match film {
            Some((_, film)) => self.film(film),
            None => Picture::default_at(object.span),
        };
        let [width, height] = picture.film.resolution.map(f64::from);
        let camera = self.camera(&mut props, width / height);
        let sampler = match sampler {
            Some((_, sampler)) => self.sampler(sampler),
            None => SamplerDesc {
                kind: SamplerKind::Independent,
                pixel_samples: DEFAULT_SAMPLES,
            },
        };
        props.finish(self.report());
        let Some(camera) = camera else { return };
        let camera = CameraDesc { medium, ..camera };
        let fit = |id: &&String| {
            let plain = |c: char| c.is_alphanumeric() || "-_.".contains(c);
            !id.is_empty() && !id.starts_with('.') && id.chars().all(plain)
        };
        let taken = |name: &str| self.views.iter().any(|view| view.name == name);
        let numbered = if count == 1 {
            "camera".to_owned()
        } else {
            format!("camera{}", number + 1)
        };
        let name = object.id.as_ref().filter(fit).filter(|id| !taken(id));
        self.views.push(ViewDesc {
            name: name.cloned().unwrap_or(numbered),
            camera,
            film: picture.film,
            filter: picture.filter,
            sampler,
            span: object.span,
        });
    }

    fn camera(&mut self, props: &mut Props<'g>, aspect: f64) -> Option<CameraDesc> {
        let object = props.object;
        let to_world = props.transform("to_world");
        let opens = props.float("shutter_open").unwrap_or(0.0);
        let closes = props.float("shutter_close").unwrap_or(0.0);
        if closes < opens {
            props.error(props.span_of("shutter_close"), "the shutter closes before it opens");
        }
        let near_clip = props.float_in("near_clip", DEFAULT_NEAR_CLIP, "not negative", |v| v >= 0.0);
        props.inert(&[("far_clip", "all distances are seen")]);
        let mut screen = None;
        let mut lens = [0.0, 1.0];
        let kind = match object.plugin.as_str() {
            "perspective" | "thinlens" => {
                let x_fov = field_of_view(props, aspect);
                let offset = ["principal_point_offset_x", "principal_point_offset_y"].map(|name| {
                    let offset = props.float(name);
                    offset.unwrap_or(0.0)
                });
                let focus = props.positive("focus_distance", 1.0);
                if object.plugin == "thinlens" {
                    lens = [props.positive("aperture_radius", 0.0), focus];
                    if !props.has("aperture_radius") {
                        props.error(object.span, "a `thinlens` needs an `aperture_radius`");
                    }
                }
                let half_width = (0.5 * x_fov?.to_radians()).tan();
                let mut half = half_width / aspect.max(1.0);
                if offset != [0.0, 0.0] {
                    // The screen plane is as wide as from -1 to 1, x to the right and y up.
                    let [x, y] = [2.0 * offset[0], -2.0 * offset[1] / aspect];
                    screen = Some([-1.0 + x, 1.0 + x, -1.0 / aspect + y, 1.0 / aspect + y]);
                    half = half_width;
                }
                let fov = (2.0 * half.atan()).to_degrees();
                CameraKind::Perspective { fov, near_clip }
            }
            "orthographic" => {
                screen = Some([-1.0, 1.0, -1.0 / aspect, 1.0 / aspect]);
                CameraKind::Orthographic
            }
            _ => {
                self.refuse(object, "it is left out");
                props.objects(|_| true);
                return None;
            }
        };
        // To the left of the picture is +x.
        let world_from_camera = to_world * DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        Some(CameraDesc {
            kind,
            screen,
            frame_aspect: None,
            lens_radius: lens[0],
            focal_distance: lens[1],
            aperture: ApertureDesc::Round,
            // Nothing moves.
            shutter: [0.0, 1.0],
            medium: None,
            camera_from_world: MotionDesc::fixed(world_from_camera.inverse()),
        })
    }

    fn sampler(&mut self, object: &'g Object) -> SamplerDesc {
        let mut props = Props::new(object);
        let pixel_samples = props.count("sample_count", 1, DEFAULT_SAMPLES);
        props.inert(&[("seed", "the seed is an option of the command line")]);
        let jitter = props.boolean("jitter", true);
        let kind = match object.plugin.as_str() {
            "stratified" => {
                let side = f64::from(pixel_samples).sqrt().ceil() as u32;
                SamplerKind::Stratified(Strata {
                    columns: side,
                    rows: side,
                    jitter,
                })
            }
            "halton" => SamplerKind::Halton,
            "sobol" | "hammersley" => SamplerKind::Sobol,
            "multijitter" | "orthogonal" | "ldsampler" => {
                let message = format!(
                    "the sampler `{}` is `sobol` here, which converges to the same picture",
                    object.plugin
                );
                props.warning(object.span, message);
                SamplerKind::Sobol
            }
            _ => SamplerKind::Independent,
        };
        if object.plugin == "orthogonal" {
            props.ignore(&["strength"]);
        }
        props.finish(self.report());
        SamplerDesc { kind, pixel_samples }
    }
}

/// If a scene does not say.
const DEFAULT_SAMPLES: u32 = 4;
const DEFAULT_NEAR_CLIP: f64 = 0.01;

/// The angle of the width in degrees, of a picture so many times as wide as high; by a focal length of 50 mm if nothing is said, as in
/// Mitsuba. `None` if it is wrong, which is said.
pub(super) fn field_of_view(props: &mut Props<'_>, aspect: f64) -> Option<f64> {
    let axis = props.choice("fov_axis", &["x", "y", "diagonal", "smaller", "larger"]);
    let length = props.string("focal_length");
    if props.has("fov") && length.is_some() {
        props.error(
            props.span_of("focal_length"),
            "`fov` and `focal_length` exclude each other",
        );
    }
    if length.is_some() || !props.has("fov") {
        let text = length.unwrap_or("50mm");
        let millimetres = text.trim().strip_suffix("mm").unwrap_or(text).trim().parse::<f64>();
        let Some(length) = millimetres.ok().filter(|v| *v > 0.0 && v.is_finite()) else {
            props.error(
                props.span_of("focal_length"),
                "expected a length in millimetres, `50mm`",
            );
            return None;
        };
        // For the diagonal of 35 mm film.
        let half_diagonal = 0.5 * (36.0_f64 * 36.0 + 24.0 * 24.0).sqrt() / length;
        return Some(2.0 * half_width(half_diagonal, "diagonal", aspect).atan().to_degrees());
    }
    let fov = props.float("fov")?;
    if !(fov > 0.0 && fov < 180.0) {
        props.error(
            props.span_of("fov"),
            format!("`fov` is {fov}; expected an angle in (0, 180) degrees"),
        );
        return None;
    }
    let half = (0.5 * fov.to_radians()).tan();
    Some(2.0 * half_width(half, axis, aspect).atan().to_degrees())
}

/// Half the width of a picture at distance 1, from half its extent along an axis.
fn half_width(half: f64, axis: &str, aspect: f64) -> f64 {
    match axis {
        "y" => half * aspect,
        "smaller" => half * aspect.max(1.0),
        "larger" => half * aspect.min(1.0),
        "diagonal" => half / (1.0 + 1.0 / (aspect * aspect)).sqrt(),
        _ => half,
    }
}
