//! Exact sums. A contribution is rounded once to a multiple of 2^-64 and added as an integer, so that the order of additions does
//! not matter: the image has the same bits for any number of threads and any split of the samples.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use super::layers::TileLayers;
use crate::desc::{FilmKind, PixelRect};

/// Edge of a tile in pixels: the paths of one at one sample index fit a second level cache. Tiles lie at multiples of it from the top left corner of the whole picture, whatever the crop.
pub const TILE_SIZE: u32 = 32;

/// The sums of one pixel: weighted linear RGB and weights, in units of 2^-64.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(align(64))]
struct PixelSums {
    rgb: [i128; 3],
    weight: i128,
}

/// The sums of the pixels of a tile that lie in the film.
#[derive(Clone, Debug)]
pub struct TileSums {
    pub(super) rect: PixelRect,
    pixels: Vec<PixelSums>,
    /// What light paths brought, if the film takes it: linear RGB, in units of 2^-64; else empty.
    pub(super) splats: Vec<[i128; 3]>,
    /// Squares of the luminance of camera samples, if the film keeps them, in units of 2^-48; else empty.
    squares: Vec<i128>,
    pub(super) layers: TileLayers,
    dropped: u64,
}

/// Values of this magnitude or more are not added: 2^23 of them would just fit into a sum.
pub(super) const LARGEST: f64 = (1_u64 << 40) as f64;

/// `value` in units of 2^-64, rounded to an even number of them towards 0; `None` if it is not finite or beyond [`LARGEST`].
#[inline]
pub(super) fn quantize(value: f64) -> Option<i128> {
    (value.abs() < LARGEST).then(|| {
        // Both parts are exact, and so is scaling by a power of two. The fraction may be negative: 2^63 of them fit a signed integer.
        let whole = value as i64;
        let fraction = (value - whole as f64) * 9_223_372_036_854_775_808.0;
        (i128::from(whole) << 64) + (i128::from(fraction as i64) << 1)
    })
}

/// One over the unit of squares: 2^48. Squares of what is summed fit 128 bits with it.
const SQUARE_SCALE: f64 = (1_u64 << 48) as f64;

/// Of linear RGB, by the weights of sRGB's primaries.
fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Back to a number.
pub(super) fn dequantize(sum: i128) -> f64 {
    sum as f64 / 18_446_744_073_709_551_616.0
}

impl TileSums {
    /// The pixels that it holds.
    pub fn rect(&self) -> PixelRect {
        self.rect
    }

    /// Where a pixel of it is in its arrays.
    #[inline]
    pub(super) fn index(&self, x: u32, y: u32) -> usize {
        ((y - self.rect.y0) * self.rect.width() + (x - self.rect.x0)) as usize
    }

    /// Adds one camera sample of pixel (x, y), which must lie in [`TileSums::rect`]: `weight` of the pixel filter, and linear
    /// `rgb`, `None` for a sample that was dropped. A dropped sample, or one whose colour is not finite or out of range, counts
    /// as black; whether it did is returned.
    #[inline]
    pub fn add(&mut self, x: u32, y: u32, rgb: Option<[f32; 3]>, weight: f32) -> bool {
        let index = self.index(x, y);
        let w = f64::from(weight);
        let quantized = rgb.and_then(|rgb| {
            let [r, g, b] = rgb.map(f64::from);
            Some((rgb, [quantize(w * r)?, quantize(w * g)?, quantize(w * b)?]))
        });
        let (_, [r, g, b]) = quantized.unwrap_or_default();
        self.add_quantized(index, [r, g, b, quantize(w).unwrap_or(0)]);
        match quantized {
            Some((rgb, _)) => self.add_square(index, rgb),
            None => self.count_dropped(1),
        }
        quantized.is_some()
    }

    /// Adds red, green, blue and a weight.
    #[inline]
    pub(super) fn add_quantized(&mut self, index: usize, [r, g, b, weight]: [i128; 4]) {
        let sums = &mut self.pixels[index];
        for (sum, value) in sums.rgb.iter_mut().zip([r, g, b]) {
            *sum += value;
        }
        sums.weight += weight;
    }

    /// Whether there are sums of squares.
    #[inline]
    pub(super) fn has_squares(&self) -> bool {
        !self.squares.is_empty()
    }

    /// Adds the square of a colour, if there are such sums.
    #[inline]
    pub(super) fn add_square(&mut self, index: usize, rgb: [f32; 3]) {
        if let Some(square) = self.squares.get_mut(index) {
            *square += (luminance(rgb.map(f64::from)).powi(2) * SQUARE_SCALE) as i128;
        }
    }

    /// Counts samples that were dropped.
    #[inline]
    pub(super) fn count_dropped(&mut self, samples: u64) {
        self.dropped += samples;
    }

    /// The filter weight of all samples of a pixel.
    pub(super) fn weight(&self, index: usize) -> f64 {
        dequantize(self.pixels[index].weight)
    }

    /// How many pixels it holds.
    pub(super) fn pixel_count(&self) -> usize {
        self.pixels.len()
    }

