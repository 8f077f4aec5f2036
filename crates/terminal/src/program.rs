//! Functions common to both programs: signals, shell completions, man pages.

use std::ffi::OsString;
use std::io::IsTerminal;

use clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand;
use clap::{Command, Parser};
pub use clap_complete::Shell;

use dem_io::safe_write::write_standard_bytes;
use dem_io::{Diagnostic, Result};

use crate::standard_output::write_standard_output;

/// Turns a file size limit of the shell (`ulimit -f`) into a write error, like a full disk, instead
/// of the end of the program.
pub fn take_size_limits_as_errors() {
    #[cfg(unix)]
    {
        // Once it is caught, the write fails; the flag is not used. Without the handler the program
        // would be ended and leave an unfinished file, nothing worse.
        let caught = std::sync::Arc::default();
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, caught);
    }
}

/// The arguments of a program called `name`. Its help and version are printed, and end the program.
/// A wrong argument is an error: the message of clap on one line.
pub fn parsed<P: Parser>(name: &str, given: &[OsString]) -> Result<P> {
    let matches = taking_negative_numbers(P::command()).try_get_matches_from(given);
    matches
        .and_then(|matches| P::from_arg_matches(&matches))
        .map_err(|error| {
            if !error.use_stderr() {
                return match print_rendered(&error) {
                    Ok(()) => std::process::exit(0),
                    Err(failed) => failed,
                };
            }
            if error.kind() == DisplayHelpOnMissingArgumentOrSubcommand {
                error.exit();
            }
            let command = P::command();
            let word = given.get(1).and_then(|word| word.to_str());
            let sub = word.filter(|word| command.find_subcommand(word).is_some());
            let sub = sub.map_or(String::new(), |word| format!(" {word}"));
            Diagnostic::input(
                "",
                on_one_line(&error.to_string()),
                format!("see {name}{sub} --help"),
            )
        })
}

/// Prints help or a version, in colour on a terminal.
fn print_rendered(help: &clap::Error) -> Result<()> {
    let text = help.render();
    let text = if std::io::stdout().is_terminal() {
        text.ansi().to_string()
    } else {
        text.to_string()
    };
    write_standard_bytes(|out| out.write_all(text.as_bytes()))
}

/// The command, with values of options that may begin with a minus sign, so that a negative number
/// is refused by its limits and not taken for an option.
fn taking_negative_numbers(command: Command) -> Command {
    let options = command.mut_args(|option| {
        let takes_a_value = option.get_long().is_some() && option.get_action().takes_values();
        option.allow_negative_numbers(takes_a_value)
    });
    options.mut_subcommands(taking_negative_numbers)
}

/// What the standard library says of numbers that it cannot read, and what that means.
const NUMBERS: [(&str, &str); 4] = [
    (
        "invalid digit found in string",
        "it is not a whole number of 0 or more",
    ),
    ("number too large to fit in target type", "it is too large"),
    ("cannot parse integer from empty string", "it is empty"),
    ("invalid float literal", "it is not a number"),
];

/// The message of clap, without its `error:`, the usage, the hint to the help and that to `--`,
/// which are paragraphs of their own.
pub fn on_one_line(said: &str) -> String {
    let paragraphs = said.trim_start_matches("error:").split("\n\n");
    let left_out = ["Usage:", "For more", "tip: to pass"];
    let kept = paragraphs.filter(|p| {
        !left_out
            .iter()
            .any(|start| p.trim_start().starts_with(start))
    });
    let lines = kept.map(|p| p.split_whitespace().collect::<Vec<_>>().join(" "));
    let line = lines.collect::<Vec<_>>().join("; ");
    NUMBERS
        .iter()
        .fold(line, |line, (said, meant)| line.replace(said, meant))
}

/// Prints a script for completing the options of a program in a shell.
pub fn print_completions(shell: Shell, mut command: Command) -> Result<()> {
    let name = command.get_name().to_owned();
    // Its writer may not fail.
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, name, &mut script);
    write_standard_output(|out| out.write_all(&script))
}

/// Prints the man page of a program.
pub fn print_man_page(command: Command) -> Result<()> {
    write_standard_output(|mut out| clap_mangen::Man::new(command).render(&mut out))
}

/// The present day in universal time, as in 2026-01-31.
pub fn today() -> String {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    date_of_day(now.map_or(0, |since| since.as_secs() / 86_400))
}

/// The date of a day counted from 1970-01-01, in the Gregorian calendar: years of March to February
/// in cycles of 400 years, which have 146,097 days each.
pub fn date_of_day(day: u64) -> String {
    let day = day + 719_468;
    let (cycle, day) = (day / 146_097, day % 146_097);
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let from_march = (5 * day + 2) / 153;
    let month = if from_march < 10 {
        from_march + 3
    } else {
        from_march - 9
    };
    let year = 400 * cycle + year + u64::from(month < 3);
    let day = day - (153 * from_march + 2) / 5 + 1;
    format!("{year:04}-{month:02}-{day:02}")
}
