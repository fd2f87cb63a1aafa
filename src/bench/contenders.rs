//! What is compared: builds of both backends, and the ways to trace through each.

use std::sync::Arc;
use std::time::Instant;

use serde::Serialize;

use crate::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use crate::accel::embree::{Calls, EmbreeScene, Entry};
use crate::accel::{Accel, Backend, BuildOptions, BuildQuality};
use crate::error::Result;
use crate::geometry::World;

/// Who answers, in a report: the rows that are compared with each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Embree with its fast triangle test, which is not watertight.
    EmbreeFast,
    /// Embree in its robust mode.
    EmbreeRobust,
    /// Embree in its robust mode, in compact scenes.
    EmbreeCompact,
    /// Our own BVH.
    Bvh,
}

impl Family {
    /// All, in the order of reports.
    pub const ALL: [Self; 4] = [Self::EmbreeFast, Self::EmbreeRobust, Self::EmbreeCompact, Self::Bvh];

    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Self::EmbreeFast => "embree fast",
            Self::EmbreeRobust => "embree robust",
            Self::EmbreeCompact => "embree compact",
            Self::Bvh => "bvh",
        }
    }

    fn backend(self) -> Backend {
        match self {
            Self::EmbreeFast | Self::EmbreeRobust | Self::EmbreeCompact => Backend::Embree,
            Self::Bvh => Backend::Bvh,
        }
    }
}

/// A build to be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuildPlan {
    /// Whose.
    pub family: Family,
    /// How.
    pub quality: BuildQuality,
}

/// How much is compared.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Every way to trace with builds of every quality; else only with those of high quality, and with others what a render would do.
    pub all: bool,
    /// Only what has all of these words in its name.
    pub only: Vec<String>,
}

impl BuildPlan {
    /// All there are: of the highest quality first.
    pub fn all() -> Vec<Self> {
        let families = Family::ALL
            .into_iter()
            .filter(|family| Backend::AVAILABLE.contains(&family.backend()));
        // Compact scenes have no spatial splits: those of high quality are those of medium quality.
        let exists = |plan: &Self| plan.family != Family::EmbreeCompact || plan.quality != BuildQuality::High;
        let of_quality = |quality| {
            families
                .clone()
                .map(move |family| Self { family, quality })
                .filter(exists)
        };
        [BuildQuality::High, BuildQuality::Medium, BuildQuality::Low]
            .into_iter()
            .flat_map(of_quality)
            .collect()
    }

    /// For people.
    pub fn name(&self) -> String {
        format!("{} {}", self.family.name(), quality_name(self.quality))
    }

    /// The names of the ways to trace that are compared with this build, or none.
    fn wants(&self, choice: &Choice, way: &str) -> bool {
        let is_usual = way == USUAL;
        let name = format!("{}, {way}", self.name());
        (choice.all || is_usual || self.quality == BuildQuality::High)
            && choice.only.iter().all(|word| name.contains(word))
    }

    /// Whether anything is compared with this build.
    pub fn is_wanted(&self, choice: &Choice) -> bool {
        let ways = match self.family {
            #[cfg(feature = "embree")]
            Family::EmbreeFast | Family::EmbreeRobust | Family::EmbreeCompact => {
                embree_ways().into_iter().map(|way| way.0).collect()
            }
            #[cfg(not(feature = "embree"))]
            Family::EmbreeFast | Family::EmbreeRobust | Family::EmbreeCompact => Vec::new(),
            Family::Bvh => Bvh::variant_names(),
        };
        [USUAL.to_owned()]
            .iter()
            .chain(&ways)
            .any(|way| self.wants(choice, way))
    }

    /// Builds, on `threads` threads, and returns it with the seconds that took: the least of three times if they are short.
    ///
    /// # Errors
    /// Those of the backend.
    pub fn build(&self, world: &Arc<World>, choice: &Choice, threads: usize) -> Result<Built> {
        const SHORT: f64 = 0.5;
        let start = Instant::now();
        let mut built = self.build_once(world, choice, threads)?;
        for _ in 0..2 {
            if start.elapsed().as_secs_f64() > SHORT {
                break;
            }
            let seconds = built.seconds;
            built = self.build_once(world, choice, threads)?;
            built.seconds = built.seconds.min(seconds);
        }
        Ok(built)
    }

    fn build_once(&self, world: &Arc<World>, choice: &Choice, threads: usize) -> Result<Built> {
        let options = BuildOptions {
            quality: self.quality,
            robust: self.family != Family::EmbreeFast,
            compact: self.family == Family::EmbreeCompact,
            threads,
        };
        let start = Instant::now();
        let (usual, ways): (Box<dyn Accel>, Ways) = match self.family {
            #[cfg(feature = "embree")]
            Family::EmbreeFast | Family::EmbreeRobust | Family::EmbreeCompact => {
                let scene = EmbreeScene::build(world, &options)?;
                let way = |(name, calls)| (name, Box::new(scene.calling(calls)) as Box<dyn Accel>);
                let ways = embree_ways();
                let ways = ways.into_iter().filter(|(_, calls)| calls.return_from(world, &options));
                let ways = ways.map(way).collect();
                (Box::new(scene), ways)
            }
            #[cfg(not(feature = "embree"))]
            Family::EmbreeFast | Family::EmbreeRobust | Family::EmbreeCompact => {
                (crate::accel::build(Backend::Embree, world, &options)?, Vec::new())
            }
            Family::Bvh => {
                let bvh = Bvh::build(world, &options);
                let way = |(name, bvh)| (name, Box::new(bvh) as Box<dyn Accel>);
                let ways = bvh.variants().into_iter().map(way).collect();
                (Box::new(bvh), ways)
            }
        };
        let seconds = start.elapsed().as_secs_f64();
        let info = usual.info();
        let mut contenders = vec![(USUAL.to_owned(), usual)];
        contenders.extend(ways);
        contenders.retain(|(way, _)| self.wants(choice, way));
        Ok(Built {
            plan: *self,
            seconds,
            threads,
            version: info.version,
            bytes: info.memory,
            contenders,
        })
    }
}

/// The way that a render takes.
pub const USUAL: &str = "as renders do";

/// For people.
pub fn quality_name(quality: BuildQuality) -> &'static str {
    match quality {
        BuildQuality::Low => "low",
        BuildQuality::Medium => "medium",
        BuildQuality::High => "high",
    }
}

/// Ways to trace, by name.
pub type Ways = Vec<(String, Box<dyn Accel>)>;

/// A build, and the ways to trace through it.
pub struct Built {
    /// What was to be built.
    pub plan: BuildPlan,
    /// How long it took.
    pub seconds: f64,
    /// On so many threads.
    pub threads: usize,
    /// Of the backend.
    pub version: String,
    /// Of the structures.
    pub bytes: usize,
    /// Ways to trace, by name.
    pub contenders: Ways,
}

#[cfg(feature = "embree")]
fn embree_ways() -> Vec<(String, Calls)> {
    let mut ways = Vec::new();
    for &entry in Entry::AVAILABLE {
        let name = match entry {
            Entry::Single => "single",
            Entry::Packet4 => "4 wide",
            Entry::Packet8 => "8 wide",
            Entry::Packet16 => "16 wide",
            Entry::Stream => "stream",
        };
        for coherent in [false, true] {
            // The flag means nothing to a single ray.
            let name = match (entry, coherent) {
                (Entry::Single, true) => continue,
                (Entry::Single, false) => name.to_owned(),
                (_, true) => format!("{name} coherent"),
                (_, false) => format!("{name} incoherent"),
            };
            ways.push((name, Calls { entry, coherent }));
        }
    }
    ways
}
