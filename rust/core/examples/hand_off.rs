//! What a parallel run costs beyond its work: `cargo run --release -p visviva-core --example hand_off`.
//!
//! 16 chunks of spinning on one and on two threads, with a pause before each run: after more than 50 µs the
//! worker is asleep and has to be woken.

use std::io::Write;
use std::time::{Duration, Instant};
use visviva_core::parallel::{Control, Ticker, for_chunks};

const CHUNKS: usize = 16;

fn spin(microseconds: u64) {
    let started = Instant::now();
    while started.elapsed() < Duration::from_micros(microseconds) {
        core::hint::spin_loop();
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut out = std::io::stdout();
    let control = Control::new(0);
    let mut monitor = |_: u64, _: u64| true;
    let mut ticker = Ticker::new(&control, &mut monitor);
    writeln!(
        out,
        "µs of work per chunk, pause before the run: µs on 1 thread | beyond half of that on 2 threads"
    )?;
    for (work, pause) in [(0, 0), (5, 0), (20, 0), (20, 20), (20, 40), (20, 200), (100, 20), (100, 2000)] {
        let mut best_and_median = |threads| -> Result<(f64, f64), visviva_core::Error> {
            let mut times = Vec::new();
            for _ in 0..(1_000_000 / (CHUNKS as u64 * work + pause + 200)).min(1000) {
                spin(pause);
                let started = Instant::now();
                let _: Vec<()> = for_chunks(threads, CHUNKS, &mut ticker, |_, _| {
                    spin(work);
                    Ok(())
                })?;
                times.push(started.elapsed().as_secs_f64() * 1e6);
            }
            times.sort_unstable_by(f64::total_cmp);
            Ok((times[0], times[times.len() / 2]))
        };
        let one = best_and_median(1)?.0;
        let (best, median) = best_and_median(2)?;
        writeln!(
            out,
            "{work:4} {pause:5}: {one:8.1} | {:6.1} best, {:6.1} median",
            best - one / 2.0,
            median - one / 2.0
        )?;
    }
    let started = Instant::now();
    const TICKS: u32 = 100_000_000;
    for _ in 0..TICKS {
        ticker.tick()?;
    }
    writeln!(out, "a tick: {:.2} ns", started.elapsed().as_secs_f64() * 1e9 / f64::from(TICKS))?;
    Ok(())
}
