//! Weights of all strategies (s, t) that could have made a path, without walking along it.
//!
//! A path x_0 ... x_k (x_0 on a light, x_k on the lens) can be made in k + 1 ways: its first s vertices by a light subpath, the other
//! t by a camera subpath. Let →p_i be the density by area with which a light subpath makes x_i from x_{i-1}, and ←p_i that with which
//! a camera subpath makes it from x_{i+1}. Strategy s has the density →p_0 ... →p_{s-1} ←p_s ... ←p_k; n_s samples of it are drawn.
//! Multiple importance sampling (Veach 1997, 9.2) weighs what it finds by (n_s p_s)^β over the sum of all (n_i p_i)^β, with β = 1 for
//! the balance and β = 2 for the power heuristic. With r(x) = x^β this is
//!
//! ```text
//! 1 / (w_light + 1 + w_camera),   w_light  = Σ_{i<s} r(p_i / p_s),   w_camera = Σ_{i>s} r(p_i / p_s).
//! ```
//!
//! Neighbouring strategies differ in one vertex, p_{i} / p_{i+1} = ←p_i / →p_i, so that both sums nest:
//!
//! ```text
//! w_light = r(←p_{s-1}/→p_{s-1}) (1 + r(←p_{s-2}/→p_{s-2}) (1 + ...))                                                      (1)
//! ```
//!
//! and the same from the other end. Seen from the last vertex y of a subpath, with z the vertex it is connected to, only two factors
//! depend on z: ←p(y), and, as a BSDF's density depends on where one comes from, ←p of the vertex before y. What is left is known when
//! y is made, is kept there, and grows from vertex to vertex (van Antwerpen 2011; Georgiev 2012, "Implementing Vertex Connection and
//! Merging", whose names these are):
//!
//! ```text
//! w = r(←p(y)) (vcm + r(←p_ω(y → before y)) vc)                                                                             (2)
//! vcm = r(1 / →p(y))                                  the strategy that is connected one vertex earlier, over that part of (1)
//! vc  = r(g / →p(y)) (vcm' + r(←p_ω') vc')            all before, from the values at the vertex before y                    (3)
//! ```
//!
//! where p_ω is by solid angle, g = |cos| / d² takes it to the area of the vertex before y, and →p(y) = →p_ω |cos_y| / d². So
//!
//! ```text
//! scatter from a vertex into w:    vc ← r(|cos_w| / →p_ω) (vcm + r(←p_ω) vc),   vcm ← r(1 / →p_ω)                           (4)
//! arrive at the next one:          vcm ← vcm r(d² / |cos|),   vc ← vc / r(|cos|)                                            (5)
//! ```
//!
//! A vertex that scatters by a delta lobe cannot be connected: its vcm is 0, →p_ω and ←p_ω are the same probability and cancel:
//!
//! ```text
//! vc ← r(|cos_w|) vc,   vcm ← 0                                                                                             (6)
//! ```
//!
//! Cosines of densities are those to geometric normals. What russian roulette does is left out of all densities alike: the weights of
//! a path still add up to one.

use crate::desc::Heuristic;

/// What a vertex of a subpath keeps of the strategies that are connected before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Partial {
    pub vcm: f64,
    pub vc: f64,
}

/// How the first vertex of a light subpath on a surface came about.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightStart {
    /// Density of the point of the light, as light samples from the surface choose it (s = 1), by solid angle there, times
    /// |cos| at the light. Where the position is a delta function: its probability times d². Of an infinite light: by solid angle; of a
    /// distant one the probability. 0 of a light that light samples do not find.
    pub direct: f64,
    /// Density with which the light subpath has the ray: that of the light, of the position and of the direction, without delta
    /// functions.
    pub emission: f64,
    /// |cos| at the light; 1 if it has no surface.
    pub cos_light: f64,
    /// Whether no camera subpath meets the light (s = 0).
    pub is_delta: bool,
}

/// r(x).
#[derive(Clone, Copy, Debug)]
pub(super) struct Exponent(pub Heuristic);

impl Exponent {
    #[inline]
    pub fn of(self, x: f64) -> f64 {
        match self.0 {
            Heuristic::Balance => x,
            Heuristic::Power => x * x,
        }
    }

    /// The weight of a strategy, given both sums.
    #[inline]
    pub fn weight(w_light: f64, w_camera: f64) -> f64 {
        1.0 / (w_light + 1.0 + w_camera)
    }

    /// At the first surface of a camera subpath. The strategy before it is the connection of that vertex to the lens (t = 1), whose
    /// point is chosen in the same way in both, and of which there are `light_paths` for each sample of a pixel; no light subpath
    /// finds the lens (t = 0). `arrival` is the density by area of the vertex, were it to face the ray.
    #[inline]
    pub fn camera_start(self, light_paths: f64, arrival: f64, cos: f64) -> Partial {
        Partial {
            vcm: self.of(light_paths / (arrival * cos)),
            vc: 0.0,
        }
    }

    /// At the first surface of a light subpath. With →p(y) = →p_ω |cos| / d², (3) has g = |cos_light| / d²; strategy s = 1 chooses the
    /// point of the light by another density than s > 1, which goes into vcm: direct / (emission |cos|). Distances cancel, which is why
    /// the same holds for infinite lights, where →p(y) = p_disk |cos|.
    #[inline]
    pub fn light_start(self, start: &LightStart, cos: f64) -> Partial {
        Partial {
            vcm: self.of(start.direct / (start.emission * cos)),
            vc: if start.is_delta {
                0.0
            } else {
                self.of(start.cos_light / (start.emission * cos))
            },
        }
    }

    /// (4), for densities `forward` of the direction that was drawn and `reverse` of the way back.
    #[inline]
    pub fn scatter(self, at: Partial, forward: f64, reverse: f64, cos: f64) -> Partial {
        Partial {
            vcm: self.of(1.0 / forward),
            vc: self.of(cos / forward) * (at.vcm + self.of(reverse) * at.vc),
        }
    }

    /// (6).
    #[inline]
    pub fn scatter_delta(self, at: Partial, cos: f64) -> Partial {
        Partial {
            vcm: 0.0,
            vc: self.of(cos) * at.vc,
        }
    }

    /// (5).
    #[inline]
    pub fn arrive(self, on_the_way: Partial, distance_squared: f64, cos: f64) -> Partial {
        Partial {
            vcm: on_the_way.vcm * self.of(distance_squared / cos),
            vc: on_the_way.vc / self.of(cos),
        }
    }

    /// (2), where the connection makes the vertex with the density `density` by area, and the one before it with `reverse` by solid
    /// angle.
    #[inline]
    pub fn sum(self, at: Partial, density: f64, reverse: f64) -> f64 {
        self.of(density) * (at.vcm + self.of(reverse) * at.vc)
    }
}
