//! Which machine this is: run times of different ones are not compared.

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
