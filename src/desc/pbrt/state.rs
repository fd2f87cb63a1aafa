//! The graphics state: what a directive sets for those after it.

use std::sync::Arc;

use glam::{DAffine3, DMat4, DVec3};

use super::params::Param;
use crate::desc::{AreaLightDesc, ColorSpace, MediumInterfaceDesc, MotionDesc};
use crate::error::Span;

/// What `AttributeBegin` saves and `AttributeEnd` restores.
#[derive(Clone, Debug)]
pub(super) struct GraphicsState {
    /// The current transforms.
    pub ctm: MotionDesc,
    /// Which of them transform directives change: at the start, at the end.
    pub active: [bool; 2],
    pub reverse_orientation: bool,
    /// What `rgb` parameters are in.
    pub color_space: ColorSpace,
    /// The current material, an index of a slot.
    pub material: usize,
    pub area_light: Option<Arc<AreaLightDesc>>,
    /// What `MediumInterface` set.
    pub media: MediumInterfaceDesc,
    /// Defaults from `Attribute`.
    pub defaults: Defaults,
}

/// The parameters that `Attribute` gives to all entities of a class.
#[derive(Clone, Debug, Default)]
pub(super) struct Defaults {
    pub shape: Arc<Vec<Param>>,
    pub light: Arc<Vec<Param>>,
    pub material: Arc<Vec<Param>>,
    pub texture: Arc<Vec<Param>>,
    pub medium: Arc<Vec<Param>>,
}

/// A saved state and why it was saved.
#[derive(Debug)]
pub(super) struct Saved {
    pub state: GraphicsState,
    pub why: Block,
    /// The directive that saved it.
    pub span: Span,
}

/// What saves a graphics state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Block {
    Attribute,
    Object,
    Import,
}

impl GraphicsState {
    /// As at the start of a file; slot 0 is the default material.
    pub fn new() -> Self {
        Self {
            ctm: MotionDesc::IDENTITY,
            active: [true; 2],
            reverse_orientation: false,
            color_space: ColorSpace::default(),
            material: 0,
            area_light: None,
            media: MediumInterfaceDesc {
                interior: None,
                exterior: None,
            },
            defaults: Defaults::default(),
        }
    }

    /// Applies a change to the active transforms. What would not be finite or not invertible is refused: then nothing changes and
    /// the answer is false.
    pub fn transform(&mut self, change: impl Fn(DAffine3) -> DAffine3) -> bool {
        let mut ctm = self.ctm;
        if self.active[0] {
            ctm.start = change(ctm.start);
        }
        if self.active[1] {
            ctm.end = change(ctm.end);
        }
        let fine = is_invertible(&ctm.start) && is_invertible(&ctm.end);
        if fine {
            self.ctm = ctm;
        }
        fine
    }
}

fn is_invertible(transform: &DAffine3) -> bool {
    let determinant = transform.matrix3.determinant();
    transform.is_finite() && determinant != 0.0 && determinant.is_finite() && transform.inverse().is_finite()
}

/// pbrt's `LookAt`: from the world to a camera at `eye` that looks at `target`. `None` if the arguments do not say where to.
pub(super) fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> Option<DAffine3> {
    let z = (target - eye).try_normalize()?;
    let x = up.try_normalize()?.cross(z);
    // pbrt refuses an up vector that is parallel to the view; so near to it, the result would be noise.
    if x.length() < 1e-9 {
        return None;
    }
    let x = x.normalize();
    let world_from_camera = DAffine3::from_mat3_translation(glam::DMat3::from_cols(x, z.cross(x), z), eye);
    Some(world_from_camera.inverse())
}

/// The affine transform of a 4x4 matrix given as pbrt gives it, transposed; `None` if it is projective.
pub(super) fn affine(numbers: &[f64; 16]) -> Option<DAffine3> {
    let matrix = DMat4::from_cols_array(numbers);
    let last = matrix.row(3);
    if last.truncate() != DVec3::ZERO || last.w == 0.0 {
        return None;
    }
    Some(DAffine3::from_mat4(matrix * (1.0 / last.w)))
}
