//! How much memory a recorded run may take.

/// The part of the free memory that a record may take. A list that grows takes twice what it holds,
/// and three times while it is copied to where it has room: with a quarter, as much is left to all
/// else.
const PART: u64 = 4;
/// No record takes more than this without being allowed to: 4 GiB.
const MOST: u64 = 4 << 30;
/// Records smaller than this, 16 MiB, do not ask how much is free: that takes as long as to write
/// a good part of them.
const FIRST: usize = 16 << 20;
/// A record asks again when it has grown by this part, since others may have grown beside it: with
/// n of them each ends at 1/(n + 3) of what was free, so that up to 48, each a sixteenth beyond,
/// find room together.
const AGAIN: usize = 16;

/// The limit on what a record takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Room {
    /// So many bytes.
    Given(usize),
    /// By how much is free.
    Free,
}

impl Room {
    /// When a record that begins is to ask, in bytes.
    pub(crate) const fn first(self) -> usize {
        match self {
            Self::Given(most) => most,
            Self::Free => FIRST,
        }
    }

    /// A record has come to `bytes`: when it is to ask again, or the limit that it has reached.
    pub(crate) fn ask(self, bytes: usize) -> Result<usize, usize> {
        match self {
            Self::Given(most) => Err(most),
            Self::Free => next(bytes, limit(available(), bytes)),
        }
    }

    /// Whether a record may be larger than one that ended at this limit.
    pub(crate) fn exceeds(self, most: usize) -> bool {
        match self {
            Self::Given(given) => given > most,
            Self::Free => limit(available(), 0) > most,
        }
    }
}

/// The limit on a record that takes `bytes` of the memory, of which so many more are free.
fn limit(free: u64, bytes: usize) -> usize {
    let most = (free.saturating_add(bytes as u64) / PART).min(MOST);
    usize::try_from(most).unwrap_or(usize::MAX)
}

fn next(bytes: usize, most: usize) -> Result<usize, usize> {
    if bytes < most { Ok(most.min(bytes + (bytes / AGAIN).max(1))) } else { Err(most) }
}

/// How many bytes are free: of the machine, or of the group of processes to which this one is held.
#[cfg(not(target_family = "wasm"))]
fn available() -> u64 {
    let mut system = sysinfo::System::new();
    system.refresh_memory();
    let free = system.available_memory();
    let free = system.cgroup_limits().map_or(free, |group| free.min(group.free_memory));
    if sysinfo::IS_SUPPORTED_SYSTEM { free } else { ADDRESSED }
}

/// Nobody says how many are free.
#[cfg(target_family = "wasm")]
fn available() -> u64 {
    ADDRESSED
}

/// What 32 bits can address.
const ADDRESSED: u64 = 1 << 32;

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_limit_is_a_quarter_of_what_is_free_and_at_most_four_gibibytes() {
        assert_eq!(limit(8 << 20, 0), 2 << 20);
        assert_eq!(limit(7 << 20, 1 << 20), 2 << 20);
        assert_eq!(limit(1 << 40, 0), 4 << 30);
        assert_eq!(limit(u64::MAX, usize::MAX), 4 << 30);
        assert_eq!(limit(0, 0), 0);
        assert_eq!(Room::Given(7).ask(8), Err(7));
        assert!(Room::Given(8).exceeds(7) && !Room::Given(7).exceeds(7));
    }

    #[test]
    fn this_machine_has_memory_and_says_so() {
        let free = available();
        assert!((1 << 20..1 << 50).contains(&free), "{free}");
        let next = Room::Free.ask(FIRST).unwrap();
        assert_eq!(next, FIRST + FIRST / AGAIN);
    }

    proptest! {
        /// Records that grow side by side all end, and never take more than there is.
        #[test]
        fn records_leave_room_for_each_other(free in 1_u64..1 << 36, count in 1..=48_usize, turns in prop::collection::vec(0..47_usize, 40)) {
            let first = 1 + (free / 1000) as usize;
            // What each takes, and when it asks; those that have ended no more.
            let mut records = vec![(0_usize, Some(first)); count];
            for turn in turns.into_iter().cycle() {
                let growing: Vec<usize> = (0..count).filter(|&place| records[place].1.is_some()).collect();
                let taken: usize = records.iter().map(|record| record.0).sum();
                prop_assert!(taken as u64 <= free.max((count * first) as u64), "{taken} of {free}");
                if growing.is_empty() {
                    break;
                }
                let (bytes, due) = &mut records[growing[turn % growing.len()]];
                let at = due.unwrap_or(*bytes);
                let others = taken - *bytes;
                let most = limit(free.saturating_sub((others + at) as u64), at);
                prop_assert!(at as u64 <= free || next(at, most).is_err());
                (*bytes, *due) = (at, next(at, most).ok());
            }
        }
    }
}
