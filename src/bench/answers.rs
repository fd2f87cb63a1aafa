//! What backends answer about a stream, and where they disagree.

use serde::Serialize;

use super::streams::Stream;
use crate::accel::judge::Judge;
use crate::accel::{Accel, RayKind};
use crate::geometry::{HitPacket, LANES, Ray};

/// Two distances that differ by no more than this, relatively, are one: of two surfaces there, either may be answered.
const SAME_DISTANCE: f32 = 1e-4;

/// Rays that are judged, at most, times primitives.
const MOST_JUDGED: u64 = 100_000_000;

/// What is answered about a ray: the distance and the ids of the nearest hit. Of a ray that is asked about occlusion only, the ids are
/// zeros and the distance is zero.
type Answer = Option<(f32, [u32; 3])>;

/// The answers about all active rays of a stream, in order.
pub struct Answers(Vec<Answer>);

/// How answers differ from those of another backend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// Rays that hit nothing, and the other says they do.
    pub missed: usize,
    /// Rays that hit something, and the other says they do not.
    pub extra: usize,
    /// Rays that hit something else, at another distance.
    pub other: usize,
    /// Of all these, those that a judge in double precision has looked at.
    pub judged: usize,
    /// Of which it says that the answer is wrong, however arithmetic rounds.
    pub wrong: usize,
}

impl Difference {
    /// Rays with another answer.
    pub fn count(&self) -> usize {
        self.missed + self.extra + self.other
    }
}

impl Answers {
    /// Asks `accel`, once.
    pub fn of(accel: &dyn Accel, stream: &Stream) -> Self {
        let kind = stream.kind.ray_kind();
        let mut answers = Vec::new();
        let mut hits = Vec::new();
        for wave in &stream.waves {
            let mut rays = wave.clone();
            hits.resize(wave.len(), HitPacket::EMPTY);
            match kind {
                RayKind::Shadow => accel.occluded(kind, &mut rays, None),
                RayKind::Camera | RayKind::Bounce => accel.intersect(kind, &rays, &mut hits, None),
            }
            for (place, packet) in wave.iter().enumerate() {
                for lane in (0..LANES).filter(|&lane| packet.is_active(lane)) {
                    let hit = &hits[place];
                    answers.push(match kind {
                        RayKind::Shadow => rays[place].is_occluded(lane).then_some((0.0, [0; 3])),
                        _ if !hit.is_hit(lane) => None,
                        _ => Some((
                            hit.t[lane],
                            [hit.geometry[lane], hit.primitive[lane], hit.instance[lane]],
                        )),
                    });
                }
            }
        }
        Self(answers)
    }

    /// Rays that hit something.
    pub fn hits(&self) -> usize {
        self.0.iter().flatten().count()
    }

    /// How these differ from `other`; the judge looks at as many of the rays as it has time for.
    pub fn compare(&self, other: &Self, stream: &Stream, judge: &Judge, primitives: u64) -> Difference {
        let mut difference = Difference::default();
        let most_judged = (MOST_JUDGED / primitives.max(1)) as usize;
        let rays = stream.waves.iter().flatten().flat_map(|packet| {
            let lanes = (0..LANES).filter(|&lane| packet.is_active(lane));
            lanes.map(|lane| packet.get(lane))
        });
        for ((mine, theirs), ray) in self.0.iter().zip(&other.0).zip(rays) {
            match (mine, theirs) {
                (None, None) => continue,
                (None, Some(_)) => difference.missed += 1,
                (Some(_), None) => difference.extra += 1,
                (Some((t, ids)), Some((u, other_ids))) => {
                    if ids == other_ids || (t - u).abs() <= SAME_DISTANCE * t.abs().max(u.abs()) {
                        continue;
                    }
                    difference.other += 1;
                }
            }
            if difference.judged < most_judged {
                difference.judged += 1;
                difference.wrong += usize::from(is_wrong(judge, &ray, *mine, stream.kind.ray_kind()));
            }
        }
        difference
    }
}

/// Whether a clear ray is answered otherwise than the judge says.
fn is_wrong(judge: &Judge, ray: &Ray, answer: Answer, kind: RayKind) -> bool {
    use crate::accel::judge::Verdict;
    match judge.judge(ray, |_| true) {
        Verdict::Ambiguous { .. } => false,
        Verdict::Clear(expected) => match (expected, answer) {
            (None, None) => false,
            (Some(_), Some(_)) if kind == RayKind::Shadow => false,
            (Some(hit), Some((_, ids))) => {
                let hit = hit.hit;
                let instance = hit.instance.map_or(HitPacket::NONE, |id| id.0);
                ids != [hit.geometry.0, hit.primitive.0, instance]
            }
            _ => true,
        },
    }
}
