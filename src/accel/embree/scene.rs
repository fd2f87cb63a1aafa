//! From a [`World`] to committed Embree scenes: one for each group, and the root, which places them.

use std::ffi::c_void;
use std::sync::Arc;

use embree_sys as ffi;

use super::callbacks::{self, GeometryData};
use super::curves::{self, CurveLayer};
use super::device::{Device, backend_error};
use super::motion;
use crate::accel::{BuildOptions, BuildQuality};
use crate::error::Result;
use crate::geometry::{FacingCurves, Geometry, GeometryId, Instance, Opacity, Shape, TriangleMesh, World};

/// A scene of Embree's.
pub struct SceneHandle {
    handle: ffi::RTCScene,
    device: Arc<Device>,
}

// SAFETY: a committed scene may be queried from any thread, and its reference count is atomic; it is changed and committed only by
// the thread that builds it, before it is shared.
unsafe impl Send for SceneHandle {}
// SAFETY: as above.
unsafe impl Sync for SceneHandle {}

impl SceneHandle {
    fn new(device: &Arc<Device>, options: &BuildOptions) -> Result<Self> {
        let quality = match options.quality {
            BuildQuality::Low => ffi::RTC_BUILD_QUALITY_LOW,
            BuildQuality::Medium => ffi::RTC_BUILD_QUALITY_MEDIUM,
            BuildQuality::High => ffi::RTC_BUILD_QUALITY_HIGH,
        };
        let mut flags = ffi::RTC_SCENE_FLAG_NONE;
        // With the fast test in compact scenes, what a stream answers for a ray depends on the others (Embree 3.13.5).
        if options.robust || options.compact {
            flags |= ffi::RTC_SCENE_FLAG_ROBUST;
        }
        if options.compact {
            flags |= ffi::RTC_SCENE_FLAG_COMPACT;
        }
        // SAFETY: the device is live.
        let handle = unsafe { ffi::rtcNewScene(device.handle()) };
        if handle.is_null() {
            return Err(failure(device, "cannot create a scene"));
        }
        // SAFETY: the scene is live.
        unsafe {
            ffi::rtcSetSceneFlags(handle, flags);
            ffi::rtcSetSceneBuildQuality(handle, quality);
        }
        Ok(Self {
            handle,
            device: Arc::clone(device),
        })
    }

    /// For queries.
    pub fn raw(&self) -> ffi::RTCScene {
        self.handle
    }

    fn attach(&self, geometry: &GeometryHandle, position: usize) -> Result<()> {
        let id = id(position)?;
        // SAFETY: both are live; the scene takes a reference of its own.
        unsafe { ffi::rtcAttachGeometryByID(self.handle, geometry.handle, id) };
        Ok(())
    }

    /// Builds the scene's tree.
    fn commit(&self) -> Result<()> {
        // SAFETY: the scene is live, and nothing else uses it yet.
        unsafe { ffi::rtcCommitScene(self.handle) };
        self.device.check()
    }
}

impl Drop for SceneHandle {
    fn drop(&mut self) {
        // SAFETY: this is the reference that `new` got.
        unsafe { ffi::rtcReleaseScene(self.handle) };
    }
}

/// A geometry of Embree's: a mesh, other primitives or an instance.
pub struct GeometryHandle {
    handle: ffi::RTCGeometry,
    /// Kept until the geometry is released.
    _device: Arc<Device>,
}

impl GeometryHandle {
    /// A geometry of `kind`, not committed, seen by rays that share a bit with `mask`.
    pub fn new(device: &Arc<Device>, kind: ffi::RTCGeometryType, mask: u32) -> Result<Self> {
        // SAFETY: the device is live.
        let handle = unsafe { ffi::rtcNewGeometry(device.handle(), kind) };
        if handle.is_null() {
            return Err(failure(device, "cannot create a geometry"));
        }
        // SAFETY: the geometry is live. The mask is set always: Embree's own default differs between versions.
        unsafe { ffi::rtcSetGeometryMask(handle, mask) };
        Ok(Self {
            handle,
            _device: Arc::clone(device),
        })
    }

    /// For calls that take a geometry.
    pub fn raw(&self) -> ffi::RTCGeometry {
        self.handle
    }
}

impl Drop for GeometryHandle {
    fn drop(&mut self) {
        // SAFETY: this is the reference that `new` got; scenes that it is attached to have their own.
        unsafe { ffi::rtcReleaseGeometry(self.handle) };
    }
}

