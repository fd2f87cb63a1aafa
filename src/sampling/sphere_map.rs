//! Images of the sphere of directions.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::cells::Cell;
use super::warp::{equal_area_square_to_sphere, invert_equal_area_square_to_sphere};

/// How the pixels of an image cover the sphere. The pole is +z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SphereMap {
    /// Octahedral by equal areas, the form of pbrt-v4: square images, +z in the middle.
    EqualArea,
    /// Azimuth (from +x towards +y) to the right, angle from +z downwards (Lucerna's extension): images twice as wide as high.
    LatLong,
}

impl SphereMap {
    /// The one that an image of this size is in: equal-area if square, latitude and longitude if twice as wide as high.
    pub fn of_size(width: usize, height: usize) -> Option<Self> {
        if width == height {
            Some(Self::EqualArea)
        } else if width == 2 * height {
            Some(Self::LatLong)
        } else {
            None
        }
    }

    /// The direction of a point of a cell, uniform by solid angle within the cell.
    #[inline]
    pub fn direction(self, cell: &Cell, [width, height]: [usize; 2]) -> Vec3 {
        let x = (cell.x as f32 + cell.offset.x) / width as f32;
        match self {
            Self::EqualArea => {
                let y = (cell.y as f32 + cell.offset.y) / height as f32;
                equal_area_square_to_sphere(Vec2::new(x, y))
            }
            Self::LatLong => {
                let [top, bottom] = row_cosines(cell.y, height);
                let z = top + cell.offset.y * (bottom - top);
                let (sin, cos) = (TAU * x).sin_cos();
                let r = (1.0 - z * z).max(0.0).sqrt();
                Vec3::new(r * cos, r * sin, z)
            }
        }
    }

    /// The point of a cell that [`Self::direction`] maps to the unit vector `w`.
    #[inline]
    pub fn cell(self, w: Vec3, [width, height]: [usize; 2]) -> Cell {
        let split = |c: f32, count: usize| {
            let index = (c as usize).min(count - 1);
            (index, (c - index as f32).clamp(0.0, super::BELOW_ONE))
        };
        let p = self.point(w);
        let (x, offset_x) = split(p.x * width as f32, width);
        let (y, offset_y) = match self {
            Self::EqualArea => split(p.y * height as f32, height),
            Self::LatLong => {
                let (y, _) = split(p.y * height as f32, height);
                let [top, bottom] = row_cosines(y, height);
                let offset = (w.z - top) / (bottom - top);
                (y, offset.clamp(0.0, super::BELOW_ONE))
            }
        };
        Cell {
            x,
            y,
            offset: Vec2::new(offset_x, offset_y),
        }
    }

    /// The point of the unit square, from its upper left corner, that the unit vector `w` is drawn at.
    #[inline]
    pub fn point(self, w: Vec3) -> Vec2 {
        match self {
            Self::EqualArea => invert_equal_area_square_to_sphere(w),
            Self::LatLong => {
                let turn = w.y.atan2(w.x) / TAU;
                let turn = if turn < 0.0 { turn + 1.0 } else { turn };
                // The angle from +z, precise at both poles.
                Vec2::new(turn, w.truncate().length().atan2(w.z) / PI)
            }
        }
    }

    /// The solid angle of each cell of row `y`.
    #[inline]
    pub fn solid_angle(self, y: usize, [width, height]: [usize; 2]) -> f32 {
        match self {
            Self::EqualArea => 4.0 * PI / (width * height) as f32,
            Self::LatLong => {
                // cos a - cos b without cancellation near the poles.
                let (middle, half) = ((y as f32 + 0.5) * PI / height as f32, 0.5 * PI / height as f32);
                2.0 * middle.sin() * half.sin() * TAU / width as f32
            }
        }
    }

    /// The pixel that continues the image at (x, y), which may be one outside on any side.
    pub fn wrap(self, [x, y]: [i64; 2], [width, height]: [usize; 2]) -> [usize; 2] {
        let (w, h) = (width as i64, height as i64);
        let [x, y] = match self {
            Self::LatLong => [x.rem_euclid(w), y.clamp(0, h - 1)],
            Self::EqualArea => {
                // Across an edge of the square one comes back in at the mirrored place of the same edge.
                let [mut x, mut y] = [x, y];
                if x < 0 || x >= w {
                    x = if x < 0 { -1 - x } else { 2 * w - 1 - x };
                    y = h - 1 - y;
                }
                if y < 0 || y >= h {
                    y = if y < 0 { -1 - y } else { 2 * h - 1 - y };
                    x = w - 1 - x;
                }
                [x.clamp(0, w - 1), y.clamp(0, h - 1)]
            }
        };
        [x as usize, y as usize]
    }
}

