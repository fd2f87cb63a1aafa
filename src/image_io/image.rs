//! The image that every reader gives and every writer takes.

use crate::{Error, Result};

/// A rectangle of pixels, half open: `x0 <= x < x1`, `y0 <= y < y1`, y downwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// The leftmost column inside.
    pub x0: i32,
    /// The topmost row inside.
    pub y0: i32,
    /// One past the rightmost column.
    pub x1: i32,
    /// One past the bottom row.
    pub y1: i32,
}

impl Window {
    /// The window from the origin to (`width`, `height`).
    pub fn of_size(width: i32, height: i32) -> Self {
        Self {
            x0: 0,
            y0: 0,
            x1: width,
            y1: height,
        }
    }

    /// Columns; 0 if the window is empty.
    pub fn width(&self) -> usize {
        usize::try_from(i64::from(self.x1) - i64::from(self.x0)).unwrap_or(0)
    }

    /// Rows; 0 if the window is empty.
    pub fn height(&self) -> usize {
        usize::try_from(i64::from(self.y1) - i64::from(self.y0)).unwrap_or(0)
    }

    /// Pixels inside.
    pub fn pixel_count(&self) -> usize {
        self.width().saturating_mul(self.height())
    }
}

/// Linear values of the pixels of a data window, and where that window lies in the whole picture.
///
/// Values are interleaved, row by row from the top: `data[(y * width + x) * channels + c]`, relative to the data window's corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    data_window: Window,
    display_window: Window,
    channels: Vec<String>,
    data: Vec<f32>,
    chromaticities: Option<Chromaticities>,
}

/// (x, y) of red, green, blue and white: what R, G and B of an image are.
pub type Chromaticities = [[f32; 2]; 4];

impl Image {
    /// An image of the pixels in `data_window`, which may be a part of `display_window` (a crop), or reach beyond it.
    ///
    /// # Errors
    /// [`Error::Usage`] if a window is empty, a channel's name is empty or given twice, or `data` does not hold one value for each
    /// pixel of the data window and channel.
    pub fn new(data_window: Window, display_window: Window, channels: Vec<String>, data: Vec<f32>) -> Result<Self> {
        if data_window.pixel_count() == 0 || display_window.pixel_count() == 0 {
            return Err(Error::Usage("an image needs at least one pixel".to_owned()));
        }
        for (i, name) in channels.iter().enumerate() {
            if name.is_empty() || channels[..i].contains(name) {
                return Err(Error::Usage(format!("channel name `{name}` is empty or given twice")));
            }
        }
        let expected = data_window.pixel_count().checked_mul(channels.len());
        if channels.is_empty() || expected != Some(data.len()) {
            return Err(Error::Usage(format!(
                "{} values do not fill {}x{} pixels of {} channels",
                data.len(),
                data_window.width(),
                data_window.height(),
                channels.len()
            )));
        }
        Ok(Self {
            data_window,
            display_window,
            channels,
            data,
            chromaticities: None,
        })
    }

    /// This image with what its file says of its colours.
    #[must_use]
    pub(super) fn with_chromaticities(self, chromaticities: Option<Chromaticities>) -> Self {
        Self { chromaticities, ..self }
    }

    /// An image with the channels R, G and B; see [`Image::new`].
    ///
    /// # Errors
    /// As [`Image::new`].
    pub fn rgb(data_window: Window, display_window: Window, data: Vec<f32>) -> Result<Self> {
        let channels = ["R", "G", "B"].map(str::to_owned).to_vec();
        Self::new(data_window, display_window, channels, data)
    }

    /// The pixels that the image holds.
    pub fn data_window(&self) -> Window {
        self.data_window
    }

    /// The whole picture.
    pub fn display_window(&self) -> Window {
        self.display_window
    }

    /// Columns of the data window.
    pub fn width(&self) -> usize {
        self.data_window.width()
    }

    /// Rows of the data window.
    pub fn height(&self) -> usize {
        self.data_window.height()
    }

    /// The channels' names, in the order of their values in a pixel.
    pub fn channels(&self) -> &[String] {
        &self.channels
    }

    /// What the colours are, if the image's file says so; else they are those of sRGB.
    pub fn chromaticities(&self) -> Option<Chromaticities> {
        self.chromaticities
    }

    /// All values; the layout is the type's.
    pub fn data(&self) -> &[f32] {
        &self.data
    }

    /// The values of the pixel in column `x` and row `y` of the data window, one for each channel.
    ///
    /// # Panics
    /// If the pixel is outside the data window.
    pub fn pixel(&self, x: usize, y: usize) -> &[f32] {
        assert!(x < self.width() && y < self.height(), "pixel ({x}, {y}) is outside");
        let start = (y * self.width() + x) * self.channels.len();
        &self.data[start..start + self.channels.len()]
    }

    /// The colour of every pixel, row by row: R, G, B, or Y three times; other channels are left out. `None` if the image has
    /// neither.
    pub fn to_rgb(&self) -> Option<Vec<[f32; 3]>> {
        let [r, g, b] = self.colour_channels()?;
        Some(
            self.data
                .chunks_exact(self.channels.len())
                .map(|pixel| [pixel[r], pixel[g], pixel[b]])
                .collect(),
        )
    }

    /// Which channels are red, green and blue; all three are Y in a grey image. `None` if the image has neither.
    pub fn colour_channels(&self) -> Option<[usize; 3]> {
        let find = |name: &str| self.channels.iter().position(|channel| channel == name);
        match (find("R"), find("G"), find("B"), find("Y")) {
            (Some(r), Some(g), Some(b), _) => Some([r, g, b]),
            (None, None, None, Some(y)) => Some([y; 3]),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_must_fill_the_window() {
        let window = Window::of_size(2, 2);
        assert!(Image::rgb(window, window, vec![0.0; 12]).is_ok());
        for wrong in [
            Image::rgb(window, window, vec![0.0; 11]),
            Image::rgb(Window::of_size(0, 2), window, vec![]),
            Image::rgb(window, Window::of_size(2, -1), vec![0.0; 12]),
            Image::new(window, window, vec![], vec![]),
            Image::new(window, window, vec!["Y".into(), "Y".into()], vec![0.0; 8]),
        ] {
            assert!(matches!(wrong, Err(Error::Usage(_))));
        }
    }

    #[test]
    fn extreme_windows_do_not_overflow() {
        let all = Window {
            x0: i32::MIN,
            y0: i32::MIN,
            x1: i32::MAX,
            y1: i32::MAX,
        };
        assert_eq!(all.width(), u32::MAX as usize);
        assert!(Image::rgb(all, all, vec![0.0; 3]).is_err());
    }

    #[test]
    fn colour_is_found_by_name() {
        let window = Window::of_size(1, 1);
        let names = |list: &[&str]| list.iter().map(ToString::to_string).collect();
        let abgr = Image::new(window, window, names(&["A", "B", "G", "R"]), vec![1.0, 2.0, 3.0, 4.0]).unwrap();
        assert_eq!(abgr.to_rgb(), Some(vec![[4.0, 3.0, 2.0]]));
        let grey = Image::new(window, window, names(&["Y"]), vec![0.5]).unwrap();
        assert_eq!(grey.to_rgb(), Some(vec![[0.5; 3]]));
        let depth = Image::new(window, window, names(&["Z"]), vec![0.5]).unwrap();
        assert_eq!(depth.to_rgb(), None);
    }
}
