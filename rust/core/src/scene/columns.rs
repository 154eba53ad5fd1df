//! What a run records: arrays that trajectories fill side by side, with NaN where one has failed.
//!
//! Derived columns are computed at the record, from the state and its compensation, by the unit that holds all that has
//! mass in its ensemble member. Where there is none (bodies that do not act on each other are units by themselves), the
//! states are kept, and the columns derived when all of them are there.

mod wanted;

use super::Scene;
use super::room;
use super::unit::Turned;
use crate::conservation::columns::{Column, Snapshot};
use crate::error::Result;
use crate::forces::bodies::PreciseBodies;
use crate::numerics::lanes::{Bits, Vector8, WIDTH};
use crate::numerics::simd::prefetch;
use crate::parallel::Ticker;
use core::marker::PhantomData;
pub use wanted::Wanted;

/// A derived column: its numbers, `copies × times × width`.
#[derive(Clone, Debug)]
pub struct Derived {
    /// Which it is.
    pub column: &'static Column,
    /// The numbers; NaN where nothing was recorded.
    pub values: Vec<f64>,
}

/// Output arrays of a batch, C order `(copies, times, particles, 3)`; empty where not asked for.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    /// Ensemble members.
    pub copies: usize,
    /// Output times.
    pub times: usize,
    /// Particles.
    pub particles: usize,
    /// Positions.
    pub position: Vec<f64>,
    /// Velocities.
    pub velocity: Vec<f64>,
    /// What the positions leave out, where columns are derived from kept states.
    pub position_rest: Vec<f64>,
    /// What the velocities leave out.
    pub velocity_rest: Vec<f64>,
    /// Derived columns, in the order asked for.
    pub derived: Vec<Derived>,
    /// Rigid bodies.
    pub rigid: usize,
    /// Their orientations, quaternions.
    pub orientation: Vec<f64>,
    /// Their angular velocities.
    pub angular_velocity: Vec<f64>,
    streams: bool,
}

impl Columns {
    /// The arrays, with anything in them: what is not written is made NaN by [`finish`](Self::finish).
    ///
    /// # Errors
    /// Of `t`, if there is no room for them.
    pub fn new(copies: usize, times: usize, particles: usize, wanted: &Wanted) -> Result<Self> {
        let array = |width: Option<usize>| {
            let len = width.and_then(|width| copies.checked_mul(times)?.checked_mul(width));
            len.and_then(room::take).ok_or_else(|| room::refusal(wanted.bytes(copies, times, particles)))
        };
        let vector = |wanted: bool| array(if wanted { particles.checked_mul(3) } else { Some(0) });
        let [position, velocity, position_rest, velocity_rest] = wanted.vectors();
        let derived = wanted.derived.iter();
        let derived = derived
            .map(|&column| Ok(Derived { column, values: array(Some(column.width))? }))
            .collect::<Result<_>>()?;
        Ok(Self {
            copies,
            times,
            particles,
            position: vector(position)?,
            velocity: vector(velocity)?,
            position_rest: vector(position_rest)?,
            velocity_rest: vector(velocity_rest)?,
            derived,
            rigid: wanted.rigid,
            orientation: array(wanted.rigid.checked_mul(4))?,
            angular_velocity: array(wanted.rigid.checked_mul(3))?,
            streams: !wanted.keep_states,
        })
    }

    /// Takes as many rows as there are from those of one copy of others of the same kind.
    pub fn take_rows(&mut self, all: &Self, copy: usize) {
        let arrays = [(&mut self.position, &all.position), (&mut self.velocity, &all.velocity)];
        let derived = self.derived.iter_mut().zip(&all.derived);
        let derived = derived.map(|(own, all)| (&mut own.values, &all.values));
        for (own, all_copies) in arrays.into_iter().chain(derived) {
            let each = all_copies.len() / all.copies;
            let rows = own.len();
            own.copy_from_slice(&all_copies[copy * each..][..rows]);
        }
    }

