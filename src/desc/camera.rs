//! Cameras: projections, lenses, shutters.

use std::sync::Arc;

use super::{MediumId, MotionDesc};
use crate::image_io::Image;
use crate::sampling::SphereMap;

/// A camera. In its own space it looks along +z, x is to the right of the picture and y is up (pbrt's left-handed convention).
#[derive(Clone, Debug)]
pub struct CameraDesc {
    /// The projection.
    pub kind: CameraKind,
    /// `[x_min, x_max, y_min, y_max]` of the picture on the screen plane, if the file gives it; see
    /// [`CameraDesc::screen_window`].
    pub screen: Option<[f64; 4]>,
    /// Width over height, if the file gives it; else that of the resolution.
    pub frame_aspect: Option<f64>,
    /// In scene units, not negative; 0 is a pinhole.
    pub lens_radius: f64,
    /// Distance of the plane of focus, in scene units, positive.
    pub focal_distance: f64,
    /// The shape of the lens.
    pub aperture: ApertureDesc,
    /// When the shutter opens and closes, in the time of [`super::SceneDesc::transform_times`]; open < close.
    pub shutter: [f64; 2],
    /// What it stands in; `None` is the vacuum.
    pub medium: Option<MediumId>,
    /// pbrt's current transform at the `Camera` directive.
    pub camera_from_world: MotionDesc,
}

/// The shape of the opening of a thin lens.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ApertureDesc {
    /// A disk.
    #[default]
    Round,
    /// A regular polygon with its corners on the rim of the disk (Lucerna's extension).
    Polygon {
        /// Its corners, from 3 to 64.
        blades: u32,
        /// Degrees by which the first corner is turned from +x towards +y of the camera.
        rotation: f64,
    },
}

/// The projection of a camera.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraKind {
    /// Through a point.
    Perspective {
        /// Angle, in degrees, that the span from -1 to 1 of the screen plane covers (with the default screen window: the angle of
        /// the shorter side of the picture); in (0, 180).
        fov: f64,
        /// Rays start where they cross the plane at this depth before the camera (measured along its z axis), so that what is
        /// nearer is not seen; not negative; 0 (the default): at the eye or on the lens.
        near_clip: f64,
    },
    /// Parallel: the screen window is in scene units.
    Orthographic,
    /// All around from a point: by this map, whose pole is up and whose second axis is forward.
    Spherical(SphereMap),
    /// Through lenses; scene units are metres.
    Realistic(Arc<RealisticDesc>),
}

/// The lenses of a camera.
#[derive(Clone, Debug, PartialEq)]
pub struct RealisticDesc {
    /// From the scene to the film, at least one; one at most is the aperture stop, whose diameter is what is asked for.
    pub surfaces: Vec<LensSurface>,
    /// How far away what is sharp is from the film, in scene units; positive.
    pub focus_distance: f64,
    /// The shape of the stop's opening.
    pub shape: StopShape,
}

/// A surface of a lens; lengths are in millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensSurface {
    /// Of curvature, positive if it bulges towards the scene; 0 for the aperture stop.
    pub radius: f64,
    /// Along the axis to the next surface; of the last one, before focusing, to the film.
    pub thickness: f64,
    /// The index of refraction from here to the next surface; 0 or 1 for air.
    pub eta: f64,
    /// Of the opening; positive.
    pub diameter: f64,
}

/// The shape of an aperture stop's opening; all let the same light through.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum StopShape {
    /// A disk.
    #[default]
    Round,
    /// A disk that fades out towards its rim.
    Gaussian,
    /// Of half the diameter.
    Square,
    /// Regular.
    Pentagon,
    /// With five points.
    Star,
    /// How much passes, by place; finite, not negative, not black.
    Image(Arc<Image>),
}

impl CameraDesc {
    /// Where it stands and looks.
    pub fn world_from_camera(&self) -> MotionDesc {
        self.camera_from_world.inverse()
    }

    /// `[x_min, x_max, y_min, y_max]` of the picture on the screen plane: what the file says, else -1 to 1 along the shorter side
    /// and the aspect ratio along the other.
    pub fn screen_window(&self, resolution: [u32; 2]) -> [f64; 4] {
        if let Some(window) = self.screen {
            return window;
        }
        let aspect = self
            .frame_aspect
            .unwrap_or_else(|| f64::from(resolution[0]) / f64::from(resolution[1]));
        if aspect > 1.0 {
            [-aspect, aspect, -1.0, 1.0]
        } else {
            [-1.0, 1.0, -1.0 / aspect, 1.0 / aspect]
        }
    }
}
