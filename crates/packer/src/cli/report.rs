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
fn mass_text(made: &BodyReport) -> String {
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
    let centre = centre.trim_start_matches("centre ");
    format!("mass             {mass}\ncentre           {centre}\n")
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

/// The summary of a new body: its quality, warnings, and times.
pub(super) fn summary_text(surface: &Surface, made: &BodyReport, output: &Path) -> String {
    let seconds = made.seconds.packing + made.seconds.bonds + made.seconds.report;
    let name = if output == Path::new("-") {
        "standard output".to_owned()
    } else {
        output.display().to_string()
    };
    let mut text = format!(
        "{} -> {}\n{}",
        visible(&surface.source),
        visible(&name),
        made.quality.text()
    );
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
    text += &mass_text(made);
    let history = &made.history;
    text += &format!(
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
    );
    text += &format!(
        "time             {seconds:.2} s: front {:.2}, densification {:.2}, voids {:.2}, bonds {:.2}, report {:.2}; {} spheres/s\n",
        history.front_seconds,
        history.densify_seconds,
        history.fill_seconds,
        made.seconds.bonds,
        made.seconds.report,
        significant(made.quality.particles as f64 / seconds, 3)
    );
    for warning in surface.warnings.iter().chain(&made.notes) {
        text += &format!("note             {warning}\n");
    }
    text += &match made.quality.warnings.len() {
        0 => "verdict          sound: no warnings\n".to_owned(),
        1 => "verdict          doubtful: resolve the warning above before using the body\n"
            .to_owned(),
        many => {
            format!(
                "verdict          doubtful: resolve the {many} warnings above before using the body\n"
            )
        }
    };
    text
}
