//! Which machine this is, as run times of different ones are not compared, and the time that its
//! processors gave to this program.

/// Processor and number of cores: `AMD EPYC 7763, 16 cores`. Nodes of one kind are one machine.
pub fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(':'))
        .map_or_else(
            || format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            |(_, model)| model.trim().to_owned(),
        );
    format!("{model}, {cores} core{}", if cores == 1 { "" } else { "s" })
}

/// Time that processors have spent on this program, all its threads together, s. None: the system
/// does not say.
#[cfg(unix)]
pub fn processor_time_s() -> Option<f64> {
    let spent = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(spent.tv_sec as f64 + 1e-9 * spent.tv_nsec as f64)
}

/// Time that processors have spent on this program, all its threads together, s. None: the system
/// does not say.
#[cfg(not(unix))]
pub fn processor_time_s() -> Option<f64> {
    None
}
