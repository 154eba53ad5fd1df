//! Against published and extrapolated cases, on both sides of the separatrix and on it.

use super::*;
use crate::rigid::quaternion::{dot, rotated};

fn w_last([w, x, y, z]: [f64; 4]) -> Quaternion {
    [x, y, z, w]
}

fn near(found: [f64; 3], wanted: [f64; 3], bound: f64, what: &str) {
    let off = (0..3).map(|at| (found[at] - wanted[at]).abs()).fold(0.0, f64::max);
    let size = dot(wanted, wanted).sqrt();
    assert!(off <= bound * size, "{what}: {found:?}, not {wanted:?}: {:e}", off / size);
}

/// Up to the sign.
fn same_rotation(found: Quaternion, wanted: Quaternion, bound: f64, what: &str) {
    let [x, y, z, _] = product(conjugate(wanted), found);
    let angle = 2.0 * dot([x, y, z], [x, y, z]).sqrt();
    assert!(angle <= bound, "{what}: {found:?}, not {wanted:?}: {angle:e}");
}

fn over(m: [f64; 3], moments: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|at| m[at] / moments[at])
}

#[test]
fn the_case_of_hairer_and_vilmart() -> Result<()> {
    let moments = [0.6, 0.8, 1.0];
    let body =
        FreeRotation::new(moments, over([1.8, 0.4, -0.9], moments), super::super::quaternion::IDENTITY)?;
    let polhode = body.polhode();
    assert!((polhode.period - 6.862_616_178_058_117).abs() < 2e-15, "{}", polhode.period);
    assert!((polhode.modulus.powi(2) - 0.165_454_545_454_545_45).abs() < 1e-16);
    let ten = body.state(10.0);
    near(
        ten.angular_momentum,
        [1.765_962_508_518_207_5, -0.695_464_197_033_089_1, 0.779_554_981_481_871_1],
        4e-15,
        "m 10",
    );
    same_rotation(
        ten.orientation,
        w_last([
            -0.736_061_364_160_793_9,
            -0.570_786_951_240_350_7,
            -0.299_388_571_830_790_1,
            -0.206_839_086_104_673_2,
        ]),
        1e-14,
        "q 10",
    );
    // The moments are rounded decimals: 3 ε of 150 rad.
    let hundred = body.state(100.0);
    near(
        hundred.angular_momentum,
        [1.813_980_481_719_941_3, 0.158_953_342_748_450_2, 0.945_626_060_749_270_8],
        1e-13,
        "m 100",
    );
    same_rotation(
        hundred.orientation,
        w_last([
            0.838_169_770_474_586_4,
            -0.401_161_607_031_241_8,
            0.366_000_136_740_688_7,
            0.050_839_952_915_870_07,
        ]),
        1e-13,
        "q 100",
    );
    Ok(())
}

#[test]
fn tumbling_boxes() -> Result<()> {
    let box_of = |a: f64, b: f64, c: f64| [b * b + c * c, a * a + c * c, a * a + b * b];
    let gazebo =
        FreeRotation::new(box_of(0.1, 0.4, 0.9), [0.1, 5.0, 0.1], super::super::quaternion::IDENTITY)?;
    assert!((gazebo.polhode().period - 6.056_844_158_015_676).abs() < 1e-13, "{}", gazebo.polhode().period);
    let ten = gazebo.state(10.0);
    // The rounding of the sides amplified: 1 - k² = 1.4e-4.
    near(
        ten.angular_velocity,
        [2.755_840_405_146_849_4, -3.735_963_519_216_22, -3.161_809_003_467_513_3],
        1e-12,
        "w",
    );
    same_rotation(
        ten.orientation,
        w_last([
            0.225_164_563_413_958_16,
            -0.619_927_562_499_452_5,
            -0.277_029_150_687_194_6,
            0.698_745_723_640_310_1,
        ]),
        1e-12,
        "q",
    );
    let moments = [13.0 / 300.0, 1.0 / 30.0, 1.0 / 60.0];
    let mujoco = FreeRotation::new(moments, [1.0, 2.0, 3.0], super::super::quaternion::IDENTITY)?;
    assert!((mujoco.polhode().period - 3.671_847_302_652_354).abs() < 4e-15);
    let five = mujoco.state(5.0);
    near(
        five.angular_velocity,
        [0.280_861_940_814_600_5, -2.432_266_939_712_798, 2.750_101_480_033_983],
        1e-14,
        "w",
    );
    same_rotation(
        five.orientation,
        w_last([
            -0.364_863_742_986_862_6,
            0.023_563_357_342_588_683,
            0.021_262_001_052_007_397,
            -0.930_519_824_912_734_8,
        ]),
        2e-14,
        "q",
    );
    let principia = FreeRotation::of_any_moments(
        [3.0, 5.0, 9.0],
        [0.0, 0.4, 0.01 / 9.0],
        super::super::quaternion::IDENTITY,
    )?;
    assert!((principia.polhode().period - 118.110_887_046_385_74).abs() < 2e-13);
    Ok(())
}

