//! The Embree device: threads, errors, memory.

use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicIsize, Ordering};
use std::sync::{Arc, OnceLock};

use embree_sys as ffi;

use crate::error::{Error, Result};

/// A device, shared by everything made on it. Released with the last of those.
pub struct Device {
    handle: ffi::RTCDevice,
    /// Boxed: Embree's callbacks hold its address.
    state: Box<State>,
}

/// What the callbacks write.
#[derive(Default)]
struct State {
    first_error: OnceLock<String>,
    allocated: AtomicIsize,
}

// SAFETY: Embree's device functions may be called from any thread, its reference counts are atomic, and `State` is `Sync`.
unsafe impl Send for Device {}
// SAFETY: as above.
unsafe impl Sync for Device {}

impl Device {
    /// A device whose builds run on up to `threads` threads (at least 1), the calling one included.
    ///
    /// # Errors
    /// [`Error::Backend`] if Embree refuses: an old processor, or no memory.
    pub fn new(threads: usize) -> Result<Arc<Self>> {
        let config = format!("threads={},set_affinity=0", threads.max(1));
        let config = CString::new(config).map_err(|error| backend_error(error.to_string()))?;
        // SAFETY: the configuration is a terminated string, which Embree copies.
        let handle = unsafe { ffi::rtcNewDevice(config.as_ptr()) };
        if handle.is_null() {
            // SAFETY: null asks for the error of this thread's failed creation.
            let code = unsafe { ffi::rtcGetDeviceError(handle) };
            return Err(backend_error(format!("cannot create a device: {}", describe(code))));
        }
        let state = Box::new(State::default());
        let user = (&raw const *state).cast_mut().cast::<c_void>();
        // SAFETY: the device is live; `state` outlives it (see `drop`), and the callbacks only read it through a shared reference.
        unsafe {
            ffi::rtcSetDeviceErrorFunction(handle, Some(on_error), user);
            ffi::rtcSetDeviceMemoryMonitorFunction(handle, Some(on_memory), user);
        }
        Ok(Arc::new(Self { handle, state }))
    }

    /// For calls that take a device.
    pub fn handle(&self) -> ffi::RTCDevice {
        self.handle
    }

    /// The first error that Embree reported since the device was made, if any. To be asked after a build or a commit.
    ///
    /// # Errors
    /// [`Error::Backend`] with that error.
    pub fn check(&self) -> Result<()> {
        match self.state.first_error.get() {
            Some(message) => Err(backend_error(message.clone())),
            None => Ok(()),
        }
    }

    /// Bytes that Embree holds now.
    pub fn memory(&self) -> usize {
        usize::try_from(self.state.allocated.load(Ordering::Relaxed)).unwrap_or(0)
    }

    /// The version of the library that is loaded, as `3.13.5`.
    pub fn version(&self) -> String {
        [
            ffi::RTC_DEVICE_PROPERTY_VERSION_MAJOR,
            ffi::RTC_DEVICE_PROPERTY_VERSION_MINOR,
            ffi::RTC_DEVICE_PROPERTY_VERSION_PATCH,
        ]
        // SAFETY: the device is live.
        .map(|property| unsafe { ffi::rtcGetDeviceProperty(self.handle, property) }.to_string())
        .join(".")
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: scenes and geometries hold an `Arc` of this, so it is the last reference: Embree's callbacks end with this call,
        // and `state` is dropped after it.
        unsafe { ffi::rtcReleaseDevice(self.handle) };
    }
}

/// Keeps the first error; later ones are its consequences.
unsafe extern "C" fn on_error(user: *mut c_void, code: ffi::RTCError, message: *const c_char) {
    // Nothing here is expected to panic; but a panic must not reach C.
    let _ = catch_unwind(AssertUnwindSafe(|| {
        // SAFETY: `user` is the address of the device's `State`, which outlives the device.
        let state = unsafe { &*user.cast::<State>() };
        let text = if message.is_null() {
            String::new()
        } else {
            // SAFETY: Embree passes a terminated string that lives through this call.
            let text = unsafe { CStr::from_ptr(message) };
            format!(": {}", text.to_string_lossy())
        };
        // A second error finds the cell full, and is dropped.
        let _ = state.first_error.set(format!("{}{text}", describe(code)));
    }));
}

/// Counts bytes: positive when allocated, negative when freed.
unsafe extern "C" fn on_memory(user: *mut c_void, bytes: isize, _post: bool) -> bool {
    // SAFETY: `user` is the address of the device's `State`, which outlives the device.
    let state = unsafe { &*user.cast::<State>() };
    state.allocated.fetch_add(bytes, Ordering::Relaxed);
    true
}

fn describe(code: ffi::RTCError) -> &'static str {
    match code {
        ffi::RTC_ERROR_INVALID_ARGUMENT => "invalid argument",
        ffi::RTC_ERROR_INVALID_OPERATION => "invalid operation",
        ffi::RTC_ERROR_OUT_OF_MEMORY => "out of memory",
        ffi::RTC_ERROR_UNSUPPORTED_CPU => "this processor is not supported",
        ffi::RTC_ERROR_CANCELLED => "cancelled",
        _ => "unknown error",
    }
}

pub fn backend_error(message: String) -> Error {
    Error::Backend {
        backend: "embree",
        message,
    }
}
