//! The list of measurements.

use dem_scene::Measure;

use super::measurement::Measurement;
use super::{bonds, bulk, contacts, heap, mixing, pieces, supports, whole};

/// One that is not in the list.
static UNKNOWN: Measurement = Measurement::new("", |_, _| f64::NAN);

fn all() -> impl Iterator<Item = &'static Measurement> {
    let files = [
        whole::MEASUREMENTS,
        supports::MEASUREMENTS,
        bonds::MEASUREMENTS,
        heap::MEASUREMENTS,
        bulk::MEASUREMENTS,
        mixing::MEASUREMENTS,
        contacts::MEASUREMENTS,
        pieces::MEASUREMENTS,
    ];
    files.into_iter().flatten()
}

impl Measurement {
    /// That of a measure.
    pub fn of(measure: &Measure) -> &'static Self {
        let names = measure.quantity.names;
        all()
            .find(|one| names.contains(&one.name))
            .unwrap_or(&UNKNOWN)
    }
}

#[cfg(test)]
mod tests {
    use dem_scene::QUANTITIES;

    #[test]
    fn every_quantity_of_scenes_is_measured_once() {
        let mut measured: Vec<&str> = super::all().map(|one| one.name).collect();
        let mut known: Vec<&str> = QUANTITIES.iter().map(|one| one.names[0]).collect();
        measured.sort_unstable();
        known.sort_unstable();
        assert_eq!(measured, known);
    }
}