/// Scenes of some of a world's geometries: the root, and one for each group.
pub struct Layer {
    // In this order they are dropped: instances before what they place.
    pub root: SceneHandle,
    _groups: Vec<Option<SceneHandle>>,
}

/// The scenes of a world. Geometries and instances of the root have dense ids in this order: `world.root()`, then
/// `world.instances()`; the geometries of a group have their position in it.
pub struct Scenes {
    // In this order they are dropped: scenes before what their callbacks read.
    pub main: Layer,
    /// Curves that are Embree's own primitives, if there are any.
    pub curves: Option<CurveLayer>,
    /// The id of the first instance.
    pub first_instance: u32,
    _data: Box<[GeometryData]>,
}

/// Builds all scenes of `world`.
pub fn build(world: &Arc<World>, device: &Arc<Device>, options: &BuildOptions) -> Result<Scenes> {
    let data: Box<[GeometryData]> = (0..world.geometries().len())
        .map(|index| GeometryData {
            world: Arc::clone(world),
            id: GeometryId::from_index(index),
        })
        .collect();
    let facing = curves::facing(world);
    let [mut others, mut curves] = [(); 2].map(|()| Vec::with_capacity(data.len()));
    for (data, facing) in data.iter().zip(&facing) {
        let handle = geometry(device, data, facing.as_ref(), options.quality)?;
        let (to, other) = match facing {
            Some(_) => (&mut curves, &mut others),
            None => (&mut others, &mut curves),
        };
        to.push(handle);
        other.push(None);
    }
    let has_curves = curves.iter().any(Option::is_some);
    let of_curves = has_curves.then(|| layer(world, device, options, &curves)).transpose()?;
    Ok(Scenes {
        main: layer(world, device, options, &others)?,
        curves: of_curves.map(|layer| CurveLayer::new(layer, world, &facing)),
        first_instance: id(world.root().len())?,
        _data: data,
    })
}

/// Scenes of the geometries that are not `None`.
fn layer(
    world: &World,
    device: &Arc<Device>,
    options: &BuildOptions,
    geometries: &[Option<GeometryHandle>],
) -> Result<Layer> {
    let mut groups = Vec::with_capacity(world.groups().len());
    for members in world.groups() {
        let scene = SceneHandle::new(device, options)?;
        let group = attach_all(&scene, members, geometries)?.then_some(scene);
        if let Some(scene) = &group {
            scene.commit()?;
        }
        groups.push(group);
    }
    let root = SceneHandle::new(device, options)?;
    attach_all(&root, world.root(), geometries)?;
    for (index, instance) in world.instances().iter().enumerate() {
        // An instance of nothing would have a box of infinities.
        if let Some(group) = &groups[instance.group.index()] {
            root.attach(&place(device, instance, group)?, world.root().len() + index)?;
        }
    }
    root.commit()?;
    Ok(Layer { root, _groups: groups })
}

/// Attaches those of `members` that have primitives, each by its position; whether there were any.
fn attach_all(scene: &SceneHandle, members: &[GeometryId], geometries: &[Option<GeometryHandle>]) -> Result<bool> {
    let mut any = false;
    for (position, id) in members.iter().enumerate() {
        if let Some(geometry) = &geometries[id.index()] {
            scene.attach(geometry, position)?;
            any = true;
        }
    }
    Ok(any)
}

/// A committed geometry; `None` where it has no primitive.
fn geometry(
    device: &Arc<Device>,
    data: &GeometryData,
    facing: Option<&FacingCurves>,
    quality: BuildQuality,
) -> Result<Option<GeometryHandle>> {
    let geometry = data.world.geometry(data.id);
    if geometry.primitive_count() == 0 {
        return Ok(None);
    }
    let handle = match (&geometry.shape, facing) {
        (Shape::Mesh(mesh), _) => triangles(device, geometry, mesh)?,
        (_, Some(facing)) => curves::geometry(device, geometry, facing)?,
        (_, None) => analytic(device, geometry)?,
    };
    if quality == BuildQuality::Low {
        // In a scene of low quality each geometry has a tree of its own, of medium quality if nobody says.
        // SAFETY: the geometry is live.
        unsafe { ffi::rtcSetGeometryBuildQuality(handle.handle, ffi::RTC_BUILD_QUALITY_LOW) };
    }
    let user = (&raw const *data).cast_mut().cast::<c_void>();
    // SAFETY: the geometry is live; `data` outlives the scenes that hold it (see `Scenes`), and is only read.
    unsafe {
        ffi::rtcSetGeometryUserData(handle.handle, user);
        ffi::rtcCommitGeometry(handle.handle);
    }
    device.check()?;
    Ok(Some(handle))
}

