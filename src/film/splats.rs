//! What light paths bring: a colour at any film position, which counts for every pixel whose filter reaches it.
//!
//! A light path is one sample of the whole picture, so a pixel's value is the sum of what arrives over the number of light paths of
//! the whole picture. Camera samples are averaged apart from it, by the weights of their pixel; both means add up.

use std::ops::Range;

use super::PixelFilter;
use super::sums::{Film, LARGEST, TILE_SIZE, TileSums, lock, quantize};
use crate::desc::PixelRect;
use crate::math::Vec2;

/// What a light path brings to the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splat {
    /// Where, in pixels from the top left corner of the whole picture, y down; may be outside of it, by the radius of the filter.
    pub film: Vec2,
    /// Linear RGB of the picture, for a unit area of film: if it arrives at positions of density p, the radiance there is its mean
    /// times p. May be negative.
    pub rgb: [f32; 3],
}

/// The pixels of a film that a splat counts for.
struct Footprint {
    pixels: PixelRect,
    rgb: [f64; 3],
    /// Where the values of the filter for its columns are, those for its rows after them.
    values: usize,
}

/// Splats by pixels, and by tiles.
#[derive(Default)]
struct Footprints {
    list: Vec<Footprint>,
    /// Values of the filter along the axes.
    values: Vec<f64>,
    /// Tile and footprint, wherever they meet.
    meetings: Vec<(u32, u32)>,
}

impl Film {
    /// Adds splats, and empties the list. Each counts, times the value of `filter` over its integral, for all pixels in whose support it
    /// lies: from a radius left of and above a pixel's centre, inclusive, to a radius right of and below it, exclusive. Those that no pixel of the
    /// crop sees change nothing. May be called from many threads: it holds the lock of one tile at a time, and sums are exact, so
    /// that neither order nor grouping matters.
    ///
    /// Returns the number of splats dropped, which are those that are not finite or out of range.
    ///
    /// # Panics
    /// If the film is not made [`Film::with_splats`].
    pub fn splat(&self, filter: &PixelFilter, splats: &mut Vec<Splat>) -> u64 {
        assert!(self.takes_splats(), "a film without sums for splats");
        let mut footprints = Footprints::default();
        let mut dropped = 0;
        for splat in splats.drain(..) {
            if is_in_range(&splat, filter) {
                footprints.push(self, filter, &splat);
            } else {
                dropped += 1;
            }
        }
        footprints.each_by_tile(self.tiles().len(), |tile, of_tile| {
            let mut tile = lock(&self.tiles()[tile]);
            for &index in of_tile {
                footprints.add(&mut tile, &footprints.list[index as usize]);
            }
        });
        dropped
    }

    /// The tiles, by index, that hold pixels of `rect`, which lies in the crop.
    fn tiles_of(&self, rect: PixelRect) -> impl Iterator<Item = u32> {
        let crop = self.crop();
        let [first_x, first_y] = [crop.x0 / TILE_SIZE, crop.y0 / TILE_SIZE];
        let columns = crop.x1.div_ceil(TILE_SIZE) - first_x;
        let rows = rect.y0 / TILE_SIZE..rect.y1.div_ceil(TILE_SIZE);
        rows.flat_map(move |ty| {
            (rect.x0 / TILE_SIZE..rect.x1.div_ceil(TILE_SIZE)).map(move |tx| (ty - first_y) * columns + (tx - first_x))
        })
    }
}

/// Whether everything is finite, and small enough for every pixel: a function of the splat alone, so that it is the same for any crop.
fn is_in_range(splat: &Splat, filter: &PixelFilter) -> bool {
    let largest = LARGEST / filter.peak();
    splat.film.is_finite() && splat.rgb.iter().all(|&c| f64::from(c).abs() < largest)
}

/// The pixels among `all` of an axis whose support, of `radius`, holds the position `x`: those whose centre c satisfies
/// c - radius <= x < c + radius.
#[inline]
fn support(x: f64, radius: f64, all: Range<u32>) -> Range<u32> {
    let [start, stop] = [f64::from(all.start), f64::from(all.end)];
    let [first, end] = [x - 0.5 - radius, x - 0.5 + radius].map(|x| (x.floor() + 1.0).clamp(start, stop) as u32);
    first..end
}

impl Footprints {
    fn push(&mut self, film: &Film, filter: &PixelFilter, splat: &Splat) {
        let [x, y] = splat.film.as_dvec2().to_array();
        let [radius_x, radius_y] = filter.radii();
        let crop = film.crop();
        let columns = support(x, radius_x, crop.x0..crop.x1);
        let rows = support(y, radius_y, crop.y0..crop.y1);
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        let index = self.list.len() as u32;
        let pixels = PixelRect {
            x0: columns.start,
            y0: rows.start,
            x1: columns.end,
            y1: rows.end,
        };
        self.meetings.extend(film.tiles_of(pixels).map(|tile| (tile, index)));
        self.list.push(Footprint {
            pixels,
            rgb: splat.rgb.map(f64::from),
            values: self.values.len(),
        });
        let center = |pixel: u32| f64::from(pixel) + 0.5;
        self.values
            .extend(columns.map(|i| filter.evaluate_axis(0, x - center(i))));
        self.values.extend(rows.map(|i| filter.evaluate_axis(1, y - center(i))));
    }

