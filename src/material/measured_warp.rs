//! Tables over the unit square that depend on further parameters: interpolated, and as densities to sample from.
//!
//! Values are bilinear over the square and linear in the parameters; so are the integrals of densities, so that what is sampled
//! is exactly the interpolated density.

use crate::math::Vec2;

/// The greatest number of parameters.
const MOST: usize = 3;

/// A grid over the square for each combination of parameters.
#[derive(Clone, Debug)]
pub(super) struct Table {
    columns: usize,
    rows: usize,
    parameters: Vec<Vec<f32>>,
    values: Vec<f32>,
}

/// [`Table`] scaled to densities, with their integrals along rows and over rows.
#[derive(Clone, Debug)]
pub(super) struct DensityTable {
    table: Table,
    /// By row, from the left: as many as values.
    along: Vec<f32>,
    /// Over rows, from below.
    over: Vec<f32>,
}

/// The slices that an interpolation is the mean of, and their weights.
#[derive(Clone, Copy)]
pub(super) struct Slices {
    parts: [(usize, f32); 1 << MOST],
    count: usize,
}

impl Slices {
    fn sum(&self, f: impl Fn(usize) -> f32) -> f32 {
        self.parts[..self.count]
            .iter()
            .map(|&(slice, weight)| weight * f(slice))
            .sum()
    }
}

impl Table {
    /// Grids of `rows` by `columns` (at least 2 each) for the values of up to three parameters, the last of which runs fastest.
    pub fn new([rows, columns]: [usize; 2], parameters: Vec<Vec<f32>>, values: Vec<f32>) -> Self {
        Self {
            columns,
            rows,
            parameters,
            values,
        }
    }

    fn area(&self) -> usize {
        self.rows * self.columns
    }

    /// The slices for parameters; beyond the ends the end holds.
    pub fn slices(&self, at: &[f32]) -> Slices {
        let mut slices = Slices {
            parts: [(0, 1.0); 1 << MOST],
            count: 1,
        };
        for (grid, &value) in self.parameters.iter().zip(at) {
            let after = grid.partition_point(|&g| g <= value).clamp(1, (grid.len() - 1).max(1));
            let (low, t) = if grid.len() == 1 {
                (0, 0.0)
            } else {
                let (a, b) = (grid[after - 1], grid[after]);
                (after - 1, ((value - a) / (b - a)).clamp(0.0, 1.0))
            };
            let count = slices.count;
            for i in 0..count {
                let (slice, weight) = slices.parts[i];
                let base = slice * grid.len() + low;
                slices.parts[i] = (base, weight * (1.0 - t));
                if t > 0.0 {
                    slices.parts[slices.count] = (base + 1, weight * t);
                    slices.count += 1;
                }
            }
        }
        slices
    }

    /// The cell of a point and the place in it.
    fn cell(&self, p: Vec2) -> (usize, usize, f32, f32) {
        let x = p.x.clamp(0.0, 1.0) * (self.columns - 1) as f32;
        let y = p.y.clamp(0.0, 1.0) * (self.rows - 1) as f32;
        let (i, j) = ((x as usize).min(self.columns - 2), (y as usize).min(self.rows - 2));
        (i, j, x - i as f32, y - j as f32)
    }

    fn value(&self, slices: &Slices, row: usize, column: usize) -> f32 {
        slices.sum(|slice| self.values[slice * self.area() + row * self.columns + column])
    }

    /// The interpolated value at a point of the square.
    pub fn at(&self, slices: &Slices, p: Vec2) -> f32 {
        let (i, j, s, t) = self.cell(p);
        let along = |row| lerp(self.value(slices, row, i), self.value(slices, row, i + 1), s);
        lerp(along(j), along(j + 1), t)
    }
}

impl DensityTable {
    /// Densities proportional to the values of each slice, none of which is negative; a slice of zeros is uniform.
    pub fn new(mut table: Table) -> Self {
        let (rows, columns) = (table.rows, table.columns);
        let cell = 1.0 / ((rows - 1) * (columns - 1)) as f64;
        let (mut along, mut over) = (Vec::new(), Vec::new());
        for slice in table.values.chunks_exact_mut(rows * columns) {
            let (row_sums, row_integrals) = integrals(slice, columns);
            let whole = row_integrals[rows - 1] * cell;
            let scale = if whole > 0.0 { 1.0 / whole } else { 0.0 };
            if whole > 0.0 {
                slice.iter_mut().for_each(|v| *v = (f64::from(*v) * scale) as f32);
                along.extend(row_sums.iter().map(|v| (v * scale) as f32));
                over.extend(row_integrals.iter().map(|v| (v * scale) as f32));
            } else {
                slice.fill(1.0);
                let (row_sums, row_integrals) = integrals(slice, columns);
                along.extend(row_sums.iter().map(|&v| v as f32));
                over.extend(row_integrals.iter().map(|&v| v as f32));
            }
        }
        Self { table, along, over }
    }

