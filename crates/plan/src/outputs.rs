//! Output intervals of a run: refuses those that would fill the disk.

use dem_io::units::significant;
use dem_io::{Diagnostic, Result};
use dem_scene::Scene;

/// Largest number of frames, and of pictures: each is a file.
const MOST_FILES: f64 = 1e5;
/// Largest number of rows of the time series.
const MOST_ROWS: f64 = 1e7;
/// Largest number of intervals of mass flows: each is a row for every body and outlet.
const MOST_INTERVALS: f64 = 1e5;
/// Largest number of checkpoints: each replaces the one before.
const MOST_CHECKPOINTS: f64 = 1e6;

/// Refuses intervals of `[output]` with which a run with this step, s, would write too often.
pub(super) fn refuse_endless_output(scene: &Scene, step_s: f64) -> Result<()> {
    let Some(output) = &scene.output else {
        return Ok(());
    };
    let end_s = scene.run.end_time_s;
    // Output is written at most once a step. An adaptive step may become shorter than it is now.
    let steps = if scene.run.adaptive {
        f64::INFINITY
    } else {
        (end_s / step_s).ceil()
    };
    let intervals = [
        ("frames", output.frames_s, MOST_FILES, "frames"),
        ("pictures", output.pictures_s, MOST_FILES, "pictures"),
        ("series", output.series_s, MOST_ROWS, "rows"),
        ("flow", output.flow_s, MOST_INTERVALS, "intervals"),
        (
            "checkpoint",
            output.checkpoint_s,
            MOST_CHECKPOINTS,
            "checkpoints",
        ),
    ];
    for (key, interval_s, most, what) in intervals {
        let Some(interval_s) = interval_s else {
            continue;
        };
        // Rows of mass flows are written at the end, one for each interval.
        let at_most = if key == "flow" { f64::INFINITY } else { steps };
        let count = (end_s / interval_s).floor().min(at_most);
        if count > most {
            // Rounding to two digits of a value larger by a twentieth never gives less than the
            // shortest interval itself.
            let shortest_s = 1.05 * end_s / most;
            return Err(Diagnostic::input(
                format!("{}: output.{key}", scene.source),
                format!(
                    "an interval of {} s in a run of {} s makes {} {what}, more than {most}",
                    significant(interval_s, 3),
                    significant(end_s, 3),
                    significant(count, 3),
                ),
                format!("write {key} = \"{shortest_s:.1e} s\" or more"),
            ));
        }
    }
    Ok(())
}
