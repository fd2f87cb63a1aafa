//! Films: what a picture is taken on, which part of it, and what is kept of a pixel.

use std::path::PathBuf;

use crate::error::Span;
use crate::spectrum::ColorSpace;

/// What the picture is taken on.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmDesc {
    /// Width and height in pixels, neither 0. Default 1280 by 720.
    pub resolution: [u32; 2],
    /// The part of it that is rendered.
    pub crop: CropDesc,
    /// From corner to corner of the film, in millimetres, behind the lenses of a realistic camera; positive. Default 35.
    pub diagonal: f64,
    /// The output file, as typed, if the scene names one.
    pub filename: Option<PathBuf>,
    /// Sensitivity; default 100; positive.
    pub iso: f64,
    /// How long the shutter is open: close - open of the view's camera, as in pbrt-v4; positive.
    pub exposure_time: f64,
    /// What light does to it.
    pub sensor: SensorDesc,
    /// The temperature, in kelvin, of the daylight that looks white; positive. `None` if the file does not say.
    pub white_balance: Option<f64>,
    /// The largest value of a sample, positive; infinite if the file does not say.
    pub max_component: f64,
    /// The colour space of the picture: the one in force at the `Film` directive.
    pub color_space: ColorSpace,
    /// What of radiance a pixel is.
    pub measure: MeasureDesc,
    /// What is kept of a pixel beside its colour.
    pub kind: FilmKind,
    /// The `Film` directive; the whole file's first byte if there is none.
    pub span: Span,
}

impl FilmDesc {
    /// Whether another film is the same, wherever it is described and however long the shutter of its camera is open.
    pub fn is_like(&self, other: &Self) -> bool {
        let placed = Self {
            span: self.span,
            exposure_time: self.exposure_time,
            ..other.clone()
        };
        *self == placed
    }

    /// What the sensor multiplies radiance by: `exposure_time * iso / 100`, as in pbrt-v4. It is 1 by default.
    pub fn imaging_ratio(&self) -> f64 {
        self.exposure_time * self.iso / 100.0
    }
}

/// What a film keeps of a pixel beside its colour.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum FilmKind {
    /// Nothing.
    #[default]
    Rgb,
    /// The surfaces that it sees first: positions and normals in this space, and more. See [`crate::film::GBUFFER_CHANNELS`].
    GBuffer(GBufferSpace),
    /// Radiance by wavelength.
    Spectral(SpectralBins),
}

/// The space of positions and normals in a G-buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GBufferSpace {
    /// That of the camera, which looks along +z.
    #[default]
    Camera,
    /// That of the scene.
    World,
}

/// Parts of equal width of a range of wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralBins {
    /// The shortest and the longest wavelength, in nm, within 360 to 830.
    pub range: [f32; 2],
    /// How many parts it has, at least 1.
    pub count: u32,
}

impl SpectralBins {
    /// The part that a wavelength, in nm, is in: the upper one at an edge. `None` outside of the range; its end belongs to the last.
    #[inline]
    pub fn index(&self, nm: f32) -> Option<usize> {
        let [start, end] = self.range;
        let part = (nm - start) / (end - start) * self.count as f32;
        (nm >= start && nm <= end).then(|| (part as usize).min(self.count as usize - 1))
    }

    /// The wavelength in the middle of a part, in nm.
    pub fn center(&self, index: u32) -> f64 {
        let [start, end] = self.range.map(f64::from);
        start + (f64::from(index) + 0.5) / f64::from(self.count) * (end - start)
    }
}

/// The spectral response of a film.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SensorDesc {
    /// The CIE 1931 observer.
    #[default]
    Cie1931,
    /// A camera of [`crate::spectrum::sensor_names`].
    Named(String),
    /// Wavelength in nm, responses of red, green and blue pixels (Lucerna's extension): by increasing wavelength, two rows at
    /// least; linear in between, zero outside.
    Curves(Vec<[f32; 4]>),
}

/// What a pixel measures (Lucerna's extension).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MeasureDesc {
    /// The mean of the radiance that it sees, weighted by the pixel filter: as in pbrt.
    #[default]
    Radiance,
    /// The integral of radiance times the cosine over the directions (or, of an orthographic camera, the area) that it sees. See
    /// [`crate::camera::Camera::importance`].
    Irradiance,
}

/// Which part of an image is rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CropDesc {
    /// All of it.
    Full,
    /// Pixels, whatever the resolution.
    Pixels(PixelRect),
    /// `[x0, x1, y0, y1]` as fractions of the resolution, in [0, 1], in order.
    Window([f32; 4]),
}

/// A rectangle of pixels: origin top left, `x1` and `y1` exclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelRect {
    /// First column.
    pub x0: u32,
    /// First row.
    pub y0: u32,
    /// One past the last column.
    pub x1: u32,
    /// One past the last row.
    pub y1: u32,
}

impl PixelRect {
    /// All pixels of a picture.
    pub fn full(resolution: [u32; 2]) -> Self {
        Self {
            x0: 0,
            y0: 0,
            x1: resolution[0],
            y1: resolution[1],
        }
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.x1 - self.x0
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.y1 - self.y0
    }

    /// Pixels.
    pub fn area(&self) -> u64 {
        u64::from(self.width()) * u64::from(self.height())
    }

    /// Whether it holds pixel (x, y).
    #[inline]
    pub fn contains(&self, x: u32, y: u32) -> bool {
        (self.x0..self.x1).contains(&x) && (self.y0..self.y1).contains(&y)
    }

    /// The pixels in both; `None` if there are none.
    pub fn intersection(&self, other: &Self) -> Option<Self> {
        let rect = Self {
            x0: self.x0.max(other.x0),
            y0: self.y0.max(other.y0),
            x1: self.x1.min(other.x1),
            y1: self.y1.min(other.y1),
        };
        (rect.x0 < rect.x1 && rect.y0 < rect.y1).then_some(rect)
    }
}

impl CropDesc {
    /// The pixels meant, clamped to the image; pbrt rounds both ends of a window up. Empty only if `resolution` is not the one of
    /// the file, for which the parser has checked it.
    pub fn pixels(&self, resolution: [u32; 2]) -> PixelRect {
        let [width, height] = resolution;
        match *self {
            Self::Full => PixelRect {
                x0: 0,
                y0: 0,
                x1: width,
                y1: height,
            },
            Self::Pixels(r) => PixelRect {
                x0: r.x0.min(width),
                y0: r.y0.min(height),
                x1: r.x1.min(width),
                y1: r.y1.min(height),
            },
            Self::Window([x0, x1, y0, y1]) => {
                let edge = |size: u32, fraction: f32| ((size as f32 * fraction).ceil() as u32).min(size);
                PixelRect {
                    x0: edge(width, x0),
                    y0: edge(height, y0),
                    x1: edge(width, x1),
                    y1: edge(height, y1),
                }
            }
        }
    }
}
