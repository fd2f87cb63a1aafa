//! How photons count by their distance.

use crate::desc::PhotonFilter;

/// Jensen's (2001) constants of the Gaussian filter; its factor alpha is here the exact norm.
const BETA: f32 = 1.953;
/// Jensen's slope of the cone filter.
const CONE: f32 = 1.1;

/// A filter over a disk of radius 1, whose mean over the disk is 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kernel {
    filter: PhotonFilter,
    norm: f32,
}

impl Kernel {
    pub fn new(filter: PhotonFilter) -> Self {
        let norm = match filter {
            PhotonFilter::Constant => 1.0,
            // The mean of 1 - s / k over the disk, s being the distance.
            PhotonFilter::Cone => 1.0 / (1.0 - 2.0 / (3.0 * CONE)),
            PhotonFilter::Gaussian => {
                let mean = (1.0 - (-0.5 * BETA).exp()) * 2.0 / BETA;
                1.0 / (1.0 - (1.0 - mean) / (1.0 - (-BETA).exp()))
            }
        };
        Self { filter, norm }
    }

    /// At the squared distance `s2`, in [0, 1].
    #[inline]
    pub fn at(&self, s2: f32) -> f32 {
        let shape = match self.filter {
            PhotonFilter::Constant => 1.0,
            PhotonFilter::Cone => 1.0 - s2.sqrt() / CONE,
            PhotonFilter::Gaussian => 1.0 - (1.0 - (-0.5 * BETA * s2).exp()) / (1.0 - (-BETA).exp()),
        };
        self.norm * shape
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_over_the_disk_is_one() {
        for filter in [PhotonFilter::Constant, PhotonFilter::Cone, PhotonFilter::Gaussian] {
            let kernel = Kernel::new(filter);
            // Points of equal area.
            let count = 1000;
            let mean = (0..count)
                .map(|i| f64::from(kernel.at((i as f32 + 0.5) / count as f32)))
                .sum::<f64>()
                / f64::from(count);
            assert!((mean - 1.0).abs() < 1e-4, "{filter:?} {mean}");
            assert!(kernel.at(0.0) >= kernel.at(0.5) && kernel.at(0.5) >= kernel.at(1.0) && kernel.at(1.0) > 0.0);
        }
    }
}
