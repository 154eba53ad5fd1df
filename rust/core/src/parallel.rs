//! Threads, cancellation and progress for everything that takes long.
//!
//! The one idea: the calling thread always does the work itself, and the pool only joins in. So nothing
//! waits for a busy pool, one thread needs no pool at all, and the calling thread — the only one that may
//! look at Python — keeps calling its monitor about every 50 ms, also while it waits for the others.

mod pool;

use crate::error::{Error, Result};
use core::cell::Cell;
use core::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// Between two calls of the monitor.
const MONITOR_INTERVAL: Duration = Duration::from_millis(50);
/// Between two looks at the clock, about.
const CLOCK_INTERVAL: Duration = Duration::from_millis(1);
/// Ticks between two looks at the clock, at most: bounds the delay when ticks suddenly become slow.
const LONGEST_STRIDE: u32 = 256;
/// More threads than this is a mistake of the caller.
const MOST_THREADS: i64 = 1024;

/// The flag alone on its cache line: every tick reads it, and progress counts must not disturb that.
#[repr(align(128))]
#[derive(Debug, Default)]
struct Flag(AtomicBool);

/// Cancellation flag and progress counters shared by all threads of one run.
#[derive(Debug, Default)]
pub struct Control {
    cancelled: Flag,
    done: AtomicU64,
    total: AtomicU64,
    /// Whether only what is counted as a whole is counted.
    whole: AtomicBool,
}

impl Control {
    /// For a run of `total` units of progress.
    pub fn new(total: u64) -> Self {
        Self { total: AtomicU64::new(total), ..Self::default() }
    }
    /// Says how much there is to do, once it is known.
    pub fn set_total(&self, total: u64) {
        self.total.store(total, Ordering::Relaxed);
    }
    /// From now on only [`count`](Self::count) counts, up to `total`: the parts of what is done do not know the whole.
    pub fn count_whole(&self, total: u64) {
        self.whole.store(true, Ordering::Relaxed);
        self.set_total(total);
    }
    /// Counts so many units of a whole.
    #[inline]
    pub fn count(&self, done: u64) {
        let _: u64 = self.done.fetch_add(done, Ordering::Relaxed);
    }
    /// Says how much of a whole that is one piece of work is done.
    #[inline]
    fn reach(&self, share: f64) {
        let total = self.total.load(Ordering::Relaxed);
        self.done.store((share * total as f64) as u64, Ordering::Relaxed);
    }
    /// Says how much more there is to do, where work is begun part by part.
    pub fn add_total(&self, total: u64) {
        if self.whole.load(Ordering::Relaxed) {
            return;
        }
        let _: u64 = self.total.fetch_add(total, Ordering::Relaxed);
    }
    /// Asks every thread to stop at its next tick.
    pub fn cancel(&self) {
        self.cancelled.0.store(true, Ordering::Relaxed);
    }
    /// Whether somebody asked to stop.
    #[inline]
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.0.load(Ordering::Relaxed)
    }
    /// Units done and units in all.
    pub fn progress(&self) -> (u64, u64) {
        (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed))
    }
}

/// What the calling thread does about every 50 ms: (done, total) → go on?
pub type Monitor<'a> = dyn FnMut(u64, u64) -> bool + 'a;

/// The monitor and when to call it next.
struct Watch<'a> {
    monitor: &'a mut Monitor<'a>,
    looked: Instant,
    called: Instant,
}

/// One per thread: notices cancellation, counts progress, and on the calling thread feeds the monitor.
pub struct Ticker<'a> {
    control: &'a Control,
    watch: Option<Watch<'a>>,
    countdown: u32,
    stride: u32,
}

impl<'a> Ticker<'a> {
    /// The calling thread's.
    pub fn new(control: &'a Control, monitor: &'a mut Monitor<'a>) -> Self {
        let now = Instant::now();
        let watch = Some(Watch { monitor, looked: now, called: now });
        Self { control, watch, countdown: 1, stride: 1 }
    }

    /// Another thread's, or that of a caller without a monitor: looks at the flag only.
    pub fn quiet(control: &'a Control) -> Self {
        Self { control, watch: None, countdown: u32::MAX, stride: u32::MAX }
    }

    /// The counters and the flag that this ticker shares with the other threads of the run.
    pub fn control(&self) -> &'a Control {
        self.control
    }

    /// To be called at least every 10 ms of work; costs about a nanosecond.
    ///
    /// # Errors
    /// [`Error::Interrupted`] once the run is cancelled.
    #[inline]
    pub fn tick(&mut self) -> Result<()> {
        self.countdown -= 1;
        if self.countdown == 0 {
            self.look();
        }
        if self.control.is_cancelled() { Err(Error::Interrupted) } else { Ok(()) }
    }

    /// Counts `done` more units of progress.
    #[inline]
    pub fn advance(&mut self, done: u64) {
        if !self.control.whole.load(Ordering::Relaxed) {
            self.control.count(done);
        }
    }

    /// Says which share of one piece of work is done, where that is the whole that is counted.
    #[inline]
    pub fn reach(&mut self, share: f64) {
        if self.control.whole.load(Ordering::Relaxed) {
            self.control.reach(share);
        }
    }

    /// Reads the clock, adapts the stride, and calls the monitor when it is due.
    #[cold]
    fn look(&mut self) {
        let now = Instant::now();
        if let Some(watch) = &self.watch {
            let elapsed = now - watch.looked;
            if elapsed < CLOCK_INTERVAL / 2 {
                self.stride = (2 * self.stride).min(LONGEST_STRIDE);
            } else if elapsed > 2 * CLOCK_INTERVAL {
                self.stride = 1;
            }
        }
        self.countdown = self.stride;
        self.watch_at(now);
    }

    /// Calls the monitor if it is due.
    fn watch_at(&mut self, now: Instant) {
        let Some(watch) = &mut self.watch else { return };
        watch.looked = now;
        if now - watch.called < MONITOR_INTERVAL {
            return;
        }
        let (done, total) = self.control.progress();
        if !(watch.monitor)(done, total) {
            self.control.cancel();
        }
        watch.called = Instant::now();
    }

    /// How long the calling thread may sleep before its monitor is due.
    fn patience(&self) -> Duration {
        self.watch.as_ref().map_or(MONITOR_INTERVAL, |watch| {
            MONITOR_INTERVAL.saturating_sub(watch.called.elapsed()).max(CLOCK_INTERVAL)
        })
    }
}

