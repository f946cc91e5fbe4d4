//! The progress line: one line that changes on a terminal of any width, plain lines every few seconds in a log.

use std::fmt::Write;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::args::{LogArgs, LogFormat};
use crate::log::Console;

/// Time between two lines in a log.
const LOG_EVERY: Duration = Duration::from_secs(5);

/// How far a render is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Status {
    /// Part of the work that is done, from 0 to 1.
    pub done: f64,
    /// Time of rendering so far.
    pub elapsed: Duration,
    /// Time that is left, once it can be told.
    pub left: Option<Duration>,
    /// Samples of the picture; `None` where no picture is being made.
    pub samples: Option<Samples>,
    /// Median over the pixels of the relative standard error of luminance, once it is known.
    pub median_rel_se: Option<f64>,
}

/// Samples of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Samples {
    /// Per pixel so far, a mean where pixels differ.
    pub spp: f64,
    /// Per pixel at the end, if that is what ends the run.
    pub end: Option<u32>,
    /// Camera samples per second, over all pixels.
    pub per_second: f64,
}

impl Status {
    /// The progress line, the most wanted first, since a narrow terminal cuts its end.
    pub fn line(&self) -> String {
        let mut line = format!("{:3.0} %  {} elapsed", (100.0 * self.done).floor(), clock(self.elapsed));
        let mut add = |part: std::fmt::Arguments<'_>| {
            // writing to a string cannot fail
            let _ = line.write_fmt(part);
        };
        if let Some(left) = self.left {
            add(format_args!("  {} left", clock(left)));
        }
        if let Some(Samples { spp, end, per_second }) = self.samples {
            match end {
                Some(end) => add(format_args!("  {spp:.0}/{end} spp")),
                None => add(format_args!("  {spp:.0} spp")),
            }
            add(format_args!("  {}samples/s", with_prefix(per_second)));
        }
        if let Some(error) = self.median_rel_se {
            add(format_args!("  median error {} %", three_digits(100.0 * error)));
        }
        line
    }
}

/// Shows how far a render is.
#[derive(Debug)]
pub struct Progress(Place);

#[derive(Debug)]
enum Place {
    Nowhere,
    Terminal(ProgressBar),
    Log { form: LogFormat, last: Option<Instant> },
}

impl Progress {
    /// On the terminal if there is one and the log is for people; else in the log; nowhere with `--quiet`.
    pub fn start(console: &Console, args: &LogArgs) -> Self {
        Self(match args.log {
            _ if args.quiet => Place::Nowhere,
            LogFormat::Plain if console.is_terminal() => Place::Terminal(bottom_line(console)),
            form => Place::Log { form, last: None },
        })
    }

    /// Shows this, unless something was shown a moment ago.
    pub fn update(&mut self, status: &Status) {
        match &mut self.0 {
            Place::Nowhere => {}
            Place::Terminal(line) => line.set_message(status.line()),
            Place::Log { form, last } => {
                let now = Instant::now();
                // the end is told by `finish`, once
                if status.done < 1.0 && is_due(*last, now) {
                    *last = Some(now);
                    write_log(*form, status);
                }
            }
        }
    }

    /// Shows this as the last line, which stays.
    pub fn finish(self, status: &Status) {
        match self.0 {
            Place::Nowhere => {}
            Place::Terminal(line) => line.abandon_with_message(status.line()),
            Place::Log { form, .. } => write_log(form, status),
        }
    }
}

/// A line at the bottom of the terminal. `wide_msg` cuts it to the width, whatever that is.
fn bottom_line(console: &Console) -> ProgressBar {
    let style = ProgressStyle::with_template("{wide_msg}").expect("the template is well formed");
    console.lines().add(ProgressBar::no_length().with_style(style))
}

fn is_due(last: Option<Instant>, now: Instant) -> bool {
    last.is_none_or(|last| now.duration_since(last) >= LOG_EVERY)
}

fn write_log(form: LogFormat, status: &Status) {
    match form {
        LogFormat::Plain => tracing::info!("{}", status.line()),
        LogFormat::Json => tracing::info!(
            done = status.done,
            elapsed_s = status.elapsed.as_secs_f64(),
            left_s = status.left.map(|left| left.as_secs_f64()),
            spp = status.samples.map(|s| s.spp),
            spp_end = status.samples.and_then(|s| s.end),
            samples_per_second = status.samples.map(|s| s.per_second),
            median_rel_se_y = status.median_rel_se,
            "progress"
        ),
    }
}

/// `0:31`, `12:05`, `1:02:03`, `2 d 1:02:03`.
pub fn clock(span: Duration) -> String {
    let seconds = span.as_secs();
    let (days, hours, minutes, seconds) =
        (seconds / 86400, seconds / 3600 % 24, seconds / 60 % 60, seconds % 60);
    match (days, hours) {
        (0, 0) => format!("{minutes}:{seconds:02}"),
        (0, _) => format!("{hours}:{minutes:02}:{seconds:02}"),
        _ => format!("{days} d {hours}:{minutes:02}:{seconds:02}"),
    }
}

