//! Integrals by the rule of Gauss and Kronrod of 15 points, with the rule of Gauss of 7 in it as a check.
//!
//! Source: R. Piessens, E. de Doncker-Kapenga, C. W. Überhuber, D. K. Kahaner, *QUADPACK* (1983).

/// Places of the rule of 15 points, of those above 0, with their weights there and in the rule of 7.
const RULE: [[f64; 3]; 8] = [
    [0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0],
    [0.949_107_912_342_758_5, 0.063_092_092_629_978_55, 0.129_484_966_168_869_7],
    [0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0],
    [0.741_531_185_599_394_4, 0.140_653_259_715_525_92, 0.279_705_391_489_276_67],
    [0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0],
    [0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9],
    [0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0],
    [0.0, 0.209_482_141_084_727_83, 0.417_959_183_673_469_4],
];
/// How many points it has.
pub(super) const POINTS: usize = 15;
/// Where both rules agree to this part, the rest is rounding, and halving would find more of it.
const AGREED: f64 = 16.0 * f64::EPSILON;

/// What both rules say of an interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    pub(super) integral: f64,
    /// How far that may be off.
    pub(super) error: f64,
    /// The integral of the size of what is integrated.
    pub(super) size: f64,
}

/// The k-th point between two ends.
#[inline(always)]
pub(super) fn place([from, to]: [f64; 2], k: usize) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    if k < 8 { half.mul_add(-RULE[k][0], middle) } else { half.mul_add(RULE[14 - k][0], middle) }
}

/// Of the values at all points.
#[inline(always)]
pub(super) fn estimate([from, to]: [f64; 2], value: impl Fn(usize) -> f64) -> Estimate {
    let half = 0.5 * (to - from);
    let (mut fifteen, mut seven, mut size) = (0.0, 0.0, 0.0);
    for k in 0..POINTS {
        let ([_, more, less], value) = (RULE[k.min(14 - k)], value(k));
        fifteen += more * value;
        seven += less * value;
        size += more * value.abs();
    }
    let (off, size) = (half * (fifteen - seven).abs(), half * size);
    let share = off / size;
    // The rule of 15 points is that much better than that of 7.
    let grown = 200.0 * share;
    let error = if off <= AGREED * size { 0.0 } else { size * (grown * grown.sqrt()).min(share) };
    Estimate { integral: half * fifteen, error, size }
}

#[cfg(test)]
mod tests;
