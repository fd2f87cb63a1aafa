//! Rays prepared for boxes and triangles, a lane for each: what [`LocalRay::new`] computes, by the same operations.

use super::lanes::Lanes;
use super::query::{Asked, CULL_SLACK, Query};
use super::ray::{FAR_SLACK, LEAST_SLOPE, Line, LocalRay, MARGIN, NEAR_SLACK, Slab, USUAL_SIZES};
use super::triangle::Shear;
use crate::geometry::HitPacket;
use crate::math::Vec3;

/// A row of a number for each ray.
pub type Row<const N: usize> = [f32; N];

/// Rays as they are given, by lane.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Rays<const N: usize> {
    /// Origin.
    pub origin: [Row<N>; 3],
    /// Direction.
    pub direction: [Row<N>; 3],
    /// Start of the segment.
    pub tnear: Row<N>,
    /// End of the segment, then of the nearest hit.
    pub tfar: Row<N>,
    /// Time.
    pub time: Row<N>,
    /// Mask.
    pub mask: [u32; N],
    /// For a filter.
    pub id: [u32; N],
}

impl<const N: usize> Rays<N> {
    /// Rays that take no part.
    #[inline(always)]
    pub fn none() -> Self {
        Self {
            origin: [[0.0; N]; 3],
            direction: [[0.0; N], [0.0; N], [1.0; N]],
            tnear: [0.0; N],
            tfar: [0.0; N],
            time: [0.0; N],
            mask: [0; N],
            id: [0; N],
        }
    }
}

/// Rays, and what is computed from them.
#[repr(C, align(64))]
pub struct Prepared<const N: usize> {
    /// The rays.
    pub rays: Rays<N>,
    /// See [`Slab::near`].
    pub near_scale: [Row<N>; 3],
    /// See [`Slab::near`].
    pub near_shift: [Row<N>; 3],
    /// See [`Slab::far`].
    pub far_scale: [Row<N>; 3],
    /// See [`Slab::far`].
    pub far_shift: [Row<N>; 3],
    /// See [`Shear::scale`].
    pub scale: [Row<N>; 3],
    /// See [`Shear::inverse`]; of all axes.
    pub inverse: [Row<N>; 3],
    /// Rays whose directions are negative, by axis.
    pub negative: [u32; 3],
    /// Rays whose direction is greatest along an axis.
    pub greatest: [u32; 3],
    /// Rays whose directions are of a [usual size](USUAL_SIZES). Of others nothing else is right.
    pub usual: u32,
}

/// What one ray has of each row.
#[inline(always)]
fn column<const N: usize>(rows: &[Row<N>; 3], lane: usize) -> [f32; 3] {
    [rows[0][lane], rows[1][lane], rows[2][lane]]
}

// Functions, not `array::map`, which is compiled without the instructions of `S`.
#[inline(always)]
fn load<S: Lanes<N>, const N: usize>(s: S, [x, y, z]: &[Row<N>; 3]) -> [S::F; 3] {
    [s.load(x), s.load(y), s.load(z)]
}

#[inline(always)]
fn sizes<S: Lanes<N>, const N: usize>(s: S, [x, y, z]: [S::F; 3]) -> [S::F; 3] {
    [s.abs(x), s.abs(y), s.abs(z)]
}

#[inline(always)]
fn greatest<S: Lanes<N>, const N: usize>(s: S, [x, y, z]: [S::F; 3]) -> S::F {
    s.greatest(s.greatest(x, y), z)
}

impl<const N: usize> Prepared<N> {
    /// Rays that take no part, and nothing computed.
    #[inline(always)]
    pub fn none() -> Self {
        Self {
            rays: Rays::none(),
            near_scale: [[0.0; N]; 3],
            near_shift: [[0.0; N]; 3],
            far_scale: [[0.0; N]; 3],
            far_shift: [[0.0; N]; 3],
            scale: [[0.0; N]; 3],
            inverse: [[0.0; N]; 3],
            negative: [0; 3],
            greatest: [0; 3],
            usual: 0,
        }
    }

    /// Prepares rays.
    #[inline(always)]
    pub fn new<S: Lanes<N>>(s: S, rays: Rays<N>) -> Self {
        let mut prepared = Self { rays, ..Self::none() };
        prepared.prepare(s);
        prepared
    }

    /// Computes all of it from the rays.
    #[inline(always)]
    pub fn prepare<S: Lanes<N>>(&mut self, s: S) {
        self.prepare_shears(s);
        self.prepare_slabs(s);
    }

