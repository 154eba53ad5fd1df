//! How much memory there is, so that what does not fit is refused by name before anything runs.
//!
//! A system that promises pages it does not have ends the process when they are touched; asking it first is all one can
//! do. Where it does not tell, the allocator's own refusal is what remains.

use crate::error::{Error, Result};
use std::fs::read_to_string;

/// Less than this is not worth asking for.
const SMALL: usize = 64 * 1024 * 1024;

/// Refuses an argument that asks for more bytes than there are; `None` is more than can be counted.
///
/// # Errors
/// `InvalidInput` with the bytes needed and those available.
pub fn check(argument: &str, what: &str, bytes: Option<usize>, cure: &str) -> Result<()> {
    match bytes {
        Some(bytes) if bytes < SMALL => Ok(()),
        Some(bytes) if available().is_none_or(|available| bytes <= available) => Ok(()),
        _ => Err(refusal(argument, what, bytes, cure)),
    }
}

/// What to do where an argument asks for more than fits.
const CURE: &str = "ask for fewer at a time";

/// The values, for which there is room or the argument is refused.
///
/// # Errors
/// As [`check`].
pub fn collected<T>(argument: &str, what: &str, values: impl ExactSizeIterator<Item = T>) -> Result<Vec<T>> {
    let mut all = room(argument, what, Some(values.len()))?;
    all.extend(values);
    Ok(all)
}

/// An empty vector with room for so many values.
///
/// # Errors
/// As [`check`].
pub fn room<T>(argument: &str, what: &str, len: Option<usize>) -> Result<Vec<T>> {
    let bytes = len.and_then(|len| len.checked_mul(size_of::<T>()));
    check(argument, what, bytes, CURE)?;
    let mut values = Vec::new();
    values.try_reserve_exact(len.unwrap_or(0)).map_err(|_| refusal(argument, what, bytes, CURE))?;
    Ok(values)
}

/// Empty vectors with room for so many numbers each.
///
/// # Errors
/// As [`check`].
pub fn reserved<const K: usize>(argument: &str, what: &str, len: Option<usize>) -> Result<[Vec<f64>; K]> {
    let bytes = len.and_then(|len| len.checked_mul(K * size_of::<f64>()));
    check(argument, what, bytes, CURE)?;
    let mut vectors = [const { Vec::new() }; K];
    for vector in &mut vectors {
        vector.try_reserve_exact(len.unwrap_or(0)).map_err(|_| refusal(argument, what, bytes, CURE))?;
    }
    Ok(vectors)
}

/// The refusal itself.
pub fn refusal(argument: &str, what: &str, bytes: Option<usize>, cure: &str) -> Error {
    let needed = bytes.map_or("more bytes than can be counted".to_owned(), in_words);
    let have = available()
        .map_or("not available".to_owned(), |bytes| format!("and {} are available", in_words(bytes)));
    Error::invalid(argument, format!("{what} would take {needed}, {have}; {cure}"))
}

fn in_words(bytes: usize) -> String {
    let gigabytes = bytes as f64 / 1e9;
    if gigabytes < 0.1 { format!("{bytes} bytes") } else { format!("{bytes} bytes ({gigabytes:.1} GB)") }
}

/// The bytes that can still be had, where the system tells: what is available, within the limit of the process.
pub fn available() -> Option<usize> {
    let free = in_kilobytes(&read_to_string("/proc/meminfo").ok()?, "MemAvailable:");
    let limit = read_to_string("/proc/self/limits").ok().and_then(|limits| address_space(&limits));
    let left = limit.and_then(|limit| {
        let used = in_kilobytes(&read_to_string("/proc/self/status").ok()?, "VmSize:")?;
        Some(limit.saturating_sub(used))
    });
    match (free, left) {
        (Some(free), Some(left)) => Some(free.min(left)),
        (free, left) => free.or(left),
    }
}

/// A number of a table of numbers of kilobytes.
fn in_kilobytes(table: &str, name: &str) -> Option<usize> {
    let line = table.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse::<usize>().ok()?.checked_mul(1024)
}

/// The soft limit of the address space, if there is one.
fn address_space(limits: &str) -> Option<usize> {
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read_as_the_system_writes_them() {
        assert_eq!(in_kilobytes("MemFree: 7 kB\nMemAvailable:   23 kB\n", "MemAvailable:"), Some(23 * 1024));
        let limits =
            "Max data size   unlimited unlimited bytes\nMax address space         4096 unlimited bytes\n";
        assert_eq!(address_space(limits), Some(4096));
        assert_eq!(address_space(&limits.replace("4096", "unlimited")), None);
    }

    #[test]
    fn what_does_not_fit_is_refused_with_both_numbers() {
        assert!(check("t", "it", Some(1000), "").is_ok());
        let refused = check("t", "it", Some(1 << 60), "ask for less").map_err(|error| error.to_string());
        let uncounted = check("t", "it", None, "ask for less").map_err(|error| error.to_string());
        let expected = "t: it would take 1152921504606846976 bytes (1152921504.6 GB), ";
        assert!(cfg!(not(target_os = "linux")) || refused.is_err_and(|text| text.starts_with(expected)));
        assert!(uncounted.is_err_and(|text| text.contains("can be counted")));
    }
}