    /// The colour of a pixel, where there were `light_paths`.
    fn develop(&self, x: u32, y: u32, light_paths: f64) -> [f32; 3] {
        let index = self.index(x, y);
        let sums = &self.pixels[index];
        let splats = self.splats.get(index).copied().unwrap_or_default();
        let weight = dequantize(sums.weight);
        std::array::from_fn(|channel| {
            let mean = if sums.weight == 0 {
                0.0
            } else {
                dequantize(sums.rgb[channel]) / weight
            };
            (mean + dequantize(splats[channel]) / light_paths) as f32
        })
    }
}

/// The sums of all pixels of a crop, by tile.
#[derive(Debug)]
pub struct Film {
    resolution: [u32; 2],
    crop: PixelRect,
    tiles: Vec<Mutex<TileSums>>,
    /// Whether it has sums for splats.
    takes_splats: bool,
    light_paths: AtomicU64,
    layers: Vec<Film>,
    /// What it keeps beside colours.
    pub(super) kind: FilmKind,
}

impl Film {
    /// A black film for the pixels in `crop` of a picture of `resolution`.
    ///
    /// # Panics
    /// If the crop is empty or reaches beyond the picture.
    pub fn new(resolution: [u32; 2], crop: PixelRect) -> Self {
        assert!(crop.x0 < crop.x1 && crop.y0 < crop.y1 && crop.x1 <= resolution[0] && crop.y1 <= resolution[1]);
        let mut tiles = Vec::new();
        for ty in crop.y0 / TILE_SIZE..crop.y1.div_ceil(TILE_SIZE) {
            for tx in crop.x0 / TILE_SIZE..crop.x1.div_ceil(TILE_SIZE) {
                let (x0, y0) = (tx * TILE_SIZE, ty * TILE_SIZE);
                let tile = PixelRect {
                    x0,
                    y0,
                    x1: x0 + TILE_SIZE,
                    y1: y0 + TILE_SIZE,
                };
                if let Some(rect) = tile.intersection(&crop) {
                    let pixels = vec![PixelSums::default(); rect.area() as usize];
                    tiles.push(Mutex::new(TileSums {
                        rect,
                        pixels,
                        splats: Vec::new(),
                        squares: Vec::new(),
                        layers: TileLayers::default(),
                        dropped: 0,
                    }));
                }
            }
        }
        Self {
            resolution,
            crop,
            tiles,
            takes_splats: false,
            light_paths: AtomicU64::new(0),
            layers: Vec::new(),
            kind: FilmKind::Rgb,
        }
    }

    /// The same film with sums for what light paths bring, see [`Film::splat`].
    pub fn with_splats(mut self) -> Self {
        for tile in self.tiles_mut() {
            tile.splats.resize(tile.pixels.len(), [0; 3]);
        }
        self.takes_splats = true;
        self
    }

    /// The same film with sums of squares, from which [`Film::noise`] tells how far it is from its end.
    pub fn with_squares(mut self) -> Self {
        for tile in self.tiles_mut() {
            tile.squares.resize(tile.pixels.len(), 0);
        }
        self
    }

    /// The relative error that is to be expected of a film [with squares](Film::with_squares) after `samples` independent samples of
    /// each pixel: the root of the mean over pixels of V / (n (m² + 0.01)), with m and V the mean and the variance of a sample's
    /// luminance. Infinite for fewer than two samples.
    pub fn noise(&self, samples: u32) -> f64 {
        if samples < 2 {
            return f64::INFINITY;
        }
        let n = f64::from(samples);
        let mut sum = 0.0;
        for tile in &self.tiles {
            let tile = lock(tile);
            for (pixel, &square) in tile.pixels.iter().zip(&tile.squares) {
                let weight = dequantize(pixel.weight);
                if weight != 0.0 {
                    let mean = luminance(pixel.rgb.map(|value| dequantize(value) / weight));
                    let variance = (square as f64 / SQUARE_SCALE / n - mean * mean).max(0.0) * n / (n - 1.0);
                    sum += variance / (n * (mean * mean + 0.01));
                }
            }
        }
        (sum / self.crop.area() as f64).sqrt()
    }

    /// The same film with others beside it, which take parts of its picture.
    ///
    /// # Panics
    /// If they are not for the same pixels.
    pub fn with_layers(mut self, layers: Vec<Self>) -> Self {
        let same = |layer: &Self| layer.resolution == self.resolution && layer.crop == self.crop;
        assert!(layers.iter().all(same), "a layer for other pixels");
        self.layers = layers;
        self
    }

    /// The films beside it; mostly none.
    pub fn layers(&self) -> &[Self] {
        &self.layers
    }

    /// Memory that a film takes for each pixel, in bytes.
    pub fn bytes_per_pixel(takes_splats: bool) -> u64 {
        let splats = if takes_splats { size_of::<[i128; 3]>() } else { 0 };
        (size_of::<PixelSums>() + splats) as u64
    }

    /// Whether it has such sums.
    pub fn takes_splats(&self) -> bool {
        self.takes_splats
    }

    /// Counts `paths` more light paths of the whole picture, whether or not they brought anything.
    pub fn add_light_paths(&self, paths: u64) {
        self.light_paths.fetch_add(paths, Ordering::Relaxed);
    }