#[test]
fn the_ladder_to_the_separatrix() -> Result<()> {
    let cases = [
        (1e-4, [4.795_963_175_004_112_8e-4, -1.999_999_779_987_360_1, 8.660_472_754_300_806e-4]),
        (1e-8, [-0.101_816_317_520_899_4, -1.989_606_430_916_912_3, 0.176_351_034_985_764_74]),
        (1e-12, [-0.003_918_420_164_742_597, 1.999_984_645_924_475_6, 0.006_786_902_810_736_587]),
    ];
    for (e, wanted) in cases {
        let body = FreeRotation::new([1.0, 2.0, 3.0], [e, 1.0, e], super::super::quaternion::IDENTITY)?;
        near(body.state(40.0).angular_momentum, wanted, 2e-15, &format!("{e:e}"));
    }
    Ok(())
}

#[test]
fn it_obeys_its_equations_everywhere() -> Result<()> {
    let bodies: Vec<([f64; 3], [f64; 3])> = vec![
        ([1.0, 2.0, 2.5], [0.3, 0.4, 0.5]),
        ([2.5, 1.0, 2.0], [-0.3, 0.4, -0.5]),
        ([2.0, 2.5, 1.0], [0.9, -0.1, 0.05]),
        ([1.0, 2.0, 2.5], [-0.9, -0.4, 0.01]),
        ([1.0, 1.0, 1.5], [0.3, 0.4, -0.5]),
        ([1.5, 1.0, 1.5], [0.3, 0.4, -0.5]),
        ([1.0, 1.0, 1.0], [0.3, 0.4, -0.5]),
        ([1.0, 1.0 + 1e-15, 1.5], [0.3, 0.4, 0.5]),
        ([1.0, 1.5, 1.5 + 4e-16], [0.3, 0.4, 0.5]),
        ([1.0, 2.0, 2.0], [1e-9, 0.4, 0.5]),
        ([1.0, 2.0, 3.0], [1e-3, 1.0, 1e-3]),
        ([1.0, 2.0, 3.0], [1e-3, -1.0, -1e-3]),
        ([1.0, 2.0, 3.0], [1.0, 0.5, 1.0 / 3.0_f64.sqrt()]),
        ([1.0, 2.0, 3.0], [1e-100, 1.0, 1e-100]),
        ([1.0, 2.0, 3.0], [0.0, 1.0, 0.0]),
        ([1.0, 2.0, 3.0], [0.0, 1.0, 1e-20]),
        ([1.0, 2.0, 3.0], [1e-20, 0.0, 1.0]),
        ([1e-6, 1.0, 1.0 + 5e-7], [200.0, 0.5, 0.3]),
        ([0.0, 1.0, 1.0], [0.0, 0.5, 0.3]),
    ];
    let start = [0.5, -0.5, 0.5, 0.5];
    for (moments, spin) in bodies {
        let what = format!("{moments:?} {spin:?}");
        let body = FreeRotation::new(moments, spin, start)?;
        let first = body.state(0.0);
        let size = dot(spin, spin).sqrt();
        near(first.angular_velocity, spin, 1e-15, &what);
        same_rotation(first.orientation, start, 2e-15, &what);
        let momentum: [f64; 3] = core::array::from_fn(|at| moments[at] * spin[at]);
        let in_space = rotated(start, momentum);
        for t in [-30.0, -3.1, -0.4, 0.0, 0.9, 2.7, 8.3, 40.0] {
            let t = t / size;
            let now = body.state(t);
            let phase = 1e-14 + 8.0 * f64::EPSILON * (t * size).abs();
            near(rotated(now.orientation, now.angular_momentum), in_space, phase, &what);
            // Euler's equations and q̇ = ½ q ω by sixth-order differences.
            let h = 1e-2 / size;
            let [a, b, c] = [1.0, 2.0, 3.0].map(|n| (body.state(t - n * h), body.state(t + n * h)));
            let slope = |part: &dyn Fn(&State) -> f64| {
                let apart = |(before, after): &(State, State)| part(after) - part(before);
                (45.0 * apart(&a) - 9.0 * apart(&b) + apart(&c)) / (60.0 * h)
            };
            let w = now.angular_velocity;
            let torque = crate::rigid::quaternion::cross(now.angular_momentum, w);
            let fast = w.iter().fold(size, |most, part| most.max(part.abs()));
            let bound = 3e-11 * fast;
            for at in 0..3 {
                let rate = slope(&|state| state.angular_momentum[at]);
                let scale = dot(momentum, momentum).sqrt();
                assert!((rate - torque[at]).abs() <= bound * scale, "{what} at {t}: {rate} {torque:?}");
            }
            let wanted = product(now.orientation, [0.5 * w[0], 0.5 * w[1], 0.5 * w[2], 0.0]);
            for at in 0..4 {
                let rate = slope(&|state| state.orientation[at]);
                assert!((rate - wanted[at]).abs() <= bound, "{what} at {t}: {at} {rate} {wanted:?}");
            }
        }
    }
    Ok(())
}
