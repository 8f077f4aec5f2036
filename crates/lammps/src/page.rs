//! The page of an export: what is carried over, and what is not.

use std::fmt::Write;

use dem_io::text::counted;

use super::bonds::CLASS_WIDTH;
use super::clumps::has_bodies;
use super::duration::{frame_every, step_s, steps};
use super::files::{BONDS, BROKEN, FRAMES};
use super::input::Input;
use super::input_walls::needs_surfaces;
use super::wall_motion::SurfaceMotion;
use super::walls::{WrittenShape, WrittenWall};

/// The page as Markdown.
pub(super) fn page(input: &Input<'_>) -> String {
    let state = &input.plan.state;
    let mut text = format!(
        "# {} for LAMMPS\n\n\
         ```sh\nmpirun -np 4 lmp -in in.lammps      # or lmp -in in.lammps\n\
         dem-run import . -o results          # back to frames, a page and pictures\n```\n\n\
         SI units (m, kg, s, N). Needs {}.\n\n\
         ## Carried over\n\n",
        input.scene.source,
        needs(input.walls)
    );
    let mut item = |line: String| {
        // Writing to a string does not fail.
        let _ = writeln!(text, "- {line}");
    };
    item(format!(
        "{}: places, radii, densities, velocities, spins. The id of an atom is `particle_id` + 1.",
        counted(state.particles.len(), "particle")
    ));
    if !input.types.types.is_empty() {
        item(format!(
            "{} as `bpm/rotational` in {}: classes of stiffness and strength no wider than {CLASS_WIDTH:e}; no coefficient of a bond differs by more than {:.1e} from that of its type.",
            counted(state.bonds.len(), "bond"),
            counted(input.types.types.len(), "type"),
            input.types.largest_error
        ));
    }
    for ([a, b], law) in &input.contacts.laws {
        let names = &input.contacts.materials;
        item(format!("contacts {}-{}: `{law}`", names[*a], names[*b]));
    }
    for wall in input.walls {
        item(format!("wall {}: {}", wall.name, shape(wall)));
    }
    if has_bodies(state) {
        item(format!(
            "{} as `rigid/small`, with mass, centre and inertia of the clump",
            counted(state.clumps.all.len(), "clump")
        ));
    }
    for feed in input.feeds {
        item(format!(
            "inlet {}, body {}: {}, one every {}, as `deposit` in `region {}`",
            feed.inlet,
            feed.body,
            counted(feed.count as usize, "body"),
            counted(feed.every as usize, "step"),
            feed.region
        ));
    }
    for load in &input.forces.loads {
        item(format!("load {} (`addforce`)", load.name));
    }
    for support in &input.forces.supports {
        item(format!("support {}", support.name));
    }
    if state.model.particle_damping > 0.0 {
        item("local damping (`damping/cundall`)".to_owned());
    }
    item(format!(
        "{} of {:e} s, frames every {}: `{FRAMES}`, unbroken bonds `{BONDS}`, broken ones `{BROKEN}`",
        counted(steps(input.scene, input.plan) as usize, "step"),
        step_s(input.scene, input.plan),
        counted(frame_every(input.scene, input.plan) as usize, "step"),
    ));
    text += "\n## Different\n\n";
    for line in different(input) {
        let _ = writeln!(text, "- {line}");
    }
    text
}

/// The LAMMPS that can run an export with these walls.
pub(super) fn needs(walls: &[WrittenWall]) -> String {
    match walls.iter().any(needs_surfaces) {
        true => "LAMMPS of 4 July 2026 or later with the packages BPM, EXTRA-FIX, GRANSURF, GRANULAR and RIGID",
        false => "LAMMPS of 22 July 2025 or later with the packages BPM, EXTRA-FIX, GRANULAR and RIGID",
    }
    .to_owned()
}

