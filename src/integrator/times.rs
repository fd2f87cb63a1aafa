//! Where a render's time goes. The clock is read a few times for each batch of some thousand rays, whether anybody asks or not.

use std::ops::AddAssign;
use std::time::{Duration, Instant};

/// Time of all threads together, by what they do in waves. What is not in a wave (building photon maps, waiting for other threads) is
/// not in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StageTimes {
    /// The backend, about camera rays.
    pub camera: Duration,
    /// The backend, about rays scattered on the way from the camera.
    pub bounce: Duration,
    /// The backend, about rays on the way from lights.
    pub photon: Duration,
    /// The backend, about shadow rays.
    pub shadow: Duration,
    /// Beginnings of paths: camera samples, emission.
    pub sample: Duration,
    /// Scattering events: surfaces, materials, lights, photons looked up.
    pub shade: Duration,
    /// What comes to the film.
    pub film: Duration,
}

impl StageTimes {
    /// The backend.
    pub fn backend(&self) -> Duration {
        self.camera + self.bounce + self.photon + self.shadow
    }

    /// Everything.
    pub fn all(&self) -> Duration {
        self.backend() + self.sample + self.shade + self.film
    }
}

impl AddAssign for StageTimes {
    fn add_assign(&mut self, other: Self) {
        self.camera += other.camera;
        self.bounce += other.bounce;
        self.photon += other.photon;
        self.shadow += other.shadow;
        self.sample += other.sample;
        self.shade += other.shade;
        self.film += other.film;
    }
}

/// Adds the time since `start` and begins again.
pub(super) fn lap(start: &mut Instant, time: &mut Duration) {
    let now = Instant::now();
    *time += now.duration_since(*start);
    *start = now;
}
