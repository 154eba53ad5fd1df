use super::*;
use crate::numerics::binary::Binary;
use proptest::prelude::*;

/// What every tier must agree on, bit for bit.
#[inline(always)]
fn exercise<V: Vector8 + Binary>(input: &[Lanes; 3]) -> [Lanes; 22] {
    let [a, b, c] = input.map(V::load);
    let mask = a.less(b).or(b.less_equal(c).not());
    let [first, second, third] = V::interleave(a, b, c);
    let [sum_a, sum_b, sum_c] = V::sums_in_lanes(mask, [a, b, c], [b, c, a]);
    let mut written = [Lanes([0.0; WIDTH]); 2];
    // From the second number on: nothing asks for alignment.
    // SAFETY: fifteen numbers lie there.
    unsafe { a.write_where(mask, as_numbers_mut(&mut written)[1..].as_mut_ptr()) };
    [
        a + b * c,
        a / b - c,
        a.abs().sqrt(),
        a.max(b).min(c),
        V::select(mask, a, -b),
        a.permute(&[7, 0, 3, 3, 1, 2, 6, 5]),
        V::splat(a.store().horizontal_sum()),
        a.sum_in_every_lane(),
        a.scaled_by(DoubleDouble::PI).0,
        a.scaled_by(DoubleDouble::PI).1,
        a.multiply_add(b, c),
        a.multiply_subtract_from(b, c),
        (a * a).inverse_root_guess(),
        a.leading_bits(),
        sum_a,
        sum_b,
        sum_c,
        first,
        second,
        third,
        V::load(written[0]),
        V::load(written[1]),
    ]
    .map(V::store)
}

crate::tiered! {
    fn exercised[][](input: &[Lanes; 3]) -> [Lanes; 22] = exercise;
}

fn bits(lanes: [Lanes; 22]) -> Vec<u64> {
    lanes.iter().flat_map(|lane| lane.0.map(f64::to_bits)).collect()
}

proptest! {
    #[test]
    fn every_tier_gives_the_same_bits(numbers in prop::array::uniform24(-1e9..1e9f64)) {
        let mut input = [Lanes([0.0; WIDTH]); 3];
        for (index, number) in numbers.into_iter().enumerate() {
            input[index / WIDTH].0[index % WIDTH] = number;
        }
        let expected = bits(exercise::<Lanes>(&input));
        prop_assert_eq!(&bits(exercised(&input)), &expected);
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            #[target_feature(enable = "avx2,fma")]
            fn avx2(input: &[Lanes; 3]) -> [Lanes; 22] {
                exercise::<Avx2>(input)
            }
            // SAFETY: the machine has AVX2 and FMA.
            prop_assert_eq!(&bits(unsafe { avx2(&input) }), &expected);
        }
    }
}

/// Every operation on words, and what is lost on the way down.
#[inline(always)]
fn exercise_words<V: Vector8>(a: [u64; WIDTH], b: [u64; WIDTH]) -> [u64; 2 * WIDTH] {
    let (a, b) = (V::Words::load(a), V::Words::load(b));
    let mixed = a.product(0xd251_1f53) ^ b.shifted_down::<11>() ^ V::Words::splat(0x0123_4567_89ab_cdef);
    let mut words = [0; 2 * WIDTH];
    mixed.below(b).interleave(a.below(mixed), &mut words);
    words
}

crate::tiered! {
    fn exercised_words[][](a: [u64; WIDTH], b: [u64; WIDTH]) -> [u64; 2 * WIDTH] = exercise_words;
}

proptest! {
    #[test]
    fn words_are_those_of_integers_on_every_tier(a: [u64; WIDTH], b: [u64; WIDTH]) {
        let half = |x: u64| x & 0xffff_ffff;
        let expected: Vec<u64> = a
            .into_iter()
            .zip(b)
            .flat_map(|(a, b)| {
                let mixed = (half(a) * 0xd251_1f53) ^ (b >> 11) ^ 0x0123_4567_89ab_cdef;
                [half(b) << 32 | half(mixed), half(mixed) << 32 | half(a)]
            })
            .collect();
        prop_assert_eq!(&exercise_words::<Lanes>(a, b)[..], &expected[..]);
        prop_assert_eq!(&exercised_words(a, b)[..], &expected[..]);
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            #[target_feature(enable = "avx2,fma")]
            fn avx2(a: [u64; WIDTH], b: [u64; WIDTH]) -> [u64; 2 * WIDTH] {
                exercise_words::<Avx2>(a, b)
            }
            // SAFETY: the machine has AVX2 and FMA.
            prop_assert_eq!(&unsafe { avx2(a, b) }[..], &expected[..]);
        }
    }
}

#[test]
fn interleaved_coordinates_are_points() {
    let coordinates: [Lanes; 3] =
        core::array::from_fn(|c| Lanes(core::array::from_fn(|lane| (3 * lane + c) as f64)));
    let [x, y, z] = coordinates;
    let points = Lanes::interleave(x, y, z);
    let counted: Vec<f64> = (0..24).map(f64::from).collect();
    assert_eq!(as_numbers(&points), counted);
}

#[test]
fn only_the_lanes_of_the_mask_are_written() {
    let lanes = Lanes(core::array::from_fn(|lane| lane as f64));
    let mut written = [-1.0; WIDTH];
    // SAFETY: eight numbers lie there.
    unsafe { lanes.write_where(Bits(0b0110_0001), written.as_mut_ptr()) };
    assert_eq!(written, [0.0, -1.0, -1.0, -1.0, -1.0, 5.0, 6.0, -1.0]);
}