    /// Computes what triangles need.
    #[inline(always)]
    pub fn prepare_shears<S: Lanes<N>>(&mut self, s: S) {
        let direction = load(s, &self.rays.direction);
        let slope = sizes(s, direction);
        let steepest = greatest(s, slope);
        let [x, y, z] = slope;
        let is_x = s.and(s.lt(y, x), s.lt(z, x));
        let is_y = s.lt(z, y);
        let [dx, dy, dz] = direction;
        let pick = |a, b, c| s.blend(is_x, s.blend(is_y, c, b), a);
        let along = pick(dx, dy, dz);
        let bits = [s.bits(is_x), s.bits(is_y) & !s.bits(is_x)];
        let (smallest, largest) = (s.splat(*USUAL_SIZES.start()), s.splat(*USUAL_SIZES.end()));
        self.greatest = [bits[0], bits[1], !(bits[0] | bits[1])];
        self.usual = s.bits(s.and(s.le(smallest, steepest), s.le(steepest, largest)));
        s.store(s.div(pick(dy, dz, dx), along), &mut self.scale[0]);
        s.store(s.div(pick(dz, dx, dy), along), &mut self.scale[1]);
        // Adding zero turns a negative zero into a positive one, whose bits compare as an integer.
        s.store(s.add(s.load(&self.rays.tnear), s.splat(0.0)), &mut self.rays.tnear);
        let least = s.mul(s.splat(LEAST_SLOPE), steepest);
        for axis in 0..3 {
            let scale = s.copysign(s.greatest(slope[axis], least), direction[axis]);
            s.store(s.div(s.splat(1.0), scale), &mut self.inverse[axis]);
        }
        // Along the greatest axis that is 1 over the direction.
        let [x, y, z] = load(s, &self.inverse);
        s.store(pick(x, y, z), &mut self.scale[2]);
    }

    /// Computes what boxes need, from what triangles need.
    #[inline(always)]
    fn prepare_slabs<S: Lanes<N>>(&mut self, s: S) {
        let (origin, direction) = (load(s, &self.rays.origin), load(s, &self.rays.direction));
        let size = sizes(s, origin);
        let greatest = greatest(s, size);
        let [dx, dy, dz] = direction;
        self.negative = [s.signs(dx), s.signs(dy), s.signs(dz)];
        for axis in 0..3 {
            let margin = s.mul(s.splat(MARGIN), s.add(size[axis], greatest));
            let margin = s.copysign(margin, direction[axis]);
            let scale = s.load(&self.inverse[axis]);
            let (near, far) = (s.mul(scale, s.splat(NEAR_SLACK)), s.mul(scale, s.splat(FAR_SLACK)));
            let minus = |x: S::F| s.sub(s.splat(0.0), x);
            s.store(near, &mut self.near_scale[axis]);
            s.store(far, &mut self.far_scale[axis]);
            let shift = s.mul(minus(s.add(origin[axis], margin)), near);
            s.store(shift, &mut self.near_shift[axis]);
            let shift = s.mul(minus(s.sub(origin[axis], margin)), far);
            s.store(shift, &mut self.far_shift[axis]);
        }
    }

    /// The axes of the shear of a ray.
    #[inline(always)]
    pub fn axes(&self, lane: usize) -> [usize; 3] {
        const AXES: [[usize; 3]; 3] = [[1, 2, 0], [2, 0, 1], [0, 1, 2]];
        let bit = |axis: usize| (self.greatest[axis] >> lane & 1) as usize;
        AXES[bit(1) + 2 * bit(2)]
    }

    /// What triangles need of a ray.
    #[inline(always)]
    pub fn shear(&self, lane: usize) -> Shear {
        let axes = self.axes(lane);
        let [x, y, _] = axes;
        Shear {
            axes,
            origin: column(&self.rays.origin, lane),
            direction: column(&self.rays.direction, lane),
            scale: column(&self.scale, lane),
            inverse: [self.inverse[x][lane], self.inverse[y][lane]],
        }
    }

    /// Where one ray starts and goes.
    #[inline(always)]
    pub fn line(&self, lane: usize) -> Line {
        Line {
            origin: Vec3::from_array(column(&self.rays.origin, lane)),
            direction: Vec3::from_array(column(&self.rays.direction, lane)),
        }
    }

    /// One ray.
    #[inline(always)]
    pub fn local(&self, lane: usize) -> LocalRay {
        let plane = |scale: &[Row<N>; 3], shift: &[Row<N>; 3]| {
            let at = |axis: usize| [scale[axis][lane], shift[axis][lane]];
            [at(0), at(1), at(2)]
        };
        let negative = |axis: usize| (self.negative[axis] >> lane & 1) as usize;
        LocalRay {
            origin: Vec3::from_array(column(&self.rays.origin, lane)),
            direction: Vec3::from_array(column(&self.rays.direction, lane)),
            slab: Slab {
                near: plane(&self.near_scale, &self.near_shift),
                far: plane(&self.far_scale, &self.far_shift),
                negative: [negative(0), negative(1), negative(2)],
            },
            shear: self.shear(lane),
        }
    }

    /// The query of one ray, with nothing hit.
    #[inline(always)]
    pub fn query<'a>(&self, lane: usize, asked: Asked<'a>) -> Query<'a> {
        Query {
            tnear: self.rays.tnear[lane],
            tfar: self.rays.tfar[lane],
            cull: self.rays.tfar[lane] * CULL_SLACK,
            ids: [HitPacket::NONE; 3],
            mask: self.rays.mask[lane],
            time: self.rays.time[lane],
            ray_id: self.rays.id[lane],
            scale: 1.0,
            asked,
        }
    }
}
