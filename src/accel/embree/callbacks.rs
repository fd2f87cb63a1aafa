//! What Embree calls back: the filter of cut-out geometry, and the intersection in double precision of what is no triangle.
//!
//! A packet in a callback is `N` values for each field, in the order of `RTCRay` and `RTCHit`; `N` is what Embree chose.

use std::any::Any;
use std::cell::Cell;
use std::ffi::{c_int, c_uint, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use embree_sys as ffi;

use crate::accel::{FilterHit, HitFilter};
use crate::geometry::{GeometryId, InstanceId, Opacity, PrimitiveId, Shape, World};
use crate::math::Vec3;

/// The user data of one Embree geometry. Embree holds its address.
pub struct GeometryData {
    pub world: Arc<World>,
    pub id: GeometryId,
}

impl GeometryData {
    fn shape(&self) -> &Shape {
        &self.world.geometry(self.id).shape
    }
}

/// The user data of one query; one thread uses it.
pub struct QueryData<'a> {
    filter: Option<&'a dyn HitFilter>,
    /// Embree's ids of instances start here.
    first_instance: u32,
    /// What a callback panicked with, to go on with once Embree has returned.
    panic: Cell<Option<Box<dyn Any + Send>>>,
}

impl<'a> QueryData<'a> {
    pub fn new(filter: Option<&'a dyn HitFilter>, first_instance: u32) -> Self {
        Self {
            filter,
            first_instance,
            panic: Cell::new(None),
        }
    }

    /// What a callback panicked with.
    pub fn into_panic(self) -> Option<Box<dyn Any + Send>> {
        self.panic.into_inner()
    }

    /// Runs the body of a callback; a panic is kept for later.
    fn guard(&self, body: impl FnOnce()) {
        if let Err(payload) = catch_unwind(AssertUnwindSafe(body)) {
            self.panic.set(Some(payload));
        }
    }

    fn instance(&self, context: *const ffi::EmbreeContext) -> Option<InstanceId> {
        // SAFETY: Embree passes the context of the query that it is in.
        let id = unsafe { ffi::embree_context_instance(context, 0) };
        (id != ffi::EMBREE_INVALID_ID).then(|| InstanceId(id - self.first_instance))
    }

    fn accepts(&self, hit: &FilterHit) -> bool {
        self.filter.is_none_or(|filter| filter.accept(hit))
    }
}

/// The two user data that a callback belongs to.
///
/// # Safety
/// Both pointers are what Embree passed to a callback of a geometry and a query made by this module.
unsafe fn user_data<'a>(
    geometry: *mut c_void,
    context: *const ffi::EmbreeContext,
) -> (&'a GeometryData, &'a QueryData<'a>) {
    // SAFETY: geometries get the address of a `GeometryData` that lives as long as their scene, queries that of a `QueryData` on
    // the stack of the thread that waits for Embree.
    unsafe {
        let query = ffi::embree_context_user(context).cast::<QueryData<'a>>();
        (&*geometry.cast::<GeometryData>(), &*query)
    }
}

/// A packet of rays as a callback sees it.
struct RaySlots {
    words: *mut u32,
    lanes: usize,
}

impl RaySlots {
    const ORIGIN: usize = 0;
    const TNEAR: usize = 3;
    const DIRECTION: usize = 4;
    const TFAR: usize = 8;
    const ID: usize = 10;

    /// # Safety
    /// `packet` points to 12 fields of `lanes` values, live and unshared while this is used.
    unsafe fn new(packet: *mut c_void, lanes: c_uint) -> Self {
        Self {
            words: packet.cast(),
            lanes: lanes as usize,
        }
    }

    fn word(&self, field: usize, lane: usize) -> u32 {
        debug_assert!(field < 12 && lane < self.lanes);
        // SAFETY: inside the packet, by `new`.
        unsafe { *self.words.add(field * self.lanes + lane) }
    }

    fn get(&self, field: usize, lane: usize) -> f32 {
        f32::from_bits(self.word(field, lane))
    }

    fn vector(&self, field: usize, lane: usize) -> Vec3 {
        Vec3::from_array(std::array::from_fn(|axis| self.get(field + axis, lane)))
    }

    fn id(&self, lane: usize) -> u32 {
        self.word(Self::ID, lane)
    }

    /// Marks `lane` as occluded.
    fn occlude(&mut self, lane: usize) {
        debug_assert!(lane < self.lanes);
        // SAFETY: inside the packet, by `new`.
        unsafe { *self.words.add(Self::TFAR * self.lanes + lane) = f32::NEG_INFINITY.to_bits() };
    }
}

/// The lanes that a callback is asked about.
///
/// # Safety
/// `valid` points to `lanes` values.
unsafe fn active_lanes(valid: *const c_int, lanes: c_uint) -> impl Iterator<Item = usize> {
    // SAFETY: by the caller; each value is read when the iterator comes to it.
    (0..lanes as usize).filter(move |&lane| unsafe { *valid.add(lane) } == -1)
}

