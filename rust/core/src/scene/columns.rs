//! What a run records: arrays that trajectories fill side by side, NaN where one has failed.

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
    /// Arrays full of NaN; `derived` asks for all four.
    pub fn new(
        copies: usize,
        times: usize,
        particles: usize,
        position: bool,
        velocity: bool,
        derived: bool,
    ) -> Self {
        let array = |wanted: bool| vec![f64::NAN; if wanted { copies * times * particles * 3 } else { 0 }];
        Self {
            times,
            particles,
            position: array(position || derived),
            velocity: array(velocity || derived),
            position_rest: array(derived),
            velocity_rest: array(derived),
        }
    }

    /// A writer that threads may share, each for particles of its own.
    pub fn writer(&mut self) -> Writer<'_> {
        let raw = |array: &mut Vec<f64>| (array.as_mut_ptr(), array.len());
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

impl Writer<'_> {
    /// Writes a particle of a copy at an output time. Only one thread may write a given particle.
    pub fn write(&self, copy: usize, time: usize, particle: usize, entry: &Entry) {
        let at = ((copy * self.times + time) * self.particles + particle) * 3;
        for ((array, len), values) in [
            (self.position, entry.position),
            (self.velocity, entry.velocity),
            (self.position_rest, entry.position_rest),
            (self.velocity_rest, entry.velocity_rest),
        ] {
            if at + 3 <= len {
                for (c, value) in values.into_iter().enumerate() {
                    // SAFETY: in bounds by the test above; not shared by the contract of `write`.
                    unsafe { array.add(at + c).write(value) };
                }
            }
        }
    }
}