    /// NaN for each particle from the output time at which its record ends, and for what is derived from it.
    pub fn finish(&mut self, missing: &[Missing]) {
        let Self { times, particles, .. } = *self;
        for &Missing { copy, from_time, particle } in missing {
            for array in
                [&mut self.position, &mut self.velocity, &mut self.position_rest, &mut self.velocity_rest]
            {
                if array.is_empty() {
                    continue;
                }
                for time in from_time..times {
                    let at = ((copy * times + time) * particles + particle) * 3;
                    array[at..at + 3].fill(f64::NAN);
                }
            }
            if let Some(body) = particle.checked_sub(particles - self.rigid).filter(|_| self.rigid > 0) {
                for (array, width) in [(&mut self.orientation, 4), (&mut self.angular_velocity, 3)] {
                    for time in from_time..times {
                        let at = ((copy * times + time) * self.rigid + body) * width;
                        array[at..at + width].fill(f64::NAN);
                    }
                }
            }
            for Derived { column, values } in &mut self.derived {
                values[(copy * times + from_time) * column.width..(copy + 1) * times * column.width]
                    .fill(f64::NAN);
            }
        }
    }

    /// A writer that threads may share, each for particles of its own. The copies of `scene` are `members` of these
    /// columns; what takes long is shared out over so many `threads`.
    pub fn writer<'a>(
        &'a mut self,
        scene: &'a Scene,
        members: Option<&'a [usize]>,
        threads: usize,
    ) -> Writer<'a> {
        let raw = |array: &mut Vec<f64>| (array.as_mut_ptr(), array.len());
        let streams = self.streams;
        Writer {
            times: self.times,
            particles: self.particles,
            position: raw(&mut self.position),
            velocity: raw(&mut self.velocity),
            position_rest: raw(&mut self.position_rest),
            velocity_rest: raw(&mut self.velocity_rest),
            rigid: self.rigid,
            orientation: raw(&mut self.orientation),
            angular_velocity: raw(&mut self.angular_velocity),
            derived: self
                .derived
                .iter_mut()
                .filter(|_| streams)
                .map(|derived| (derived.column, raw(&mut derived.values)))
                .collect(),
            scene,
            members,
            threads,
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
    rigid: usize,
    orientation: (*mut f64, usize),
    angular_velocity: (*mut f64, usize),
    derived: Vec<(&'static Column, (*mut f64, usize))>,
    scene: &'a Scene,
    members: Option<&'a [usize]>,
    threads: usize,
    columns: PhantomData<&'a mut Columns>,
}

// SAFETY: the arrays outlive the writer (its lifetime borrows them mutably), and whoever takes an output from it
// promises that no other thread writes there.
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
pub struct Consecutive {
    first: usize,
    /// How many coordinates they have.
    numbers: usize,
    /// Which lanes of their points, three rows of coordinates, these are.
    wanted: [Bits; 3],
    /// The lanes without a particle.
    pub idle: Bits,
}

impl Consecutive {
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

    /// Whether positions or velocities are recorded.
    pub fn writes_states(&self) -> bool {
        self.position.1 > 0 || self.velocity.1 > 0
    }

    /// The columns that are derived at the record.
    pub fn derived(&self) -> impl Iterator<Item = &'static Column> {
        self.derived.iter().map(|&(column, _)| column)
    }

    /// Whether columns are derived at the record.
    pub fn derives(&self) -> bool {
        !self.derived.is_empty()
    }

    /// The scene that is recorded.
    pub fn scene(&self) -> &Scene {
        self.scene
    }

    /// The masses of a copy.
    pub fn masses(&self, copy: usize) -> &[f64] {
        self.scene.masses(copy)
    }

    /// The entries of a copy at an output time.
    ///
    /// # Safety
    /// As long as it is there, no other thread writes the particles, or derives the columns, of this copy at this time
    /// that are written through it.
    #[inline(always)]
    pub unsafe fn output(&'a self, copy: usize, time: usize) -> Output<'a> {
        let member = self.members.map_or(copy, |members| members[copy]);
        let row = member * self.times + time;
        Output { writer: self, copy, row, start: row * self.particles }
    }
}

/// What is recorded of a copy at one output time.
#[derive(Debug)]
pub struct Output<'a> {
    writer: &'a Writer<'a>,
    /// Which copy of those that are written.
    copy: usize,
    /// Its place among those of all copies.
    row: usize,
    /// The entry of its first particle.
    start: usize,
}

