//! A step function on the unit square, sampled within any rectangle of it: by a summed-area table, as in the portals of Bitterli,
//! Novák and Jarosz (2015).

use glam::Vec2;

use super::BELOW_ONE;

/// A density proportional to a step function within a window that each sample chooses.
#[derive(Clone, Debug)]
pub struct WindowedDistribution {
    width: usize,
    height: usize,
    values: Vec<f32>,
    /// The integral from the corner to each node, rows of width + 1, in units of cells.
    sums: Vec<f64>,
}

/// Corners of a rectangle of the unit square: least, greatest.
type Window = [Vec2; 2];

impl WindowedDistribution {
    /// For `values` of equal cells, row by row, `width` a row. `None` if there is no whole row, a value is negative or not
    /// finite, or all are 0.
    pub fn new(values: Vec<f32>, width: usize) -> Option<Self> {
        let valid = width > 0 && values.len().is_multiple_of(width) && values.iter().all(|v| *v >= 0.0);
        if !valid {
            return None;
        }
        let height = values.len() / width;
        let mut sums = vec![0.0; (width + 1) * (height + 1)];
        for y in 0..height {
            let mut row = 0.0;
            for x in 0..width {
                row += f64::from(values[y * width + x]);
                sums[(y + 1) * (width + 1) + x + 1] = sums[y * (width + 1) + x + 1] + row;
            }
        }
        let total = *sums.last()?;
        (total > 0.0 && total.is_finite()).then_some(Self {
            width,
            height,
            values,
            sums,
        })
    }

    /// The cell (column, row) that a point of the unit square is in.
    #[inline]
    pub fn cell(&self, p: Vec2) -> [usize; 2] {
        let index = |c: f32, count: usize| ((c * count as f32) as usize).min(count - 1);
        [index(p.x, self.width), index(p.y, self.height)]
    }

    /// The point of `window` that `u` in [0, 1)² draws, and its density by area of the square. `None` if the function is zero
    /// all over the window.
    pub fn sample(&self, u: Vec2, window: Window) -> Option<(Vec2, f32)> {
        let [low, high] = self.in_cells(window);
        let total = self.integral(low, high);
        if total <= 0.0 {
            return None;
        }
        let x = search([low[0], high[0]], f64::from(u.x) * total, |x| {
            self.integral(low, [x, high[1]])
        });
        // Below each other in one column the function has the same width.
        let column = (x as usize).min(self.width - 1) as f64;
        let [left, right] = [column, column + 1.0];
        let of_column = self.integral([left, low[1]], [right, high[1]]);
        if of_column <= 0.0 {
            return None;
        }
        let y = search([low[1], high[1]], f64::from(u.y) * of_column, |y| {
            self.integral([left, low[1]], [right, y])
        });
        let row = (y as usize).min(self.height - 1);
        let value = f64::from(self.values[row * self.width + column as usize]);
        let density = value / total * (self.width * self.height) as f64;
        let unit = |c: f64, count: usize| ((c / count as f64) as f32).min(BELOW_ONE);
        (density > 0.0).then(|| (Vec2::new(unit(x, self.width), unit(y, self.height)), density as f32))
    }

    /// The density of [`Self::sample`] at `p`; 0 outside the window.
    pub fn pdf(&self, p: Vec2, window: Window) -> f32 {
        let [low, high] = self.in_cells(window);
        let total = self.integral(low, high);
        let inside = p.cmpge(window[0]).all() && p.cmple(window[1]).all();
        if total <= 0.0 || !inside {
            return 0.0;
        }
        let [x, y] = self.cell(p);
        (f64::from(self.values[y * self.width + x]) / total * (self.width * self.height) as f64) as f32
    }

    fn in_cells(&self, window: Window) -> [[f64; 2]; 2] {
        window.map(|p| {
            let p = p.clamp(Vec2::ZERO, Vec2::ONE);
            [f64::from(p.x) * self.width as f64, f64::from(p.y) * self.height as f64]
        })
    }

