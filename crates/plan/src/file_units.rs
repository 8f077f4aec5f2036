//! Bodies whose files say no unit of length.

use std::collections::BTreeMap;

use dem_io::Body;
use dem_io::units::significant;
use dem_scene::{BodySource, Scene};

/// Radius of a sphere from which a file is perhaps in millimetres, m.
const LARGE_M: f64 = 0.5;

/// A sentence on each body of large spheres from a file without a unit, whose numbers are read as
/// metres. `read`: bodies by name, as in their files.
pub(super) fn notes(scene: &Scene, read: &BTreeMap<String, Body>) -> Vec<String> {
    let note = |(name, body): (&String, &Body)| {
        let entry = scene
            .bodies
            .get(name)
            .filter(|e| e.sieve_size_m.is_none())?;
        let BodySource::File(path) = &entry.source else {
            return None;
        };
        let file = path.file_name()?.to_string_lossy().into_owned();
        let says_unit = file == "-"
            || path
                .extension()
                .is_some_and(|of| of.eq_ignore_ascii_case("vtp"));
        let ends = [f64::INFINITY, 0.0];
        let [least_m, most_m] = (body.radii.iter()).fold(ends, |[least, most], radius| {
            [least.min(*radius), most.max(*radius)]
        });
        (!says_unit && most_m > LARGE_M).then(|| {
            let [least, most] = [least_m, most_m].map(|radius| significant(radius, 3));
            let span = if least == most { least } else { format!("{least} to {most}") };
            format!(
                "bodies.{name}: the spheres of '{file}' have radii of {span} m, as its numbers are metres: if they are millimetres, multiply them by 0.001, or set bodies.{name}.sieve_size, which scales the body"
            )
        })
    };
    read.iter().filter_map(note).collect()
}
