//! What a run records: arrays that trajectories fill side by side, with NaN where one has failed.

use super::room;
use crate::numerics::lanes::{Bits, Vector8, WIDTH};
use crate::numerics::simd::prefetch;
use core::marker::PhantomData;

/// Output arrays of a batch, C order `(copies, times, particles, 3)`; empty where not asked for.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    /// Output times.
    pub times: usize,
    /// Particles.
    pub particles: usize,
    /// Positions.
    pub position: Vec<f64>,
    /// Velocities.
    pub velocity: Vec<f64>,
    /// What the positions leave out, for quantities derived from them.
    pub position_rest: Vec<f64>,
    /// What the velocities leave out.
    pub velocity_rest: Vec<f64>,
}

impl Columns {
    /// Room for the arrays; `derived` asks for all four.
    ///
    /// The room is not initialised (touching it twice would cost as much as the steps between two
    /// outputs): the arrays are empty until [`finish`](Self::finish).
    pub fn new(
        copies: usize,
        times: usize,
        particles: usize,
        position: bool,
        velocity: bool,
        derived: bool,
    ) -> Self {
        let array = |wanted: bool| room::take(if wanted { copies * times * particles * 3 } else { 0 });
        Self {
            times,
            particles,
            position: array(position || derived),
            velocity: array(velocity || derived),
            position_rest: array(derived),
            velocity_rest: array(derived),
        }
    }

    /// Makes the arrays whole: NaN for a (particle, copy) from the output time at which its record ends.
    ///
    /// # Safety
    /// Every entry that is not in `missing` has been written, for each of the `copies` copies.
    pub unsafe fn finish(&mut self, copies: usize, missing: &[Missing]) {
        let Self { times, particles, .. } = *self;
        let len = copies * times * particles * 3;
        for array in
            [&mut self.position, &mut self.velocity, &mut self.position_rest, &mut self.velocity_rest]
        {
            if array.capacity() < len || len == 0 {
                continue;
            }
            for &Missing { copy, from_time, particle } in missing {
                for time in from_time..times {
                    let at = ((copy * times + time) * particles + particle) * 3;
                    for entry in &mut array.spare_capacity_mut()[at..at + 3] {
                        let _: &mut f64 = entry.write(f64::NAN);
                    }
                }
            }
            // SAFETY: the capacity is there (tested above) and everything was written, by the contract or
            // by the loop above.
            unsafe { array.set_len(len) };
        }
    }

    /// A writer that threads may share, each for particles of its own.
    pub fn writer(&mut self) -> Writer<'_> {
        let raw = |array: &mut Vec<f64>| (array.as_mut_ptr(), array.capacity());
        Writer {
            times: self.times,
            particles: self.particles,
            position: raw(&mut self.position),
            velocity: raw(&mut self.velocity),
            position_rest: raw(&mut self.position_rest),
            velocity_rest: raw(&mut self.velocity_rest),
            columns: PhantomData,
        }
    }
}

/// A particle whose record ends before the last output time.
#[derive(Clone, Copy, Debug)]
pub struct Missing {
    /// Which copy.
    pub copy: usize,
    /// The first output time that was not recorded.
    pub from_time: usize,
    /// Which particle.
    pub particle: usize,
}

/// Writes single entries of [`Columns`].
#[derive(Debug)]
pub struct Writer<'a> {
    times: usize,
    particles: usize,
    position: (*mut f64, usize),
    velocity: (*mut f64, usize),
    position_rest: (*mut f64, usize),
    velocity_rest: (*mut f64, usize),
    columns: PhantomData<&'a mut Columns>,
}

// SAFETY: the arrays outlive the writer (its lifetime borrows them mutably), and every particle of every
// copy is written by the one thread that integrates it, so no entry is written by two threads.
unsafe impl Sync for Writer<'_> {}

/// One particle at one time: values and what they leave out.
#[derive(Clone, Copy, Debug, Default)]
pub struct Entry {
    /// Position.
    pub position: [f64; 3],
    /// Velocity.
    pub velocity: [f64; 3],
    /// What the position leaves out.
    pub position_rest: [f64; 3],
    /// What the velocity leaves out.
    pub velocity_rest: [f64; 3],
}

/// Particles that follow each other, at most eight, in the lanes of a row from the first on.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    first: usize,
    /// How many coordinates they have.
    numbers: usize,
    /// Which lanes of their points, three rows of coordinates, these are.
    wanted: [Bits; 3],
    /// The lanes without a particle.
    pub idle: Bits,
}

impl Run {
    /// From the first and how many they are.
    pub fn new(first: usize, particles: usize) -> Self {
        let numbers = 3 * particles;
        let all = (1_u32 << numbers) - 1;
        let wanted = [0, WIDTH, 2 * WIDTH].map(|offset| Bits((all >> offset) as u8));
        Self { first, numbers, wanted, idle: Bits((0xff_u32 << particles) as u8) }
    }
}

impl<'a> Writer<'a> {
    /// Whether what the values leave out is kept.
    pub fn keeps_rest(&self) -> bool {
        self.position_rest.1 > 0
    }

    /// The entries of a copy at an output time.
    #[inline(always)]
    pub fn output(&'a self, copy: usize, time: usize) -> Output<'a> {
        Output { writer: self, start: (copy * self.times + time) * self.particles }
    }
}

/// What is recorded of a copy at one output time. Only one thread may write a given particle.
#[derive(Debug)]
pub struct Output<'a> {
    writer: &'a Writer<'a>,
    /// The entry of its first particle.
    start: usize,
}

impl Output<'_> {
    #[inline(always)]
    fn put(&self, (array, len): (*mut f64, usize), particle: usize, values: [f64; 3]) {
        let at = (self.start + particle) * 3;
        if at + 3 <= len {
            // SAFETY: in bounds by the test; no other thread writes this particle (see the type).
            unsafe { array.add(at).cast::<[f64; 3]>().write(values) };
        }
    }

    /// Writes a particle.
    pub fn write(&self, particle: usize, entry: &Entry) {
        self.write_rounded(particle, entry.position, entry.velocity);
        self.put(self.writer.position_rest, particle, entry.position_rest);
        self.put(self.writer.velocity_rest, particle, entry.velocity_rest);
    }

    /// As [`write_rounded`](Self::write_rounded), of a run of particles, point after point.
    #[inline(always)]
    pub fn write_points<V: Vector8>(&self, run: &Run, position: [V; 3], velocity: [V; 3]) {
        self.put_points(self.writer.position, run, position);
        self.put_points(self.writer.velocity, run, velocity);
    }

    #[inline(always)]
    fn put_points<V: Vector8>(&self, (array, len): (*mut f64, usize), run: &Run, points: [V; 3]) {
        let at = (self.start + run.first) * 3;
        if at + run.numbers <= len {
            // A store to a line that is far holds up all after it, so the lines of the next output time come while
            // there are steps to take.
            let next = at + 3 * self.writer.particles;
            for (third, lanes) in points.into_iter().enumerate() {
                prefetch(array.wrapping_add(next + WIDTH * third));
                // SAFETY: in bounds by the test; no other thread writes these particles (see the type).
                unsafe { lanes.write_where(run.wanted[third], array.wrapping_add(at + WIDTH * third)) };
            }
        }
    }

    /// As [`write`](Self::write), without what the values leave out.
    #[inline(always)]
    pub fn write_rounded(&self, particle: usize, position: [f64; 3], velocity: [f64; 3]) {
        self.put(self.writer.position, particle, position);
        self.put(self.writer.velocity, particle, velocity);
    }
}
