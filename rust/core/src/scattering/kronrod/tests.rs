//! Both rules by themselves.

use super::RULE;

/// ∫₋₁¹ xⁿ dx by the weights of a column.
fn moment(column: usize, power: i32) -> f64 {
    RULE.iter().map(|row| row[column] * row[0].powi(power) * if row[0] == 0.0 { 1.0 } else { 2.0 }).sum()
}

/// 15 points are exact to degree 22, and the seven among them to degree 13; measured 3e-16.
#[test]
fn both_rules_integrate_polynomials_to_their_degrees() {
    for power in (0..=22).step_by(2) {
        let exact = 2.0 / f64::from(power + 1);
        assert!((moment(1, power) - exact).abs() < 1e-15, "{power}");
        if power <= 12 {
            assert!((moment(2, power) - exact).abs() < 1e-15, "{power}");
        }
    }
    assert!((moment(1, 24) - 2.0 / 25.0).abs() > 1e-15);
}
