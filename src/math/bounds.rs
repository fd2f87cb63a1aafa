//! Axis-aligned boxes.

use super::{DAffine3, DVec3, Vec3};

/// An axis-aligned box; empty where `min > max` on any axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds3 {
    /// The corner of least coordinates.
    pub min: Vec3,
    /// The corner of greatest coordinates.
    pub max: Vec3,
}

impl Bounds3 {
    /// The box that holds nothing: the neutral element of [`Bounds3::union`].
    pub const EMPTY: Self = Self {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    /// The smallest box around `points`.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::grow)
    }

    /// A box that holds all between two corners in double precision, rounded outward.
    pub fn around(min: DVec3, max: DVec3) -> Self {
        let outward = |v: DVec3, round: fn(f32) -> f32| Vec3::from_array(v.as_vec3().to_array().map(round));
        Self {
            min: outward(min, f32::next_down),
            max: outward(max, f32::next_up),
        }
    }

    /// The smallest box that holds this one and `point`.
    #[must_use]
    pub fn grow(self, point: Vec3) -> Self {
        Self {
            min: self.min.min(point),
            max: self.max.max(point),
        }
    }

    /// The smallest box that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// This box, larger by `margin` on each side.
    #[must_use]
    pub fn expand(self, margin: f32) -> Self {
        Self {
            min: self.min - margin,
            max: self.max + margin,
        }
    }

    /// Whether it holds no point.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Edge lengths; negative infinity when empty.
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// The middle.
    pub fn center(&self) -> Vec3 {
        0.5 * (self.min + self.max)
    }

    /// Half of the surface area, the measure of the surface area heuristic; 0 when empty.
    pub fn half_area(&self) -> f32 {
        if self.is_empty() {
            return 0.0;
        }
        let d = self.extent();
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// The eight corners.
    pub fn corners(&self) -> [Vec3; 8] {
        let (a, b) = (self.min, self.max);
        std::array::from_fn(|i| {
            Vec3::new(
                if i & 1 == 0 { a.x } else { b.x },
                if i & 2 == 0 { a.y } else { b.y },
                if i & 4 == 0 { a.z } else { b.z },
            )
        })
    }

    /// A box around this one after `transform`, rounded outward; empty stays empty.
    #[must_use]
    pub fn transformed(&self, transform: &DAffine3) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let corners = self
            .corners()
            .map(|corner| transform.transform_point3(corner.as_dvec3()));
        let boxes = corners.into_iter().map(|p| Self::around(p, p));
        boxes.fold(Self::EMPTY, Self::union)
    }

    /// Radius of the sphere around [`Bounds3::center`] that holds the box; 0 when empty.
    pub fn radius(&self) -> f32 {
        if self.is_empty() {
            0.0
        } else {
            0.5 * self.extent().length()
        }
    }
}
