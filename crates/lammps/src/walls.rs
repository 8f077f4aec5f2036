//! Walls as `fix wall/gran/region`.
//!
//! Planes, and boxes and cylinders along the axes, are regions of LAMMPS; a surface that is convex
//! as seen from within is the intersection of planes, which stands. The others may move without
//! turning.

use dem_io::Result;
use dem_scene::{Factor, Scene, WallMotion};
use nalgebra::Vector3;

use super::contacts::law_in_words;
use super::feeds::Feed;
use super::forces::formula;
use super::surfaces::{Face, depth_m, faces};
use super::words::{self, ALONG, block, numbers, refused};
use dem_engine::state::contacts::NO_KIND;
use dem_engine::state::walls::Wall;
use dem_physics::geometry::{Bounds, Shape, SolidBox};
use dem_plan::Plan;

/// A wall in the words of LAMMPS.
#[derive(Debug, Clone)]
pub(super) struct WrittenWall {
    /// Its name in the scene.
    pub name: String,
    /// Style and arguments of its region, or of those that intersect in it.
    pub regions: Vec<String>,
    /// Formulas of the displacement along x, y, z; None: it does not move.
    pub moves: Option<[String; 3]>,
    /// For each material that it meets, the law.
    pub laws: Vec<(usize, String)>,
}

/// The walls of a planned scene.
///
/// # Errors
/// A surface that is not convex as seen from the particles, a box or cylinder across the axes, a
/// belt, a servo or a turning wall.
pub(super) fn walls(scene: &Scene, plan: &Plan, feeds: &[Feed]) -> Result<Vec<WrittenWall>> {
    let materials: Vec<&String> = scene.materials.keys().collect();
    let mut present = vec![false; materials.len()];
    for &material in plan.state.contacts.iter().flat_map(|c| &c.materials) {
        present[material as usize] = true;
    }
    for feed in feeds {
        present[feed.material] = true;
    }
    let mut walls = Vec::new();
    for wall in &plan.state.walls {
        let model = &wall.model;
        let part = format!("[walls.{}]", model.name);
        if model.surface_velocity_m_s != [0.0; 3] {
            return Err(refused(
                scene,
                &part,
                "a region has no belt that moves while it stands",
                "leave surface_velocity out, or run the scene with dem-run",
            ));
        }
        let regions = regions(scene, &part, plan, wall)?;
        let moves = moves(scene, &part, &model.motion)?;
        if regions.len() > 1 && moves.is_some() {
            return Err(refused(
                scene,
                &part,
                "a surface is an intersection of regions, which cannot move as one",
                "let it stand, or run the scene with dem-run",
            ));
        }
        let mut laws = Vec::new();
        let kinds = model.kind_of.iter().enumerate();
        for (material, &kind) in kinds.filter(|(m, kind)| **kind != NO_KIND && present[*m]) {
            let names = format!("{} with [walls.{}]", materials[material], model.name);
            let law = law_in_words(scene, &names, &model.kinds[kind as usize])?;
            laws.push((material, law));
        }
        walls.push(WrittenWall {
            name: model.name.clone(),
            regions,
            moves,
            laws,
        });
    }
    Ok(walls)
}

/// Style and arguments of the region of a wall, or of those that intersect in it.
fn regions(scene: &Scene, part: &str, plan: &Plan, wall: &Wall) -> Result<Vec<String>> {
    let frame = &wall.frame;
    let region = match &wall.model.shape {
        Shape::Plane(plane) => {
            let point = frame.to_space(plane.point_m());
            let normal = frame.direction_to_space(plane.normal());
            plane_region(&point, &normal)
        }
        Shape::Box(solid) => {
            let corners = corners(scene, part, wall, solid)?;
            format!("{} side out", block(corners))
        }
        Shape::Cylinder(cylinder) => {
            let ends_m = cylinder.ends_m().map(|end| frame.to_space(end));
            let Some(region) = words::cylinder(ends_m, cylinder.radius_m()) else {
                return Err(refused(
                    scene,
                    part,
                    "the region cylinder is along an axis, and this wall is not",
                    "turn the scene, or run it with dem-run",
                ));
            };
            format!("{region} side out")
        }
        Shape::Mesh(mesh) => {
            let up = -Vector3::from(plan.state.model.gravity_m_s2);
            let up = up.try_normalize(0.0).unwrap_or_default();
            let faces = faces(mesh, frame, up).and_then(|faces| holds_all(plan, faces));
            let regions = |faces: Vec<Face>| {
                let region =
                    |[point, normal]: &Face| plane_region(&(*point).into(), &(*normal).into());
                faces.iter().map(region).collect()
            };
            return faces.map(regions).map_err(|why| {
                let why = format!("fix wall/gran has no triangles, only planes around a room, and {why}");
                let remedy = "replace the surface by planes, boxes and cylinders, or run the scene with dem-run";
                refused(scene, part, why, remedy)
            });
        }
    };
    Ok(vec![region])
}

