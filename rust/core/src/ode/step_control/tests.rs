use super::*;

/// That of a method with the error exponent 8.
const RULE: &Rule<f64> =
    &Rule { power: 1 << (POWER_PLACES - 4), max_step: f64::INFINITY, limits: (SHRINK, GROW) };

/// A clock under way: a step of 1 was taken, and the next is 1 again.
fn under_way() -> Clock<f64> {
    let mut clock = Clock::new(10.0);
    clock.h = 1.0;
    assert!(clock.settle(true, 0.5, RULE).accepted);
    clock.h = 1.0;
    clock
}

#[test]
fn a_step_grows_after_a_good_one_but_not_right_after_a_bad_one() {
    let mut clock = under_way();
    assert!(clock.settle(true, 0.0, RULE).accepted);
    assert_eq!((clock.elapsed, clock.h), (2.0, GROW));

    let mut clock = under_way();
    assert!(!clock.settle(true, 1e300, RULE).accepted);
    assert_eq!((clock.elapsed, clock.h), (1.0, SHRINK));
    assert!(clock.settle(true, 0.0, RULE).accepted);
    assert_eq!(clock.h, SHRINK);
    assert!(clock.settle(true, 0.0, RULE).accepted);
    assert_eq!(clock.h, SHRINK * GROW);
}

#[test]
fn the_step_goes_with_the_root_that_the_estimate_has() {
    for exponent in 1..=20 {
        let rule = Rule::new(exponent, f64::INFINITY);
        for power in -12..=12 {
            let error = 10f64.powi(power);
            let exact = error.powf(1.0 / f64::from(exponent));
            let found = root(error * error, &rule);
            // The power is known to 1.2e-4: (1e12²)^0.00012 = 1.0067.
            assert!((found / exact - 1.0).abs() < 7e-3, "{exponent}: {found} for {exact}");
        }
    }
}

#[test]
fn no_step_is_longer_than_the_longest() {
    for sign in [1.0, -1.0] {
        let rule = Rule { max_step: 1.5, ..*RULE };
        let mut clock = Clock::new(100.0 * sign);
        clock.h = sign;
        for _ in 0..5 {
            assert!(clock.settle(true, 1e-20, &rule).accepted);
            assert_eq!(clock.h, 1.5 * sign);
        }
    }
}

#[test]
fn a_step_that_time_no_longer_feels_is_stuck() {
    let mut clock = under_way();
    let mut tries = 0;
    while !clock.settle(true, 1e300, RULE).stuck {
        assert!(clock.elapsed + clock.h > clock.elapsed, "a step of {:e}", clock.h);
        tries += 1;
    }
    // 3^-32 is the first power below 4ε.
    assert_eq!(tries, 31);
}

#[test]
fn time_keeps_what_rounding_leaves_out() {
    let mut clock = Clock::new(1e300);
    for h in [1e16, 0.75, 0.75, 0.75, 0.75] {
        clock.h = h;
        assert!(clock.settle(true, 0.5, RULE).accepted);
    }
    // Each 0.75 alone is lost beside 1e16; four of them are 3.
    assert_eq!((clock.elapsed - 1e16) + clock.error, 3.0);
}
