use super::*;
use std::thread::sleep;

/// A run with a monitor that never stops it.
fn run<R: Send>(
    threads: usize,
    chunks: usize,
    body: impl Fn(usize, &mut Ticker<'_>) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let control = Control::new(chunks as u64);
    let mut monitor = |_: u64, _: u64| true;
    for_chunks(threads, chunks, &mut Ticker::new(&control, &mut monitor), body)
}

#[test]
fn results_come_in_chunk_order() {
    for threads in 1..=3 {
        for chunks in [0, 1, 2, 3, 100] {
            let squares = run(threads, chunks, |chunk, _| {
                // The first chunks end last.
                if chunk < 3 {
                    sleep(Duration::from_millis(3 - chunk as u64));
                }
                Ok(chunk * chunk)
            });
            assert_eq!(squares, Ok((0..chunks).map(|chunk| chunk * chunk).collect()));
        }
    }
}

#[test]
fn other_threads_do_take_part() {
    let names = run(2, 20, |_, _| {
        sleep(Duration::from_millis(1));
        Ok(std::thread::current().id())
    });
    let mut names = names.unwrap_or_default();
    names.dedup();
    names.sort_unstable_by_key(|id| format!("{id:?}"));
    names.dedup();
    assert_eq!(names.len(), 2);
}

#[test]
fn cancellation_is_noticed_by_every_thread() {
    for threads in 1..=3 {
        let control = Control::new(0);
        let mut cancelled_at = None;
        let started = Instant::now();
        let mut monitor = |_: u64, _: u64| {
            cancelled_at = Some(Instant::now());
            false
        };
        let outcome: Result<Vec<()>> =
            for_chunks(threads, threads, &mut Ticker::new(&control, &mut monitor), |_, ticker| {
                loop {
                    ticker.tick()?;
                }
            });
        assert_eq!(outcome, Err(Error::Interrupted));
        let ended = Instant::now();
        assert!(cancelled_at.is_some_and(|at| ended - at < Duration::from_millis(50)));
        // The monitor is called first after 50 ms; the rest is for a busy machine.
        assert!(ended - started < Duration::from_millis(200));
    }
}

#[test]
fn the_monitor_is_called_while_the_caller_waits_for_others() {
    let control = Control::new(0);
    let mut monitor = |_: u64, _: u64| false;
    let caller = std::thread::current().id();
    let helped = AtomicBool::new(false);
    let outcome = for_chunks(2, 2, &mut Ticker::new(&control, &mut monitor), |_, ticker| {
        if std::thread::current().id() == caller {
            // Leaves the other chunk to the other thread and has nothing more to do.
            while !helped.load(Ordering::Relaxed) {
                sleep(Duration::from_millis(1));
            }
            return Ok(());
        }
        helped.store(true, Ordering::Relaxed);
        loop {
            ticker.tick()?;
        }
    });
    assert_eq!(outcome, Err(Error::Interrupted));
}

#[test]
fn a_cancelled_body_may_keep_what_it_has() {
    let control = Control::new(0);
    control.cancel();
    let kept = for_chunks(2, 5, &mut Ticker::quiet(&control), |chunk, ticker| match ticker.tick() {
        Err(Error::Interrupted) => Ok(chunk),
        _ => Err(Error::Internal("the flag was not seen".to_owned())),
    });
    assert_eq!(kept, Ok(vec![0, 1, 2, 3, 4]));
}

#[test]
fn slow_ticks_after_fast_ones_still_reach_the_monitor() {
    let control = Control::new(0);
    let mut calls = 0;
    let mut monitor = |_: u64, _: u64| {
        calls += 1;
        true
    };
    let mut ticker = Ticker::new(&control, &mut monitor);
    for _ in 0..100_000 {
        assert_eq!(ticker.tick(), Ok(()));
    }
    let started = Instant::now();
    while started.elapsed() < Duration::from_millis(400) {
        sleep(Duration::from_micros(500));
        assert_eq!(ticker.tick(), Ok(()));
    }
    assert!(calls >= 3, "{calls}");
}

#[test]
fn the_lowest_error_wins_and_a_panic_is_an_error() {
    for threads in 1..=3 {
        let outcome = run(threads, 50, |chunk, _| {
            if chunk == 7 {
                sleep(Duration::from_millis(5));
                panic!("seven");
            }
            if chunk > 7 { Err(Error::Interrupted) } else { Ok(chunk) }
        });
        assert_eq!(outcome, Err(Error::Internal("a panic: seven".to_owned())));
    }
    // The pool is as good as before.
    assert_eq!(run(3, 3, |chunk, _| Ok(chunk)), Ok(vec![0, 1, 2]));
}

#[test]
fn nothing_is_begun_after_an_error() {
    for threads in 1..=3 {
        let begun = AtomicUsize::new(0);
        let outcome = run(threads, 1000, |chunk, _| {
            let _: usize = begun.fetch_add(1, Ordering::Relaxed);
            if chunk == 5 {
                return Err(Error::Interrupted);
            }
            sleep(Duration::from_millis(1));
            Ok(())
        });
        assert_eq!(outcome, Err(Error::Interrupted));
        assert!(begun.into_inner() <= 6 + threads);
    }
}

#[test]
fn nested_runs_are_serial() {
    let outcome = run(3, 6, |_, ticker| {
        let here = std::thread::current().id();
        let there = for_chunks(3, 4, ticker, |_, _| {
            sleep(Duration::from_millis(2)); // time for others to join in
            Ok(std::thread::current().id())
        })?;
        Ok(there.iter().all(|id| *id == here))
    });
    assert_eq!(outcome, Ok(vec![true; 6]));
    assert!(!INSIDE.get());
}

#[test]
fn a_busy_pool_does_not_hold_up_another_run() {
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let long = scope.spawn(|| {
            run(4, 4, |_, _| {
                while !stop.load(Ordering::Relaxed) {
                    sleep(Duration::from_millis(1));
                }
                Ok(())
            })
        });
        sleep(Duration::from_millis(20));
        assert_eq!(run(4, 100, |chunk, _| Ok(chunk)).map(|all| all.len()), Ok(100));
        stop.store(true, Ordering::Relaxed);
        assert!(long.join().is_ok_and(|outcome| outcome.is_ok()));
    });
}

