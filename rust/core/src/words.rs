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

/// The nearest of the names, if it is near at all: the one that shares most letters with the word, in order.
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
    fn a_very_long_word_is_near_to_nothing() {
        assert_eq!(nearest(&"rk4".repeat(1_000_000), ["rk4"].into_iter()), None);
    }
}
