//! Scenes for LAMMPS: a data file, an input script and a page of what is carried over, and the way
//! back from its dumps to frames.
//!
//! Bonds become `bond_style bpm/rotational`, contacts `pair_style granular`, walls `fix
//! wall/gran/region`, surfaces `fix surface/global`, clumps `fix rigid/small`. What LAMMPS has no
//! word for is refused by name.
//!
//! Written for LAMMPS of 22 July 2025 with the packages BPM, GRANULAR, RIGID and EXTRA-FIX;
//! surfaces that planes cannot stand for need that of 4 July 2026 with GRANSURF.

pub mod bonds;
mod breaks;
mod came;
mod clumps;
mod contacts;
mod data;
pub(crate) mod dump;
mod duration;
mod exported;
mod feeds;
pub(crate) mod files;
mod forces;
pub mod import;
mod input;
mod input_walls;
mod molecules;
mod page;
mod pieces;
pub mod refusals;
mod results;
mod surfaces;
mod wall_motion;
mod walls;
mod words;

use std::path::Path;

use dem_io::Result;
use dem_io::safe_write::{write_file, write_json_text};
use dem_io::stl::write_stl_text;
use dem_io::whole_folder::WholeFolder;
use dem_scene::Scene;
use serde::Serialize;

use self::files::{CLUMPS, DATA, FedBody, INPUT, MANIFEST, Manifest, PAGE, TYPES};
use self::refusals::Refusals;
use dem_plan::Plan;

/// Counts of what has been written, and what it needs.
#[derive(Debug, Clone, Serialize)]
pub struct Written {
    /// Particles, those of clumps included.
    pub particles: usize,
    /// Bonds.
    pub bonds: usize,
    /// Bonds with other coefficients are of another type.
    pub bond_types: usize,
    /// Rigid clumps.
    pub clumps: usize,
    /// Steps of the run.
    pub steps: u64,
    /// The LAMMPS that it needs: version and packages.
    pub needs: String,
}

/// Writes a planned scene for LAMMPS into a new or empty folder. All files appear in it, or none.
///
/// # Errors
/// Parts that LAMMPS has no word for: all in one message, with those in `refusals`, which were
/// known before ([`refusals::refuse_parts`]). `place_of`: file and line of a key of the scene.
pub fn export(
    scene: &Scene,
    plan: &Plan,
    mut refusals: Refusals,
    place_of: &dyn Fn(&str) -> Option<String>,
    folder: &Path,
) -> Result<Written> {
    refusals::refuse(scene, plan, &mut refusals);
    let types = bonds::bond_types(scene, &plan.state, &mut refusals);
    let contacts = contacts::contacts(scene, plan, &mut refusals);
    let feeds = feeds::feeds(scene, plan, &mut refusals);
    let walls = walls::walls(scene, plan, &feeds, &mut refusals);
    let forces = forces::forces(scene, plan, &mut refusals);
    refusals.check(scene, place_of)?;
    let molecules = molecules::molecules(plan);
    let steps = duration::steps(scene, plan);
    let input = input::Input {
        scene,
        plan,
        types: &types,
        contacts: &contacts,
        walls: &walls,
        forces: &forces,
        feeds: &feeds,
    };
    let manifest = Manifest {
        program: concat!("dem-run ", env!("CARGO_PKG_VERSION")).to_owned(),
        scene: scene.source.clone(),
        steps,
        end_s: scene.run.end_time_s,
        bodies: plan.state.model.bodies.clone(),
        body_of_molecule: molecules.bodies.clone(),
        is_clump: molecules.are_clumps.clone(),
        fed: feeds.iter().map(|feed| fed_body(plan, feed)).collect(),
        bond_radii_m: types.types.iter().map(|one| one.radius_m).collect(),
        breaks: types.break_at_all(),
        sieves_m: (scene.output.as_ref()).map_or_else(Vec::new, |o| o.sieves_m.clone()),
    };
    let texts = [(INPUT, input.text()), (PAGE, page::page(&input))];
    let whole = WholeFolder::beside(folder, "--output")?;
    let folder = whole.path();
    write_file(&folder.join(DATA), |out| {
        data::write(plan, &contacts, &types, &molecules, &feeds, out)
    })?;
    for feed in &feeds {
        let template = &plan.state.clumps.templates[feed.template];
        write_file(&folder.join(feed.file()), |out| {
            feeds::write(feed, template, out)
        })?;
    }
    for wall in &walls {
        if let Some(surface) = wall.surface() {
            write_file(&folder.join(wall.file()), |out| {
                write_stl_text(&format!("wall {}", wall.number), &surface.triangles_m, out)
            })?;
        }
    }
    if !types.types.is_empty() {
        write_file(&folder.join(TYPES), |out| bonds::write(&types, out))?;
    }
    if clumps::has_bodies(&plan.state) {
        write_file(&folder.join(CLUMPS), |out| {
            clumps::write(&plan.state, &molecules, out)
        })?;
    }
    for (name, text) in &texts {
        write_file(&folder.join(name), |out| out.write_all(text.as_bytes()))?;
    }
    let file = folder.join(MANIFEST);
    write_file(&file, |out| write_json_text(out, &manifest))?;
    whole.publish()?;
    Ok(Written {
        particles: plan.state.particles.len(),
        bonds: plan.state.bonds.len(),
        bond_types: types.types.len(),
        clumps: plan.state.clumps.all.len(),
        steps,
        needs: page::needs(&walls),
    })
}

fn fed_body(plan: &Plan, feed: &feeds::Feed) -> FedBody {
    FedBody {
        atom_type: feed.atom_type as u64,
        body: plan.state.model.body_number(&feed.body),
        is_clump: feed.is_clump,
        density_kg_m3: feeds::density_kg_m3(&plan.state.clumps.templates[feed.template]),
    }
}