    /// The slices for parameters.
    pub fn slices(&self, at: &[f32]) -> Slices {
        self.table.slices(at)
    }

    /// The density at a point, by area of the square.
    pub fn pdf(&self, slices: &Slices, p: Vec2) -> f32 {
        self.table.at(slices, p)
    }

    fn along(&self, slices: &Slices, row: usize, column: usize) -> f32 {
        slices.sum(|slice| self.along[slice * self.table.area() + row * self.table.columns + column])
    }

    fn over(&self, slices: &Slices, row: usize) -> f32 {
        slices.sum(|slice| self.over[slice * self.table.rows + row])
    }

    /// Maps uniform numbers to a point with this density.
    pub fn sample(&self, slices: &Slices, u: Vec2) -> Vec2 {
        let (rows, columns) = (self.table.rows, self.table.columns);
        let y = u.y * self.over(slices, rows - 1);
        let row = last_below(rows - 1, |row| self.over(slices, row), y);
        let ends = [row, row + 1].map(|row| self.along(slices, row, columns - 1));
        let t = invert_linear(y - self.over(slices, row), ends[0], ends[1]);
        let sum = |column| lerp(self.along(slices, row, column), self.along(slices, row + 1, column), t);
        let value = |column| {
            lerp(
                self.table.value(slices, row, column),
                self.table.value(slices, row + 1, column),
                t,
            )
        };
        let x = u.x * sum(columns - 1);
        let column = last_below(columns - 1, sum, x);
        let s = invert_linear(x - sum(column), value(column), value(column + 1));
        Vec2::new(
            (column as f32 + s) / (columns - 1) as f32,
            (row as f32 + t) / (rows - 1) as f32,
        )
    }

    /// The numbers that [`DensityTable::sample`] maps to a point.
    pub fn invert(&self, slices: &Slices, p: Vec2) -> Vec2 {
        let (rows, columns) = (self.table.rows, self.table.columns);
        let (i, j, s, t) = self.table.cell(p);
        let part = |a: f32, b: f32, x: f32| x * (a + 0.5 * x * (b - a));
        let ends = [j, j + 1].map(|row| self.along(slices, row, columns - 1));
        let y = self.over(slices, j) + part(ends[0], ends[1], t);
        let sum = |column| lerp(self.along(slices, j, column), self.along(slices, j + 1, column), t);
        let value = |column| {
            lerp(
                self.table.value(slices, j, column),
                self.table.value(slices, j + 1, column),
                t,
            )
        };
        let x = sum(i) + part(value(i), value(i + 1), s);
        let unit = |part: f32, whole: f32| {
            if whole > 0.0 {
                (part / whole).clamp(0.0, 1.0)
            } else {
                0.0
            }
        };
        Vec2::new(unit(x, sum(columns - 1)), unit(y, self.over(slices, rows - 1)))
    }
}

/// By the trapezoidal rule: the integral of each row up to each column, and that of all rows up to each row, in units of cells.
fn integrals(slice: &[f32], columns: usize) -> (Vec<f64>, Vec<f64>) {
    let mut along = Vec::with_capacity(slice.len());
    for row in slice.chunks_exact(columns) {
        let mut sum = 0.0;
        along.push(sum);
        for pair in row.windows(2) {
            sum += 0.5 * (f64::from(pair[0]) + f64::from(pair[1]));
            along.push(sum);
        }
    }
    let mut over = vec![0.0];
    let ends: Vec<f64> = along.chunks_exact(columns).map(|row| row[columns - 1]).collect();
    for pair in ends.windows(2) {
        over.push(over[over.len() - 1] + 0.5 * (pair[0] + pair[1]));
    }
    (along, over)
}

/// The last index below `count` at which an increasing function is not above `x`.
fn last_below(count: usize, f: impl Fn(usize) -> f32, x: f32) -> usize {
    let (mut low, mut high) = (0, count);
    while high - low > 1 {
        let middle = usize::midpoint(low, high);
        if f(middle) <= x { low = middle } else { high = middle }
    }
    low
}

/// Where the integral of the line from `a` at 0 to `b` at 1 reaches `s`.
fn invert_linear(s: f32, a: f32, b: f32) -> f32 {
    let root = (a * a + 2.0 * s * (b - a)).max(0.0).sqrt();
    let denominator = a + root;
    if denominator > 0.0 {
        (2.0 * s / denominator).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a * (1.0 - t) + b * t
}
