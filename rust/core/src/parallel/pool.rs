//! The threads that join in.
//!
//! The one idea: a run leaves invitations in a queue and gets on with its work. An idle worker takes one
//! and helps until no chunk is left; what nobody took is withdrawn. A run therefore waits only for workers
//! that are inside it, never for a pool that is busy elsewhere.
//!
//! Fork: the pool belongs to the process that made it. A child finds another pid, makes its own, and
//! leaves the parent's alone: never joined, never freed, its lock never touched.

use super::Ticker;
use crate::error::{Error, Result};
use core::ptr;
use core::sync::atomic::{AtomicPtr, AtomicUsize, Ordering};
use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, Thread};
use std::time::{Duration, Instant};

/// How long an idle worker, or a caller that waits, spins before it sleeps. Waking a sleeping thread takes 10 to
/// 100 µs, which every force evaluation of some thousand bodies would feel; between two of them the calling
/// thread is alone for a tenth of this.
const SPIN: Duration = Duration::from_micros(500);

/// What a worker is to do: one run's work and who waits for it. Lives on the caller's stack.
struct Job<'a> {
    work: &'a (dyn Fn() + Sync),
    /// Workers inside.
    inside: AtomicUsize,
    caller: Thread,
}

/// A pointer to a job, which outlives it: see [`Invited`].
#[derive(Clone, Copy, PartialEq)]
struct Invitation(*const Job<'static>);

// SAFETY: a job is only shared work (`Sync`), an atomic and a `Thread`.
unsafe impl Send for Invitation {}

/// What the lock protects.
#[derive(Default)]
struct Desk {
    queue: VecDeque<Invitation>,
    workers: usize,
    asleep: usize,
}

/// The pool of one process.
struct Pool {
    pid: u32,
    desk: Mutex<Desk>,
    wake: Condvar,
    /// Invitations in the queue, readable without the lock.
    waiting: AtomicUsize,
}

static POOL: AtomicPtr<Pool> = AtomicPtr::new(ptr::null_mut());

impl Pool {
    /// This process's pool, made on first use. Holds no lock that a fork could leave locked.
    fn current() -> &'static Self {
        let pid = std::process::id();
        let mut seen = POOL.load(Ordering::Acquire);
        loop {
            // SAFETY: a non-null pointer comes from `Box::leak` below and is never freed.
            if let Some(pool) = unsafe { seen.as_ref() }
                && pool.pid == pid
            {
                return pool;
            }
            let made: &'static mut Self = Box::leak(Box::new(Self {
                pid,
                desk: Mutex::default(),
                wake: Condvar::new(),
                waiting: AtomicUsize::new(0),
            }));
            match POOL.compare_exchange(seen, made, Ordering::AcqRel, Ordering::Acquire) {
                Ok(_) => return made,
                // Another thread was first; ours stays behind, a hundred bytes without threads.
                Err(theirs) => seen = theirs,
            }
        }
    }

    fn desk(&self) -> MutexGuard<'_, Desk> {
        self.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Leaves `helpers` invitations and sees that there are as many workers. A thread that the system
    /// refuses is done without: the run is slower and its results are the same.
    fn invite(&'static self, helpers: usize, invitation: Invitation) {
        let mut desk = self.desk();
        while desk.workers < helpers {
            let name = format!("visviva-{}", desk.workers + 1);
            if thread::Builder::new().name(name).spawn(|| self.serve()).is_err() {
                break;
            }
            desk.workers += 1;
        }
        desk.queue.extend((0..helpers).map(|_| invitation));
        self.waiting.store(desk.queue.len(), Ordering::Relaxed);
        let asleep = desk.asleep.min(helpers);
        drop(desk);
        for _ in 0..asleep {
            self.wake.notify_one();
        }
    }

    /// Takes back what nobody took.
    fn withdraw(&self, invitation: Invitation) {
        let mut desk = self.desk();
        desk.queue.retain(|other| *other != invitation);
        self.waiting.store(desk.queue.len(), Ordering::Relaxed);
    }

    /// A worker's life.
    fn serve(&self) {
        loop {
            let started = Instant::now();
            while self.waiting.load(Ordering::Relaxed) == 0 && started.elapsed() < SPIN {
                core::hint::spin_loop();
            }
            let (invitation, caller) = self.accept();
            // SAFETY: `accept` counted this worker in under the lock, so the caller keeps the job alive
            // until it is counted out.
            let job = unsafe { &*invitation.0 };
            (job.work)();
            // From here on the job may be gone; `caller` is our own handle.
            if job.inside.fetch_sub(1, Ordering::Release) == 1 {
                caller.unpark();
            }
        }
    }

    /// Waits for an invitation and enters its job.
    fn accept(&self) -> (Invitation, Thread) {
        let mut desk = self.desk();
        loop {
            if let Some(invitation) = desk.queue.pop_front() {
                self.waiting.store(desk.queue.len(), Ordering::Relaxed);
                // SAFETY: an invitation in the queue is withdrawn, under this lock, before its job ends.
                let job = unsafe { &*invitation.0 };
                let _: usize = job.inside.fetch_add(1, Ordering::Relaxed);
                return (invitation, job.caller.clone());
            }
            desk.asleep += 1;
            desk = self.wake.wait(desk).unwrap_or_else(PoisonError::into_inner);
            desk.asleep -= 1;
        }
    }
}

/// Keeps a job alive until no worker can touch it, also while unwinding.
struct Invited<'a> {
    pool: &'static Pool,
    job: &'a Job<'a>,
    invitation: Invitation,
}

impl Invited<'_> {
    /// Whether this is a child forked in the middle of the run: the workers stayed with the parent.
    fn orphaned(&self) -> bool {
        self.pool.pid != std::process::id()
    }
    fn alone(&self) -> bool {
        self.job.inside.load(Ordering::Acquire) == 0
    }
}

impl Drop for Invited<'_> {
    fn drop(&mut self) {
        if self.orphaned() {
            return;
        }
        self.pool.withdraw(self.invitation);
        while !self.alone() {
            thread::park_timeout(Duration::from_millis(1));
        }
    }
}

/// Does `work(ticker)` here while up to `helpers` workers do `helper()`; returns its value when all have ended.
/// `helper` must not unwind.
///
/// # Errors
/// [`Error::Internal`] in a child that was forked while the run was under way.
pub(super) fn join_in<T>(
    helpers: usize,
    helper: &(dyn Fn() + Sync),
    ticker: &mut Ticker<'_>,
    work: impl FnOnce(&mut Ticker<'_>) -> T,
) -> Result<T> {
    let pool = Pool::current();
    let job = Job { work: helper, inside: AtomicUsize::new(0), caller: thread::current() };
    let invited = Invited { pool, job: &job, invitation: Invitation(ptr::from_ref(&job).cast()) };
    pool.invite(helpers, invited.invitation);
    let result = work(ticker);
    if !invited.orphaned() {
        pool.withdraw(invited.invitation);
        let started = Instant::now();
        while !invited.alone() && started.elapsed() < SPIN {
            core::hint::spin_loop();
        }
    }
    while !invited.alone() {
        if invited.orphaned() {
            return Err(Error::Internal("the process was forked in the middle of a parallel run".to_owned()));
        }
        thread::park_timeout(ticker.patience());
        ticker.watch_at(Instant::now());
    }
    Ok(result)
}
