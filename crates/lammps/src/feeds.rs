//! Inlets as `fix deposit`: for each body that an inlet feeds, a molecule, a type of atoms and a
//! group.
//!
//! Places, orientations and times are those that LAMMPS draws. A clump joins `fix rigid/small`; a
//! body of one sphere is a sphere.
//!
//! <https://docs.lammps.org/fix_deposit.html>, <https://docs.lammps.org/molecule.html>

use std::io::{self, Write};

use dem_io::body::mass::volume_m3;
use dem_scene::Scene;

use super::duration::{step_s, steps};
use super::refusals::Refusals;
use super::words::{block, cylinder, numbers};
use dem_engine::state::clumps::Template;
use dem_engine::state::rules::{Feed as Rate, Inlet};
use dem_physics::geometry::Bounds;
use dem_physics::geometry::region::Region;
use dem_plan::Plan;

/// A body that an inlet feeds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Feed {
    /// Number from 1: that of its molecule file and of its group.
    pub number: usize,
    /// The inlet in the scene.
    pub inlet: String,
    /// The body in the scene.
    pub body: String,
    /// Number of its template.
    pub template: usize,
    /// Number of its material.
    pub material: usize,
    /// Its type of atoms, from 1: no other particle has it.
    pub atom_type: usize,
    /// Whether it has several spheres.
    pub is_clump: bool,
    /// Step at which feeding begins, steps from one body to the next, and number of bodies.
    pub start: u64,
    pub every: u64,
    pub count: u64,
    /// Style and arguments of the region of its centre.
    pub region: String,
    /// The box around it in that region.
    pub room: Bounds,
    /// m/s. Length 3.
    pub velocity_m_s: [f64; 3],
    /// Of the random numbers: at least 1.
    pub seed: u64,
}

impl Feed {
    /// Name of the file of its molecule.
    pub(super) fn file(&self) -> String {
        format!("fed-{}.molecule", self.number)
    }

    /// Name of the group of its atoms.
    pub(super) fn group(&self) -> String {
        format!("fed_{}", self.number)
    }
}

/// What the inlets of a planned scene feed. Refuses bodies that are bonded, turn, or come as they
/// lie in their file, and a region that is a surface or a cylinder across the axes.
pub(super) fn feeds(scene: &Scene, plan: &Plan, refusals: &mut Refusals) -> Vec<Feed> {
    let mut feeds = Vec::new();
    for inlet in &plan.state.model.rules.inlets {
        if inlet.spin_rad_s != [0.0; 3] {
            refusals.add(
                format!("inlets.{}.angular_velocity", inlet.name),
                "fix deposit gives new bodies a velocity and no spin",
                "leave it out, or run the scene with dem-run",
            );
        }
        let (region, bounds) = region(plan, inlet, refusals);
        let mean_mass_kg: f64 = (inlet.templates.iter())
            .map(|(of, share)| share * plan.state.clumps.templates[*of as usize].mass_kg)
            .sum();
        let per_s = match inlet.feed {
            Rate::Number(per_s) => per_s,
            Rate::Mass(kg_s) => kg_s / mean_mass_kg,
        };
        for &(of, share) in &inlet.templates {
            let template = &plan.state.clumps.templates[of as usize];
            let is_clump = template.outer.len() > 1;
            refuse_body(plan, inlet, of as usize, is_clump, refusals);
            let Some([start, every, count]) = times(scene, plan, inlet, share, per_s) else {
                continue;
            };
            let number = feeds.len() + 1;
            feeds.push(Feed {
                number,
                inlet: inlet.name.clone(),
                body: template.body.clone(),
                template: of as usize,
                material: template.material as usize,
                atom_type: scene.materials.len() + number,
                is_clump,
                start,
                every,
                count,
                region: region.clone(),
                room: bounds.grown(template.largest_reach_m()),
                velocity_m_s: inlet.velocity_m_s,
                seed: (plan.state.model.rules.seed % 1_000_000) + number as u64,
            });
        }
    }
    feeds
}

fn refuse_body(
    plan: &Plan,
    inlet: &Inlet,
    template: usize,
    is_clump: bool,
    refusals: &mut Refusals,
) {
    let body = &plan.state.clumps.templates[template].body;
    if plan.state.model.rules.starts[template].bonded {
        refusals.add(
            format!("[inlets.{}]", inlet.name),
            format!(
                "the exported inlets feed clumps and spheres, and \"{body}\" comes with its bonds"
            ),
            format!("feed it as a clump: bodies.{body}.start_as = \"clump\""),
        );
    }
    if is_clump && !inlet.random_orientation {
        refusals.add(
            format!("inlets.{}.orientation", inlet.name),
            "fix deposit turns each molecule at random",
            "use orientation = \"random\", or run the scene with dem-run",
        );
    }
}