/// A wall in the words of LAMMPS.
fn shape(wall: &WrittenWall) -> String {
    let surface = match &wall.shape {
        WrittenShape::Region(region, moves) => {
            let moves = if moves.is_some() { ", moving" } else { "" };
            return format!("`region {region}`{moves}");
        }
        WrittenShape::Surface(surface) => surface,
    };
    let moves = match surface.motion {
        SurfaceMotion::Stands => "",
        SurfaceMotion::Travels { .. } => ", moving",
        SurfaceMotion::Turns(_) => ", turning",
    };
    let triangles = counted(surface.triangles_m.len(), "triangle");
    let file = wall.file();
    let instead = match &surface.planes {
        Ok(planes) => format!(
            "in LAMMPS before 4 July 2026, and with `-var surfaces 0`, as `region intersect` of {} planes, one for each face of the surface",
            planes.len()
        ),
        Err(why) => format!("planes cannot stand for it: {why}"),
    };
    format!("`fix surface/global` of {triangles} (`{file}`){moves}; {instead}")
}

/// What the exported run does differently.
fn different(input: &Input<'_>) -> Vec<String> {
    let mut lines = Vec::new();
    let scene = input.scene;
    if scene.run.rest_energy_ratio.is_some() {
        lines.push("`run.rest_energy_ratio`: the run goes on to `end_time`.".to_owned());
    }
    if scene.measures.values().any(|m| m.end_run_above.is_some()) {
        lines.push("`end_run_above` of measures: the run goes on to `end_time`.".to_owned());
    }
    if input.plan.is_adaptive {
        lines.push("The time step stays that of the start.".to_owned());
    }
    if input.plan.state.damping_rate_1_s > 0.0 {
        lines.push("Damping of bonds is of first order in the time step, in Crumble of second: it shortens the largest stable step.".to_owned());
    }
    if !scene.measures.is_empty() {
        lines.push(
            "Measures, energies, events and the verdict: LAMMPS does not compute them.".to_owned(),
        );
    }
    if input.types.break_at_all() && !input.contacts.laws.is_empty() {
        lines.push("Particles that overlap when their bond breaks push each other with the full force of that overlap; in Crumble it becomes the origin of their law.".to_owned());
    }
    let of_style = |wall: &WrittenWall, style: &str| match &wall.shape {
        WrittenShape::Region(region, _) => region.starts_with(style),
        WrittenShape::Surface(_) => false,
    };
    if input.walls.iter().any(|wall| of_style(wall, "cylinder")) {
        lines.push("On cylinders, LAMMPS takes the curvature of the wall into account; in Crumble a wall is flat where it is touched.".to_owned());
    }
    // Planes alone meet in corners only, where each of them pushes here as well.
    if input.walls.len() > 1 && !input.walls.iter().all(|wall| of_style(wall, "plane")) {
        lines.push("Where walls meet as one surface, as two boxes side by side do, LAMMPS pushes a sphere with each of them; in Crumble with the nearer one.".to_owned());
    }
    let surfaces = || input.walls.iter().filter_map(WrittenWall::surface);
    if surfaces().any(|surface| surface.planes.is_ok()) {
        lines.push("Without `fix surface/global`, the faces of a surface that is open go on upwards beyond its rim, and nothing touches the rim.".to_owned());
    }
    if surfaces().next().is_some() {
        lines.push("`fix surface/global` averages the normals of edges and corners. Each particle is compared with each triangle: for large surfaces try `neighbor bin` in place of `neighbor nsq`, unless an inlet feeds particles larger than those of the start.".to_owned());
    }
    if !input.contacts.laws.is_empty() || !input.walls.is_empty() {
        lines.push("Where a contact slides, LAMMPS limits spring and damper together; in Crumble the spring first, and the damper to what is left.".to_owned());
    }
    if !input.feeds.is_empty() {
        lines.push("Inlets: LAMMPS draws places and orientations of its own and feeds at whole numbers of steps, so results agree as those of two seeds do. The middle of a body's box is in the region, not its centre of mass. A body without room after ten tries is left out; in Crumble it waits. LAMMPS looks for room among particles, not at walls.".to_owned());
    }
    lines.push("Large deformations: bending and torsion are proportional to angles; in Crumble to twice the sine of half of them.".to_owned());
    lines
}
