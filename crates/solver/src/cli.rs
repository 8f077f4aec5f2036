//! The command line of dem-run.

mod all_fragments;
mod arguments;
mod as_run;
mod body;
mod calibrate;
mod check;
mod check_form;
mod export;
mod export_frames;
mod export_walls;
mod flow_trial;
mod fragment;
mod fragment_body;
mod import;
mod keys;
mod keys_text;
mod lab;
mod memory;
mod new;
mod pace;
mod packings;
mod picture;
pub(crate) mod pool;
mod progress;
mod report;
mod run_scene;
mod scene_arguments;
mod statics;
mod stress;
mod sweep;
mod trial;

use std::ffi::OsString;
use std::sync::Arc;

use clap::CommandFactory;
use dem_io::safe_write::remove_unfinished;
use dem_io::{Diagnostic, Result};
use dem_terminal::program::{print_completions, print_man_page, take_size_limits_as_errors};
use dem_terminal::standard_output::write_standard_error;

use self::arguments::Command;
use self::body::body_information;
use self::pool::in_pool;
use self::report::write_report;
use self::run_scene::run_scene;
use crate::interrupt::Interrupt;

pub use self::arguments::Arguments;
pub use self::progress::Tell;

/// The program: does what its command line says, reports an error on standard error, and returns
/// the exit code. The first of `given` is the name of the program. At Ctrl-C a run stops and keeps
/// its state; anything else, or a second Ctrl-C, ends the process.
pub fn program(given: impl Iterator<Item = OsString>) -> u8 {
    let interrupt = Arc::new(Interrupt::default());
    let asked = Arc::clone(&interrupt);
    let at_interrupt = move || {
        if !asked.ask() {
            remove_unfinished();
            let problem = Diagnostic::interrupted("interrupted", "");
            write_standard_error(&problem);
            std::process::exit(i32::from(problem.exit_code()));
        }
    };
    let done = Arguments::parsed(given).and_then(|arguments| {
        take_size_limits_as_errors();
        // Without the handler, the only loss is the checkpoint of an interrupted run.
        let _ = ctrlc::set_handler(at_interrupt);
        run(&arguments, &interrupt, &|_, _| {})
    });
    match done {
        Ok(()) => 0,
        Err(error) => {
            write_standard_error(&error);
            error.exit_code()
        }
    }
}

/// Does what was requested. `interrupt` tells a run to stop; `tell` hears how far the run of a
/// scene or a study has come.
pub fn run(arguments: &Arguments, interrupt: &Interrupt, tell: Tell<'_>) -> Result<()> {
    match &arguments.command {
        Some(Command::Check {
            scene,
            picture,
            verbose,
            quiet,
        }) => {
            let form = check_form::Form::of(scene.json, *verbose, *quiet);
            check::check_scene(scene, picture.as_deref(), form)
        }
        Some(Command::New(arguments)) => new::new(arguments),
        Some(Command::Keys(arguments)) => keys::keys(arguments),
        Some(Command::Fragment(arguments)) => fragment::fragment(arguments),
        Some(Command::Export(arguments)) => export::export(arguments),
        Some(Command::Import(arguments)) => import::import(arguments),
        Some(Command::Lab(arguments)) => lab::lab(arguments),
        Some(Command::Calibrate(arguments)) => calibrate::calibrate(arguments, interrupt),
        Some(Command::Picture(arguments)) => in_pool(None, |_| picture::write_picture(arguments)),
        Some(Command::Report { folder }) => write_report(folder),
        Some(Command::Sweep(arguments)) => sweep::sweep(arguments, interrupt, tell),
        Some(Command::Stress(arguments)) => stress::stress(arguments, interrupt),
        Some(Command::Completions { shell }) => print_completions(*shell, Arguments::command()),
        Some(Command::Man) => print_man_page(Arguments::command()),
        None if arguments.run.scene.names_a_scene() => {
            in_pool(arguments.run.scene.threads, |threads| {
                run_scene(&arguments.run, threads, interrupt, tell)
            })
        }
        None => {
            arguments.run.refuse_scene_options()?;
            body_information(&arguments.run.scene)
        }
    }
}
