//! Images at all scales, and the filters that look things up in them, as in pbrt-v4: a point, four texels, those of two levels, or
//! an elliptical Gaussian (Heckbert 1989).
//!
//! Coordinates (s, t) are in [0, 1] over the image, t downwards. A level is half the one below, rounded down; a texel of it is the
//! mean of what it covers, so that every level has the mean of the image.

use std::sync::Arc;

use crate::image_io::Image;
use crate::math::{Vec2, Vec3};

/// What is beyond the edges of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The image again.
    Repeat,
    /// Black.
    Black,
    /// The nearest texel of the edge.
    Clamp,
    /// The image and its mirror image in turn.
    Mirror,
    /// The image again, flipped as an octahedral map of the sphere continues.
    OctahedralSphere,
}

/// How texels are combined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// The nearest texel of the nearest finer level.
    Point,
    /// Four texels of the nearest finer level.
    Bilinear,
    /// Four texels of each of two levels.
    Trilinear,
    /// All within the ellipse of the footprint, whose axes are kept within this ratio.
    Ewa {
        /// At least 1.
        max_anisotropy: f32,
    },
}

/// An image at all scales: linear r, g, b (a grey image three times the same), or its first channel where only that is wanted.
#[derive(Clone, Debug)]
pub struct MipMap {
    levels: Vec<Level>,
    wrap: Wrap,
}

#[derive(Clone, Debug)]
struct Level {
    width: usize,
    height: usize,
    texels: Texels,
}

#[derive(Clone, Debug)]
enum Texels {
    /// The image itself, and which channels of it.
    Image(Arc<Image>, [usize; 3]),
    /// One number.
    Grey(Vec<f32>),
    /// Three numbers.
    Colour(Vec<[f32; 3]>),
}

impl Level {
    #[inline]
    fn texel(&self, x: usize, y: usize) -> Vec3 {
        let index = y * self.width + x;
        match &self.texels {
            Texels::Image(image, channels) => {
                let pixel = &image.data()[index * image.channels().len()..];
                Vec3::from(channels.map(|c| pixel[c]))
            }
            Texels::Grey(values) => Vec3::splat(values[index]),
            Texels::Colour(values) => values[index].into(),
        }
    }

    fn memory(&self) -> usize {
        match &self.texels {
            Texels::Image(image, _) => size_of_val(image.data()),
            Texels::Grey(values) => size_of_val(values.as_slice()),
            Texels::Colour(values) => size_of_val(values.as_slice()),
        }
    }
}

impl MipMap {
    /// All levels of an image: of its colour, or with `grey` of its first channel alone. `None` if it has no colour (R, G and B, or Y).
    pub fn new(image: &Arc<Image>, wrap: Wrap, grey: bool) -> Option<Self> {
        let channels = image.colour_channels()?;
        let channels = if grey { [channels[0]; 3] } else { channels };
        let is_grey = channels[0] == channels[1];
        let mut levels = vec![Level {
            width: image.width(),
            height: image.height(),
            texels: Texels::Image(Arc::clone(image), channels),
        }];
        while let Some(finer) = levels.last().filter(|level| level.width * level.height > 1) {
            levels.push(reduced(finer, is_grey));
        }
        Some(Self { levels, wrap })
    }

    /// Bytes of all levels.
    pub fn memory(&self) -> usize {
        self.levels.iter().map(Level::memory).sum()
    }

    /// The value at `st` for a footprint with axes `dst0` and `dst1`.
    pub fn lookup(&self, st: Vec2, dst0: Vec2, dst1: Vec2, filter: Filter) -> Vec3 {
        if let Filter::Ewa { max_anisotropy } = filter {
            return self.elliptical(st, dst0, dst1, max_anisotropy);
        }
        // The filter is twice as wide as the step from sample to sample.
        let width = 2.0 * dst0.abs().max(dst1.abs()).max_element();
        let level = self.level_of(width);
        if level >= (self.levels.len() - 1) as f32 {
            return self.coarsest();
        }
        let finer = level as usize;
        match filter {
            Filter::Point => {
                let at = self.texel_coordinates(finer, st).round();
                self.texel(finer, at.x as i64, at.y as i64)
            }
            Filter::Bilinear => self.bilinear(finer, st),
            _ if level <= 0.0 => self.bilinear(0, st),
            _ => {
                let (a, b) = (self.bilinear(finer, st), self.bilinear(finer + 1, st));
                a.lerp(b, level.fract())
            }
        }
    }