impl Output<'_> {
    #[inline(always)]
    fn put(&self, (array, len): (*mut f64, usize), particle: usize, values: [f64; 3]) {
        if len == 0 {
            return;
        }
        let at = (self.start + particle) * 3;
        assert!(at + 3 <= len, "a particle has a place in its column");
        // SAFETY: in bounds by the test; no other thread writes this particle (see the type).
        unsafe { array.add(at).cast::<[f64; 3]>().write(values) };
    }

    /// Derives the columns from all bodies of the copy that have a mass, or from all of them if none has.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted), and then not all are written.
    pub fn derive(&self, bodies: &PreciseBodies, ticker: &mut Ticker<'_>) -> Result<()> {
        let Writer { derived, scene, threads, .. } = self.writer;
        let mut state = Snapshot::new(scene.forces_of(self.copy), bodies, [0.0; 3], *threads, ticker);
        for (index, &(column, _)) in derived.iter().enumerate() {
            let values = state.value(column)?;
            self.write_derived(index, &values[..column.width]);
        }
        Ok(())
    }

    /// Writes the numbers of a derived column.
    #[inline]
    pub fn write_derived(&self, index: usize, values: &[f64]) {
        let (column, (array, len)) = self.writer.derived[index];
        let at = self.row * column.width;
        assert!(values.len() == column.width && at + column.width <= len, "a row has a place in its column");
        for (offset, &value) in values.iter().enumerate() {
            // SAFETY: in bounds by the test; no other thread derives this row (see the type).
            unsafe { array.add(at + offset).write(value) };
        }
    }

    /// Writes how a rigid body is turned and turns.
    pub fn write_turned(&self, body: usize, (orientation, spin): Turned) {
        if self.writer.rigid == 0 {
            return;
        }
        let at = self.row * self.writer.rigid + body;
        let ((q, q_len), (v, v_len)) = (self.writer.orientation, self.writer.angular_velocity);
        assert!(4 * at + 4 <= q_len && 3 * at + 3 <= v_len, "a body has a place in its columns");
        // SAFETY: in bounds by the test; no other thread writes this body (see the type).
        unsafe {
            q.add(4 * at).cast::<[f64; 4]>().write(orientation);
            v.add(3 * at).cast::<[f64; 3]>().write(spin);
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
    pub fn write_points<V: Vector8>(&self, run: &Consecutive, position: [V; 3], velocity: [V; 3]) {
        self.put_points(self.writer.position, run, position);
        self.put_points(self.writer.velocity, run, velocity);
    }

    #[inline(always)]
    fn put_points<V: Vector8>(&self, (array, len): (*mut f64, usize), run: &Consecutive, points: [V; 3]) {
        if len == 0 {
            return;
        }
        let at = (self.start + run.first) * 3;
        assert!(at + run.numbers <= len, "particles have places in their column");
        // A store to a line that is far holds up all after it, so the lines of the next output time come while
        // there are steps to take.
        let next = at + 3 * self.writer.particles;
        // By index: an array's own iterator would lie in memory, and be dropped by a call.
        for third in 0..3 {
            prefetch(array.wrapping_add(next + WIDTH * third));
            // SAFETY: in bounds by the test; no other thread writes these particles (see the type).
            unsafe { points[third].write_where(run.wanted[third], array.wrapping_add(at + WIDTH * third)) };
        }
    }

    /// As [`write`](Self::write), without what the values leave out.
    #[inline(always)]
    pub fn write_rounded(&self, particle: usize, position: [f64; 3], velocity: [f64; 3]) {
        self.put(self.writer.position, particle, position);
        self.put(self.writer.velocity, particle, velocity);
    }
}
