//! The command line of dem-pack.

mod arguments;
mod bond;
mod recipe;
mod report;
mod shape;

pub use self::arguments::Arguments;
use self::arguments::{Command, PackArguments, Reading};
use self::bond::bond;
pub use self::recipe::Recipe;
use self::report::{short_text, summary_text, surface_summary, surface_text};
use self::shape::{check_unit_of_diameter, read_surface};
use crate::body::{BodySettings, make_body, make_body_only};
use crate::sizes::Sizes;
use clap::CommandFactory;
use dem_io::body::{body_summary, files::body_files, read_body, write_body};
use dem_io::safe_write::remove_unfinished;
use dem_io::triangles::is_named_so;
use dem_io::write_target::{need_folder_of, refuse_to_replace};
use dem_io::{Diagnostic, Result};
use dem_terminal::program::{print_completions, print_man_page, take_size_limits_as_errors};
use dem_terminal::progress::progress_bar;
use dem_terminal::standard_output::{
    write_standard_error, write_standard_json, write_standard_output,
};
use std::ffi::OsString;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

/// The program: does what its command line says, reports an error on standard error, and returns
/// the exit code. The first of `given` is the name of the program. Ctrl-C ends the process.
pub fn program(given: impl Iterator<Item = OsString>) -> u8 {
    let at_interrupt = || {
        remove_unfinished();
        std::process::exit(130);
    };
    take_size_limits_as_errors();
    // Without the handler an interrupted run could leave a temporary file behind, nothing worse.
    let _ = ctrlc::set_handler(at_interrupt);
    match Arguments::parsed(given).and_then(|arguments| run(&arguments)) {
        Ok(()) => 0,
        Err(error) => {
            write_standard_error(&error);
            error.exit_code()
        }
    }
}

/// Runs the command given by the arguments.
pub fn run(arguments: &Arguments) -> Result<()> {
    match &arguments.command {
        Some(Command::Info {
            file,
            reading,
            json,
        }) => info(file, reading, *json),
        Some(Command::Convert { from, to }) => {
            refuse_to_replace(&body_files(to)?, &body_files(from)?)?;
            write_body(&read_body(from)?, to)
        }
        Some(Command::Bond(command)) => bond(command),
        Some(Command::Completions { shell }) => print_completions(*shell, Arguments::command()),
        Some(Command::Man) => print_man_page(Arguments::command()),
        None => pack_command(&arguments.pack),
    }
}

fn pack_command(arguments: &PackArguments) -> Result<()> {
    let Some(shape) = &arguments.shape else {
        return Err(Diagnostic::input("", "no shape was given", ""));
    };
    let output = arguments.output.as_deref().unwrap_or(Path::new("-"));
    check_output(output, shape, arguments.diameter.as_deref())?;
    if arguments.json && output == Path::new("-") {
        return Err(Diagnostic::input(
            "--json",
            "standard output cannot take both the report and the body",
            "give --output FILE",
        ));
    }
    let settings = arguments.checked()?;
    // The complete job runs in the pool: a parallel loop started outside it puts the calling thread
    // to sleep and wakes it again.
    thread_pool(arguments.threads)?.install(|| pack_and_write(shape, arguments, &settings, output))
}

fn pack_and_write(
    shape: &Path,
    arguments: &PackArguments,
    settings: &BodySettings,
    output: &Path,
) -> Result<()> {
    let surface = read_surface(shape, &arguments.reading)?;
    check_unit_of_diameter(
        arguments.diameter.as_deref(),
        &settings.packing.sizes,
        &surface,
    )?;
    let person = if arguments.quiet {
        None
    } else {
        Some(std::io::stderr())
    };
    let template = "{msg:14} [{bar:40}] {percent:>3} %  {eta} left";
    let bar = progress_bar(arguments.quiet, 1000, template);
    let progress = |stage: &str, done: f64| {
        bar.set_message(stage.to_owned());
        bar.set_position((done.clamp(0.0, 1.0) * 1000.0) as u64);
        Ok(())
    };
    if arguments.quiet && !arguments.json {
        return write_body(&make_body_only(&surface, settings, &progress)?, output);
    }
    let (body, made) = make_body(&surface, settings, &progress)?;
    bar.set_message("writing");
    write_body(&body, output)?;
    bar.finish_and_clear();
    drop(body);

    if arguments.json {
        return write_standard_json(&made);
    }
    let text = if arguments.verbose {
        summary_text(&surface, &made, output)
    } else {
        short_text(&surface, &made, output)
    };
    if arguments.output.is_some() && output != Path::new("-") {
        write_standard_output(|out| out.write_all(text.as_bytes()))
    } else {
        if let Some(mut person) = person {
            // If standard error cannot be written to, there is nowhere to report that.
            let _ = person.write_all(text.as_bytes());
        }
        Ok(())
    }
}

/// The requested number of threads, 1 to 1024, or one per core.
pub fn thread_pool(threads: Option<usize>) -> Result<rayon::ThreadPool> {
    if let Some(threads @ (0 | 1025..)) = threads {
        return Err(Diagnostic::input(
            "--threads",
            format!("{threads} is not between 1 and 1024"),
            "",
        ));
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .build()
        .map_err(|e| {
            Diagnostic::failed(
                "--threads",
                format!("the threads cannot be started: {e}"),
                "ask for fewer",
            )
        })
}

/// Checks before the work whether the body can be written.
fn check_output(output: &Path, shape: &Path, diameter: Option<&str>) -> Result<()> {
    let files = body_files(output)?;
    for file in &files {
        need_folder_of(file)?;
    }
    let sieve = diameter.and_then(Sizes::file).map(PathBuf::from);
    let read: Vec<PathBuf> = sieve.into_iter().chain([shape.to_owned()]).collect();
    refuse_to_replace(&files, &read)?;
    if output == Path::new("-") && std::io::stdout().is_terminal() {
        return Err(Diagnostic::input(
            "standard output",
            "a .vtp is no text for a terminal",
            "give --output FILE, or pipe it into another program",
        ));
    }
    Ok(())
}

fn info(file: &Path, reading: &Reading, json: bool) -> Result<()> {
    if is_named_so(file) {
        let surface = read_surface(file, reading)?;
        if json {
            return write_standard_json(&surface_summary(&surface));
        }
        return write_standard_output(|out| out.write_all(surface_text(&surface).as_bytes()));
    }
    let summary = body_summary(&read_body(file)?);
    if json {
        return write_standard_json(&summary);
    }
    write_standard_output(|out| write!(out, "{summary}"))
}
