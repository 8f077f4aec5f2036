//! What a sweep leaves and prints: commands, tables, the page and the plots.

use std::path::{Path, PathBuf};

use dem_io::own_command::own_command;
use dem_io::safe_write::write_file;
use dem_io::text::visible;
use dem_io::units::significant;
use dem_io::{Diagnostic, Result};
use dem_results::{write_json, write_plot_file};
use dem_scene::study::Study;
use dem_terminal::standard_output::{write_standard_json, write_standard_output};
use serde_json::json;

use dem_study::cluster::{ListedRun, write_cluster_files};
use dem_study::curves;
use dem_study::expand::Run;
use dem_study::folder::SweepFolder;
use dem_study::jobs::{Job, arguments, refuse_unlistable, scene_arguments, shell_line};
use dem_study::page::page;
use dem_study::plot::plot;
use dem_study::probability_page::{probability_csv, probability_fit_csv, probability_plots};
use dem_study::ranking::{DesignTable, Rankings};
use dem_study::ranking_plot::{change_bars, morris_bars, sigma_plot};
use dem_study::ranking_text::effects_csv;
use dem_study::response_plot::{found_plots, plots};
use dem_study::row::Row;
use dem_study::sweep_table::SweepTable;
use dem_study::text::{csv, find_csv, response_csv};

/// Prints one sh command for each job, and writes them for the schedulers of a cluster.
pub(super) fn list(study: &Study, all: &[Run], jobs: &[Job], folder: &SweepFolder) -> Result<()> {
    let own = own_command();
    let (program, first) = own.unwrap_or_else(|_| (PathBuf::from("dem-run"), Vec::new()));
    refuse_unlistable("this program", &program)?;
    let program = program.display().to_string();
    let runs = folder.runs();
    let mut listed = Vec::new();
    for job in jobs {
        let Some(run) = job.index(all) else {
            continue;
        };
        let own = arguments(study, &all[run], *job, &runs);
        let arguments = [first.clone(), own].concat();
        let name = job.folder(Path::new("")).display().to_string();
        let command = shell_line(&program, &arguments, Some(&job.complaint(&runs)));
        listed.push(ListedRun { name, command });
    }
    folder.remove_marks()?;
    if !listed.is_empty() {
        let here = std::env::current_dir().map_err(|error| {
            let problem = format!("the present folder is not known: {error}");
            Diagnostic::failed("--list", problem, "run it in a folder that exists")
        })?;
        write_cluster_files(folder.path(), &here, &listed, study.threads)?;
    }
    write_standard_output(|out| {
        for run in &listed {
            writeln!(out, "{}", run.command)?;
        }
        Ok(())
    })
}

/// `sweep.csv`, `responses.csv`, `find.csv`, `probability.csv`, `effects.csv`, `sweep.json`,
/// `sweep.html` and the plots of each measure.
pub(super) fn write_files(folder: &SweepFolder, table: &SweepTable) -> Result<()> {
    let file = |name: &str| folder.path().join(name);
    write_file(&file("sweep.csv"), |out| {
        out.write_all(csv(table).as_bytes())
    })?;
    if !table.responses.is_empty() {
        write_file(&file("responses.csv"), |out| {
            out.write_all(response_csv(table).as_bytes())
        })?;
    }
    if let Some(search) = &table.find {
        write_file(&file("find.csv"), |out| {
            out.write_all(find_csv(table, search).as_bytes())
        })?;
        for (number, plot) in (1..).zip(found_plots(table, search)) {
            // A measure may have the name `find`, but not one with a dot.
            let path = file(&format!("find.{number}.svg"));
            write_plot_file(&path, &plot.svg().file())?;
        }
    }
    if let Some(of) = &table.probability {
        write_file(&file("probability.csv"), |out| {
            out.write_all(probability_csv(table, of).as_bytes())
        })?;
        write_file(&file("probability-fit.csv"), |out| {
            out.write_all(probability_fit_csv(table, of).as_bytes())
        })?;
        for (number, plot) in (1..).zip(probability_plots(table, of)) {
            let path = file(&format!("probability.{number}.svg"));
            write_plot_file(&path, &plot.svg().file())?;
        }
    }
    write_json(&file("sweep.json"), table)?;
    write_file(&file("sweep.html"), |out| {
        out.write_all(page(table).as_bytes())
    })?;
    for (at, measure) in table.measures.iter().enumerate() {
        if measure.reference.is_some() {
            let path = file(&format!("{}.svg", measure.name));
            write_plot_file(&path, &plot(table, at).svg().file())?;
        }
        if let Some(plot) = curves::plot(table, at) {
            let path = file(&format!("{}-curves.svg", measure.name));
            write_plot_file(&path, &plot.svg().file())?;
        }
    }
    if let Some(design) = &table.design {
        write_file(&file("effects.csv"), |out| {
            out.write_all(effects_csv(table, design).as_bytes())
        })?;
        return write_rankings(folder, table, design);
    }
    for response in &table.responses {
        let measure = &table.measures[response.measure];
        let is_compared = measure.reference.is_some();
        for (number, plot) in (1..).zip(plots(table, response)) {
            // Names of measures have no dots.
            let name = match number {
                1 if !is_compared => format!("{}.svg", measure.name),
                1 => format!("{}.response.svg", measure.name),
                number => format!("{}.response.{number}.svg", measure.name),
            };
            write_plot_file(&file(&name), &plot.svg().file())?;
        }
    }
    Ok(())
}

