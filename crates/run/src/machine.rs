//! The machine, as run times of different ones are not compared, and the processor time of this
//! program.

/// Processor and number of cores: `AMD EPYC 7763, 16 cores`. Identical nodes count as one machine.
pub(crate) fn machine() -> String {
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

/// Processor time of this program, all threads together, s. None: the system does not provide it.
#[cfg(unix)]
pub(crate) fn processor_time_s() -> Option<f64> {
    let spent = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(spent.tv_sec as f64 + 1e-9 * spent.tv_nsec as f64)
}

/// Processor time of this program, all threads together, s. None: the system does not provide it.
#[cfg(not(unix))]
pub(crate) fn processor_time_s() -> Option<f64> {
    None
}