    /// The level, not below 0, whose texels are as wide as `width` in (s, t).
    fn level_of(&self, width: f32) -> f32 {
        let side = self.levels[0].width.max(self.levels[0].height);
        (width * side as f32).log2().max(0.0)
    }

    fn coarsest(&self) -> Vec3 {
        self.levels.last().map_or(Vec3::ZERO, |level| level.texel(0, 0))
    }

    /// Where `st` is among the centres of a level's texels.
    fn texel_coordinates(&self, level: usize, st: Vec2) -> Vec2 {
        let level = &self.levels[level];
        st * Vec2::new(level.width as f32, level.height as f32) - 0.5
    }

    /// The texel in column `x` and row `y` of a level, which may be beyond its edges.
    #[inline]
    fn texel(&self, level: usize, x: i64, y: i64) -> Vec3 {
        let level = &self.levels[level];
        let (width, height) = (level.width as i64, level.height as i64);
        let inside = (0..width).contains(&x) && (0..height).contains(&y);
        let (x, y) = match self.wrap {
            _ if inside => (x, y),
            Wrap::Black => return Vec3::ZERO,
            Wrap::Repeat => (wrapped(x, level.width), wrapped(y, level.height)),
            Wrap::Clamp => (x.clamp(0, width - 1), y.clamp(0, height - 1)),
            Wrap::Mirror => (mirrored(x, width), mirrored(y, height)),
            Wrap::OctahedralSphere => octahedral([x, y], [width, height]),
        };
        level.texel(x as usize, y as usize)
    }

    fn bilinear(&self, level: usize, st: Vec2) -> Vec3 {
        let at = self.texel_coordinates(level, st);
        let corner = at.floor();
        let d = at - corner;
        let (x, y) = (corner.x as i64, corner.y as i64);
        let (x, y) = match self.wrap {
            // Once, not for each of the four.
            Wrap::Repeat => (
                wrapped(x, self.levels[level].width),
                wrapped(y, self.levels[level].height),
            ),
            _ => (x, y),
        };
        let top = self.texel(level, x, y).lerp(self.texel(level, x + 1, y), d.x);
        let bottom = self.texel(level, x, y + 1).lerp(self.texel(level, x + 1, y + 1), d.x);
        top.lerp(bottom, d.y)
    }

    fn elliptical(&self, st: Vec2, dst0: Vec2, dst1: Vec2, max_anisotropy: f32) -> Vec3 {
        let (long, mut short) = if dst0.length_squared() < dst1.length_squared() {
            (dst1, dst0)
        } else {
            (dst0, dst1)
        };
        let (long_length, mut short_length) = (long.length(), short.length());
        if short_length == 0.0 {
            return self.bilinear(0, st);
        }
        // A thin ellipse would have many texels: make it rounder, and so blurred.
        if short_length * max_anisotropy < long_length {
            let scale = long_length / (short_length * max_anisotropy);
            short *= scale;
            short_length *= scale;
        }
        let level = self.level_of(short_length);
        let finer = level as usize;
        let a = self.gaussian(finer, st, long, short);
        match level.fract() {
            0.0 => a,
            fraction => a.lerp(self.gaussian(finer + 1, st, long, short), fraction),
        }
    }