/// The plots of a design: `NAME.svg`, the ranking of each measure, and for trajectories
/// `NAME.sigma.svg`.
fn write_rankings(folder: &SweepFolder, table: &SweepTable, design: &DesignTable) -> Result<()> {
    let file = |measure: usize, ending: &str| {
        let name = &table.measures[measure].name;
        folder.path().join(format!("{name}{ending}"))
    };
    match &design.rankings {
        Rankings::Morris(rankings) => {
            for one in rankings {
                let bars = morris_bars(table, design, one).svg();
                write_plot_file(&file(one.measure, ".svg"), &bars.file())?;
                let plot = sigma_plot(table, design, one).svg();
                write_plot_file(&file(one.measure, ".sigma.svg"), &plot.file())?;
            }
        }
        Rankings::OneAtATime(rankings) => {
            for one in rankings {
                let bars = change_bars(table, design, one).svg();
                write_plot_file(&file(one.measure, ".svg"), &bars.file())?;
            }
        }
    }
    Ok(())
}

/// Prints the table, as text or as JSON, with the fastest setting if that is asked for, and the
/// name of the scene that was `written` with it.
pub(super) fn say(
    study: &Study,
    all: &[Run],
    table: &SweepTable,
    best: Option<&Row>,
    written: Option<&Path>,
    folder: &SweepFolder,
    as_json: bool,
) -> Result<()> {
    let command = |row: &Row| {
        let run = all.iter().find(|run| run.number == row.number);
        let arguments = run.map_or(Vec::new(), |run| scene_arguments(study, run));
        shell_line("dem-run", &arguments, None)
    };
    if as_json {
        let mut value = serde_json::to_value(table)
            .map_err(|error| Diagnostic::failed("--json", error.to_string(), ""))?;
        value["fastest"] = match best {
            Some(row) => json!({ "run": row.number, "command": command(row) }),
            None => serde_json::Value::Null,
        };
        return write_standard_json(&value);
    }
    write_standard_output(|out| {
        write!(out, "{table}")?;
        writeln!(
            out,
            "results      {}",
            visible(&folder.path().join("sweep.html").display().to_string())
        )?;
        if let Some(row) = best {
            let errors = table.measures.iter().zip(&row.results);
            let errors: Vec<String> = errors
                .filter_map(|(m, judged)| Some((m, judged.sure_error()?)))
                .map(|(m, error)| format!("{} {}", m.name, significant(error, 2)))
                .collect();
            writeln!(
                out,
                "fastest      run {}, {} s, error {}: {}",
                row.number,
                significant(row.time_s.unwrap_or(f64::NAN), 3),
                errors.join(", "),
                visible(&table.named(row))
            )?;
            writeln!(out, "             {}", command(row))?;
            if let Some(target) = written {
                writeln!(
                    out,
                    "written      {}",
                    visible(&target.display().to_string())
                )?;
            }
        }
        Ok(())
    })
}