/// First step, steps from one body to the next, and number of bodies, for a share of an inlet.
/// None: no body comes during the run.
fn times(scene: &Scene, plan: &Plan, inlet: &Inlet, share: f64, per_s: f64) -> Option<[u64; 3]> {
    let step_s = step_s(scene, plan);
    let [start_s, end_s] = inlet.between_s;
    let start = (start_s / step_s).round() as u64;
    let end = ((end_s / step_s).round() as u64).min(steps(scene, plan));
    let every = ((1.0 / (share * per_s * step_s)).round() as u64).max(1);
    let in_time = end.saturating_sub(start).div_ceil(every);
    let allowed = (share * f64::from(inlet.count)).round() as u64;
    let count = in_time.min(allowed);
    (count > 0).then_some([start, every, count])
}

/// Style and arguments of the region of an inlet, and the box around it. They are empty if it is
/// refused.
fn region(plan: &Plan, inlet: &Inlet, refusals: &mut Refusals) -> (String, Bounds) {
    let region = &plan.state.model.rules.regions[inlet.region];
    let bounds = region.bounds();
    let mut refuse = |why: &str| {
        let remedy =
            "use a box, a sphere, or a cylinder along an axis, or run the scene with dem-run";
        refusals.add(format!("inlets.{}.region", inlet.name), why, remedy);
        String::new()
    };
    let words = match region {
        Region::Box(Bounds { low, high }) => block([*low, *high]),
        Region::Sphere { centre_m, radius_m } => {
            format!("sphere {} {radius_m:e}", numbers(centre_m))
        }
        Region::Cylinder {
            from_m,
            to_m,
            radius_m,
        } => match cylinder([*from_m, *to_m], *radius_m) {
            Some(words) => words,
            None => refuse("the region cylinder is along an axis, and this one is not"),
        },
        Region::Inside(..) => refuse("a region of LAMMPS has no triangles"),
    };
    (words, bounds)
}

/// Writes the molecule of a body: its outer spheres, which can be touched, along its principal
/// axes, with its mass, centre and inertia.
pub(super) fn write(feed: &Feed, template: &Template, out: &mut dyn Write) -> io::Result<()> {
    let spheres = || {
        template
            .outer
            .iter()
            .map(|&at| &template.spheres[at as usize])
    };
    writeln!(out, "# {}: units si\n", feed.body)?;
    writeln!(out, "{} atoms", template.outer.len())?;
    if feed.is_clump {
        let [a, b, c] = template.moments_kg_m2;
        writeln!(
            out,
            "{:e} mass\n0 0 0 com\n{a:e} {b:e} {c:e} 0 0 0 inertia",
            template.mass_kg
        )?;
    }
    writeln!(out, "\nCoords\n")?;
    for (number, sphere) in (1..).zip(spheres()) {
        writeln!(out, "{number} {}", numbers(&sphere.place_m))?;
    }
    writeln!(out, "\nTypes\n")?;
    for (number, _) in (1..).zip(spheres()) {
        writeln!(out, "{number} {}", feed.atom_type)?;
    }
    writeln!(out, "\nDiameters\n")?;
    for (number, sphere) in (1..).zip(spheres()) {
        writeln!(out, "{number} {:e}", 2.0 * template.scale * sphere.radius_m)?;
    }
    writeln!(out, "\nMasses\n")?;
    let density_kg_m3 = density_kg_m3(template);
    for (number, volume_m3) in (1..).zip(volumes_m3(template)) {
        writeln!(out, "{number} {:e}", density_kg_m3 * volume_m3)?;
    }
    Ok(())
}

/// Density with which the outer spheres of a clump have its mass together, kg/m3.
pub(super) fn density_kg_m3(template: &Template) -> f64 {
    template.mass_kg / volumes_m3(template).sum::<f64>()
}

/// Volumes of the outer spheres of a clump, m3.
fn volumes_m3(template: &Template) -> impl Iterator<Item = f64> {
    let outer = template
        .outer
        .iter()
        .map(|&at| &template.spheres[at as usize]);
    outer.map(|sphere| volume_m3(template.scale * sphere.radius_m))
}
