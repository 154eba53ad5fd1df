use super::*;
use crate::numerics::elementary::Exponential;

fn of(function: impl Fn(f64) -> f64, range: [f64; 2], tolerance: f64) -> Result<Fit> {
    fit(&mut |r: &[f64]| Ok(r.iter().map(|&r| function(r)).collect()), range, tolerance, POTENTIAL)
}

fn piece(fit: &Fit, at: usize) -> [f64; TERMS] {
    core::array::from_fn(|k| fit.coefficients[TERMS * at + k])
}

#[test]
fn a_polynomial_is_one_piece() {
    let made = of(|r| ((r - 2.0) * r + 0.5) * r * r, [1.5, 2.5], 1e-12).unwrap();
    assert_eq!(made.breaks, [1.5, 2.5]);
    // In t = 2 (r − 2): (t/2 + 2)⁴ − 2 (t/2 + 2)³ + (t/2 + 2)²/2.
    for (k, expected) in [2.0, 5.0, 3.125, 0.75, 0.0625, 0.0, 0.0].into_iter().enumerate() {
        assert!((made.coefficients[k] - expected).abs() < 2e-11, "{k}: {}", made.coefficients[k]);
    }
}

#[test]
fn what_is_met_is_met_elsewhere_too_and_smoothly() {
    let function = |r: f64| 1.0 / r.powi(12) - 1.0 / r.powi(6) + Exponential::exp(-r);
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let made = of(function, [0.3, 9.0], tolerance).unwrap();
        assert!(made.error <= tolerance);
        let pieces = made.breaks.windows(2).enumerate();
        for (at, ends) in pieces {
            let (p, per) = (piece(&made, at), 2.0 / (ends[1] - ends[0]));
            for step in 0..100 {
                let t = f64::from(step) / 50.0 - 0.99;
                let r = 0.5 * (ends[0] + ends[1]) + t / per;
                let [value, slope, _] = derivatives(&p, t);
                let size = function(r).abs() + (ends[1] * slope * per).abs();
                // Between the checks it may be a little worse than in them.
                assert!((value - function(r)).abs() <= 2.0 * tolerance * size, "{tolerance} at {r}");
            }
            if at + 2 < made.breaks.len() {
                let next = 2.0 / (made.breaks[at + 2] - ends[1]);
                let (here, there) = (derivatives(&p, 1.0), derivatives(&piece(&made, at + 1), -1.0));
                for (order, (here, there)) in here.into_iter().zip(there).enumerate() {
                    let order = order as i32;
                    let (here, there) = (here * per.powi(order), there * next.powi(order));
                    assert!(
                        (here - there).abs() <= 1e-11 * here.abs().max(1.0 / ends[1].powi(order)),
                        "{order}"
                    );
                }
            }
        }
    }
}

#[test]
fn what_is_not_smooth_or_no_range_is_refused_by_name() {
    let refused = |outcome: Result<Fit>| match outcome {
        Err(Error::InvalidInput { argument, message }) => (argument, message),
        other => panic!("{other:?}"),
    };
    let (argument, message) = refused(of(|r| (r - 1.234).abs(), [1.0, 2.0], 1e-10));
    assert!(
        argument == "function" && message.contains("pieces it is met to") && message.contains("1.23"),
        "{message}"
    );
    let noise = |r: f64| 1.0 + 1e-7 * (1e9 * r).sin();
    assert_eq!(refused(of(noise, [1.0, 2.0], 1e-10)).0, "function");
    assert!(refused(of(|r| 1.0 / (r - 1.0), [1.0, 2.0], 1e-10)).1.contains("got inf at r = 1"));
    for (range, name) in [([-1.0, 1.0], "r_min"), ([2.0, 1.0], "r_max"), ([1.0, f64::INFINITY], "r_max")] {
        assert_eq!(refused(of(|r| r, range, 1e-10)).0, name);
    }
    for tolerance in [0.0, 1e-13, 1.0, f64::NAN] {
        assert_eq!(refused(of(|r| r, [1.0, 2.0], tolerance)).0, "tolerance");
    }
}

#[test]
fn nothing_beyond_a_smooth_cutoff_is_nothing() {
    let made = of(|r| if r < 2.0 { (2.0 - r).powi(9) } else { 0.0 }, [1.0, 3.0], 1e-10).unwrap();
    let last = piece(&made, made.breaks.len() - 2);
    assert_eq!(last, [0.0; TERMS]);
}