    /// All light paths that were counted.
    pub fn light_paths(&self) -> u64 {
        self.light_paths.load(Ordering::Relaxed)
    }

    /// Width and height of the whole picture.
    pub fn resolution(&self) -> [u32; 2] {
        self.resolution
    }

    /// The pixels that it holds.
    pub fn crop(&self) -> PixelRect {
        self.crop
    }

    /// Its tiles, to be changed.
    pub(super) fn tiles_mut(&mut self) -> impl Iterator<Item = &mut TileSums> {
        self.tiles
            .iter_mut()
            .map(|tile| tile.get_mut().unwrap_or_else(std::sync::PoisonError::into_inner))
    }

    /// Its tiles, row by row, each behind its own lock.
    pub fn tiles(&self) -> &[Mutex<TileSums>] {
        &self.tiles
    }

    /// Samples that counted as black because they were not finite, negative or out of range.
    pub fn dropped_samples(&self) -> u64 {
        self.tiles.iter().map(|tile| lock(tile).dropped).sum()
    }

    /// Linear RGB, row by row from the top left pixel of the crop: the weighted means of camera samples, 0 where no weight fell, and the
    /// mean over all light paths of what they brought, 0 if there were none.
    pub fn develop(&self) -> Vec<f32> {
        let mut image = vec![0.0; 3 * self.crop.area() as usize];
        let light_paths = self.light_paths().max(1) as f64;
        for tile in &self.tiles {
            let tile = lock(tile);
            for y in tile.rect.y0..tile.rect.y1 {
                for x in tile.rect.x0..tile.rect.x1 {
                    let row = u64::from(y - self.crop.y0) * u64::from(self.crop.width());
                    let index = 3 * (row + u64::from(x - self.crop.x0)) as usize;
                    image[index..index + 3].copy_from_slice(&tile.develop(x, y, light_paths));
                }
            }
        }
        image
    }
}

/// Locks a tile; the sums are whole even if another thread panicked between two of them.
pub(crate) fn lock(tile: &Mutex<TileSums>) -> std::sync::MutexGuard<'_, TileSums> {
    tile.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film() -> Film {
        Film::new(
            [100, 70],
            PixelRect {
                x0: 60,
                y0: 10,
                x1: 90,
                y1: 66,
            },
        )
    }

    #[test]
    fn tiles_lie_on_the_grid_of_the_whole_picture() {
        let rects: Vec<_> = film().tiles().iter().map(|tile| lock(tile).rect()).collect();
        assert_eq!(rects.len(), 6);
        assert_eq!(
            rects[0],
            PixelRect {
                x0: 60,
                y0: 10,
                x1: 64,
                y1: 32
            }
        );
        assert_eq!(
            rects[5],
            PixelRect {
                x0: 64,
                y0: 64,
                x1: 90,
                y1: 66
            }
        );
    }

    #[test]
    fn sums_do_not_depend_on_their_order() {
        // Values that floating-point addition cannot reorder: 1e8 + 1e-8 - 1e8.
        let values: Vec<f32> = (0..1000)
            .map(|i| (if i % 3 == 0 { 1e8 } else { 1e-8 }) * (1.0 + i as f32))
            .collect();
        let render = |order: &mut dyn Iterator<Item = &f32>| {
            let film = film();
            for &v in order {
                lock(&film.tiles()[0]).add(61, 11, Some([v, -v, 0.5 * v]), 0.7);
            }
            film.develop()
        };
        assert_eq!(render(&mut values.iter()), render(&mut values.iter().rev()));
    }

    #[test]
    fn noise_is_the_relative_error_of_the_mean() {
        // Samples of 1 and 3 in turn: mean 2, variance 1 (n / (n - 1) of it from n samples).
        let film = film().with_squares();
        assert_eq!(film.noise(1), f64::INFINITY);
        for tile in film.tiles() {
            let mut tile = lock(tile);
            let rect = tile.rect();
            for (y, x) in (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| (y, x))) {
                for sample in 0..100 {
                    tile.add(x, y, Some([1.0 + 2.0 * (sample % 2) as f32; 3]), 1.0);
                }
            }
        }
        let expected = (100.0_f64 / 99.0 / (100.0 * 4.01)).sqrt();
        assert!((film.noise(100) / expected - 1.0).abs() < 1e-6, "{}", film.noise(100));
    }

    #[test]
    fn pixels_are_weighted_means_and_dropped_samples_count_as_black() {
        let film = film();
        let mut tile = lock(&film.tiles()[5]);
        assert!(tile.add(89, 65, Some([1.0, 2.0, 3.0]), 1.0));
        assert!(tile.add(89, 65, Some([5.0, 0.0, 0.0]), -0.5));
        assert!(!tile.add(89, 65, Some([f32::NAN, 0.0, 0.0]), 0.5));
        assert!(!tile.add(89, 65, None, 1.0));
        drop(tile);
        let image = film.develop();
        assert_eq!(image[image.len() - 3..], [-0.75, 1.0, 1.5]);
        assert_eq!(film.dropped_samples(), 2);
    }
}
