//! The words of refusals: numbers as Python prints them, and the nearest of the known names.

use crate::error::Error;

/// A number as Python prints it: the shortest digits that give it back, and a point or an exponent.
///
/// ```
/// use visviva_core::words::number;
/// assert_eq!([-1.0, 0.25, 1e-15, 1e16, f64::NAN].map(number), ["-1.0", "0.25", "1e-15", "1e+16", "nan"]);
/// ```
pub fn number(value: f64) -> String {
    if value.is_nan() {
        return "nan".to_owned();
    }
    let scientific = format!("{value:e}");
    match scientific.split_once('e').and_then(|(digits, power)| Some((digits, power.parse::<i32>().ok()?))) {
        Some((digits, power)) if !(-4..16).contains(&power) => {
            format!("{digits}e{}{:02}", if power < 0 { '-' } else { '+' }, power.abs())
        }
        // Infinities have no exponent; Rust prints them as Python does.
        None => scientific,
        // With the digit after the point that tells a float from an integer.
        Some(_) if value.fract() == 0.0 => format!("{value:.1}"),
        Some(_) => value.to_string(),
    }
}

/// Several numbers as Python prints a list of them.
pub fn numbers(values: &[f64]) -> String {
    format!("[{}]", values.iter().copied().map(number).collect::<Vec<_>>().join(", "))
}

/// The nearest of the names, if one is the word misspelt, or has it in it: of those that are, the one that shares most
/// letters with it, in order. Letters that are shared by chance make no name near.
///
/// Capitals do not count, and `-`, `_` and a space are the same. Of equally near names the first is taken.
pub fn nearest<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let word = folded(word);
    let mut best: Option<(usize, usize, &str)> = None;
    for name in names {
        let known = folded(name);
        let letters = word.len() + known.len();
        // Half of the letters of both must be shared, which words of very different lengths cannot do.
        if letters == 0 || 4 * word.len().min(known.len()) < letters {
            continue;
        }
        if !is_near(&word, &known) {
            continue;
        }
        let shared = shared(&word, &known);
        if 4 * shared >= letters && best.is_none_or(|(most, of, _)| shared * of > most * letters) {
            best = Some((shared, letters, name));
        }
    }
    best.map(|(_, _, name)| name)
}

/// "expected one of …, got 'x'; did you mean 'y'?"
pub fn unknown<'a>(argument: &str, word: &str, names: impl Iterator<Item = &'a str> + Clone) -> Error {
    let list: Vec<&str> = names.clone().collect();
    let hint = nearest(word, names).map(|name| format!("; did you mean '{name}'?")).unwrap_or_default();
    Error::invalid(argument, format!("expected one of {}, got '{word}'{hint}", list.join(", ")))
}

fn folded(word: &str) -> Vec<char> {
    let one = |letter| if matches!(letter, '-' | ' ') { '_' } else { letter };
    word.trim().chars().flat_map(char::to_lowercase).map(one).collect()
}

/// Whether one has the other in it, begins with most of it, or is it but for few slips.
fn is_near(word: &[char], known: &[char]) -> bool {
    let (short, long) = if word.len() < known.len() { (word, known) } else { (known, word) };
    let begins = (2 * long.len()).div_ceil(3); // velocities, velocity
    short.is_empty()
        || long.windows(short.len()).any(|part| part == short)
        || short.get(..begins).is_some_and(|part| long.starts_with(part))
        || slips(word, known) <= (long.len() / 3).clamp(1, 3)
}