/// Asks the query's filter about hits on cut-out triangles.
pub unsafe extern "C" fn filter_triangles(args: *const ffi::RTCFilterFunctionNArguments) {
    // SAFETY: Embree passes valid arguments: N lanes of `valid`, of a ray packet and of a hit packet.
    unsafe {
        let args = &*args;
        let (geometry, query) = user_data(args.geometryUserPtr, args.context);
        query.guard(|| {
            let rays = RaySlots::new(args.ray.cast(), args.N);
            let hits = args.hit.cast::<u32>();
            let field = |field: usize, lane: usize| *hits.add(field * args.N as usize + lane);
            let instance = query.instance(args.context);
            for lane in active_lanes(args.valid, args.N) {
                let hit = FilterHit {
                    geometry: geometry.id,
                    primitive: PrimitiveId(field(5, lane)),
                    instance,
                    u: f32::from_bits(field(3, lane)),
                    v: f32::from_bits(field(4, lane)),
                    t: rays.get(RaySlots::TFAR, lane),
                    ray_id: rays.id(lane),
                };
                if !query.accepts(&hit) {
                    *args.valid.add(lane) = 0;
                }
            }
        });
    }
}

/// The box of one primitive.
pub unsafe extern "C" fn primitive_bounds(args: *const ffi::RTCBoundsFunctionArguments) {
    // SAFETY: Embree passes valid arguments, with the user data of the geometry.
    let (args, geometry) = unsafe {
        let args = &*args;
        (args, &*args.geometryUserPtr.cast::<GeometryData>())
    };
    // Nothing below panics: a primitive beyond the end, which Embree does not ask for, gets no box.
    let bounds = geometry.shape().primitive_bounds(args.primID as usize);
    if bounds.is_empty() {
        return;
    }
    // Embree's slab test of user geometry rounds by some units of the coordinates' size, even in robust mode.
    let margin = bounds.min.abs().max(bounds.max.abs()) * (8.0 * f32::EPSILON);
    let (lower, upper) = (bounds.min - margin, bounds.max + margin);
    let bounds = ffi::RTCBounds {
        lower_x: lower.x,
        lower_y: lower.y,
        lower_z: lower.z,
        align0: 0.0,
        upper_x: upper.x,
        upper_y: upper.y,
        upper_z: upper.z,
        align1: 0.0,
    };
    // SAFETY: Embree passes the place for the box.
    unsafe { *args.bounds_o = bounds };
}

/// The nearest hit of `lane` on a primitive that counts.
fn primitive_hit(
    (geometry, query): (&GeometryData, &QueryData),
    primitive: c_uint,
    instance: Option<InstanceId>,
    rays: &RaySlots,
    lane: usize,
) -> Option<f32> {
    let origin = rays.vector(RaySlots::ORIGIN, lane).as_dvec3();
    let direction = rays.vector(RaySlots::DIRECTION, lane).as_dvec3();
    let inside = f64::from(rays.get(RaySlots::TNEAR, lane))..=f64::from(rays.get(RaySlots::TFAR, lane));
    let hits = geometry.shape().line_hits(primitive as usize, origin, direction);
    let filtered = geometry.world.geometry(geometry.id).opacity == Opacity::Filtered;
    hits.iter().filter(|t| inside.contains(t)).map(|t| t as f32).find(|&t| {
        !filtered
            || query.accepts(&FilterHit {
                geometry: geometry.id,
                primitive: PrimitiveId(primitive),
                instance,
                u: 0.0,
                v: 0.0,
                t,
                ray_id: rays.id(lane),
            })
    })
}

/// The nearest hits of a packet on one primitive.
pub unsafe extern "C" fn intersect_primitive(args: *const ffi::RTCIntersectFunctionNArguments) {
    // SAFETY: Embree passes valid arguments: N lanes of `valid` and of a packet of rays and hits.
    unsafe {
        let args = &*args;
        let data = user_data(args.geometryUserPtr, args.context);
        data.1.guard(|| {
            let rays = RaySlots::new(args.rayhit.cast(), args.N);
            let instance = data.1.instance(args.context);
            for lane in active_lanes(args.valid, args.N) {
                if let Some(t) = primitive_hit(data, args.primID, instance, &rays, lane) {
                    ffi::embree_accept_hit(args, lane as c_uint, t);
                }
            }
        });
    }
}

/// Whether the rays of a packet meet one primitive.
pub unsafe extern "C" fn occlude_primitive(args: *const ffi::RTCOccludedFunctionNArguments) {
    // SAFETY: Embree passes valid arguments: N lanes of `valid` and of a packet of rays.
    unsafe {
        let args = &*args;
        let data = user_data(args.geometryUserPtr, args.context);
        data.1.guard(|| {
            let mut rays = RaySlots::new(args.ray.cast(), args.N);
            let instance = data.1.instance(args.context);
            for lane in active_lanes(args.valid, args.N) {
                if primitive_hit(data, args.primID, instance, &rays, lane).is_some() {
                    rays.occlude(lane);
                }
            }
        });
    }
}
