//! What is computed of a packet and few triangles.

use crate::accel::bvh::few::{FAR, Facet, Few};
use crate::accel::bvh::lanes::Lanes;
use crate::accel::bvh::prepare::{Prepared, Row};

/// What is computed once for all triangles that have it.
pub struct Seen<'a> {
    /// The triangles.
    pub few: &'a Few,
    /// Offsets of corners across the rays, sheared.
    corners: Placed<'a, [LongRow; 2]>,
    /// Of each edge, where its function is negative: a bit for each lane.
    edges: Placed<'a, u32>,
    /// By axis, distances to the planes where boxes begin and end: see
    /// [`Shear::inverse`](crate::accel::bvh::triangle::Shear::inverse).
    ends: [Placed<'a, LongRow>; 3],
}

/// Things by their places in a [`Few`].
struct Placed<'a, T>(&'a mut [T]);

impl<T> Placed<'_, T> {
    #[inline(always)]
    fn at(&self, place: u16) -> &T {
        // SAFETY: `SeenRoom::of` makes as many as the `Few` has, and `Few::new` makes all places that are asked for.
        unsafe { self.0.get_unchecked(usize::from(place)) }
    }
}

/// A [`Row`], or more than one needs.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct LongRow([f32; 16]);

impl LongRow {
    #[inline(always)]
    fn row<const N: usize>(&self) -> &Row<N> {
        const { assert!(N <= 16, "as long as the longest") };
        // SAFETY: it has as many.
        unsafe { self.0.first_chunk().unwrap_unchecked() }
    }

    #[inline(always)]
    fn row_mut<const N: usize>(&mut self) -> &mut Row<N> {
        const { assert!(N <= 16, "as long as the longest") };
        // SAFETY: it has as many.
        unsafe { self.0.first_chunk_mut().unwrap_unchecked() }
    }
}

/// Memory for what is computed.
#[derive(Default)]
pub struct SeenRoom {
    corners: Vec<[LongRow; 2]>,
    edges: Vec<u32>,
    ends: [Vec<LongRow>; 3],
}

impl SeenRoom {
    /// Room for the triangles of `few`.
    pub fn of<'a>(&'a mut self, few: &'a Few) -> Seen<'a> {
        const EMPTY: LongRow = LongRow([0.0; 16]);
        let [x, y, z] = &mut self.ends;
        Seen {
            few,
            corners: placed(&mut self.corners, few.corners.len(), [EMPTY; 2]),
            edges: placed(&mut self.edges, few.edges.len(), 0),
            ends: [
                placed(x, few.ends[0].len(), EMPTY),
                placed(y, few.ends[1].len(), EMPTY),
                placed(z, few.ends[2].len(), EMPTY),
            ],
        }
    }
}

/// The first `len`, which are made if there are not so many.
fn placed<T: Clone>(all: &mut Vec<T>, len: usize, new: T) -> Placed<'_, T> {
    if all.len() < len {
        all.resize(len, new);
    }
    Placed(&mut all[..len])
}

impl Seen<'_> {
    /// Looks at corners, edges and ends of boxes from the rays. Returns those that single precision tells the sides of all edges of.
    #[inline(always)]
    pub fn look<S: Lanes<N>, const N: usize>(&mut self, s: S, prepared: &Prepared<N>) -> u32 {
        let Self {
            few,
            corners,
            edges,
            ends,
        } = self;
        let [origin_x, origin_y, origin_z] = &prepared.rays.origin;
        let [is_x, is_y] = [s.mask(prepared.greatest[0]), s.mask(prepared.greatest[1])];
        // The greatest axis is the last; those after it, in cyclic order, precede it.
        let pick = |x: S::F, y: S::F, z: S::F| s.blend(is_x, s.blend(is_y, z, y), x);
        for (&[x, y, z], across) in few.corners.iter().zip(corners.0.iter_mut()) {
            let x = s.sub(s.splat(x), s.load(origin_x));
            let y = s.sub(s.splat(y), s.load(origin_y));
            let z = s.sub(s.splat(z), s.load(origin_z));
            let depth = pick(x, y, z);
            let shear = |offset, scale| s.sub(offset, s.mul(depth, s.load(scale)));
            s.store(shear(pick(y, z, x), &prepared.scale[0]), across[0].row_mut());
            s.store(shear(pick(z, x, y), &prepared.scale[1]), across[1].row_mut());
        }
        let mut least_size = s.splat(f32::INFINITY);
        for (&[a, b], negative) in few.edges.iter().zip(edges.0.iter_mut()) {
            let ([ax, ay], [bx, by]) = (corners.at(a), corners.at(b));
            let [ax, ay, bx, by] = [s.load(ax.row()), s.load(ay.row()), s.load(bx.row()), s.load(by.row())];
            let function = s.sub(s.mul(bx, ay), s.mul(by, ax));
            least_size = s.least(s.abs(function), least_size);
            *negative = s.signs(function);
        }
        for (axis, seen) in ends.iter_mut().enumerate() {
            let (origin, inverse) = (s.load(&prepared.rays.origin[axis]), s.load(&prepared.inverse[axis]));
            for (&end, distances) in few.ends[axis].iter().zip(seen.0.iter_mut()) {
                s.store(s.mul(s.sub(s.splat(end), origin), inverse), distances.row_mut());
            }
        }
        let [x, y, z] = [s.load(origin_x), s.load(origin_y), s.load(origin_z)];
        let size = s.greatest(s.greatest(s.abs(x), s.abs(y)), s.abs(z));
        s.bits(s.and(s.le(size, s.splat(FAR)), s.lt(s.splat(0.0), least_size)))
    }

    /// The rays that pass through a triangle: all edge functions have the same sign.
    #[inline(always)]
    pub fn through(&self, facet: &Facet) -> u32 {
        let [a, b, c] = facet.edges;
        let [a, b, c] = [*self.edges.at(a), *self.edges.at(b), *self.edges.at(c)];
        let [turned_b, turned_c] = facet.turned;
        !((a ^ b ^ turned_b) | (a ^ c ^ turned_c))
    }

    /// Where rays enter and leave the box of a triangle.
    #[inline(always)]
    pub fn range<S: Lanes<N>, const N: usize>(&self, s: S, facet: &Facet) -> [S::F; 2] {
        let [x, y, z] = facet.bounds;
        let ([x0, x1], [y0, y1], [z0, z1]) = (self.between(s, 0, x), self.between(s, 1, y), self.between(s, 2, z));
        [s.greatest(s.greatest(x0, y0), z0), s.least(s.least(x1, y1), z1)]
    }

    /// Where rays are between two planes across an axis. Rounding keeps the order of the corners.
    #[inline(always)]
    fn between<S: Lanes<N>, const N: usize>(&self, s: S, axis: usize, [lower, upper]: [u16; 2]) -> [S::F; 2] {
        let (a, b) = (
            s.load(self.ends[axis].at(lower).row()),
            s.load(self.ends[axis].at(upper).row()),
        );
        [s.least(a, b), s.greatest(a, b)]
    }
}