thread_local! {
    /// Whether this thread is inside a body of a parallel run.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Runs `body(chunk, ticker)` for every chunk on `threads` threads, the calling one included.
///
/// Chunks are handed out in increasing order as threads become free; results come back in chunk order.
/// Called from inside a body of a parallel run, it runs serially on that thread.
/// A cancelled run still calls the bodies: the first `tick` says so, and a body chooses between
/// `Err(Interrupted)`, which ends the run, and `Ok` with what there is.
///
/// # Errors
/// The error of the lowest failing chunk, whatever the number of threads; no chunk is begun after an
/// error is known. A panic in a body is [`Error::Internal`].
pub fn for_chunks<R: Send>(
    threads: usize,
    chunks: usize,
    ticker: &mut Ticker<'_>,
    body: impl Fn(usize, &mut Ticker<'_>) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let threads = if INSIDE.get() { 1 } else { threads.min(chunks) };
    if threads <= 1 {
        return (0..chunks).map(|chunk| guarded(chunk, ticker, &body)).collect();
    }

    let control = ticker.control;
    let next = AtomicUsize::new(0);
    let failed = AtomicBool::new(false);
    let take_chunks = |ticker: &mut Ticker<'_>| {
        let outside = INSIDE.replace(true);
        let mut results = Vec::new();
        // A failure ends the handing out. All lower chunks are out by then, so the lowest failing one
        // is always among the results.
        while !failed.load(Ordering::Relaxed) {
            let chunk = next.fetch_add(1, Ordering::Relaxed);
            if chunk >= chunks {
                break;
            }
            let result = guarded(chunk, ticker, &body);
            if result.is_err() {
                failed.store(true, Ordering::Relaxed);
            }
            results.push((chunk, result));
        }
        INSIDE.set(outside);
        results
    };
    let helped = Mutex::new(Vec::new());
    let helper = || {
        let mut results = take_chunks(&mut Ticker::quiet(control));
        helped.lock().unwrap_or_else(PoisonError::into_inner).append(&mut results);
    };
    // The calling thread stays away from the helpers' lock, which a fork may leave locked in the child.
    let mut results = pool::join_in(threads - 1, &helper, ticker, take_chunks)?;
    results.append(&mut helped.into_inner().unwrap_or_else(PoisonError::into_inner));
    results.sort_unstable_by_key(|(chunk, _)| *chunk);
    results.into_iter().map(|(_, result)| result).collect()
}

/// One body, its panic made an error, and a look at the monitor for bodies too short to tick.
fn guarded<R>(
    chunk: usize,
    ticker: &mut Ticker<'_>,
    body: &impl Fn(usize, &mut Ticker<'_>) -> Result<R>,
) -> Result<R> {
    catch_unwind(AssertUnwindSafe(|| {
        let _: Result<()> = ticker.tick();
        body(chunk, ticker)
    }))
    .unwrap_or_else(|payload| Err(panicked(payload.as_ref())))
}

/// A caught panic as an error.
pub fn panicked(payload: &(dyn Any + Send)) -> Error {
    let text = payload
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("without a message");
    Error::Internal(format!("a panic: {text}"))
}

/// How many threads to use: the argument, else `VISVIVA_THREADS`, else the cores this process may use.
///
/// # Errors
/// A number below 1 or above 1024, or a variable that is not a whole number, by name.
pub fn thread_count(argument: Option<i64>) -> Result<usize> {
    count(argument, std::env::var_os("VISVIVA_THREADS").map(|text| text.to_string_lossy().into_owned()))
}

/// The cores available, asked for once: the answer is read from files, and would cost more than a closed form.
static CORES: OnceLock<usize> = OnceLock::new();

/// As [`thread_count`], with the variable given.
#[inline]
fn count(argument: Option<i64>, variable: Option<String>) -> Result<usize> {
    let (name, got, number) = match (argument, variable.as_deref().map(str::trim)) {
        (Some(number), _) => ("threads", number.to_string(), Some(number)),
        (None, Some(text)) if !text.is_empty() => {
            ("VISVIVA_THREADS", format!("'{text}'"), text.parse::<i64>().ok())
        }
        _ => return Ok(*CORES.get_or_init(|| std::thread::available_parallelism().map_or(1, usize::from))),
    };
    number.filter(|number| (1..=MOST_THREADS).contains(number)).and_then(|n| usize::try_from(n).ok()).ok_or_else(
        || {
            Error::invalid(
                name,
                format!(
                    "expected a whole number from 1 to {MOST_THREADS}, got {got}; leave it out to use every core"
                ),
            )
        },
    )
}

#[cfg(test)]
mod tests;
