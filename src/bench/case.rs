//! One world: its builds, and its streams through each of them.

use std::sync::Arc;

use super::answers::Answers;
use super::contenders::{BuildPlan, Built, Choice, Family, USUAL, quality_name};
use super::rates::{self, Rate};
use super::report::{BuildReport, CaseReport, RateReport, StreamReport};
use super::streams::Stream;
use super::synthetic::Recipe;
use crate::accel::Accel;
use crate::accel::judge::Judge;
use crate::error::{Error, Result};
use crate::geometry::World;

/// A world and its rays.
pub struct Case {
    /// For people.
    pub name: String,
    /// What it was made from, if it is synthetic.
    pub recipe: Option<Recipe>,
    /// What rays can hit.
    pub world: Arc<World>,
    /// The rays.
    pub streams: Vec<Stream>,
}

/// How to measure.
#[derive(Clone, Debug)]
pub struct Settings {
    /// How often each wave is traced by each contender.
    pub turns: usize,
    /// Numbers of threads. On the first all contenders are measured, on others those that trace as renders do.
    pub threads: Vec<usize>,
    /// What is compared.
    pub choice: Choice,
    /// Bytes that can be had; `None` if that is not known.
    pub memory: Option<u64>,
}

/// Bytes of a build by primitive, to see whether several fit: what the largest have, with what they need while they are made.
const BYTES_PER_PRIMITIVE: u64 = 250;
/// The same by instance.
const BYTES_PER_INSTANCE: u64 = 600;

/// Measures a case, telling `hear` what is being done.
///
/// # Errors
/// Those of backends, and [`Error::Usage`] if nothing is to be compared.
pub fn run(case: &Case, settings: &Settings, hear: &dyn Fn(&str)) -> Result<CaseReport> {
    let world = &case.world;
    let primitives: u64 = world.geometries().iter().map(|g| g.primitive_count() as u64).sum();
    let mut plans = BuildPlan::all();
    plans.retain(|plan| plan.is_wanted(&settings.choice));
    let bytes = primitives * BYTES_PER_PRIMITIVE + world.instances().len() as u64 * BYTES_PER_INSTANCE;
    let all_bytes = bytes * plans.len() as u64;
    let one_at_a_time = settings.memory.is_some_and(|free| all_bytes > free / 2) && plans.len() > 1;
    let mut measuring = Measuring {
        case,
        settings,
        hear,
        primitives,
        judge: Judge::new(world),
        references: Vec::new(),
        report: CaseReport {
            name: case.name.clone(),
            synthetic: case.recipe.map(|recipe| recipe.kind.to_string()),
            primitives,
            instanced_primitives: world.instanced_primitive_count(),
            instances: world.instances().len(),
            one_at_a_time,
            drift: None,
            builds: Vec::new(),
            streams: Vec::new(),
        },
    };
    measuring.report.streams = case.streams.iter().map(stream_report).collect();
    // Answers are compared with those of our own BVH, so it goes first.
    if let Some(ours) = plans.iter().position(|plan| plan.family == Family::Bvh) {
        plans[..=ours].rotate_right(1);
    }
    if plans.is_empty() {
        return Err(Error::Usage(
            "nothing to compare: no way to trace has all of these words in its name".into(),
        ));
    }
    if one_at_a_time {
        measuring.one_at_a_time(&plans)?;
    } else {
        let built = plans
            .iter()
            .map(|plan| measuring.build(plan))
            .collect::<Result<Vec<_>>>()?;
        measuring.measure(&built, 0)?;
    }
    Ok(measuring.report)
}

fn stream_report(stream: &Stream) -> StreamReport {
    StreamReport {
        kind: stream.kind.to_string(),
        rays: stream.rays(),
        waves: stream.waves.len(),
        results: Vec::new(),
    }
}

struct Measuring<'a> {
    case: &'a Case,
    settings: &'a Settings,
    hear: &'a dyn Fn(&str),
    primitives: u64,
    judge: Judge,
    /// By stream, what the first contender answered.
    references: Vec<Answers>,
    report: CaseReport,
}

/// A pool of threads of its own.
fn pool(threads: usize) -> Result<rayon::ThreadPool> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| Error::Usage(format!("cannot start {threads} threads: {error}")))
}

