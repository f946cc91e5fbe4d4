//! Log lines on standard error, beside the progress line: for people (`plain`) or for programs (`json`).

use std::fmt;
use std::io::{self, IsTerminal, Write};

use indicatif::{MultiProgress, ProgressDrawTarget};
use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::Layer;
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::fmt::format::Writer;
use tracing_subscriber::fmt::{FmtContext, FormatEvent, FormatFields, MakeWriter};
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::registry::LookupSpan;
use tracing_subscriber::util::SubscriberInitExt;

use crate::args::{LogArgs, LogFormat};

/// Overrides what is logged: a level (`debug`), or levels by crate (`tyndall_io=debug,warn`).
pub const FILTER_VARIABLE: &str = "TYNDALL_LOG";

/// Standard error, shared by log lines and the progress line so that neither tears the other.
#[derive(Clone, Debug)]
pub struct Console {
    lines: MultiProgress,
    terminal: bool,
}

impl Console {
    /// The console of this process.
    pub fn stderr() -> Self {
        Self::to(ProgressDrawTarget::stderr_with_hz(10), io::stderr().is_terminal())
    }

    pub(crate) fn to(target: ProgressDrawTarget, terminal: bool) -> Self {
        Self { lines: MultiProgress::with_draw_target(target), terminal }
    }

    /// Whether a person sees it, rather than a file or a pipe.
    pub const fn is_terminal(&self) -> bool {
        self.terminal
    }

    /// The progress lines at its bottom.
    pub(crate) const fn lines(&self) -> &MultiProgress {
        &self.lines
    }
}

impl Write for Console {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.lines.suspend(|| io::stderr().write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        io::stderr().flush()
    }
}

impl MakeWriter<'_> for Console {
    type Writer = Self;

    fn make_writer(&self) -> Self {
        self.clone()
    }
}

/// Sends log lines to the console from now on. A second call changes nothing.
pub fn start(args: &LogArgs, console: &Console) {
    let lines = tracing_subscriber::fmt::layer().with_writer(console.clone());
    let lines = match args.log {
        LogFormat::Json => lines.json().flatten_event(true).boxed(),
        LogFormat::Plain => lines.with_ansi(false).event_format(Plain).boxed(),
    };
    // fails only if a subscriber is there already, which then keeps its lines
    let _ = tracing_subscriber::registry().with(lines.with_filter(filter(args.quiet))).try_init();
}

/// What the environment asks for, else errors or everything for information.
fn filter(quiet: bool) -> Targets {
    let default = if quiet { LevelFilter::ERROR } else { LevelFilter::INFO };
    let wanted = std::env::var(FILTER_VARIABLE).ok().and_then(|wanted| wanted.parse().ok());
    wanted.unwrap_or_else(|| Targets::new().with_default(default))
}

/// `warning: message`, and the message alone when it is for information.
struct Plain;

impl<S, N> FormatEvent<S, N> for Plain
where
    S: Subscriber + for<'span> LookupSpan<'span>,
    N: for<'writer> FormatFields<'writer> + 'static,
{
    fn format_event(
        &self,
        _context: &FmtContext<'_, S, N>,
        mut writer: Writer<'_>,
        event: &Event<'_>,
    ) -> fmt::Result {
        writer.write_str(prefix(*event.metadata().level()))?;
        let mut message = Message { writer: writer.by_ref(), written: Ok(()) };
        event.record(&mut message);
        message.written?;
        writeln!(writer)
    }
}

/// Writes the message of an event; its fields, which repeat numbers of the message, are for programs.
struct Message<'w> {
    writer: Writer<'w>,
    written: fmt::Result,
}

impl Visit for Message<'_> {
    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        if field.name() == "message" {
            self.written = write!(self.writer, "{value:?}");
        }
    }
}

const fn prefix(level: Level) -> &'static str {
    match level {
        Level::ERROR => "error: ",
        Level::WARN => "warning: ",
        Level::INFO => "",
        Level::DEBUG => "debug: ",
        Level::TRACE => "trace: ",
    }
}