    /// Calls `f` with each tile that has some, and those. (They are counted, not compared: there are thousands for each wave.)
    fn each_by_tile(&self, tiles: usize, mut f: impl FnMut(usize, &[u32])) {
        let mut ends = vec![0_u32; tiles];
        for &(tile, _) in &self.meetings {
            ends[tile as usize] += 1;
        }
        let mut first = 0;
        for end in &mut ends {
            first += std::mem::replace(end, first);
        }
        let mut sorted = vec![0; self.meetings.len()];
        for &(tile, index) in &self.meetings {
            let end = &mut ends[tile as usize];
            sorted[*end as usize] = index;
            *end += 1;
        }
        let mut first = 0;
        for (tile, &end) in ends.iter().enumerate() {
            let of_tile = &sorted[first..end as usize];
            first = end as usize;
            if !of_tile.is_empty() {
                f(tile, of_tile);
            }
        }
    }

    /// Adds what a footprint has in a tile.
    fn add(&self, tile: &mut TileSums, footprint: &Footprint) {
        let Footprint { pixels, rgb, values } = footprint;
        let Some(rect) = tile.rect.intersection(pixels) else {
            return;
        };
        let (columns, rows) = self.values[*values..].split_at(pixels.width() as usize);
        for y in rect.y0..rect.y1 {
            let row = rows[(y - pixels.y0) as usize];
            let first = tile.index(rect.x0, y);
            let sums = &mut tile.splats[first..first + rect.width() as usize];
            for (sum, column) in sums.iter_mut().zip(&columns[(rect.x0 - pixels.x0) as usize..]) {
                let weight = row * column;
                for (sum, value) in sum.iter_mut().zip(rgb) {
                    // None of them is out of range.
                    *sum += quantize(weight * value).unwrap_or(0);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desc::FilterKind;

    const RESOLUTION: [u32; 2] = [70, 40];
    const CROP: PixelRect = PixelRect {
        x0: 21,
        y0: 30,
        x1: 66,
        y1: 39,
    };

    fn whole() -> Film {
        Film::new(RESOLUTION, PixelRect::full(RESOLUTION)).with_splats()
    }

    fn filter() -> PixelFilter {
        PixelFilter::new(FilterKind::LanczosSinc { tau: 3.0 }, [2.5, 1.7]).expect("a filter")
    }

    /// All over the grown raster and a little beyond, of magnitudes that floating-point addition cannot reorder.
    fn scattered() -> Vec<Splat> {
        // Weyl sequences, of the golden ratio and of Rauzy's number.
        let weyl = |i: u32, step: f32| (i as f32 * step).fract();
        let at = |i: u32| Splat {
            film: Vec2::new(76.0 * weyl(i, 0.754_877_7) - 3.0, 46.0 * weyl(i, 0.569_840_3) - 3.0),
            rgb: [1e8, 1e-8, -1.0].map(|c| c * (1.0 + weyl(i, 0.618_034))),
        };
        (0..4000).map(at).collect()
    }

    fn sums(film: &Film) -> Vec<Vec<[i128; 3]>> {
        film.tiles().iter().map(|tile| lock(tile).splats.clone()).collect()
    }

    #[test]
    fn neither_order_nor_threads_matter() {
        let filter = filter();
        let once = whole();
        assert_eq!(once.splat(&filter, &mut scattered()), 0);
        let backwards = whole();
        for chunk in scattered().rchunks(37) {
            backwards.splat(&filter, &mut chunk.to_vec());
        }
        let threads = whole();
        std::thread::scope(|scope| {
            for i in 0..4 {
                let (threads, filter) = (&threads, &filter);
                scope.spawn(move || {
                    let own: Vec<Splat> = scattered().into_iter().skip(i).step_by(4).collect();
                    for chunk in own.chunks(11) {
                        threads.splat(filter, &mut chunk.to_vec());
                    }
                });
            }
        });
        assert!(sums(&once).iter().flatten().all(|sum| *sum != [0; 3]));
        assert_eq!(sums(&once), sums(&backwards));
        assert_eq!(sums(&once), sums(&threads));
    }

    #[test]
    fn a_crop_is_the_crop_of_the_whole() {
        let [all, crop] = [PixelRect::full(RESOLUTION), CROP].map(|rect| {
            let film = Film::new(RESOLUTION, rect).with_splats();
            film.splat(&filter(), &mut scattered());
            film.add_light_paths(1234);
            film.develop()
        });
        let row = 3 * CROP.width() as usize;
        for (y, cropped) in (CROP.y0..CROP.y1).zip(crop.chunks_exact(row)) {
            let first = 3 * (y * RESOLUTION[0] + CROP.x0) as usize;
            assert_eq!(all[first..first + row], *cropped, "row {y}");
        }
    }

    /// Splats of radiance 1 in a fine grid over the film positions that pixels see, or over the raster only.
    fn even_picture(filter: &PixelFilter, beyond: Vec2) -> Vec<f32> {
        const RESOLUTION: [u32; 2] = [5, 4];
        const PER_PIXEL: f32 = 32.0;
        let film = Film::new(RESOLUTION, PixelRect::full(RESOLUTION)).with_splats();
        let size = Vec2::new(5.0, 4.0) + 2.0 * beyond;
        let [columns, rows] = (size * PER_PIXEL).round().as_uvec2().to_array();
        let area = size.x * size.y;
        for y in 0..rows {
            let splat = |x: u32| Splat {
                film: (Vec2::new(x as f32, y as f32) + 0.5) / PER_PIXEL - beyond,
                rgb: [1.0, -2.0, 0.5].map(|c| c * area),
            };
            assert_eq!(film.splat(filter, &mut (0..columns).map(splat).collect()), 0);
        }
        film.add_light_paths(u64::from(columns * rows));
        film.develop()
    }

    #[test]
    fn an_even_picture_is_even_to_its_borders() {
        let third = 1.0 / 3.0;
        for (kind, radius) in [
            (FilterKind::Box, [0.5, 0.5]),
            (FilterKind::Box, [1.0, 0.75]),
            (FilterKind::Triangle, [2.0, 1.0]),
            (FilterKind::Gaussian { sigma: 0.5 }, [1.5, 1.5]),
            (FilterKind::Mitchell { b: third, c: third }, [2.0, 1.5]),
            (FilterKind::LanczosSinc { tau: 3.0 }, [4.0, 3.0]),
            (FilterKind::BlackmanHarris, [2.0, 2.5]),
        ] {
            let filter = PixelFilter::new(kind, radius).expect("a filter");
            // The midpoint rule is off by h²/24 times the integral of |f''|, which is at most some 10 here: 4e-4.
            for rgb in even_picture(&filter, filter.radius() - 0.5).chunks_exact(3) {
                for (got, expected) in rgb.iter().zip([1.0, -2.0, 0.5]) {
                    assert!((got / expected - 1.0).abs() < 5e-4, "{kind:?}: {rgb:?}");
                }
            }
            // Without what lies around the raster the corner would be told apart.
            let corner = even_picture(&filter, Vec2::ZERO)[0];
            assert_eq!((corner - 1.0).abs() < 0.01, radius == [0.5, 0.5], "{kind:?}: {corner}");
        }
    }

    #[test]
    fn a_position_between_pixels_belongs_to_one() {
        let filter = PixelFilter::new(FilterKind::Box, [0.5, 0.5]).expect("a filter");
        let film = whole();
        let rgb = [1.0, 2.0, 3.0];
        for film_position in [Vec2::new(3.0, 2.0), Vec2::new(32.0, 32.0), Vec2::new(70.0, 10.0)] {
            film.splat(
                &filter,
                &mut vec![Splat {
                    film: film_position,
                    rgb,
                }],
            );
        }
        film.add_light_paths(1);
        let image = film.develop();
        let at = |x: u32, y: u32| &image[3 * (y * RESOLUTION[0] + x) as usize..][..3];
        assert_eq!((at(3, 2), at(32, 32)), (&rgb[..], &rgb[..]));
        assert_eq!(image.iter().sum::<f32>(), 12.0);
    }

    #[test]
    fn what_is_not_finite_or_too_large_is_dropped_and_counted() {
        let film = whole();
        let splat = |x: f32, green: f32| Splat {
            film: Vec2::new(x, 10.0),
            rgb: [1.0, green, 1.0],
        };
        let mut bad = vec![
            splat(f32::NAN, 1.0),
            splat(f32::INFINITY, 1.0),
            splat(10.0, f32::NAN),
            splat(10.0, f32::NEG_INFINITY),
            splat(10.0, 1e30),
            splat(-1e30, 1e30),
        ];
        assert_eq!(film.splat(&filter(), &mut bad), 6);
        assert!(bad.is_empty());
        // Nobody sees these: they are no errors.
        let mut unseen: Vec<Splat> = [-2.1, 72.1, 1e10, 3e38, -3e38].map(|x| splat(x, 1.0)).into();
        assert_eq!(film.splat(&filter(), &mut unseen), 0);
        assert!(sums(&film).iter().flatten().all(|sum| *sum == [0; 3]));
    }

    #[test]
    fn light_paths_add_to_camera_samples_or_stand_alone() {
        let filter = PixelFilter::new(FilterKind::Box, [0.5, 0.5]).expect("a filter");
        let film = whole();
        let at = |x: f32| Splat {
            film: Vec2::new(x, 0.5),
            rgb: [8.0, 4.0, -2.0],
        };
        film.splat(&filter, &mut vec![at(0.5), at(1.5), at(1.5)]);
        film.add_light_paths(3);
        film.add_light_paths(1);
        lock(&film.tiles()[0]).add(0, 0, Some([1.0, 2.0, 3.0]), 0.5);
        let image = film.develop();
        assert_eq!(image[..9], [3.0, 3.0, 2.5, 4.0, 2.0, -1.0, 0.0, 0.0, 0.0]);
        assert_eq!(film.light_paths(), 4);
    }
}
