//! Room for columns, kept for the next run.
//!
//! The one idea: pages fresh from the system cost a run of cheap steps as much as its steps (each is zeroed and
//! mapped at its first touch), so what one trajectory no longer needs, the next one fills again.

use crate::error::Error;
use crate::memory;
use std::alloc::{Layout, alloc_zeroed};
use std::sync::{Mutex, TryLockError};

/// Smaller rooms come from pages that the allocator already has.
const SMALLEST: usize = 64 * 1024 / size_of::<f64>();
/// The most that is kept, over all rooms.
const KEPT: usize = 64 * 1024 * 1024 / size_of::<f64>();

/// The rooms kept, the one given back last at the end.
static ROOMS: Mutex<Vec<Vec<f64>>> = Mutex::new(Vec::new());

/// Does something with the rooms, unless another thread (or, after a fork, a thread that is no more) has them.
fn with_rooms<T>(action: impl FnOnce(&mut Vec<Vec<f64>>) -> T) -> Option<T> {
    match ROOMS.try_lock() {
        Ok(mut rooms) => Some(action(&mut rooms)),
        Err(TryLockError::Poisoned(rooms)) => Some(action(&mut rooms.into_inner())),
        Err(TryLockError::WouldBlock) => None,
    }
}

/// A vector of `len` numbers of any value; `None` if there is no room for it.
pub fn take(len: usize) -> Option<Vec<f64>> {
    // Not one much too large: it would be held as long as its small contents.
    let fits = |room: &Vec<f64>| room.len() >= len && room.capacity() / 2 <= len;
    let kept = if len < SMALLEST {
        None
    } else {
        with_rooms(|rooms| rooms.iter().rposition(fits).map(|index| rooms.remove(index))).flatten()
    };
    match kept {
        Some(mut room) => {
            room.truncate(len);
            Some(room)
        }
        None => zeros(len),
    }
}

/// Zeros that cost nothing before they are touched, if the system has pages for them.
fn zeros(len: usize) -> Option<Vec<f64>> {
    if len == 0 {
        return Some(Vec::new());
    }
    let layout = Layout::array::<f64>(len).ok()?;
    // SAFETY: the layout is not empty.
    let numbers = unsafe { alloc_zeroed(layout) }.cast::<f64>();
    // SAFETY: the allocator made room for `len` numbers of this layout, all of them zero.
    (!numbers.is_null()).then(|| unsafe { Vec::from_raw_parts(numbers, len, len) })
}

/// Why there is no room for the arrays of a run.
pub(super) fn refusal(bytes: Option<usize>) -> Error {
    memory::refusal("t", "the columns", bytes, "ask for fewer times, record fewer columns, or run in parts")
}

/// Keeps the room of a vector for the next [`take`]; the oldest rooms go when there are too many.
pub fn give_back(room: Vec<f64>) {
    if (SMALLEST..=KEPT).contains(&room.len()) {
        let _ = with_rooms(|rooms| {
            rooms.push(room);
            while rooms.iter().map(Vec::capacity).sum::<usize>() > KEPT {
                drop(rooms.remove(0));
            }
        });
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// One test, because the rooms are shared by all threads of a process.
    #[test]
    fn rooms_come_back_only_where_they_fit() {
        let len = SMALLEST + 12_345;
        let mut first = take(len).unwrap();
        first.fill(1.0);
        let address = first.as_ptr();
        give_back(first);
        let much_smaller = take(len / 4).unwrap();
        assert!(much_smaller.capacity() < len / 2);
        let larger = take(len + 1).unwrap();
        assert!(larger.len() == len + 1 && larger.as_ptr() != address);
        let again = take(len - 1).unwrap();
        assert!(again.len() == len - 1 && again.as_ptr() == address);
        assert!(take(usize::MAX / 16).is_none() && take(usize::MAX).is_none(), "refused, and no abort");

        give_back(zeros(KEPT + 1).unwrap()); // More than is kept at all.
        for _ in 0..5 {
            give_back(zeros(KEPT / 2).unwrap());
        }
        let kept = with_rooms(|rooms| rooms.iter().map(Vec::capacity).sum::<usize>());
        assert!(kept.is_some_and(|kept| (KEPT / 2..=KEPT).contains(&kept)), "{kept:?}");
    }
}
