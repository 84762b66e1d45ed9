//! How much memory this process may take.

/// More is never needed: a drive beside ROS 2 holds some 170 MB. The systemd unit has the same limit.
#[cfg(target_os = "linux")]
const MOST_BYTES: u64 = 512 << 20;

/// Limits this process's memory, so that a forged message cannot take all of the computer's: RustDDS 0.15.1
/// makes room for whatever size a fragment claims, up to 4 GB. Beyond the limit the process aborts.
#[cfg(target_os = "linux")]
pub(crate) fn limit() {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
    let before = getrlimit(Resource::Data);
    let current = before.current.map_or(MOST_BYTES, |current| current.min(MOST_BYTES));
    if let Err(error) = setrlimit(Resource::Data, Rlimit { current: Some(current), ..before }) {
        log::warn!("memory is not limited: {error}");
    }
}

/// Other systems limit it by their own means.
#[cfg(not(target_os = "linux"))]
pub(crate) fn limit() {}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn the_systemd_unit_has_the_same_limit() {
        let unit = include_str!("../package/mapless-node.service");
        let limit = format!("\nMemoryMax={}M\n", MOST_BYTES >> 20);
        assert!(unit.contains(&limit), "{unit}");
    }
}
