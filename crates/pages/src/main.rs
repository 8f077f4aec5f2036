//! Writes the tables and pictures of the pages that take runs of the programs. From the folder of
//! the clone:
//!
//! ```sh
//! cargo run --release -p dem-pages -- laboratory bending
//! ```
//!
//! builds both programs, runs what the table needs, prints the table and writes it into its page,
//! between the lines `<!-- table: laboratory bending -->` and `<!-- end of table -->`. Results are
//! in `target/pages`; with `--resume` at the end complete ones are kept. doc/inside/development.md
//! lists the commands.

mod alumina;
mod bench;
mod board;
mod bodies;
mod bulk;
mod calibration;
mod calibration_cases;
mod cells;
mod concrete;
mod dynamic;
mod fracture;
mod laboratory;
mod packing;
mod parameters;
mod pictures;
mod plots;
mod pressing;
mod process;
mod replacement;
mod resolution;
mod rocks;
mod round_robin;
mod self_contact;
mod shapes;
mod table;
#[cfg(test)]
mod tests;
mod thesis;

use std::process::ExitCode;

use bench::{Bench, Failed};

/// Computes and writes what some words ask for.
type Work = fn(&Bench) -> Result<(), Failed>;

/// The words, and what they do.
const COMMANDS: [(&str, Work); 49] = [
    ("alumina", alumina::alumina),
    ("board page", board::write),
    ("board penetration-25k", board::penetration_25k),
    ("board penetration-50k", board::penetration_50k),
    ("board times", board::measure),
    ("bodies", bodies::bodies),
    ("bulk heaps", bulk::heaps),
    ("bulk route", bulk::route),
    ("calibration cases", calibration_cases::cases),
    ("calibration scatter", calibration::scatter),
    ("calibration sizes", calibration::sizes),
    ("concrete", concrete::concrete),
    ("dynamic heights", dynamic::heights),
    ("fracture beams", fracture::beams),
    ("fracture growth", fracture::growth),
    ("fracture materials", fracture::materials),
    ("fracture ratios", fracture::ratios),
    ("fracture recipe", fracture::recipe),
    ("fracture sizes", fracture::sizes),
    ("laboratory bending", laboratory::bending),
    ("laboratory disc-and-bar", laboratory::disc_and_bar),
    ("packing densify", packing::densify),
    ("packing growth", packing::growth),
    ("packing ratios", packing::ratios),
    ("parameters", parameters::parameters),
    ("picture failure-models", pictures::failure_models),
    ("picture larger-spheres", pictures::larger_spheres),
    ("picture strain-rate", pictures::strain_rate),
    ("pressing", pressing::pressing),
    ("process", process::process),
    ("replacement", replacement::replacement),
    ("resolution bonds", resolution::calibrate),
    ("resolution chute", resolution::chute),
    ("resolution drop", resolution::drop),
    ("resolution weight", resolution::weight),
    ("rocks calibrate", rocks::calibrate),
    ("rocks load", rocks::load),
    ("rocks page", rocks::page),
    ("round-robin drum", round_robin::drum),
    ("round-robin penetration", round_robin::penetration),
    ("round-robin silo", round_robin::silo),
    ("self-contact", self_contact::self_contact),
    ("thesis bending", thesis::bending::compute),
    ("thesis drops", thesis::drops::compute),
    ("thesis page", thesis::page::write),
    ("thesis rebound", thesis::rebound::compute),
    ("thesis sample", thesis::samples::compute),
    ("thesis steps", thesis::steps::compute),
    ("thesis strengthening", thesis::strengthening::compute),
];

#[allow(clippy::print_stderr, reason = "it says what is wrong")]
fn main() -> ExitCode {
    match work() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn work() -> Result<(), Failed> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let resumes = words.last().is_some_and(|word| word == "--resume");
    words.truncate(words.len() - usize::from(resumes));
    let wanted = words.join(" ");
    if let Some(size) = wanted.strip_prefix("packing growth ") {
        return packing::one_size(size);
    }
    let command = COMMANDS.iter().find(|(words, _)| *words == wanted);
    let Some((_, work)) = command else {
        let all = COMMANDS.map(|(words, _)| words).join("\n");
        return Err(format!("write one of these, then --resume or nothing:\n{all}").into());
    };
    let subject = words[0].as_str();
    let builds = !["board page", "board times", "rocks page"].contains(&wanted.as_str());
    work(&Bench::new(
        subject,
        resumes || subject == "thesis",
        builds,
    )?)
}
