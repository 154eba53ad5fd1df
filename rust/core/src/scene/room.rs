//! Room for columns, kept for the next run.
//!
//! The one idea: pages fresh from the system cost a run of cheap steps as much as its steps (each is zeroed and
//! mapped at its first touch), so what one trajectory no longer needs, the next one fills again.

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

/// An empty vector with room for `len` numbers.
pub fn take(len: usize) -> Vec<f64> {
    // Not one much too large: it would be held as long as its small contents.
    let fits = |room: &Vec<f64>| (len..=2 * len).contains(&room.capacity());
    let kept = if len < SMALLEST {
        None
    } else {
        with_rooms(|rooms| rooms.iter().rposition(fits).map(|index| rooms.remove(index))).flatten()
    };
    kept.unwrap_or_else(|| Vec::with_capacity(len))
}

/// Keeps the room of a vector for the next [`take`]; the oldest rooms go when there are too many.
pub fn give_back(mut room: Vec<f64>) {
    if (SMALLEST..=KEPT).contains(&room.capacity()) {
        room.clear();
        let _ = with_rooms(|rooms| {
            rooms.push(room);
            while rooms.iter().map(Vec::capacity).sum::<usize>() > KEPT {
                drop(rooms.remove(0));
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One test, because the rooms are shared by all threads of a process.
    #[test]
    fn rooms_come_back_empty_and_only_where_they_fit() {
        let len = SMALLEST + 12_345;
        let mut first = take(len);
        first.resize(len, 1.0);
        let address = first.as_ptr();
        give_back(first);
        let much_smaller = take(len / 4);
        assert!(much_smaller.capacity() < len / 2);
        let larger = take(len + 1);
        assert!(larger.capacity() > len && larger.as_ptr() != address);
        let again = take(len - 1);
        assert!(again.is_empty() && again.as_ptr() == address);

        give_back(Vec::with_capacity(KEPT + 1)); // More than is kept at all.
        for _ in 0..5 {
            give_back(Vec::with_capacity(KEPT / 2));
        }
        let kept = with_rooms(|rooms| rooms.iter().map(Vec::capacity).sum::<usize>());
        assert!(kept.is_some_and(|kept| (KEPT / 2..=KEPT).contains(&kept)), "{kept:?}");
    }
}