fn triangles(device: &Arc<Device>, geometry: &Geometry, mesh: &TriangleMesh) -> Result<GeometryHandle> {
    let handle = GeometryHandle::new(device, ffi::RTC_GEOMETRY_TYPE_TRIANGLE, geometry.mask)?;
    let raw = handle.handle;
    let steps = u32::try_from(mesh.time_steps()).unwrap_or(u32::MAX);
    if steps > ffi::RTC_MAX_TIME_STEP_COUNT {
        let most = ffi::RTC_MAX_TIME_STEP_COUNT;
        return Err(backend_error(format!(
            "a mesh has {steps} time steps, of at most {most}"
        )));
    }
    // SAFETY: the buffers are shared: the world owns them, does not change, and lives as long as the scene (`GeometryData` holds
    // it). They have as many elements as is said, of three packed 4-byte numbers, and each vertex array has one element more,
    // which covers the 16 bytes that Embree reads at the last vertex.
    unsafe {
        ffi::rtcSetGeometryTimeStepCount(raw, steps);
        for step in 0..steps {
            ffi::rtcSetSharedGeometryBuffer(
                raw,
                ffi::RTC_BUFFER_TYPE_VERTEX,
                step,
                ffi::RTC_FORMAT_FLOAT3,
                mesh.padded_positions(step as usize).as_ptr().cast(),
                0,
                size_of::<crate::math::Vec3>(),
                mesh.vertex_count(),
            );
        }
        ffi::rtcSetSharedGeometryBuffer(
            raw,
            ffi::RTC_BUFFER_TYPE_INDEX,
            0,
            ffi::RTC_FORMAT_UINT3,
            mesh.indices().as_ptr().cast(),
            0,
            size_of::<[u32; 3]>(),
            mesh.triangle_count(),
        );
        if geometry.opacity == Opacity::Filtered {
            ffi::rtcSetGeometryIntersectFilterFunction(raw, Some(callbacks::filter_triangles));
            ffi::rtcSetGeometryOccludedFilterFunction(raw, Some(callbacks::filter_triangles));
        }
    }
    Ok(handle)
}

fn analytic(device: &Arc<Device>, geometry: &Geometry) -> Result<GeometryHandle> {
    let handle = GeometryHandle::new(device, ffi::RTC_GEOMETRY_TYPE_USER, geometry.mask)?;
    let count = u32::try_from(geometry.primitive_count())
        .map_err(|_| backend_error("more than 2^32 primitives in a geometry".into()))?;
    // SAFETY: the geometry is live, and the callbacks are those for its kind of user data.
    unsafe {
        ffi::rtcSetGeometryUserPrimitiveCount(handle.handle, count);
        ffi::rtcSetGeometryBoundsFunction(handle.handle, Some(callbacks::primitive_bounds), std::ptr::null_mut());
        ffi::rtcSetGeometryIntersectFunction(handle.handle, Some(callbacks::intersect_primitive));
        ffi::rtcSetGeometryOccludedFunction(handle.handle, Some(callbacks::occlude_primitive));
    }
    Ok(handle)
}

/// A committed instance of `group`.
fn place(device: &Arc<Device>, instance: &Instance, group: &SceneHandle) -> Result<GeometryHandle> {
    let handle = GeometryHandle::new(device, ffi::RTC_GEOMETRY_TYPE_INSTANCE, instance.mask)?;
    // SAFETY: both are live; the instance takes a reference of the scene.
    unsafe { ffi::rtcSetGeometryInstancedScene(handle.handle, group.handle) };
    motion::set_transform(&handle, &instance.world_from_object);
    // SAFETY: the geometry is live.
    unsafe { ffi::rtcCommitGeometry(handle.handle) };
    Ok(handle)
}

/// A position as Embree's id.
fn id(position: usize) -> Result<u32> {
    u32::try_from(position).map_err(|_| backend_error("more than 2^32 geometries and instances".into()))
}

/// What the device says went wrong, or `what` if it says nothing.
fn failure(device: &Device, what: &str) -> crate::error::Error {
    device.check().err().unwrap_or_else(|| backend_error(what.into()))
}