/// Cosines of the angles from the pole at the upper and the lower edge of a row.
#[inline]
fn row_cosines(y: usize, height: usize) -> [f32; 2] {
    [y, y + 1].map(|edge| (edge as f32 * PI / height as f32).cos())
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAPS: [(SphereMap, [usize; 2]); 2] = [(SphereMap::EqualArea, [16, 16]), (SphereMap::LatLong, [32, 16])];

    #[test]
    fn cells_and_directions_are_inverses() {
        for (map, size) in MAPS {
            assert_eq!(SphereMap::of_size(size[0], size[1]), Some(map));
            let mut total = 0.0;
            for y in 0..size[1] {
                total += map.solid_angle(y, size) * size[0] as f32;
                for x in 0..size[0] {
                    for offset in [Vec2::new(0.01, 0.99), Vec2::new(0.5, 0.5), Vec2::new(0.9, 0.1)] {
                        let cell = Cell { x, y, offset };
                        let w = map.direction(&cell, size);
                        assert!((w.length() - 1.0).abs() < 1e-6);
                        let back = map.cell(w, size);
                        assert_eq!((back.x, back.y), (x, y), "{map:?} {offset}");
                        assert!(
                            (back.offset - offset).abs().max_element() < 5e-4,
                            "{map:?}: {back:?} {offset}"
                        );
                    }
                }
            }
            assert!((total / (4.0 * PI) - 1.0).abs() < 1e-6, "{map:?}: {total}");
        }
        assert_eq!(SphereMap::of_size(3, 2), None);
    }

    /// The solid angle of a cell, from the directions of its corners' neighbourhood: the mean direction of the whole sphere is 0,
    /// of the rows above the middle it is that of the hemisphere, (0, 0, 1/2).
    #[test]
    fn cells_are_uniform_by_solid_angle() {
        for (map, size) in MAPS {
            let (mut whole, mut squares) = (Vec3::ZERO, Vec3::ZERO);
            for y in 0..size[1] {
                for x in 0..size[0] {
                    for i in 0..64 {
                        let offset = (Vec2::new((i % 8) as f32, (i / 8) as f32) + 0.5) / 8.0;
                        let w = map.direction(&Cell { x, y, offset }, size);
                        let part = map.solid_angle(y, size) / 64.0 / (4.0 * PI);
                        whole += w * part;
                        squares += w * w * part;
                    }
                }
            }
            assert!(
                whole.length() < 1e-5 && (squares - 1.0 / 3.0).abs().max_element() < 1e-4,
                "{whole} {squares}"
            );
        }
    }

    #[test]
    fn known_directions() {
        let near = |p: Vec2, x: f32, y: f32| (p - Vec2::new(x, y)).length() < 1e-6;
        assert!(near(SphereMap::EqualArea.point(Vec3::Z), 0.5, 0.5));
        assert!(near(SphereMap::EqualArea.point(Vec3::X), 1.0, 0.5));
        assert!(near(SphereMap::EqualArea.point(-Vec3::Y), 0.5, 0.0));
        assert!(near(SphereMap::LatLong.point(Vec3::X), 0.0, 0.5));
        assert!(near(SphereMap::LatLong.point(Vec3::Y), 0.25, 0.5));
        assert!(SphereMap::LatLong.point(Vec3::Z).y < 1e-6);
    }

    /// A pixel outside is next to where it continues the image.
    #[test]
    fn images_go_on_beyond_their_edges() {
        for (map, size) in MAPS {
            let n = size.map(|s| s as i64);
            let center = |[x, y]: [usize; 2]| {
                let offset = Vec2::splat(0.5);
                map.direction(&Cell { x, y, offset }, size)
            };
            for i in 0..size[0] {
                let beside = i.min(size[1] - 1) as i64;
                let mut pairs = vec![([-1, beside], [0, beside]), ([n[0], beside], [n[0] - 1, beside])];
                if map == SphereMap::EqualArea {
                    let i = i as i64;
                    pairs.extend([([i, -1], [i, 0]), ([i, n[1]], [i, n[1] - 1])]);
                }
                for (outside, inside) in pairs {
                    let (a, b) = (map.wrap(outside, size), map.wrap(inside, size));
                    assert_eq!(b, inside.map(|c| c as usize));
                    assert!(center(a).dot(center(b)) > 0.85, "{map:?} {outside:?} {a:?}");
                }
            }
        }
    }
}
