//! The gravity kernels against a plain sum in double-double, and against each other to the bit.

use visviva_core::forces::gravity::{FewBodies, RING_MAX, Ring, Tiles, TwoRows};
use visviva_core::forces::{Force, Phase};
use visviva_core::numerics::double_double::DoubleDouble;
use visviva_core::numerics::element::Shape;
use visviva_core::numerics::lanes::{Lanes, WIDTH, as_numbers, as_numbers_mut};
use visviva_core::numerics::real::Real;
use visviva_core::parallel::{Control, Ticker};

/// Massive bodies first, as the kernels have them.
#[derive(Clone)]
struct Bodies {
    strength: Vec<f64>,
    position: Vec<[f64; 3]>,
    softening: f64,
    components: usize,
}

/// Numbers in [0, 1), the same every time (Marsaglia's xorshift64*).
struct Random(u64);
impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn bodies(active: usize, passive: usize, softening: f64, components: usize) -> Bodies {
    let mut random = Random(0x9e37_79b9_7f4a_7c15 + (active * 1000 + passive) as u64);
    let mut coordinate = |c: usize| if c < components { 2.0 * random.next() - 1.0 } else { 0.0 };
    let position = (0..active + passive).map(|_| core::array::from_fn(&mut coordinate)).collect();
    let mut random = Random(77 + active as u64);
    // Nine decades of mass.
    let strength = (0..active).map(|i| (0.5 + random.next()) * 10f64.powi(-((3 * i % 10) as i32))).collect();
    Bodies { strength, position, softening, components }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kernel {
    Few,
    Ring,
    TwoRows,
    Tiles(usize),
}

fn apply<S: visviva_core::numerics::element::Element>(
    force: &mut dyn Force<S>,
    q: &[S],
    a: &mut [S],
    first: bool,
) {
    let control = Control::default();
    let v = vec![S::zero(); q.len()];
    force.apply(&Phase { t: &S::zero(), q, v: &v }, a, first, &mut Ticker::quiet(&control)).unwrap();
}

impl Bodies {
    fn count(&self) -> usize {
        self.position.len()
    }
    fn active(&self) -> usize {
        self.strength.len()
    }

    /// Accelerations by a kernel; `before` is what another force left, if one came first.
    fn accelerations(&self, kernel: Kernel, before: Option<f64>) -> Vec<[f64; 3]> {
        let start = before.unwrap_or(f64::NAN);
        let (active, count) = (self.active(), self.count());
        if kernel == Kernel::Few {
            let shape = Shape { rows: count, components: self.components };
            let q: Vec<f64> = (0..shape.len()).map(|k| self.position[k % count][k / count]).collect();
            let mut a = vec![start; shape.len()];
            let mut force = FewBodies::<f64>::new(shape, self.strength.clone(), vec![self.softening]);
            apply(&mut force, &q, &mut a, before.is_none());
            return (0..count).map(|i| self.vector(|c| a[c * count + i])).collect();
        }
        let active_rows = active.div_ceil(WIDTH);
        let shape =
            Shape { rows: active_rows + (count - active).div_ceil(WIDTH), components: self.components };
        let slot = |i: usize| if i < active { i } else { active_rows * WIDTH + i - active };
        // Lanes without a body lie far out and apart, as the scene lays them.
        let mut q: Vec<Lanes> = (0..shape.len())
            .map(|k| Lanes(core::array::from_fn(|lane| 1e60 * (1 + lane + k % shape.rows * WIDTH) as f64)))
            .collect();
        for i in 0..count {
            for c in 0..self.components {
                as_numbers_mut(&mut q)[c * shape.rows * WIDTH + slot(i)] = self.position[i][c];
            }
        }
        let mut a = vec![Lanes::splat(start); shape.len()];
        let mut force: Box<dyn Force<Lanes>> = match kernel {
            Kernel::Tiles(threads) => Box::new(Tiles::new(shape, &self.strength, self.softening, threads)),
            Kernel::TwoRows => {
                Box::new(TwoRows::new(&self.strength, self.softening, self.components).unwrap())
            }
            _ => Box::new(Ring::new(shape, self.strength.clone(), self.softening)),
        };
        apply(force.as_mut(), &q, &mut a, before.is_none());
        let numbers = as_numbers(&a);
        (0..count).map(|i| self.vector(|c| numbers[c * shape.rows * WIDTH + slot(i)])).collect()
    }

    fn vector(&self, component: impl Fn(usize) -> f64) -> [f64; 3] {
        core::array::from_fn(|c| if c < self.components { component(c) } else { 0.0 })
    }

    /// The plain sum in double-double, and the sum of the magnitudes of its terms.
    fn exact(&self, i: usize) -> ([DoubleDouble; 3], f64) {
        let mut a = [DoubleDouble::default(); 3];
        let mut size = 0.0;
        for j in (0..self.active()).filter(|&j| j != i) {
            let d: [DoubleDouble; 3] =
                core::array::from_fn(|c| DoubleDouble::sum(self.position[j][c], -self.position[i][c]));
            let r2 = d[0] * d[0]
                + d[1] * d[1]
                + d[2] * d[2]
                + DoubleDouble::product(self.softening, self.softening);
            let w = DoubleDouble::from(self.strength[j]) / (r2 * r2.sqrt());
            for c in 0..3 {
                a[c] += w * d[c];
            }
            size += (w * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()).to_f64();
        }
        (a, size)
    }

    fn kernels(&self) -> Vec<Kernel> {
        let mut kernels = vec![Kernel::Tiles(1)];
        if self.active() <= RING_MAX {
            kernels.extend([Kernel::Few, Kernel::Ring]);
        }
        if self.active() == self.count() && (9..=16).contains(&self.active()) {
            kernels.push(Kernel::TwoRows);
        }
        kernels
    }
}

/// All numbers of massive bodies to 40, and enough for several shards; massless ones mixed in.
fn cases() -> impl Iterator<Item = Bodies> {
    let counts = (1..=40).chain([127, 128, 129, 255, 300]);
    counts.flat_map(|active| {
        [(0, 0.0, 3), (active % 11, 0.0, 3), (3, 0.125, 3), (0, 0.0, 2), (active % 7, 0.125, 2)]
            .map(|(passive, softening, components)| bodies(active, passive, softening, components))
    })
}

#[test]
fn every_kernel_agrees_with_a_plain_sum_in_double_double() {
    let mut worst = [0.0_f64; 2];
    for case in cases() {
        for kernel in case.kernels() {
            let found = case.accelerations(kernel, None);
            for (i, found) in found.iter().enumerate() {
                let (exact, size) = case.exact(i);
                for c in 0..3 {
                    let error = (DoubleDouble::from(found[c]) - exact[c]).to_f64().abs();
                    assert!(error <= 8.0 * f64::EPSILON * size, "{kernel:?}: {error:e} of {size:e}");
                    let share = if size > 0.0 { error / size } else { 0.0 };
                    worst[usize::from(case.active() > 40)] =
                        worst[usize::from(case.active() > 40)].max(share);
                }
            }
        }
    }
    println!(
        "worst error as a share of the sum of magnitudes: {:.1e} to 40 bodies, {:.1e} beyond",
        worst[0], worst[1]
    );
}

#[test]
fn the_forces_add_up_to_nothing() {
    let mut worst = 0.0_f64;
    for case in cases() {
        for kernel in case.kernels() {
            let a = case.accelerations(kernel, None);
            for c in 0..3 {
                let (mut sum, mut size) = (DoubleDouble::default(), 0.0);
                for (a, &m) in a.iter().zip(&case.strength) {
                    sum += DoubleDouble::product(m, a[c]);
                    size += (m * a[c]).abs();
                }
                worst = worst.max(if size > 0.0 { sum.to_f64().abs() / size } else { 0.0 });
            }
        }
    }
    println!("worst |Σ m a| / Σ |m a| {worst:.1e}");
    assert!(worst < 4.0 * f64::EPSILON);
}

fn bits(a: &[[f64; 3]]) -> Vec<[u64; 3]> {
    // 0.0 and -0.0 are the same acceleration.
    a.iter().map(|a| a.map(|x| (x + 0.0).to_bits())).collect()
}

#[test]
fn few_and_ring_have_the_same_bits() {
    for case in cases().filter(|case| case.active() <= RING_MAX) {
        for before in [None, Some(0.7)] {
            let (few, ring) =
                (case.accelerations(Kernel::Few, before), case.accelerations(Kernel::Ring, before));
            assert_eq!(bits(&few), bits(&ring), "{} bodies", case.count());
        }
    }
}

#[test]
fn eight_trajectories_at_once_have_the_bits_of_each_alone() {
    for active in 1..=RING_MAX {
        for (softening, components, passive) in [(0.0, 3, 2), (0.25, 3, 0), (0.0, 2, 1), (0.25, 2, 3)] {
            let lanes: Vec<Bodies> = (0..WIDTH)
                .map(|lane| {
                    let mut case = bodies(active, passive, softening, components);
                    for x in case.position.iter_mut().flatten() {
                        *x *= 1.0 + 0.1 * lane as f64;
                    }
                    for (i, m) in case.strength.iter_mut().enumerate() {
                        *m *= 1.0 + 0.3 * (lane * i) as f64;
                    }
                    case
                })
                .collect();
            let count = active + passive;
            let shape = Shape { rows: count, components };
            let gather = |of: &dyn Fn(&Bodies) -> f64| Lanes(core::array::from_fn(|lane| of(&lanes[lane])));
            let q: Vec<Lanes> =
                (0..shape.len()).map(|k| gather(&|case| case.position[k % count][k / count])).collect();
            let strength = (0..active).map(|i| gather(&|case| case.strength[i])).collect();
            let mut a = vec![Lanes::zero(); shape.len()];
            apply(
                &mut FewBodies::<Lanes>::new(shape, strength, vec![Lanes::splat(softening)]),
                &q,
                &mut a,
                true,
            );
            for (lane, case) in lanes.iter().enumerate() {
                let found: Vec<_> = (0..count).map(|i| case.vector(|c| a[c * count + i].0[lane])).collect();
                assert_eq!(bits(&found), bits(&case.accelerations(Kernel::Few, None)));
            }
        }
    }
}

#[test]
fn two_rows_have_the_bits_that_they_have_beside_massless_bodies() {
    for active in 9..=16 {
        for (softening, components) in [(0.0, 3), (0.3, 3), (0.0, 2), (0.3, 2)] {
            let alone = bodies(active, 0, softening, components);
            let found = bits(&alone.accelerations(Kernel::TwoRows, None));
            for passive in [0, 5, 70] {
                let mut among = bodies(active, passive, softening, components);
                among.position[..active].copy_from_slice(&alone.position);
                among.strength.clone_from(&alone.strength);
                let among = among.accelerations(Kernel::Tiles(2), None);
                assert_eq!(found, bits(&among[..active]), "{active} and {passive}");
            }
        }
    }
    let none = |count: usize| TwoRows::new(&vec![1.0; count], 0.0, 3).is_none();
    assert!(none(8) && none(17) && !none(9) && !none(16));
}

#[test]
fn threads_do_not_change_a_bit() {
    for (active, passive) in [(9, 0), (130, 40), (257, 0), (400, 1100), (600, 3)] {
        let case = bodies(active, passive, 0.0, 3);
        let one = bits(&case.accelerations(Kernel::Tiles(1), None));
        for threads in [2, 3] {
            assert_eq!(one, bits(&case.accelerations(Kernel::Tiles(threads), None)), "{threads} threads");
        }
    }
}

#[test]
fn the_planar_kernel_has_the_bits_of_the_spatial_one() {
    for case in cases().filter(|case| case.components == 2) {
        let spatial = Bodies { components: 3, ..case.clone() };
        for kernel in case.kernels() {
            assert_eq!(
                bits(&case.accelerations(kernel, None)),
                bits(&spatial.accelerations(kernel, None)),
                "{kernel:?}, {} bodies",
                case.count()
            );
        }
    }
}

#[test]
fn massless_bodies_do_not_change_the_bits_of_the_massive_ones_nor_of_each_other() {
    for active in (1..=24).chain([130, 300]) {
        let with = bodies(active, 21, 0.0, 3);
        let mut without = with.clone();
        without.position.truncate(active);
        let mut some = with.clone();
        some.position.truncate(active + 6);
        for kernel in with.kernels() {
            let all = with.accelerations(kernel, None);
            assert_eq!(bits(&all[..active]), bits(&without.accelerations(kernel, None)), "{kernel:?}");
            assert_eq!(bits(&all[..active + 6]), bits(&some.accelerations(kernel, None)), "{kernel:?}");
        }
    }
}

#[test]
fn a_force_that_is_not_the_first_adds_to_what_is_there() {
    for case in cases() {
        for kernel in case.kernels() {
            let first = case.accelerations(kernel, None);
            let second = case.accelerations(kernel, Some(0.7));
            for (i, (first, second)) in first.iter().zip(&second).enumerate() {
                let (_, size) = case.exact(i);
                for c in 0..case.components {
                    // Tiles add shard by shard: then in another order than the sum by itself.
                    let slack = if matches!(kernel, Kernel::Tiles(_)) {
                        4.0 * f64::EPSILON * (size + 0.7)
                    } else {
                        0.0
                    };
                    assert!((second[c] - (first[c] + 0.7)).abs() <= slack, "{kernel:?}");
                }
            }
        }
    }
}

#[test]
fn golden_forces() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/reference/golden.json");
    let cases: Vec<serde_json::Value> =
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let golden = cases.iter().find(|case| case["id"] == "G8.6-nbody-forces").unwrap();
    let vectors = |value: &serde_json::Value| -> Vec<[f64; 3]> {
        value.as_array().unwrap().iter().map(|x| core::array::from_fn(|c| x[c].as_f64().unwrap())).collect()
    };
    let inputs = &golden["inputs"];
    let strength = inputs["m"].as_array().unwrap().iter().map(|m| m.as_f64().unwrap()).collect();
    let case = Bodies { strength, position: vectors(&inputs["r"]), softening: 0.0, components: 3 };
    let expected = vectors(&golden["outputs"]["a"]);
    for kernel in case.kernels() {
        for (found, expected) in case.accelerations(kernel, None).iter().zip(&expected) {
            for c in 0..3 {
                // Terms reach 1.3; a few roundings of that.
                assert!((found[c] - expected[c]).abs() < 5e-16, "{kernel:?}: {found:?} {expected:?}");
            }
        }
    }
}