/// How many letters are wrong, missing, too many, or swapped with the next: the optimal string alignment.
fn slips(word: &[char], known: &[char]) -> usize {
    let mut before = Vec::new();
    let mut row: Vec<usize> = (0..=known.len()).collect();
    for (i, &x) in word.iter().enumerate() {
        let two_before = core::mem::replace(&mut before, core::mem::replace(&mut row, vec![i + 1]));
        for (j, &y) in known.iter().enumerate() {
            let mut least = (before[j] + usize::from(x != y)).min(before[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && x == known[j - 1] && y == word[i - 1] {
                least = least.min(two_before[j - 1] + 1);
            }
            row.push(least);
        }
    }
    row[known.len()]
}

/// The length of the longest common subsequence.
fn shared(a: &[char], b: &[char]) -> usize {
    let mut row = vec![0; b.len() + 1];
    for x in a {
        let mut diagonal = 0;
        for (j, y) in b.iter().enumerate() {
            let above = row[j + 1];
            row[j + 1] = if x == y { diagonal + 1 } else { above.max(row[j]) };
            diagonal = above;
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_python() {
        // As repr() of CPython prints them.
        let printed = [
            (0.0, "0.0"),
            (-0.0, "-0.0"),
            (1.0, "1.0"),
            (-1.0, "-1.0"),
            (2.3e-14, "2.3e-14"),
            (1e-5, "1e-05"),
            (0.0001, "0.0001"),
            (0.1 + 0.2, "0.30000000000000004"),
            (123456.75, "123456.75"),
            (9007199254740993.0, "9007199254740992.0"),
            (1e15, "1000000000000000.0"),
            (9999999999999998.0, "9999999999999998.0"),
            (1e16, "1e+16"),
            (-1.5e300, "-1.5e+300"),
            (5e-324, "5e-324"),
            (f64::MAX, "1.7976931348623157e+308"),
            (f64::INFINITY, "inf"),
            (f64::NEG_INFINITY, "-inf"),
            (f64::NAN, "nan"),
            (-f64::NAN, "nan"),
        ];
        for (value, text) in printed {
            assert_eq!(number(value), text);
        }
        assert_eq!(numbers(&[1.0, -0.5, 1e-7]), "[1.0, -0.5, 1e-07]");
        assert_eq!(numbers(&[]), "[]");
    }

    #[test]
    fn the_nearest_name_minds_neither_capitals_nor_separators() {
        let methods = ["auto", "rk4", "dop853", "leapfrog", "yoshida4", "kahan_li8"];
        for (word, meant) in [
            ("RK4", Some("rk4")),
            ("rk45", Some("rk4")),
            ("DOP-853", Some("dop853")),
            ("Leap Frog", Some("leapfrog")),
            ("leap_frog", Some("leapfrog")),
            ("Yoshida", Some("yoshida4")),
            ("kahan-li8", Some("kahan_li8")),
            ("Kahan Li 8", Some("kahan_li8")),
            (" kahanli8\n", Some("kahan_li8")),
            ("euler", None),
            ("verlet", None),
            ("", None),
        ] {
            assert_eq!(nearest(word, methods.into_iter()), meant, "{word:?}");
        }
        // Spelled differently, both are the same name: the first counts.
        assert_eq!(nearest("max step", ["max-step", "max_step"].into_iter()), Some("max-step"));
        assert_eq!(nearest("tol", ["rtol", "atol"].into_iter()), Some("rtol"));
        assert_eq!(nearest("energy", ["tally", "beam_energy"].into_iter()), Some("beam_energy"));
        assert_eq!(nearest("x", core::iter::empty()), None);
    }

    #[test]
    fn letters_that_are_shared_by_chance_make_no_name_near() {
        let columns = ["position", "velocity", "energy", "kinetic_energy", "virial", "angular_momentum"];
        for word in ["inertia", "entropy", "spin"] {
            assert_eq!(nearest(word, columns.into_iter()), None, "{word}");
        }
        for word in ["implicit", "symmetric"] {
            assert_eq!(nearest(word, ["midpoint", "symplectic_euler"].into_iter()), None, "{word}");
        }
        for (word, meant) in [("positoin", "position"), ("velocities", "velocity"), ("enrgy", "energy")] {
            assert_eq!(nearest(word, columns.into_iter()), Some(meant));
        }
    }

    #[test]
    fn a_very_long_word_is_near_to_nothing() {
        assert_eq!(nearest(&"rk4".repeat(1_000_000), ["rk4"].into_iter()), None);
    }
}
