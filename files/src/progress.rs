//! A progress bar for those who wait, and none for those who do not.

use std::io::{self, IsTerminal as _};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// How long a run takes before it shows a bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// Points between two looks at the clock.
const STRIDE: u64 = 1 << 14;

/// Counts points, and shows how far the run is on a terminal.
#[derive(Debug)]
pub struct Progress {
    start: Instant,
    points: u64,
    expected: u64,
    wanted: bool,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Starts the clock. A bar is shown only if stderr is a terminal and the run is not `quiet`.
    pub fn new(expected: f64, quiet: bool) -> Self {
        Self {
            start: Instant::now(),
            points: 0,
            expected: expected as u64,
            wanted: !quiet && io::stderr().is_terminal(),
            bar: None,
        }
    }

    /// Counts one point.
    pub fn point(&mut self) {
        self.points += 1;
        if self.wanted && self.points.is_multiple_of(STRIDE) {
            self.show();
        }
    }

    fn show(&mut self) {
        if self.bar.is_none() && self.start.elapsed() >= PATIENCE {
            let bar =
                ProgressBar::with_draw_target(Some(self.expected), ProgressDrawTarget::stderr());
            let template = "{wide_bar} {human_pos} of {human_len} points, {eta} left";
            // A template that does not parse leaves the plain style, which is a bar as well.
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            // The number of points is known only about; a full bar must not become a longer one.
            bar.set_position(self.points.min(self.expected));
        }
    }

    /// Removes the bar, and says how many points there were in how much time.
    pub fn finish(self) -> (u64, Duration) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
        (self.points, self.start.elapsed())
    }
}
