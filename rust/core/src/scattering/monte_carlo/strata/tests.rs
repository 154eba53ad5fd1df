use super::*;
use proptest::prelude::*;

const DRAWS: u64 = 1 << DRAW_BITS;

fn name(strata: Result<Strata>) -> String {
    match strata {
        Err(Error::InvalidInput { argument, .. }) => argument,
        other => panic!("{other:?}"),
    }
}

/// A ring of 2^-130 of the disc keeps sixteen digits of its impact parameters, and a boundary belongs to the ring beyond.
#[test]
fn shares_are_linear_in_each_ring() {
    let tiny = 2.0_f64.powi(-65);
    let strata = Strata::new(&[0.0, 3.0 * tiny, 1.5, 3.0], &[1.0, 1.0, 2.0]).unwrap();
    let quarter = DRAWS / 4;
    assert_eq!(
        [0, quarter - 1, quarter, 2 * quarter, DRAWS - 1].map(|draw| strata.stratum(draw)),
        [0, 0, 1, 2, 2]
    );
    assert_eq!([0, quarter, 2 * quarter].map(|draw| strata.share(draw)), [0.0, tiny * tiny, 0.25]);
    assert_eq!(strata.share(quarter / 2), 0.5 * tiny * tiny);
    assert!(strata.share(DRAWS - 1) < 1.0);
    assert_eq!(strata.boundaries().collect::<Vec<_>>(), [quarter, 2 * quarter]);
}

#[test]
fn one_ring_is_the_plain_disc() {
    let strata = Strata::new(&[0.0, 0.7], &[3.0]).unwrap();
    for draw in [0, 1, 12_345, DRAWS / 3, DRAWS - 1] {
        assert_eq!((strata.share(draw), strata.stratum(draw)), (draw as f64 * UNIT, 0));
    }
    assert_eq!(strata.weights(), [1.0]);
}

#[test]
fn what_are_no_strata_is_refused_by_name() {
    for edges in [&[][..], &[0.0], &[0.1, 1.0], &[f64::NAN, 1.0], &[0.0, f64::NAN], &[0.0, f64::INFINITY]] {
        assert_eq!(name(Strata::new(edges, &vec![1.0; edges.len().saturating_sub(1)])), "edges", "{edges:?}");
    }
    for edges in
        [[0.0, 1.0, 1.0], [0.0, 2.0, 1.0], [0.0, -1.0, 1.0], [0.0, f64::NAN, 1.0], [0.0, 1e-160, 1.0]]
    {
        assert_eq!(name(Strata::new(&edges, &[1.0, 1.0])), "edges", "{edges:?}");
    }
    for fractions in [&[1.0][..], &[1.0, 0.0], &[1.0, -1.0], &[f64::NAN, 1.0], &[1.0, f64::NAN], &[1.0, 9e-7]]
    {
        assert_eq!(name(Strata::new(&[0.0, 0.5, 1.0], fractions)), "fractions", "{fractions:?}");
    }
    assert_eq!(name(Strata::new(&[0.0, 0.5, 1.0], &[f64::MAX, f64::MAX])), "fractions");
    let many: Vec<f64> = (0..=MOST_STRATA + 1).map(|edge| edge as f64).collect();
    assert_eq!(name(Strata::new(&many, &vec![1.0; MOST_STRATA + 1])), "edges");
}

proptest! {
    /// Weights of all draws add up to all draws, of the rounded boundaries: no bias. And draws rise with shares, there and
    /// back.
    #[test]
    fn nothing_of_the_disc_is_lost(
        parts in prop::collection::vec((1e-6..1.0f64, 0.01..1.0f64), 1..20),
        draws in prop::collection::vec(0..DRAWS, 20),
    ) {
        let mut edges = vec![0.0];
        edges.extend(parts.iter().scan(0.0, |edge, (step, _)| { *edge += step; Some(*edge) }));
        let fractions: Vec<f64> = parts.iter().map(|(_, fraction)| *fraction).collect();
        let strata = Strata::new(&edges, &fractions).unwrap();
        let sum: f64 = strata.rings.iter().zip(strata.weights()).map(|(ring, weight)| ring.draws * weight).sum();
        // Twenty differences of squares are rounded.
        prop_assert!((sum * UNIT - 1.0).abs() < 1e-14);
        prop_assert_eq!(strata.rings.iter().map(|ring| ring.draws as u64).sum::<u64>(), DRAWS);
        let mut sorted = draws;
        sorted.extend(strata.boundaries().flat_map(|draw| [draw - 1, draw]));
        sorted.sort_unstable();
        for pair in sorted.windows(2) {
            prop_assert!(strata.share(pair[0]) <= strata.share(pair[1]));
        }
        for draw in sorted {
            // The share has 53 bits of which a ring far out uses few: back within what they tell apart.
            let back = strata.draw(strata.share(draw));
            let slack = strata.rings.iter().map(|ring| ring.draws * 4.0 * f64::EPSILON / ring.width).fold(2.0, f64::max);
            prop_assert!(back.abs_diff(draw) as f64 <= slack, "{} {}", back, draw);
        }
    }
}
