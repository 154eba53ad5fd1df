//! Moments of what is drawn, spots against their closed form, and directions against the law of cosines on a sphere.

use super::*;

const EVENTS: u32 = 40_000;
/// Standard deviations that a moment may be off; draws are the same every time.
const PULLS: f64 = 4.0;

/// The mean of what each event gives, and its standard error.
fn mean(of: impl Fn(Draws) -> f64) -> (f64, f64) {
    let n = f64::from(EVENTS);
    let values: Vec<f64> = (0..EVENTS).map(|event| of(Draws::new(11, u64::from(event)))).collect();
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

fn near(of: impl Fn(Draws) -> f64, expected: f64) {
    let (mean, error) = mean(of);
    assert!((mean - expected).abs() < PULLS * error, "{mean} ± {error}, expected {expected}");
}

fn with_energies(spread: Spread) -> Profile {
    Profile { energy_spread: Some(spread), ..Profile::default() }
}

fn with_directions(spread: Spread) -> Profile {
    Profile { divergence: Some(spread), ..Profile::default() }
}

/// Mean, variance and fourth moment; none beyond the end.
#[test]
fn energies_have_the_moments_of_their_distribution() {
    // Of a Gaussian that ends at 6σ the moments differ by less than 1e-6 from those of a whole one.
    for (spread, variance, fourth) in
        [(Spread::Gaussian(0.3), 0.09, 3.0 * 0.0081), (Spread::Uniform(0.3), 0.03, 0.0081 / 5.0)]
    {
        let profile = with_energies(spread);
        let off = |draws| profile.energy(5.0, draws) - 5.0;
        near(off, 0.0);
        near(|draws| off(draws).powi(2), variance);
        near(|draws| off(draws).powi(4), fourth);
        let [least, greatest] = profile.energies(5.0);
        assert!((0..EVENTS).all(|event| {
            let energy = profile.energy(5.0, Draws::new(11, u64::from(event)));
            least <= energy && energy <= greatest
        }));
    }
    assert_eq!(Profile::default().energy(5.0, Draws::new(11, 0)), 5.0);
}

/// A Gaussian has ⟨θ²⟩ = 2σ², as each of two planes has σ²; a cone has sin²(θ/2) even up to its edge; any azimuth.
#[test]
fn directions_have_the_moments_of_their_distribution() {
    let gaussian = with_directions(Spread::Gaussian(0.05));
    near(|draws| gaussian.direction(draws).tilt.powi(2), 2.0 * 0.05 * 0.05);
    near(|draws| gaussian.direction(draws).tilt.powi(4), 8.0 * 0.05_f64.powi(4));
    let half_angle = 1.1;
    let cone = with_directions(Spread::Uniform(half_angle));
    let rim = (0.5 * half_angle).sin().powi(2);
    let part = |draws| (0.5 * cone.direction(draws).tilt).sin().powi(2) / rim;
    near(part, 0.5);
    near(|draws| part(draws).powi(2), 1.0 / 3.0);
    near(|draws| cone.direction(draws).azimuth.cos(), 0.0);
    near(|draws| cone.direction(draws).azimuth.sin(), 0.0);
    assert!((0..EVENTS).all(|event| part(Draws::new(11, u64::from(event))) <= 1.0 + 1e-15));
    assert_eq!(Profile::default().direction(Draws::new(11, 0)), Direction { tilt: 0.0, azimuth: 0.0 });
}

/// The part of a Gaussian spot within b is (1 − e^(−b²/2σ²))/(1 − e^(−b_max²/2σ²)), and its inverse gives b back.
#[test]
fn spots_have_their_closed_form() {
    let b_max = 2.0;
    for spot in [0.3, 1.0, 2.0, 40.0] {
        let profile = Profile { spot: Some(spot), ..Profile::default() };
        let half = 0.5 * (b_max / spot) * (b_max / spot);
        for step in 0..=50 {
            let share = f64::from(step) / 50.0;
            let expected = (-half * share).exp_m1() / (-half).exp_m1();
            let part = profile.part(b_max, share);
            // 1 − e^(−x) loses what e^(−x) is rounded by, 1e-16 of the x of the whole disc.
            let loss = 4e-16 * (1.0 + 1.0 / half.min(1.0));
            assert!((part - expected).abs() <= loss, "{spot}: {part} {expected}");
            // What is far out on the spot's flank is told no better by the part that is within.
            let slope = (-(-half).exp_m1() / half) * (half * share).exp();
            assert!(
                (profile.share(b_max, part) - share).abs() <= 4.0 * loss * slope.max(1.0),
                "{spot} {share}"
            );
        }
        assert_eq!((profile.share(b_max, 0.0), profile.part(b_max, 0.0)), (0.0, 0.0));
    }
    let even = Profile::default();
    assert_eq!((even.share(b_max, 0.37), even.part(b_max, 0.37)), (0.37, 0.37));
}

/// cos of the whole turn = cos θ cos t − sin θ sin t cos φ; a recoil goes off on the other side; small turns add as
/// vectors to the last digits, which no arc cosine could.
#[test]
fn turns_add_on_the_sphere() {
    for tilt in [0.0_f64, 1e-9, 0.2, 1.4] {
        for angle in [0.0_f64, 1e-9, 0.7, 3.0] {
            for azimuth in [0.0_f64, 0.9, 2.5, 4.0] {
                let direction = Direction { tilt, azimuth };
                for (recoil, side) in [(false, 1.0_f64), (true, -1.0)] {
                    let cosine =
                        angle.cos() * tilt.cos() - side * angle.sin() * tilt.sin() * f64::cos(azimuth);
                    assert!((direction.turned(angle, recoil).cos() - cosine).abs() < 1e-15);
                }
            }
        }
    }
    let small = |azimuth| Direction { tilt: 3e-9, azimuth }.turned(4e-9, false);
    assert!((small(0.0) / 7e-9 - 1.0).abs() < 1e-15);
    assert!((small(FRAC_PI_2) / 5e-9 - 1.0).abs() < 1e-15);
    assert!((Direction { tilt: 3e-9, azimuth: 0.0 }.turned(4e-9, true) / 1e-9 - 1.0).abs() < 1e-15);
}

#[test]
fn what_no_beam_has_is_refused_by_name() {
    let spot = |spot| Profile { spot: Some(spot), ..Profile::default() };
    for (profile, named) in [
        (with_energies(Spread::Gaussian(1.0 / 6.0)), "energy_spread"),
        (with_energies(Spread::Uniform(1.0)), "energy_spread"),
        (with_directions(Spread::Gaussian(0.27)), "divergence"),
        (with_directions(Spread::Uniform(1.6)), "divergence"),
        (spot(1e-7), "spot"),
        (spot(1e4), "spot"),
    ] {
        let refused = profile.check(1.0, 2.0);
        assert!(
            matches!(&refused, Err(Error::InvalidInput { argument, .. }) if argument == named),
            "{refused:?}"
        );
    }
    let most = Profile {
        energy_spread: Some(Spread::Gaussian(0.16)),
        divergence: Some(Spread::Uniform(FRAC_PI_2)),
        spot: Some(2e-6),
    };
    assert!(most.check(1.0, 2.0).is_ok());
    for (name, size) in [("gaussian", 0.0), ("uniform", f64::NAN), ("gauss", 1.0)] {
        assert!(Spread::named("divergence", name, size).is_err());
    }
}
