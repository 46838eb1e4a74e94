//! What it was measured on, and with which versions.

/// The crates compared, in the order of the tables.
pub const CRATES: [&str; 6] = ["saltus", "diffsol", "differential-equations", "ivp", "ode_solvers", "russell_ode"];

/// The processor's name.
pub fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{}, {cores} cores", name.map_or("unknown processor", |(_, name)| name.trim()))
}

/// Each crate compared with its version, from the lock file that built this.
pub fn versions() -> Vec<(&'static str, &'static str)> {
    let lock = include_str!("../Cargo.lock");
    CRATES.iter().map(|&name| (name, version(lock, name))).collect()
}

fn version<'a>(lock: &'a str, name: &str) -> &'a str {
    let mut lines = lock.lines().skip_while(|line| *line != format!("name = \"{name}\""));
    lines.nth(1).and_then(|line| line.split('"').nth(1)).unwrap_or("?")
}
