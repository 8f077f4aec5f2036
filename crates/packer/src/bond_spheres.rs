//! Bonds for spheres of any origin: a packing from another program, or the loose spheres of a run.

use crate::bonds::{BondSettings, bond_lengths, bond_radii, bond_range_for, find_bonds};
use crate::quality::BondQuality;
use crate::spheres::Spheres;
use dem_io::body::About;
use dem_io::units::significant;
use dem_io::{Body, Diagnostic, Result};

/// Bonds the spheres of a body by the rule of a packing, and assesses the bonds, whose warnings
/// replace those of the body. Bonds that it has are left out. No shape is known, so that bonds also
/// join spheres with a gap of the shape between them. The bonds are at rest: contacts and overlaps
/// exert no force.
///
/// # Errors
/// No two spheres are near enough; a bond range refused by [`find_bonds`].
pub fn bond_spheres(spheres: &Body, settings: &BondSettings) -> Result<(Body, BondQuality)> {
    let packing = Spheres {
        positions: spheres.positions.clone(),
        radii: spheres.radii.clone(),
    };
    let crosses = |_, _| false;
    let range = settings.range_for(&packing, &crosses)?;
    let bonds = find_bonds(&packing, range, &crosses)?;
    if bonds.is_empty() {
        return Err(none_near(&packing, range));
    }
    let quality = BondQuality::of(&packing, &bonds);
    let body = Body {
        bond_radii: bond_radii(&packing, &bonds, settings.radius_factor),
        bond_lengths: bond_lengths(&packing, &bonds),
        bonds,
        positions: packing.positions,
        radii: packing.radii,
        about: About {
            program: Some(format!("dem-pack {}", env!("CARGO_PKG_VERSION"))),
            bond_range: Some(range),
            warnings: quality.warnings.clone(),
            ..spheres.about.clone()
        },
        ..Body::default()
    };
    Ok((body, quality))
}

/// The message that no pair is within the bond range, with the nearest one if another range bonds
/// it.
fn none_near(spheres: &Spheres, range: f64) -> Diagnostic {
    let count = spheres.radii.len();
    let problem = match count {
        1 => "there is only one sphere".to_owned(),
        _ => format!(
            "none of {count} spheres is within the bond range of {} of another",
            significant(range, 4)
        ),
    };
    // One bond in all.
    let nearest = bond_range_for(spheres, 1.0 / count as f64, &|_, _| false);
    let remedy = match nearest {
        Ok(nearest) => format!(
            "--bond-range {} bonds the nearest two",
            significant(nearest, 4)
        ),
        Err(_) => "the spheres must touch, or nearly so".to_owned(),
    };
    Diagnostic::input("", problem, remedy)
}
