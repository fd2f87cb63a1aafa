//! What of the rear lens the film sees light through: a rectangle for each part of the radius of the film, to draw points from.

use rayon::prelude::*;

use super::lens::Lens;
use super::stop::Stop;
use crate::math::{DVec2, DVec3, Vec2};

/// Parts of the film by distance from its middle, and points of each that are looked from.
const PARTS: usize = 64;
const POINTS: usize = 4;
/// Rays in each direction that look for the pupil.
const RAYS: usize = 48;

/// A rectangle of the plane of the rear lens, for a film point on +x.
#[derive(Clone, Copy, Debug)]
struct Rect {
    min: DVec2,
    max: DVec2,
}

/// By part of the film's radius; none where nothing comes through.
#[derive(Clone, Debug)]
pub(super) struct Pupil {
    parts: Vec<Option<Rect>>,
    film_radius: f64,
}

impl Rect {
    fn around(center: DVec2, half: f64) -> Self {
        Self {
            min: center - half,
            max: center + half,
        }
    }

    fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    fn grown(self, by: DVec2) -> Self {
        Self {
            min: self.min - by,
            max: self.max + by,
        }
    }
}

impl Pupil {
    /// `None` if nothing comes through at all.
    pub fn new(lens: &Lens, film_radius: f64) -> Option<Self> {
        let edge = |i: usize| i as f64 / PARTS as f64 * film_radius;
        let part = |i: usize| {
            let points = (0..=POINTS).map(|j| edge(i) + (edge(i + 1) - edge(i)) * j as f64 / POINTS as f64);
            points.filter_map(|x| seen_from(lens, x)).reduce(Rect::union)
        };
        let parts: Vec<Option<Rect>> = (0..PARTS).into_par_iter().map(part).collect();
        parts.iter().any(Option::is_some).then_some(Self { parts, film_radius })
    }

    /// A point of the rear lens's plane for a point of the film, and the area that it is drawn from. `None` where nothing comes through.
    pub fn sample(&self, film: DVec2, u: Vec2) -> Option<(DVec2, f64)> {
        let radius = film.length();
        let part = ((radius / self.film_radius * PARTS as f64) as usize).min(PARTS - 1);
        let rect = self.parts[part]?;
        let size = rect.max - rect.min;
        let p = rect.min + u.as_dvec2() * size;
        let turn = if radius > 0.0 { film / radius } else { DVec2::X };
        Some((turn.rotate(p), size.x * size.y))
    }
}

/// What comes through to the film point at `x` on its axis, in two rounds: the second one looks closer.
fn seen_from(lens: &Lens, x: f64) -> Option<Rect> {
    // The whole rear lens, and, as a small aperture may lie between the rays there, where it is seen near the axis.
    let whole = Rect::around(DVec2::ZERO, 1.05 * lens.rear_radius());
    let near_axis = lens.exit_pupil().map(|[distance, radius]| {
        let share = lens.rear_z() / distance;
        Rect::around(DVec2::new(x * (1.0 - share), 0.0), (2.0 * radius * share).abs())
    });
    let first = [Some(whole), near_axis].into_iter().flatten();
    let coarse = first.filter_map(|rect| passing(lens, x, rect)).reduce(Rect::union)?;
    Some(passing(lens, x, coarse).unwrap_or(coarse))
}

/// Around those points of a grid over `rect` that a ray from the film comes through, by a step of the grid.
fn passing(lens: &Lens, x: f64, rect: Rect) -> Option<Rect> {
    let film = DVec3::new(x, 0.0, 0.0);
    let step = (rect.max - rect.min) / RAYS as f64;
    let mut found: Option<Rect> = None;
    for i in 0..RAYS * RAYS {
        let cell = DVec2::new((i % RAYS) as f64, (i / RAYS) as f64) + 0.5;
        let p = rect.min + cell * step;
        let inside = |r: Rect| p.cmpge(r.min).all() && p.cmple(r.max).all();
        if !found.is_some_and(inside)
            && lens
                .trace_from_film(film, p.extend(lens.rear_z()) - film, &Stop::ROUND)
                .is_some()
        {
            let here = Rect { min: p, max: p };
            found = Some(found.map_or(here, |r| r.union(here)));
        }
    }
    found.map(|r| r.grown(step))
}