    /// The integral over a rectangle, in units of cells.
    fn integral(&self, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> f64 {
        (self.up_to(x1, y1) - self.up_to(x0, y1)) - (self.up_to(x1, y0) - self.up_to(x0, y0))
    }

    /// The integral from the corner: linear along each axis inside a cell.
    fn up_to(&self, x: f64, y: f64) -> f64 {
        let (i, j) = ((x as usize).min(self.width - 1), (y as usize).min(self.height - 1));
        let (fx, fy) = (x - i as f64, y - j as f64);
        let at = |i: usize, j: usize| self.sums[j * (self.width + 1) + i];
        let row = |j: usize| at(i, j) + fx * (at(i + 1, j) - at(i, j));
        row(j) + fy * (row(j + 1) - row(j))
    }
}

/// Where in [low, high] the increasing function `up_to`, linear between integers, reaches `goal`.
fn search([low, high]: [f64; 2], goal: f64, up_to: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (low, high);
    let (mut below, mut above) = (up_to(low), up_to(high));
    while high.ceil() - low.floor() > 1.0 {
        let middle = (0.5 * (low + high)).floor();
        let middle = if middle <= low { low.floor() + 1.0 } else { middle };
        if middle >= high {
            break;
        }
        let at_middle = up_to(middle);
        if at_middle <= goal {
            (low, below) = (middle, at_middle);
        } else {
            (high, above) = (middle, at_middle);
        }
    }
    if above > below {
        (low + (high - low) * ((goal - below) / (above - below)).clamp(0.0, 1.0)).min(high)
    } else {
        low
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_drawn_in_windows_by_density() {
        let values = [0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 4.0, 0.0, 1.0, 0.5, 0.0, 0.0];
        let function = WindowedDistribution::new(values.to_vec(), 3).expect("valid");
        let value = |p: Vec2| f64::from(values[(p.y * 4.0) as usize * 3 + (p.x * 3.0) as usize]);
        for window in [
            [Vec2::ZERO, Vec2::ONE],
            [Vec2::new(0.4, 0.1), Vec2::new(0.9, 0.9)],
            [Vec2::new(0.05, 0.51), Vec2::new(0.3, 0.7)],
        ] {
            const N: usize = 300;
            let size = window[1] - window[0];
            // The integral and the first moments by the midpoint rule, against the means of the samples.
            let (mut integral, mut moment, mut mean, mut mean_inverse) = (0.0, [0.0; 2], [0.0; 2], 0.0);
            for i in 0..N * N {
                let u = Vec2::new((i % N) as f32 + 0.5, (i / N) as f32 + 0.5) / N as f32;
                let p = window[0] + u * size;
                integral += value(p);
                moment = [0, 1].map(|k| moment[k] + value(p) * f64::from(p[k]));
                let (q, pdf) = function.sample(u, window).expect("not zero there");
                assert!(q.cmpge(window[0] - 1e-6).all() && q.cmple(window[1] + 1e-6).all());
                assert!((function.pdf(q, window) / pdf - 1.0).abs() < 1e-5, "{q}");
                mean = [0, 1].map(|k| mean[k] + f64::from(q[k]) / (N * N) as f64);
                mean_inverse += 1.0 / f64::from(pdf) / (N * N) as f64;
            }
            for k in 0..2 {
                let expected = moment[k] / integral;
                assert!(
                    (mean[k] - expected).abs() < 5e-3,
                    "{window:?}: {} and {expected}",
                    mean[k]
                );
            }
            // The mean of 1 / pdf is the area where the function is not zero.
            let positive = (0..N * N).filter(|i| {
                let u = Vec2::new((i % N) as f32 + 0.5, (i / N) as f32 + 0.5) / N as f32;
                value(window[0] + u * size) > 0.0
            });
            let area = positive.count() as f64 / (N * N) as f64 * f64::from(size.x * size.y);
            assert!((mean_inverse / area - 1.0).abs() < 0.02, "{mean_inverse} and {area}");
        }
        let black = [Vec2::new(0.1, 0.3), Vec2::new(0.9, 0.45)];
        assert_eq!(function.sample(Vec2::splat(0.5), black), None);
        assert_eq!(function.pdf(Vec2::splat(0.4), black), 0.0);
    }
}