impl Measuring<'_> {
    fn build(&mut self, plan: &BuildPlan) -> Result<Built> {
        let threads = self.settings.threads.iter().copied().max().unwrap_or(1);
        (self.hear)(&format!("{}: building {}", self.case.name, plan.name()));
        let built = pool(threads)?.install(|| plan.build(&self.case.world, &self.settings.choice, threads))?;
        self.report.builds.push(BuildReport {
            family: plan.family,
            quality: quality_name(plan.quality),
            version: built.version.clone(),
            seconds: built.seconds,
            threads,
            bytes: built.bytes,
            bytes_per_primitive: built.bytes as f64 / self.primitives.max(1) as f64,
        });
        Ok(built)
    }

    /// Builds, measures and forgets, and at the end does the first once more.
    fn one_at_a_time(&mut self, plans: &[BuildPlan]) -> Result<()> {
        for (index, plan) in plans.iter().enumerate() {
            let built = [self.build(plan)?];
            self.measure(&built, index)?;
        }
        if let Some(first) = plans.first() {
            let built = self.build(first)?;
            self.report.builds.pop();
            self.report.drift = self.drift(&built)?;
        }
        Ok(())
    }

    /// The rates of the first build now over what they were.
    fn drift(&self, built: &Built) -> Result<Option<f64>> {
        let threads = self.settings.threads[0];
        let accels: Vec<&dyn Accel> = built.contenders.iter().map(|(_, accel)| &**accel).collect();
        let mut ratios = Vec::new();
        for (stream, report) in self.case.streams.iter().zip(&self.report.streams) {
            let rates = pool(threads)?.install(|| rates::measure(&accels, stream, self.settings.turns));
            let before = report
                .results
                .iter()
                .filter(|result| result.build == 0 && result.threads == threads);
            ratios.extend(before.zip(&rates).map(|(before, now)| now.median / before.mrays));
        }
        Ok(super::report::geometric_mean(ratios.into_iter()))
    }

    /// Measures all streams through builds, the first of which has an index.
    fn measure(&mut self, built: &[Built], first: usize) -> Result<()> {
        for (place, stream) in self.case.streams.iter().enumerate() {
            let name = self.report.streams[place].kind.clone();
            (self.hear)(&format!("{}: {name} rays", self.case.name));
            let mut answers = self.answers(built, place, stream);
            for (turn, &threads) in self.settings.threads.iter().enumerate() {
                let contenders: Vec<_> = built
                    .iter()
                    .enumerate()
                    .flat_map(|(index, built)| built.contenders.iter().map(move |contender| (index, built, contender)))
                    .filter(|(_, _, contender)| turn == 0 || contender.0 == USUAL)
                    .collect();
                let accels: Vec<&dyn Accel> = contenders.iter().map(|(_, _, contender)| &*contender.1).collect();
                let rates = pool(threads)?.install(|| rates::measure(&accels, stream, self.settings.turns));
                for ((index, built, (way, _)), rate) in contenders.iter().zip(rates) {
                    let Rate { median, least, most } = rate;
                    let (hits, difference) = answers.remove(&(*index, way.as_str())).unwrap_or_default();
                    answers.insert((*index, way.as_str()), (hits, difference));
                    self.report.streams[place].results.push(RateReport {
                        build: first + index,
                        family: built.plan.family,
                        quality: quality_name(built.plan.quality),
                        way: way.clone(),
                        threads,
                        mrays: median,
                        least,
                        most,
                        hits,
                        difference,
                    });
                }
            }
        }
        Ok(())
    }

    /// What each contender answers, by build and way: hits, and differences from the reference. It warms up the caches too.
    fn answers<'b>(&mut self, built: &'b [Built], place: usize, stream: &Stream) -> AnswersByWay<'b> {
        let mut all = AnswersByWay::new();
        for (index, built) in built.iter().enumerate() {
            for (way, accel) in &built.contenders {
                let answers = Answers::of(&**accel, stream);
                let hits = answers.hits();
                if self.references.len() == place {
                    self.references.push(answers);
                    all.insert((index, way.as_str()), (hits, Default::default()));
                    continue;
                }
                let primitives = self.report.instanced_primitives;
                let difference = answers.compare(&self.references[place], stream, &self.judge, primitives);
                all.insert((index, way.as_str()), (hits, difference));
            }
        }
        all
    }
}

type AnswersByWay<'b> = std::collections::HashMap<(usize, &'b str), (usize, super::answers::Difference)>;