    /// The mean of a level's texels within an ellipse, by a Gaussian of the squared radius.
    fn gaussian(&self, level: usize, st: Vec2, long: Vec2, short: Vec2) -> Vec3 {
        if level >= self.levels.len() - 1 {
            return self.coarsest();
        }
        let size = Vec2::new(self.levels[level].width as f32, self.levels[level].height as f32);
        let at = self.texel_coordinates(level, st);
        let (u, v) = (long * size, short * size);
        // The quadratic form that is 1 on the ellipse; 1 is added to both diagonal elements so that it holds a texel.
        let a = u.y * u.y + v.y * v.y + 1.0;
        let b = -2.0 * (u.x * u.y + v.x * v.y);
        let c = u.x * u.x + v.x * v.x + 1.0;
        let inverse = 1.0 / (a * c - 0.25 * b * b);
        let (a, b, c) = (a * inverse, b * inverse, c * inverse);
        let determinant = 4.0 * a * c - b * b;
        let reach = Vec2::new((determinant * c).sqrt(), (determinant * a).sqrt()) * (2.0 / determinant);
        let (first, last) = ((at - reach).ceil(), (at + reach).floor());
        let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
        for y in first.y as i64..=last.y as i64 {
            let dy = y as f32 - at.y;
            for x in first.x as i64..=last.x as i64 {
                let dx = x as f32 - at.x;
                let r2 = a * dx * dx + b * dx * dy + c * dy * dy;
                if r2 < 1.0 {
                    let weight = (-2.0 * r2).exp() - GAUSSIAN_END;
                    sum += self.texel(level, x, y) * weight;
                    weights += weight;
                }
            }
        }
        if weights > 0.0 {
            sum / weights
        } else {
            self.bilinear(level, st)
        }
    }
}

/// exp(-2): the Gaussian at the ellipse's edge, where the filter is to be 0.
const GAUSSIAN_END: f32 = 0.135_335_28;

/// The texel that one of the image again is; without a division where that is near.
#[inline]
fn wrapped(x: i64, size: usize) -> i64 {
    let size = size as i64;
    if (0..size).contains(&x) {
        x
    } else if (size..2 * size).contains(&x) {
        x - size
    } else {
        x.rem_euclid(size)
    }
}

/// The texel that one beyond the edges is a mirror image of.
fn mirrored(x: i64, size: i64) -> i64 {
    let x = x.rem_euclid(2 * size);
    x.min(2 * size - 1 - x)
}

/// Where the octahedral map continues beyond its edges: flipped about the middle of the edge.
fn octahedral([x, y]: [i64; 2], [width, height]: [i64; 2]) -> (i64, i64) {
    let (mut x, mut y) = (x, y);
    if x < 0 || x >= width {
        x = if x < 0 { -1 - x } else { 2 * width - 1 - x };
        y = height - 1 - y;
    }
    if y < 0 || y >= height {
        x = width - 1 - x;
        y = if y < 0 { -1 - y } else { 2 * height - 1 - y };
    }
    // Farther away than a whole image nothing sensible is left.
    (x.clamp(0, width - 1), y.clamp(0, height - 1))
}

/// The next coarser level.
fn reduced(finer: &Level, is_grey: bool) -> Level {
    let (width, height) = ((finer.width / 2).max(1), (finer.height / 2).max(1));
    let columns: Vec<_> = (0..width).map(|x| coverage(x, width, finer.width)).collect();
    let mut colours = Vec::with_capacity(width * height);
    for y in 0..height {
        let rows = coverage(y, height, finer.height);
        for column in &columns {
            let mut sum = Vec3::ZERO;
            for &(y, row_weight) in &rows {
                for &(x, column_weight) in column {
                    sum += finer.texel(x, y) * (row_weight * column_weight);
                }
            }
            colours.push(sum.to_array());
        }
    }
    let texels = if is_grey {
        Texels::Grey(colours.into_iter().map(|c| c[0]).collect())
    } else {
        Texels::Colour(colours)
    };
    Level { width, height, texels }
}

/// Which of `finer` texels, and how much of each as a part of the whole, texel `i` of `coarser` covers.
fn coverage(i: usize, coarser: usize, finer: usize) -> Vec<(usize, f32)> {
    // In units of 1 / coarser of a fine texel.
    let (start, end) = (i * finer, (i + 1) * finer);
    (start / coarser..end.div_ceil(coarser))
        .map(|j| {
            let covered = end.min((j + 1) * coarser) - start.max(j * coarser);
            (j, covered as f32 / finer as f32)
        })
        .collect()
}

#[cfg(test)]
#[path = "mipmap_tests.rs"]
mod tests;
