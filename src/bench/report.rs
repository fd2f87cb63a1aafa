//! What was measured, as data: what `--json` writes and tables and plots are made from.

use serde::Serialize;

use super::answers::Difference;
use super::contenders::Family;
use super::machine::Machine;

/// Everything.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Where.
    pub machine: Machine,
    /// The command line.
    pub command: String,
    /// Of the random numbers of synthetic rays and of the recorded render.
    pub seed: u64,
    /// How often each wave was traced by each contender.
    pub turns: usize,
    /// The processors that the program was confined to, if any.
    pub pinned: Option<String>,
    /// World by world.
    pub cases: Vec<CaseReport>,
}

/// One world.
#[derive(Clone, Debug, Serialize)]
pub struct CaseReport {
    /// The scene file, or the kind and number of a synthetic world.
    pub name: String,
    /// The kind of a synthetic world.
    pub synthetic: Option<String>,
    /// Primitives, those of a group once.
    pub primitives: u64,
    /// Primitives with each instance of them counted.
    pub instanced_primitives: u64,
    /// Instances.
    pub instances: usize,
    /// Whether builds were made and measured one at a time, as they do not fit into half of the free memory together: rates of different
    /// builds are then not interleaved.
    pub one_at_a_time: bool,
    /// If so: the rates of the first build at the end over those at the start, the mean over its streams and ways to trace.
    pub drift: Option<f64>,
    /// Builds.
    pub builds: Vec<BuildReport>,
    /// Streams.
    pub streams: Vec<StreamReport>,
}

/// One build.
#[derive(Clone, Debug, Serialize)]
pub struct BuildReport {
    /// Whose.
    pub family: Family,
    /// `low`, `medium` or `high`.
    pub quality: &'static str,
    /// Of the backend.
    pub version: String,
    /// How long it took.
    pub seconds: f64,
    /// On so many threads.
    pub threads: usize,
    /// Bytes of its structures.
    pub bytes: usize,
    /// The same by primitive; those of a group count once.
    pub bytes_per_primitive: f64,
}

/// One stream of rays.
#[derive(Clone, Debug, Serialize)]
pub struct StreamReport {
    /// What the rays are for.
    pub kind: String,
    /// How many.
    pub rays: usize,
    /// In so many calls.
    pub waves: usize,
    /// Who traced them, how fast.
    pub results: Vec<RateReport>,
}

/// How fast one contender traced a stream, and what it answered.
#[derive(Clone, Debug, Serialize)]
pub struct RateReport {
    /// Index of the build.
    pub build: usize,
    /// Whose.
    pub family: Family,
    /// Of the build.
    pub quality: &'static str,
    /// The way to trace.
    pub way: String,
    /// Threads.
    pub threads: usize,
    /// Millions of rays a second: the median of turns.
    pub mrays: f64,
    /// The same by the upper quartile of turns' times.
    pub least: f64,
    /// By the lower quartile.
    pub most: f64,
    /// Rays that met something.
    pub hits: usize,
    /// How the answers differ from those of our BVH (of the first build of it, else of the first build).
    pub difference: Difference,
}

impl StreamReport {
    /// The fastest of a family on so many threads, of builds of a quality.
    pub fn best(&self, family: Family, quality: &str, threads: usize) -> Option<&RateReport> {
        self.results
            .iter()
            .filter(|r| r.family == family && r.threads == threads && r.quality == quality)
            .max_by(|a, b| a.mrays.total_cmp(&b.mrays))
    }

    /// The one that a render would be, on so many threads, of builds of a quality.
    pub fn usual(&self, family: Family, quality: &str, threads: usize) -> Option<&RateReport> {
        self.results.iter().find(|r| {
            r.family == family && r.threads == threads && r.quality == quality && r.way == super::contenders::USUAL
        })
    }
}

/// The geometric mean; `None` of nothing.
pub fn geometric_mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value.ln();
        count += 1.0;
    }
    (count > 0.0).then(|| f64::exp(sum / count))
}

impl Report {
    /// The kinds of streams there are, in the order of reports.
    pub fn kinds(&self) -> Vec<String> {
        let has = |kind: &String| {
            self.cases
                .iter()
                .flat_map(|case| &case.streams)
                .any(|stream| stream.kind == *kind)
        };
        super::streams::StreamKind::all()
            .map(|kind| kind.to_string())
            .filter(has)
            .collect()
    }

    /// Of a case and a kind of ray: our rate over that of a family, each by the fastest way, with builds of high quality on one thread
    /// (or as many as are measured at least).
    pub fn ratio(&self, case: &CaseReport, kind: &str, family: Family) -> Option<f64> {
        let stream = case.streams.iter().find(|stream| stream.kind == kind)?;
        let threads = stream.results.iter().map(|r| r.threads).min()?;
        let ours = stream.usual(Family::Bvh, "high", threads)?;
        Some(ours.mrays / stream.best(family, "high", threads)?.mrays)
    }
}