/// `1.92 M` with the prefix of a unit that follows; `31.0 ` without one.
fn with_prefix(number: f64) -> String {
    let (scale, prefix) = match number {
        n if n >= 999.5e6 => (1e9, "G"),
        n if n >= 999.5e3 => (1e6, "M"),
        n if n >= 999.5 => (1e3, "k"),
        _ => (1.0, ""),
    };
    format!("{} {prefix}", three_digits(number / scale))
}

/// Three significant digits, never with an exponent.
fn three_digits(number: f64) -> String {
    let decimals = match number.abs() {
        n if n >= 99.95 => 0,
        n if n >= 9.995 => 1,
        n if n >= 0.9995 => 2,
        _ => 3,
    };
    format!("{number:.decimals$}")
}

#[cfg(test)]
mod tests {
    use std::io;

    use indicatif::{ProgressDrawTarget, TermLike};

    use super::*;

    const STATUS: Status = Status {
        done: 0.428,
        elapsed: Duration::from_secs(31),
        left: Some(Duration::from_secs(3723)),
        samples: Some(Samples { spp: 27.0, end: Some(64), per_second: 1.92e6 }),
        median_rel_se: Some(0.0213),
    };

    #[test]
    fn whole_line() {
        let line = " 42 %  0:31 elapsed  1:02:03 left  27/64 spp  1.92 Msamples/s  median error 2.13 %";
        assert_eq!(STATUS.line(), line);
    }

    #[test]
    fn what_is_not_known_is_left_out() {
        let samples = STATUS.samples.map(|s| Samples { end: None, ..s });
        let status = Status { left: None, samples, median_rel_se: None, ..STATUS };
        assert_eq!(status.line(), " 42 %  0:31 elapsed  27 spp  1.92 Msamples/s");
        assert_eq!(Status { samples: None, ..status }.line(), " 42 %  0:31 elapsed");
        assert!(Status { done: 0.9999, ..STATUS }.line().starts_with(" 99 %"), "not done before the end");
        assert!(Status { done: 1.0, ..STATUS }.line().starts_with("100 %"));
    }

    #[test]
    fn numbers_for_people() {
        assert_eq!(
            [0.5, 31.04, 999.4, 999.6, 1.5e4, 2.0e9].map(with_prefix),
            ["0.500 ", "31.0 ", "999 ", "1.00 k", "15.0 k", "2.00 G"]
        );
        let clocks = [59, 60, 3599, 3600, 86399, 90061].map(|seconds| clock(Duration::from_secs(seconds)));
        assert_eq!(clocks, ["0:59", "1:00", "59:59", "1:00:00", "23:59:59", "1 d 1:01:01"]);
    }

    #[test]
    fn log_lines_keep_their_distance() {
        let start = Instant::now();
        assert!(is_due(None, start));
        assert!(!is_due(Some(start), start + LOG_EVERY / 2));
        assert!(is_due(Some(start), start + LOG_EVERY));
    }

    /// A terminal of any width that remembers what was written.
    #[derive(Debug, Default, Clone)]
    struct Terminal {
        width: u16,
        written: std::sync::Arc<std::sync::Mutex<String>>,
    }

    impl TermLike for Terminal {
        fn width(&self) -> u16 {
            self.width
        }
        fn move_cursor_up(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_down(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_right(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_left(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn write_line(&self, line: &str) -> io::Result<()> {
            self.write_str(line)
        }
        fn write_str(&self, text: &str) -> io::Result<()> {
            self.written.lock().expect("no other thread").push_str(text);
            Ok(())
        }
        fn clear_line(&self) -> io::Result<()> {
            Ok(())
        }
        fn flush(&self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn any_width() {
        for width in [0, 1, 2, 7, 40, 80, 1000] {
            let terminal = Terminal { width, ..Terminal::default() };
            let target = ProgressDrawTarget::term_like_with_hz(Box::new(terminal.clone()), 255);
            let console = Console::to(target, true);
            let mut progress = Progress::start(&console, &LogArgs { log: LogFormat::Plain, quiet: false });
            progress.update(&STATUS);
            progress.finish(&Status { done: 1.0, ..STATUS });
            let written = terminal.written.lock().expect("no other thread").clone();
            assert!(written.contains(&"100 %"[..usize::from(width).min(5)]), "width {width}: {written:?}");
            assert_eq!(written.contains("samples/s"), width >= 80, "width {width}: {written:?}");
        }
    }

    #[test]
    fn quiet_is_quiet() {
        let terminal = Terminal { width: 80, ..Terminal::default() };
        let console = Console::to(ProgressDrawTarget::term_like(Box::new(terminal.clone())), true);
        let mut progress = Progress::start(&console, &LogArgs { log: LogFormat::Plain, quiet: true });
        progress.update(&STATUS);
        progress.finish(&STATUS);
        assert_eq!(*terminal.written.lock().expect("no other thread"), "");
    }
}