fn plane_region(point: &[f64; 3], normal: &[f64; 3]) -> String {
    format!("plane {} {} side in", numbers(point), numbers(normal))
}

/// These faces, if all particles and inlets are in front of them.
fn holds_all(plan: &Plan, faces: Vec<Face>) -> std::result::Result<Vec<Face>, String> {
    let is_in = |place: &Vector3<f64>| faces.iter().all(|face| depth_m(face, place) > 0.0);
    let particles = plan.state.particles.poses.iter();
    let mut particles = particles.map(|pose| pose.place());
    if !particles.all(|place| is_in(&place)) {
        return Err("there are particles outside".to_owned());
    }
    let rules = &plan.state.model.rules;
    let of_inlets = rules
        .inlets
        .iter()
        .map(|inlet| &rules.regions[inlet.region]);
    let mut corners = of_inlets.flat_map(|region| corners_of(&region.bounds()));
    if !corners.all(|corner| is_in(&corner)) {
        return Err("there is an inlet outside".to_owned());
    }
    Ok(faces)
}

/// The corners of a box, m.
fn corners_of(bounds: &Bounds) -> [Vector3<f64>; 8] {
    let ends = [bounds.low, bounds.high];
    std::array::from_fn(|n| Vector3::from([0, 1, 2].map(|k| ends[n >> k & 1][k])))
}

/// The corners of a box along the axes.
fn corners(scene: &Scene, part: &str, wall: &Wall, solid: &SolidBox) -> Result<[[f64; 3]; 2]> {
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let is_along = |axis: [f64; 3]| {
        let turned = wall.frame.direction_to_space(axis);
        turned.iter().any(|x| x.abs() >= ALONG)
    };
    if !axes.into_iter().all(is_along) {
        return Err(refused(
            scene,
            part,
            "the region block is along the axes, and this box is turned",
            "replace it by planes, or run the scene with dem-run",
        ));
    }
    let bounds = solid.bounds();
    let [one, other] = [bounds.low, bounds.high].map(|corner| wall.frame.to_space(corner));
    Ok([
        [0, 1, 2].map(|k| one[k].min(other[k])),
        [0, 1, 2].map(|k| one[k].max(other[k])),
    ])
}

/// The displacement of a wall along x, y and z as formulas of the time.
fn moves(scene: &Scene, part: &str, motion: &WallMotion) -> Result<Option<[String; 3]>> {
    let turns = || {
        Err(refused(
            scene,
            part,
            "the exported regions move, but do not turn",
            "leave angular_velocity, angular_displacement and gyration out, or run the scene with dem-run",
        ))
    };
    match motion {
        WallMotion::Fixed => Ok(None),
        WallMotion::Velocity {
            velocity_m_s,
            spin_rad_s,
            factor,
        } => {
            if *spin_rad_s != [0.0; 3] {
                return turns();
            }
            let travelled = match factor {
                Factor::One => "time".to_owned(),
                Factor::Ramp { until_s } => format!(
                    "((time<{until_s:e})*time*time/{:e}+(time>={until_s:e})*(time-{:e}))",
                    2.0 * until_s,
                    0.5 * until_s
                ),
                Factor::Table(_) | Factor::Oscillation { .. } => {
                    return Err(refused(
                        scene,
                        part,
                        "the path of a region is a formula, and a table of velocities has no short one",
                        "give a table of displacements instead",
                    ));
                }
            };
            Ok(Some(velocity_m_s.map(|v| format!("{v:e}*{travelled}"))))
        }
        WallMotion::Displacement {
            displacement_m,
            angular_displacement_rad,
            factor,
        } => {
            if *angular_displacement_rad != [0.0; 3] {
                return turns();
            }
            let factor = formula(factor);
            Ok(Some(displacement_m.map(|d| format!("{d:e}*{factor}"))))
        }
        WallMotion::Orbit(orbit) => {
            let rate_rad_s = std::f64::consts::TAU * orbit.frequency_hz;
            let [from, to] = [0.0, 0.25 / orbit.frequency_hz].map(|at_s| orbit.place_m(at_s));
            Ok(Some([0, 1, 2].map(|k| {
                format!(
                    "({:e}*(cos({rate_rad_s:e}*time)-1)+({:e})*sin({rate_rad_s:e}*time))",
                    from[k], to[k]
                )
            })))
        }
        WallMotion::Gyration(_) => turns(),
        WallMotion::Servo { .. } | WallMotion::Bar { .. } | WallMotion::Weight { .. } => {
            Err(refused(
                scene,
                part,
                "a region that moves with particles around it takes no force as a target",
                "give it a velocity or a displacement",
            ))
        }
    }
}
