//! The printed reports: human-readable, and JSON.

use crate::body::BodyReport;
use crate::pack::PackHistory;
use dem_io::Surface;
use dem_io::text::visible;
use dem_io::units::{show_length, significant};
use std::path::Path;

/// A surface as JSON.
pub(super) fn surface_summary(surface: &Surface) -> serde_json::Value {
    serde_json::json!({
        "source": surface.source,
        "triangles": surface.triangles.len(),
        "vertices": surface.vertices.len(),
        "volume_m3": surface.volume_m3(),
        "box_min_m": surface.origin_m,
        "box_size_m": surface.extent().map(|e| e * surface.unit_m),
        "shells": surface.shells,
        "repairs": surface.repairs,
        "warnings": surface.warnings,
    })
}

/// A surface as text.
pub(super) fn surface_text(surface: &Surface) -> String {
    let size = surface
        .extent()
        .map(|e| show_length(e * surface.unit_m))
        .join(" x ");
    let corner = surface.origin_m.map(show_length).join(", ");
    let parts = surface.parts();
    let mut text = format!(
        "{}\n  surface     {} triangles, {} corners, closed\n  size        {size}, from ({corner})\n  volume      {} mm3\n  parts       {parts}, cavities {}\n",
        visible(&surface.source),
        surface.triangles.len(),
        surface.vertices.len(),
        significant(surface.volume_m3() * 1e9, 6),
        surface.shells.len() - parts,
    );
    for warning in &surface.warnings {
        text += &format!("  note        {warning}\n");
    }
    text
}

/// The mass of the body compared with that of its filled shape, and its centre of mass.
fn mass_lines(made: &BodyReport) -> [String; 2] {
    let [mass, centre] = match &made.mass {
        Some(mass) => mass.lines(),
        None => [
            format!(
                "{} of its shape filled with the density of the particles",
                significant(made.mass_over_shape, 4)
            ),
            format!("centre {}", made.centre_m.map(show_length).join(", ")),
        ],
    };
    [mass, centre.trim_start_matches("centre ").to_owned()]
}

fn packed_by(history: &PackHistory) -> String {
    let front = format!(
        "an advancing front at radii reduced by {} from {} seeds",
        significant(history.densify, 3),
        history.fronts
    );
    if history.scattered == 0 {
        return front;
    }
    format!("spheres scattered at random, largest first, since {front} left too much room")
}

/// How the spheres came to their places, and the room that is left between them.
fn packed_by_line(history: &PackHistory) -> String {
    format!(
        "packed by        {}; {} left out (too many), {} relaxation steps, {} removed (jammed), {} added in voids, {} voids still fit the smallest size\n",
        packed_by(history),
        history.thinned,
        history.densify_steps,
        history.removed,
        history.void_fillers,
        match history.voids_left {
            0 => "0".to_owned(),
            // Extrapolated from the part that was searched.
            many => format!("about {many}"),
        }
    )
}

/// The report on a new body in a few lines: its spheres, bonds and mass, and the verdict.
pub(super) fn short_text(surface: &Surface, made: &BodyReport, output: &Path) -> String {
    let quality = &made.quality;
    let filled = 100.0 * quality.union_density.value;
    let across = quality.thinnest.map_or(String::new(), |thinnest| {
        format!(
            ", {} spheres across the thinnest part ({})",
            significant(thinnest.particles_across, 2),
            show_length(thinnest.thickness_m)
        )
    });
    let mut text = first_line(surface, output);
    text += &format!(
        "particles  {} spheres, mean diameter {}, {} bonds ({} per sphere)\n",
        quality.particles,
        show_length(quality.mean_diameter_m),
        quality.bonds,
        significant(quality.bonds_per_particle, 3)
    );
    text += &format!("filled     {filled:.0} % of the shape{across}\n");
    if made.history.voids_left > 0 {
        text += &format!("packing density  {}\n", quality.packing_density());
        text += &packed_by_line(&made.history);
    }
    if made.mass.is_some() {
        let [mass, _] = mass_lines(made);
        text += &format!("mass       {mass}\n");
    }
    text + &verdict_lines(surface, made, 10)
}

fn first_line(surface: &Surface, output: &Path) -> String {
    let name = if output == Path::new("-") {
        "standard output".to_owned()
    } else {
        output.display().to_string()
    };
    format!("{} -> {}\n", visible(&surface.source), visible(&name))
}

/// Notes, warnings, and the verdict in one of three words: sound, coarse or doubtful.
fn verdict_lines(surface: &Surface, made: &BodyReport, width: usize) -> String {
    let mut text = String::new();
    let mut line = |name: &str, what: &str| text += &format!("{name:width$} {what}\n");
    for note in surface.warnings.iter().chain(&made.notes) {
        line("note", note);
    }
    let quality = &made.quality;
    for warning in &quality.warnings {
        line("warning", warning);
    }
    let verdict = match (quality.warnings.len(), &quality.coarse) {
        (0, None) => "sound".to_owned(),
        (0, Some(coarse)) => format!("coarse: {coarse}"),
        (1, _) => "doubtful: resolve the warning above before using the body".to_owned(),
        (many, _) => {
            format!("doubtful: resolve the {many} warnings above before using the body")
        }
    };
    line("verdict", &verdict);
    text
}

/// The whole report on a new body: its quality, warnings, and times.
pub(super) fn summary_text(surface: &Surface, made: &BodyReport, output: &Path) -> String {
    let seconds = made.seconds.packing + made.seconds.bonds + made.seconds.report;
    let mut text = first_line(surface, output) + &made.quality.text();
    if let Some(search) = &made.density_search {
        text += &format!(
            "density search   target {} kg/m3, found {} kg/m3 ({:+.2} %) at overlap {}; packings made: {}, fronts: {}\n",
            significant(search.wanted_kg_m3, 5),
            significant(search.found_kg_m3, 5),
            100.0 * search.relative_error,
            significant(search.overlap, 4),
            search.finished,
            search.packings
        );
    }
    let [mass, centre] = mass_lines(made);
    text += &format!("mass             {mass}\ncentre           {centre}\n");
    let history = &made.history;
    text += &packed_by_line(history);
    text += &format!(
        "time             {seconds:.2} s: front {:.2}, densification {:.2}, voids {:.2}, bonds {:.2}, report {:.2}; {} spheres/s\n",
        history.front_seconds,
        history.densify_seconds,
        history.fill_seconds,
        made.seconds.bonds,
        made.seconds.report,
        significant(made.quality.particles as f64 / seconds, 3)
    );
    text + &verdict_lines(surface, made, 16)
}