#[test]
fn many_short_runs_from_many_threads() {
    std::thread::scope(|scope| {
        for _ in 0..4 {
            let _ = scope.spawn(|| {
                for round in 0..500 {
                    let sum = run(3, 8, |chunk, _| Ok(chunk + round)).map(|all| all.iter().sum::<usize>());
                    assert_eq!(sum, Ok(28 + 8 * round));
                }
            });
        }
    });
}

#[test]
fn progress_adds_up() {
    let control = Control::new(30);
    let outcome = for_chunks(3, 10, &mut Ticker::quiet(&control), |_, ticker| {
        ticker.advance(3);
        Ok(())
    });
    assert!(outcome.is_ok());
    assert_eq!(control.progress(), (30, 30));
}

#[test]
fn thread_counts() {
    let name = |outcome: Result<usize>| match outcome {
        Err(Error::InvalidInput { argument, .. }) => argument,
        _ => String::new(),
    };
    assert_eq!(count(Some(3), Some("5".to_owned())), Ok(3));
    assert_eq!(count(None, Some(" 5 ".to_owned())), Ok(5));
    assert!(count(None, None).is_ok_and(|n| n >= 1));
    assert!(count(None, Some(String::new())).is_ok_and(|n| n >= 1));
    for bad in [0, -1, 1025, i64::MIN] {
        assert_eq!(name(count(Some(bad), None)), "threads");
    }
    for bad in ["0", "two", "1.5", "99999999999999999999"] {
        assert_eq!(name(count(None, Some(bad.to_owned()))), "VISVIVA_THREADS");
    }
}
