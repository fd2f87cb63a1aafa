//! What a person or a script hears while renders go on: a progress bar on a terminal, JSON lines, or nothing.

use std::io::{IsTerminal, Write};
use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;
use serde_json::json;

use super::stats::Statistics;
use crate::error::{Diagnostic, Error, Result};
use crate::integrator::{Progress, RenderStats};

/// Where messages go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Sentences and a bar to stderr; the bar only if that is a terminal.
    Person,
    /// JSON lines to stdout.
    Json,
    /// Nothing but errors.
    Nobody,
}

/// Tells what happens to one picture.
pub struct Reporter<'a> {
    pub channel: Channel,
    pub scene: &'a Path,
    /// Empty before the views are known.
    pub camera: &'a str,
}

/// Writes one line of JSON to stdout.
///
/// # Errors
/// [`Error::Io`] if stdout is closed.
pub fn print_json(value: &impl Serialize) -> Result<()> {
    let line = serde_json::to_string(value).map_err(std::io::Error::other);
    let mut out = std::io::stdout().lock();
    line.and_then(|line| writeln!(out, "{line}"))
        .map_err(|e| Error::io("write", Path::new("stdout"), e))
}

impl Reporter<'_> {
    /// Warnings of a scene.
    pub fn warnings(&self, warnings: &[Diagnostic]) {
        if self.channel == Channel::Person {
            warnings.iter().for_each(|warning| eprintln!("{warning}"));
        }
    }

    /// A sentence for a person.
    pub fn say(&self, sentence: &str) {
        if self.channel == Channel::Person {
            eprintln!("{sentence}");
        }
    }

    /// An event for a script. That nobody listens any more does not stop a render.
    fn event(&self, mut event: serde_json::Value) {
        if self.channel == Channel::Json {
            event["scene"] = json!(self.scene.display().to_string());
            event["camera"] = json!(self.camera);
            let _ = print_json(&event);
        }
    }

    /// A render that failed.
    pub fn error(&self, error: &Error) {
        self.event(json!({"event": "error", "message": error.to_string()}));
    }

    /// A render that is done.
    pub fn result(&self, statistics: &Statistics) {
        let mut event = serde_json::to_value(statistics).unwrap_or_default();
        event["event"] = json!("result");
        self.event(event);
        let s = statistics;
        self.say(&format!(
            "{}: {} spp in {:.1} s, {:.1} million rays a second",
            s.output,
            s.spp,
            s.render_seconds,
            s.rays_per_second * 1e-6
        ));
    }

    /// Says which samples a render dropped, and by what `options` beside seed, pixel and sample they can be rendered again.
    pub fn dropped(&self, stats: &RenderStats, seed: u64, options: &str) {
        if stats.dropped_samples == 0 {
            return;
        }
        self.say(&format!(
            "warning: {} samples were not finite or negative and count as black; to look into one:",
            stats.dropped_samples
        ));
        for dropped in stats.dropped.iter().take(4) {
            let [x, y] = dropped.pixel;
            self.say(&format!(
                "  lucerna render {} --seed {seed} --pixel {x},{y} --sample {} {options}",
                self.scene.display(),
                dropped.sample
            ));
        }
    }

    /// Hears how far the render of this picture is, or of one of its layers that is rendered by itself.
    pub fn progress(&self, layer: Option<&'static str>) -> PictureProgress<'_> {
        let bar = (self.channel == Channel::Person && std::io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr());
            let style =
                ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %  {elapsed_precise}  {prefix} left");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            let stem = self.scene.file_stem().unwrap_or_default().to_string_lossy();
            bar.set_message(layer.map_or_else(|| stem.to_string(), |layer| format!("{stem}, {layer}")));
            bar.set_prefix("?");
            bar
        });
        PictureProgress {
            reporter: self,
            layer,
            bar,
            start: Instant::now(),
            last: Mutex::new(None),
        }
    }
}

/// The time between two messages.
const INTERVAL: Duration = Duration::from_millis(250);

/// The progress of one picture.
pub struct PictureProgress<'a> {
    reporter: &'a Reporter<'a>,
    layer: Option<&'static str>,
    bar: Option<ProgressBar>,
    start: Instant,
    last: Mutex<Option<Instant>>,
}

impl PictureProgress<'_> {
    /// Takes the bar away.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Progress for PictureProgress<'_> {
    fn advance(&self, done: u64, total: u64) {
        if self.bar.is_none() && self.reporter.channel != Channel::Json {
            return;
        }
        // Whoever finds another thread speaking has nothing newer to say.
        let Ok(mut last) = self.last.try_lock() else { return };
        if last.is_some_and(|last| last.elapsed() < INTERVAL) && done < total {
            return;
        }
        *last = Some(Instant::now());
        let fraction = done as f64 / total.max(1) as f64;
        let seconds_left = self.start.elapsed().as_secs_f64() * (1.0 - fraction) / fraction.max(1e-9);
        match &self.bar {
            Some(bar) => {
                bar.set_length(total);
                bar.set_prefix(duration(seconds_left));
                bar.set_position(done);
            }
            None => {
                let mut event = json!({"event": "progress", "done": fraction, "seconds_left": seconds_left});
                if let Some(layer) = self.layer {
                    event["layer"] = json!(layer);
                }
                self.reporter.event(event);
            }
        }
    }
}

/// Hours, minutes and seconds.
fn duration(seconds: f64) -> String {
    let seconds = seconds.min(1e9).ceil() as u64;
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    if hours > 0 {
        format!("{hours}:{minutes:02}:{seconds:02}")
    } else {
        format!("{minutes}:{seconds:02}")
    }
}
